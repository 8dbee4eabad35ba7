//! Many bodies: one entity a kind of shape, its poses as instances, since a viewer grows slow with entities.

use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

use rerun::{
    Boxes3D, Capsules3D, Cylinders3D, Ellipsoids3D, EntityPath, FillMode, InstancePoses3D, Quaternion,
    RecordingStream, SerializedComponentColumn,
};
use sim::{ChildShape, Entity, Shape, SleepState};

use crate::block::Block;
use crate::body::times;
use crate::error::ViewerError;
use crate::mesh::Mesh;
use crate::palette;
use crate::path;
use crate::place::Drawn;
use crate::scenery::{Look, Scenery, Script};
use crate::visual::VisualMesh;

/// Turns the viewer's Z of capsules and cylinders to the solver's Y: minus a quarter about X.
const Z_TO_Y: [f32; 4] = [-std::f32::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f32::consts::FRAC_1_SQRT_2];

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Boxes,
    Spheres,
    Capsules,
    Cylinders,
    /// One mesh and one colour for all: the state does not show on it.
    Mesh,
}

/// One entity with its instances.
pub(crate) struct Class {
    path: EntityPath,
    kind: Kind,
    /// Entity of the scene, and body from instance.
    members: Vec<(usize, Drawn)>,
    sizes: Vec<[f32; 3]>,
    overlay: bool,
    last_poses: Vec<Drawn>,
    last_states: Vec<SleepState>,
}

impl Class {
    fn new(path: EntityPath, kind: Kind, overlay: bool) -> Self {
        let (members, sizes) = (Vec::new(), Vec::new());
        Self { path, kind, members, sizes, overlay, last_poses: Vec::new(), last_states: Vec::new() }
    }

    fn push(&mut self, entity: usize, local: Drawn, size: [f32; 3]) {
        self.members.push((entity, local));
        self.sizes.push(size);
    }

    /// Logs sizes once.
    fn begin(&self, stream: &RecordingStream) -> Result<(), ViewerError> {
        let fill = FillMode::Solid;
        let radii = || self.sizes.iter().map(|size| size[0]);
        let lengths = || self.sizes.iter().map(|size| 2.0 * size[1]);
        let path = self.path.clone();
        match self.kind {
            Kind::Boxes => stream.log_static(
                path,
                &Boxes3D::update_fields().with_half_sizes(self.sizes.iter().copied()).with_fill_mode(fill),
            ),
            Kind::Spheres => stream.log_static(
                path,
                &Ellipsoids3D::update_fields()
                    .with_half_sizes(self.sizes.iter().copied())
                    .with_fill_mode(fill),
            ),
            Kind::Capsules => stream.log_static(
                path,
                &Capsules3D::update_fields().with_radii(radii()).with_lengths(lengths()).with_fill_mode(fill),
            ),
            Kind::Cylinders => stream.log_static(
                path,
                &Cylinders3D::update_fields()
                    .with_radii(radii())
                    .with_lengths(lengths())
                    .with_fill_mode(fill),
            ),
            Kind::Mesh => Ok(()),
        }
        .map_err(ViewerError::encode)
    }

