//! What the mapper may know of a model: names and measures, in file units.

use importer::collider::{Rung, Shape};
use importer::{Asset, Measures, Stated, VolumeMethod};

/// Everything that a decision may rest on. Nothing here is looked up: the same facts give the same answer.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelFacts {
    /// Path relative to the database's root, `/` separated.
    pub model: String,
    /// A display name, where there is one beside the file's.
    pub title: Option<String>,
    pub tags: Vec<String>,
    /// Node, mesh and object names.
    pub names: Vec<String>,
    pub materials: Vec<String>,
    /// Along the file's axes, in file units; a table may not know all three.
    pub extents: [Option<f64>; 3],
    pub metres_per_unit: f64,
    /// The format or the file says what a unit is worth.
    pub unit_stated: bool,
    /// Of all parts together; `None` where there is no mesh.
    pub shape: Option<ShapeFacts>,
    pub parts: Vec<PartFacts>,
    /// Physics that the file carries.
    pub stated: Vec<Stated>,
}

/// What mass and plausibility need of a mesh, in file units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeFacts {
    pub volume: Option<f64>,
    /// The volume is that of the convex hull: an upper bound.
    pub volume_is_hull: bool,
    pub area: Option<f64>,
    pub hull_volume: Option<f64>,
    pub closed: bool,
    pub bodies: u64,
    /// Of the solid, else of the surface.
    pub spread: Option<SpreadFacts>,
}

/// Where the mass of an evenly filled mesh lies, in file units and the file's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpreadFacts {
    pub center: [f64; 3],
    /// About the centre, at density 1: `[xx, yy, zz, xy, xz, yz]`.
    pub inertia: [f64; 6],
    pub low: [f64; 3],
    pub high: [f64; 3],
    /// The centre lies outside the convex hull, which the mass of no solid does.
    pub outside_hull: bool,
}

/// One part.
#[derive(Clone, Debug, PartialEq)]
pub struct PartFacts {
    pub name: String,
    pub materials: Vec<String>,
    pub shape: ShapeFacts,
}

impl ShapeFacts {
    #[must_use]
    pub fn of(measures: &Measures) -> Self {
        Self {
            volume: measures.solid.map(|solid| solid.measure).filter(|volume| *volume > 0.0),
            volume_is_hull: measures.solid_method == Some(VolumeMethod::Hull),
            area: Some(measures.shell.measure).filter(|area| *area > 0.0),
            hull_volume: measures.hull_volume.filter(|volume| *volume > 0.0),
            closed: measures.closed,
            bodies: measures.bodies,
            spread: Some(measures.solid.unwrap_or(measures.shell)).filter(|spread| spread.measure > 0.0).map(
                |spread| SpreadFacts {
                    center: spread.centroid,
                    inertia: spread.inertia,
                    low: measures.min,
                    high: measures.max,
                    outside_hull: false,
                },
            ),
        }
    }
}

impl ModelFacts {
    /// The facts of an imported model.
    #[must_use]
    pub fn new(model: &str, asset: &Asset) -> Self {
        let mut materials: Vec<String> = Vec::new();
        for material in asset.parts.iter().flat_map(|part| &part.materials) {
            if !materials.contains(material) {
                materials.push(material.clone());
            }
        }
        let mut shape = ShapeFacts::of(&asset.measures);
        if let Some(spread) = &mut shape.spread {
            let diagonal = asset.measures.diagonal();
            spread.outside_hull =
                hull_corners(asset).is_some_and(|corners| separated(corners, spread.center, diagonal));
        }
        let names = asset.names.iter().filter(|name| !materials.contains(name)).cloned().collect();
        Self {
            model: model.to_owned(),
            title: None,
            tags: Vec::new(),
            names,
            materials,
            extents: asset.measures.size().map(Some),
            metres_per_unit: asset.frame.metres_per_unit,
            unit_stated: asset.frame.unit_stated,
            shape: Some(shape),
            parts: asset
                .parts
                .iter()
                .map(|part| PartFacts {
                    name: part.name.clone(),
                    materials: part.materials.clone(),
                    shape: ShapeFacts::of(&part.measures),
                })
                .collect(),
            stated: asset.stated.clone(),
        }
    }

    /// Longest known extent in file units, where it is a positive number.
    #[must_use]
    pub fn longest(&self) -> Option<f64> {
        self.extents.iter().flatten().copied().filter(|side| *side > 0.0 && side.is_finite()).reduce(f64::max)
    }

