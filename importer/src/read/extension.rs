//! Which glTF extensions a file may require.

use crate::ImportError;

use super::notes::Notes;

/// Read in full.
const READ: [&str; 9] = [
    "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",
    "KHR_implicit_shapes",
    "KHR_physics_rigid_bodies",
    "OMI_physics_shape",
    "OMI_physics_body",
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
];

/// Hold or pack geometry in a way that is not read, with what to say about it.
const REFUSED: [(&str, &str); 2] = [
    ("KHR_gaussian_splatting", "an export of the surface as triangles"),
    ("CESIUM_primitive_outline", "a re-export without it"),
];

/// Prefixes and names of extensions about looks, light, sound, animation or data: geometry is whole without them.
const HARMLESS: [&str; 17] = [
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "KHR_animation_",
    "KHR_audio",
    "KHR_xmp",
    "KHR_node_",
    "KHR_techniques_webgl",
    "EXT_texture_",
    "EXT_lights_",
    "EXT_materials_",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "EXT_instance_features",
    "EXT_property_",
    "MSFT_",
    "ADOBE_materials",
];

/// # Errors
/// Unsupported, naming the first required extension that packs geometry in a way that is not read.
pub(super) fn check(required: &[String], notes: &mut Notes) -> Result<(), ImportError> {
    for (index, name) in required.iter().enumerate() {
        let place = format!("extensionsRequired[{index}]");
        if let Some((_, way_out)) = REFUSED.iter().find(|(refused, _)| refused == name) {
            return Err(ImportError::unsupported(
                place,
                format!("the file requires {name}, which is not read"),
                format!("Try {way_out}"),
            ));
        }
        if READ.contains(&name.as_str()) {
            continue;
        }
        let message = if HARMLESS.iter().any(|prefix| name.starts_with(prefix)) {
            format!("the file requires {name}, which does not concern its geometry")
        } else {
            format!("the file requires {name}, which is not known here: its geometry is read without it")
        };
        notes.add("extension-ignored", place, message);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(required: &[&str]) -> Result<Notes, ImportError> {
        let mut notes = Notes::default();
        let required: Vec<_> = required.iter().map(|&name| name.to_owned()).collect();
        check(&required, &mut notes).map(|()| notes)
    }

    #[test]
    fn packed_geometry_is_refused_by_name_with_a_way_out() {
        let error = checked(&["KHR_texture_basisu", "KHR_gaussian_splatting"]).unwrap_err();
        assert_eq!(error.place(), "extensionsRequired[1]");
        assert!(error.reason().contains("KHR_gaussian_splatting"));
        assert!(error.way_out().contains("export"));
    }

    #[test]
    fn the_rest_is_noted_or_silent() {
        assert_eq!(checked(&READ).unwrap().finish(), []);
        assert_eq!(checked(&["KHR_materials_unlit", "ACME_unheard_of"]).unwrap().finish().len(), 2);
    }
}
