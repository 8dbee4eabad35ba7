//! `EXT_mesh_gpu_instancing`: a node's mesh, many times over.

use gltf::json::{Value, scene};

use crate::ImportError;

use super::accessor::Accessors;
use super::transform::Transform;

pub(super) const NAME: &str = "EXT_mesh_gpu_instancing";

/// Accessors that say where a node's instances stand.
pub(super) fn accessors(node: &scene::Node) -> Vec<usize> {
    let extension = node.extensions.as_ref().and_then(|all| all.others.get(NAME));
    let Some(attributes) = extension.and_then(|extension| extension.get("attributes")) else {
        return Vec::new();
    };
    ["TRANSLATION", "ROTATION", "SCALE"].iter().filter_map(|name| index(attributes, name)).collect()
}

fn index(attributes: &Value, name: &str) -> Option<usize> {
    attributes.get(name).and_then(Value::as_u64).and_then(|index| usize::try_from(index).ok())
}

/// Where each instance stands in the node's frame; `None` for a node without the extension.
///
/// # Errors
/// Malformed where an attribute is no accessor of the right form, or they are not of one length.
pub(super) fn frames(
    node: &scene::Node,
    number: usize,
    accessors: &Accessors<'_>,
) -> Result<Option<Vec<Transform>>, ImportError> {
    let Some(extension) = node.extensions.as_ref().and_then(|all| all.others.get(NAME)) else {
        return Ok(None);
    };
    let place = format!("nodes[{number}].extensions.{NAME}.attributes");
    let attributes = extension.get("attributes").unwrap_or(&Value::Null);
    let accessor = |name: &str| index(attributes, name);
    let asked = |name: &str| format!("{place}.{name}");
    let shifts = accessor("TRANSLATION")
        .map(|index| accessors.vectors::<3>(index, &asked("TRANSLATION")))
        .transpose()?;
    let turns =
        accessor("ROTATION").map(|index| accessors.vectors::<4>(index, &asked("ROTATION"))).transpose()?;
    let scales = accessor("SCALE").map(|index| accessors.vectors::<3>(index, &asked("SCALE"))).transpose()?;
    let counts = [shifts.as_ref().map(Vec::len), turns.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
    let Some(count) = counts.into_iter().flatten().min() else { return Ok(None) };
    if counts.into_iter().flatten().any(|other| other != count) {
        return Err(ImportError::malformed(place, "the attributes are not of one length"));
    }
    let frame = |at: usize| {
        let shift = shifts.as_ref().map_or([0.0; 3], |shifts| shifts[at]);
        let turn = turns.as_ref().map_or([0.0, 0.0, 0.0, 1.0], |turns| turns[at]);
        let scale = scales.as_ref().map_or([1.0; 3], |scales| scales[at]);
        Transform::of_parts(shift, turn, scale)
    };
    Ok(Some((0..count).map(frame).collect()))
}