    /// All three extents in file units, longest first.
    #[must_use]
    pub fn sorted_extents(&self) -> Option<[f64; 3]> {
        let mut sides = [self.extents[0]?, self.extents[1]?, self.extents[2]?];
        sides.sort_by(|a, b| b.total_cmp(a));
        (sides[0] > 0.0 && sides.iter().all(|side| side.is_finite())).then_some(sides)
    }

    /// Longest extent over shortest.
    #[must_use]
    pub fn aspect(&self) -> Option<f64> {
        let sides = self.sorted_extents()?;
        (sides[2] > 0.0).then(|| sides[0] / sides[2])
    }

    /// Hull volume over mesh volume.
    #[must_use]
    pub fn hull_ratio(&self) -> Option<f64> {
        let shape = self.shape?;
        Some(shape.hull_volume? / shape.volume?)
    }

    /// The file name without extensions (`lamp.gltf.glb` is `lamp`), and the extension in lower case.
    #[must_use]
    pub fn stem(&self) -> (&str, String) {
        let file = self.model.rsplit('/').next().unwrap_or_default();
        let mut stem = file;
        let mut extension = String::new();
        while let Some((rest, ending)) = stem.rsplit_once('.') {
            let known = [
                "glb", "gltf", "obj", "stl", "ply", "fbx", "usd", "usda", "usdc", "usdz", "dae", "blend",
                "prefab", "3ds", "max", "off", "xyz", "pts", "asc", "pcd", "vox", "binvox", "yaml", "yml",
                "shapes",
            ];
            if rest.is_empty() || !known.contains(&ending.to_ascii_lowercase().as_str()) {
                break;
            }
            if extension.is_empty() {
                extension = ending.to_ascii_lowercase();
            }
            stem = rest;
        }
        (stem, extension)
    }
}

/// Corners of the hull of the whole, where the ladder has it.
fn hull_corners(asset: &Asset) -> Option<&[[f64; 3]]> {
    let hull = asset.ladder.iter().find(|candidate| candidate.rung == Rung::Hull)?;
    match hull.shapes.as_slice() {
        [Shape::Hull { points }] => Some(points),
        _ => None,
    }
}

/// Is there a plane between a point and the hull of others, farther from it than a thousandth of `size`? Gilbert's
/// iteration on the nearest point of the hull (Gilbert 1966): each step goes to the nearest point of the segment to
/// the corner that lies farthest against it.
fn separated(corners: &[[f64; 3]], point: [f64; 3], size: f64) -> bool {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let from = |corner: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|axis| corner[axis] - point[axis]) };
    let Some(mut nearest) = corners.first().map(from) else { return false };
    for _ in 0..200 {
        let lowest = corners.iter().map(from).min_by(|a, b| dot(*a, nearest).total_cmp(&dot(*b, nearest)));
        let Some(lowest) = lowest else { return false };
        let length = dot(nearest, nearest).sqrt();
        // So near to a point of the hull, no plane keeps farther away from it.
        if length <= 1e-3 * size {
            return false;
        }
        if dot(lowest, nearest) > 1e-3 * size * length {
            return true;
        }
        let way: [f64; 3] = std::array::from_fn(|axis| lowest[axis] - nearest[axis]);
        let share = (-dot(nearest, way) / dot(way, way)).clamp(0.0, 1.0);
        if share.is_nan() || share <= 1e-12 {
            return false;
        }
        nearest = std::array::from_fn(|axis| nearest[axis] + share * way[axis]);
    }
    false
}

#[cfg(test)]
mod tests {
    use super::separated;

    #[test]
    fn a_point_is_outside_a_hull_where_a_plane_parts_them() {
        let cube: Vec<[f64; 3]> =
            (0..8).map(|bits| [0, 1, 2].map(|axis| f64::from(bits >> axis & 1))).collect();
        for (point, outside) in [
            ([0.5, 0.5, 0.5], false),
            ([0.999, 0.999, 0.999], false),
            ([1.2, 0.5, 0.5], true),
            ([-0.01, 0.2, 0.9], true),
            ([1.1, 1.1, 1.1], true),
        ] {
            assert_eq!(separated(&cube, point, 1.7), outside, "{point:?}");
        }
        // Inside the bounds of a tetrahedron and outside of it.
        let tetrahedron = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(separated(&tetrahedron, [0.6, 0.6, 0.6], 1.7));
        assert!(!separated(&tetrahedron, [0.2, 0.2, 0.2], 1.7));
    }
}