    /// Sends the rows of `block` in which any member moved or changed state.
    pub(crate) fn block(&mut self, stream: &RecordingStream, block: &Block) -> Result<(), ViewerError> {
        let (mut moved, mut changed) = (Vec::new(), Vec::new());
        let (mut poses, mut states) = (Vec::new(), Vec::new());
        for row in 0..block.rows.len() {
            let at = |entity: usize| row * block.bodies + entity;
            let now: Vec<Drawn> =
                self.members.iter().map(|(e, local)| block.poses[at(*e)].after(local)).collect();
            if now != self.last_poses {
                moved.push(row);
                poses.extend_from_slice(&now);
                self.last_poses = now;
            }
            let now: Vec<SleepState> = self.members.iter().map(|(e, _)| block.sleep[at(*e)]).collect();
            if self.kind != Kind::Mesh && now != self.last_states {
                changed.push(row);
                states.extend_from_slice(&now);
                self.last_states = now;
            }
        }
        let count = self.members.len();
        if !moved.is_empty() {
            let columns = InstancePoses3D::update_fields()
                .with_translations(poses.iter().map(|pose| pose.position))
                .with_quaternions(poses.iter().map(|pose| Quaternion::from_xyzw(pose.rotation)))
                .columns(vec![count; moved.len()])
                .map_err(ViewerError::encode)?;
            let sent = stream.send_columns(self.path.clone(), times(block, &moved), columns);
            sent.map_err(ViewerError::encode)?;
        }
        if !changed.is_empty() {
            let paint = if self.overlay { palette::overlay } else { palette::state };
            let columns = self.colors(states.into_iter().map(paint), &vec![count; changed.len()])?;
            let sent = stream.send_columns(self.path.clone(), times(block, &changed), columns);
            sent.map_err(ViewerError::encode)?;
        }
        Ok(())
    }

    fn colors(
        &self,
        colors: impl Iterator<Item = [u8; 4]>,
        lengths: &[usize],
    ) -> Result<Vec<SerializedComponentColumn>, ViewerError> {
        let colors = colors.map(palette::color);
        let columns: Vec<_> = match self.kind {
            Kind::Spheres => Ellipsoids3D::update_fields()
                .with_colors(colors)
                .columns(lengths.iter().copied())
                .map(Iterator::collect),
            Kind::Capsules => Capsules3D::update_fields()
                .with_colors(colors)
                .columns(lengths.iter().copied())
                .map(Iterator::collect),
            Kind::Cylinders => Cylinders3D::update_fields()
                .with_colors(colors)
                .columns(lengths.iter().copied())
                .map(Iterator::collect),
            Kind::Boxes | Kind::Mesh => Boxes3D::update_fields()
                .with_colors(colors)
                .columns(lengths.iter().copied())
                .map(Iterator::collect),
        }
        .map_err(ViewerError::encode)?;
        Ok(columns)
    }
}

/// Sorts the moving entities of a scene into classes and logs their constants.
pub(crate) fn begin(
    stream: &RecordingStream,
    script: &Script,
    scenery: &Scenery,
) -> Result<Vec<Class>, ViewerError> {
    let mut sorter = Sorter { stream, classes: Vec::new(), meshes: HashMap::new() };
    for (index, (entity, look)) in script.entities.iter().zip(&scenery.looks).enumerate() {
        if look.fixed {
            continue;
        }
        if look.visual {
            sorter.mesh("world/bodies", index, &look.body, IDENTITY)?;
        }
        sorter.shapes(index, entity, look)?;
    }
    for class in &sorter.classes {
        class.begin(stream)?;
    }
    Ok(sorter.classes)
}

struct Sorter<'a> {
    stream: &'a RecordingStream,
    classes: Vec<Class>,
    /// Classes of meshes by root and content; a hash met twice is taken for the same mesh.
    meshes: HashMap<(&'static str, u64), usize>,
}

