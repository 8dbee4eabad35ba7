//! From the solver's scene to rapier's types, f32.

use rapier3d::parry::shape::{SharedShape, TriMeshFlags};
use rapier3d::prelude::{
    AngVector, MassProperties, Matrix, Pose as RapierPose, RigidBodyBuilder, Rotation, Vector,
};
use sim::{Entity, Mass, Motion, Pose, Shape};

pub(crate) fn body(entity: &Entity, sleeping: bool) -> RigidBodyBuilder {
    let builder = match entity.motion {
        Motion::Static => RigidBodyBuilder::fixed(),
        Motion::Dynamic(mass) => RigidBodyBuilder::dynamic()
            .additional_mass_properties(mass_properties(&mass))
            .linvel(vector(entity.velocity.linear))
            .angvel(vector(entity.velocity.angular))
            .can_sleep(sleeping)
            .allow_fast_rotation(true),
    };
    builder.pose(pose(&entity.pose)).linear_damping(0.0).angular_damping(0.0)
}

fn mass_properties(mass: &Mass) -> MassProperties {
    let [xx, yy, zz, xy, xz, yz] = mass.inertia_kg_m2.map(|value| value as f32);
    let inertia =
        Matrix::from_cols(Vector::new(xx, xy, xz), Vector::new(xy, yy, yz), Vector::new(xz, yz, zz));
    MassProperties::with_inertia_matrix(Vector::ZERO, mass.mass_kg as f32, inertia)
}

pub(crate) fn shape(shape: &Shape) -> Result<SharedShape, String> {
    Ok(match shape {
        Shape::Sphere { radius } => SharedShape::ball(*radius as f32),
        Shape::Box { half_extents: [x, y, z] } => SharedShape::cuboid(*x as f32, *y as f32, *z as f32),
        Shape::Capsule { half_height, radius } => SharedShape::capsule_y(*half_height as f32, *radius as f32),
        Shape::Cylinder { half_height, radius } => SharedShape::cylinder(*half_height as f32, *radius as f32),
        Shape::Cone { half_height, radius } => SharedShape::cone(*half_height as f32, *radius as f32),
        Shape::Hull { points } => {
            let points: Vec<Vector> = points.iter().copied().map(vector).collect();
            SharedShape::convex_hull(&points).ok_or("rapier finds no convex hull of its points")?
        }
        Shape::HalfSpace => SharedShape::halfspace(Vector::Y),
        Shape::TriangleMesh { positions, triangles } => triangle_mesh(positions, triangles)?,
        // As its triangles: rapier's own height field parts each cell along the other diagonal.
        Shape::HeightField(field) => {
            let (positions, triangles) = field.mesh();
            triangle_mesh(&positions, &triangles)?
        }
    })
}

fn triangle_mesh(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<SharedShape, String> {
    let positions = positions.iter().copied().map(vector).collect();
    SharedShape::trimesh_with_flags(positions, triangles.to_vec(), TriMeshFlags::FIX_INTERNAL_EDGES)
        .map_err(|error| format!("rapier refuses the triangle mesh: {error}"))
}

pub(crate) fn vector(value: [f64; 3]) -> AngVector {
    AngVector::from_array(value.map(|value| value as f32))
}

pub(crate) fn pose(pose: &Pose) -> RapierPose {
    let rotation = Rotation::from_array(pose.rotation.map(|value| value as f32)).normalize();
    RapierPose::from_parts(vector(pose.position), rotation)
}
