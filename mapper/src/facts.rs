//! What the mapper may know of a model: names and measures, in file units.

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
            shape: Some(ShapeFacts::of(&asset.measures)),
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