impl Sorter<'_> {
    /// Bodies without a visual are drawn by their shapes; the others' shapes are the overlay.
    fn shapes(&mut self, index: usize, entity: &Entity, look: &Look) -> Result<(), ViewerError> {
        let root = if look.visual { "world/colliders" } else { "world/bodies" };
        for child in &entity.shapes {
            match primitive(child) {
                Some((kind, local, size)) => {
                    let name = match kind {
                        Kind::Boxes => "boxes",
                        Kind::Spheres => "spheres",
                        Kind::Capsules => "capsules",
                        Kind::Cylinders | Kind::Mesh => "cylinders",
                    };
                    self.primitive(root, name, kind).push(index, local, size);
                }
                None => {
                    if let Some(mut mesh) = crate::tessellate::shape(&child.shape) {
                        mesh.color = palette::body(0);
                        self.mesh(root, index, &[mesh], Drawn::of(&child.body_from_shape))?;
                    }
                }
            }
        }
        Ok(())
    }

    fn primitive(&mut self, root: &'static str, name: &str, kind: Kind) -> &mut Class {
        let path = path::join(root, &[name]);
        let found = self.classes.iter().position(|class| class.path == path);
        let index = found.unwrap_or_else(|| {
            self.classes.push(Class::new(path, kind, root == "world/colliders"));
            self.classes.len() - 1
        });
        &mut self.classes[index]
    }

    fn mesh(
        &mut self,
        root: &'static str,
        entity: usize,
        meshes: &[VisualMesh],
        local: Drawn,
    ) -> Result<(), ViewerError> {
        let key = (root, fingerprint(meshes));
        let next = self.meshes.len();
        let class = if let Some(class) = self.meshes.get(&key) {
            *class
        } else {
            let path = path::join(root, &[&format!("mesh_{next}")]);
            let mesh = Mesh::of(meshes).archetype();
            self.stream.log_static(path.clone(), &mesh).map_err(ViewerError::encode)?;
            self.classes.push(Class::new(path, Kind::Mesh, false));
            self.meshes.insert(key, self.classes.len() - 1);
            self.classes.len() - 1
        };
        self.classes[class].push(entity, local, [0.0; 3]);
        Ok(())
    }
}

const IDENTITY: Drawn = Drawn { position: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0] };

fn fingerprint(meshes: &[VisualMesh]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for mesh in meshes {
        mesh.positions.iter().flatten().for_each(|x| x.to_bits().hash(&mut hasher));
        (&mesh.triangles, mesh.color).hash(&mut hasher);
    }
    hasher.finish()
}

/// The viewer's own primitive for a shape: body from instance, and half sizes or `[radius, half length, 0]`.
#[expect(clippy::cast_possible_truncation, reason = "drawing needs no more than single precision")]
fn primitive(child: &ChildShape) -> Option<(Kind, Drawn, [f32; 3])> {
    let pose = Drawn::of(&child.body_from_shape);
    Some(match &child.shape {
        Shape::Box { half_extents } => (Kind::Boxes, pose, half_extents.map(|x| x as f32)),
        Shape::Sphere { radius } => (Kind::Spheres, pose, [*radius as f32; 3]),
        Shape::Cylinder { half_height, radius } => {
            let turn = Drawn { position: [0.0; 3], rotation: Z_TO_Y };
            (Kind::Cylinders, pose.after(&turn), [*radius as f32, *half_height as f32, 0.0])
        }
        Shape::Capsule { half_height, radius } => {
            // The viewer's capsule begins at its origin.
            let turn = Drawn { position: [0.0, -*half_height as f32, 0.0], rotation: Z_TO_Y };
            (Kind::Capsules, pose.after(&turn), [*radius as f32, *half_height as f32, 0.0])
        }
        Shape::Cone { .. }
        | Shape::Hull { .. }
        | Shape::HalfSpace
        | Shape::TriangleMesh { .. }
        | Shape::HeightField(_) => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_capsule_of_the_viewer_ends_where_the_solvers_does() {
        let child = ChildShape {
            shape: Shape::Capsule { half_height: 2.0, radius: 0.5 },
            body_from_shape: sim::Pose::IDENTITY,
            surface: sim::Surface::new(0.5, 0.0),
            part: 0,
        };
        let Some((_, local, size)) = primitive(&child) else { unreachable!("a capsule is a primitive") };
        let (start, end) = (local.apply([0.0; 3]), local.apply([0.0, 0.0, 2.0 * size[1]]));
        assert!((start[1] + 2.0).abs() < 1e-6 && (end[1] - 2.0).abs() < 1e-6, "{start:?} {end:?}");
    }
}
