//! From an imported asset and its physics to what the solver takes: the one file that sees both worlds.
//!
//! The importer speaks file units and file axes, the solver metres and Y up. A body's frame sits at the centre of
//! mass with its axes along the file's, turned so that Y is up.

use importer::collider::{Candidate, Rung, Shape as FileShape, cheapest, frustum_corners};
use importer::{Asset, Axis, MassProperties};
use sim::{ChildShape, Entity, Mass, Motion, Pose, Scene, Shape, Surface, Velocity};

use crate::answer::consistency::inertia_is_real;
use crate::attribute::MassModel;
use crate::mapped::Mapped;
use crate::rules::ruleset::Ruleset;

/// A collider is near enough where it is off by no more than this share of the model's diagonal.
pub const COLLIDER_TOLERANCE: f64 = 0.02;

/// Why a model cannot be put into a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    #[error("{model}: no mass: neither a mass, nor a density with a volume, nor a mass range is known")]
    NoMass { model: String },
    #[error("{model}: no collider: the importer found no shape that could stand for it")]
    NoCollider { model: String },
    #[error("{model}: no friction or restitution: a {kind} thing has none")]
    NoSurface { model: String, kind: String },
    #[error("{model}: its extents are not finite, or all zero")]
    NoExtent { model: String },
}

impl SceneError {
    /// Stable, for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoMass { .. } => "no-mass",
            Self::NoCollider { .. } => "no-collider",
            Self::NoSurface { .. } => "no-surface",
            Self::NoExtent { .. } => "no-extent",
        }
    }

    #[must_use]
    pub fn place(&self) -> String {
        match self {
            Self::NoMass { model }
            | Self::NoCollider { model }
            | Self::NoSurface { model, .. }
            | Self::NoExtent { model } => model.clone(),
        }
    }

    #[must_use]
    pub fn reason(&self) -> String {
        self.to_string()
    }

    #[must_use]
    pub fn way_out(&self) -> String {
        match self {
            Self::NoMass { .. } => "set a mass in an override, or give its category a mass range".to_owned(),
            Self::NoCollider { .. } => "check that the file holds triangles with an extent".to_owned(),
            Self::NoSurface { .. } => "set `kind: rigid`, or simulate it as what it is".to_owned(),
            Self::NoExtent { .. } => "check the file's vertices and node scales".to_owned(),
        }
    }
}

/// Where the file's geometry lies in the body's frame: `body = rotation * (metres_per_unit * file) + position`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    pub metres_per_unit: f64,
    pub body_from_file: Pose,
}

impl Placement {
    /// A point of the file, in the body's frame, m.
    #[must_use]
    pub fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        let scaled = point.map(|coordinate| coordinate * self.metres_per_unit);
        add(rotate(self.body_from_file.rotation, scaled), self.body_from_file.position)
    }
}

/// Rotation that turns the file's up axis to +Y, the shortest way.
#[must_use]
pub fn upright(up: Axis) -> [f64; 4] {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    match up {
        Axis::Y => [0.0, 0.0, 0.0, 1.0],
        Axis::Z => [-half, 0.0, 0.0, half],
        Axis::X => [0.0, 0.0, half, half],
    }
}

/// Places the file's geometry about the centre of mass that the mass model implies.
///
/// # Errors
/// [`SceneError::NoExtent`] where the measures are not finite.
pub fn placement(model: &str, asset: &Asset, mapped: &Mapped) -> Result<Placement, SceneError> {
    let scale = mapped.scale.metres_per_unit;
    let diagonal = asset.measures.diagonal() * scale;
    if !(diagonal.is_finite() && diagonal > 0.0) {
        return Err(SceneError::NoExtent { model: model.to_owned() });
    }
    let rotation = upright(asset.frame.up);
    let center = distribution(asset, mapped.mass_model).centroid;
    let position = rotate(rotation, center.map(|coordinate| -coordinate * scale));
    Ok(Placement { metres_per_unit: scale, body_from_file: Pose { position, rotation } })
}

/// How the mass is spread: through the volume, or over the surface.
fn distribution(asset: &Asset, model: MassModel) -> MassProperties {
    let measures = &asset.measures;
    match (model, measures.solid) {
        (MassModel::Shell { .. }, _) | (_, None) => measures.shell,
        (_, Some(solid)) => solid,
    }
}

/// The body of a model: collider, surface, mass and inertia; at the origin, at rest.
///
/// # Errors
/// [`SceneError`] says what is missing.
pub fn drop_entity(
    model: &str,
    asset: &Asset,
    mapped: &Mapped,
    rules: &Ruleset,
) -> Result<Entity, SceneError> {
    let placement = placement(model, asset, mapped)?;
    let surface = surface(mapped, rules)
        .ok_or_else(|| SceneError::NoSurface { model: model.to_owned(), kind: mapped.kind.to_string() })?;
    let candidate =
        collider(asset, mapped).ok_or_else(|| SceneError::NoCollider { model: model.to_owned() })?;
    let shapes: Vec<ChildShape> =
        candidate.shapes.iter().map(|shape| child(shape, &placement, surface)).collect();
    let motion = if mapped.anchored {
        Motion::Static
    } else {
        Motion::Dynamic(
            mass(asset, mapped, &shapes).ok_or_else(|| SceneError::NoMass { model: model.to_owned() })?,
        )
    };
    Ok(Entity { name: model.to_owned(), motion, pose: Pose::IDENTITY, velocity: Velocity::default(), shapes })
}

/// Its material has a name only where friction and restitution are both its preset's: who sets one of them by hand
/// means it in every contact.
fn surface(mapped: &Mapped, rules: &Ruleset) -> Option<Surface> {
    let (friction, restitution) = (mapped.attribute("friction_dynamic")?, mapped.attribute("restitution")?);
    let own = |preset: &str| {
        let by_preset =
            |by: &str| by.strip_prefix("preset:").is_some_and(|by| by.split(' ').next() == Some(preset));
        [friction, restitution].iter().all(|value| by_preset(&value.provenance.by))
    };
    let preset =
        mapped.preset.as_deref().filter(|preset| own(preset)).and_then(|preset| rules.surface(preset));
    Some(Surface {
        friction: friction.value.number()?,
        restitution: restitution.value.number()?,
        rolling_resistance: mapped.number("rolling_resistance").unwrap_or(0.0),
        material: preset.and_then(|surface| surface.material),
    })
}

/// Error that the collider may have, as a share of the diagonal: what a category, a rule or an override says in
/// metres, else [`COLLIDER_TOLERANCE`].
#[must_use]
pub fn collider_tolerance(asset: &Asset, mapped: &Mapped) -> f64 {
    let diagonal_m = asset.measures.diagonal() * mapped.scale.metres_per_unit;
    match &mapped.collider_tolerance {
        Some(said) if diagonal_m > 0.0 && diagonal_m.is_finite() => said.metres / diagonal_m,
        _ => COLLIDER_TOLERANCE,
    }
}

/// The cheapest candidate near enough; what never moves may be the surface itself.
#[must_use]
pub fn collider<'a>(asset: &'a Asset, mapped: &Mapped) -> Option<&'a Candidate> {
    let surface = asset.ladder.iter().find(|candidate| candidate.rung == Rung::TriangleMesh);
    surface
        .filter(|_| mapped.anchored)
        .or_else(|| cheapest(&asset.ladder, collider_tolerance(asset, mapped)))
        .filter(|candidate| !candidate.shapes.is_empty())
}

/// A collider's shape on a body of that placement.
#[must_use]
pub fn child(shape: &FileShape, placement: &Placement, surface: Surface) -> ChildShape {
    let scale = placement.metres_per_unit;
    let turn = placement.body_from_file.rotation;
    let posed = |center: &[f64; 3], rotation: [f64; 4]| Pose {
        position: placement.apply(*center),
        rotation: multiply(turn, rotation),
    };
    let identity = [0.0, 0.0, 0.0, 1.0];
    let points = |points: &[[f64; 3]]| points.iter().map(|point| placement.apply(*point)).collect();
    let (shape, body_from_shape) = match shape {
        FileShape::Sphere { center, radius } => {
            (Shape::Sphere { radius: radius * scale }, posed(center, identity))
        }
        FileShape::Box { center, rotation, half_extents } => {
            (Shape::Box { half_extents: half_extents.map(|half| half * scale) }, posed(center, *rotation))
        }
        FileShape::Capsule { center, rotation, half_height, radius } => (
            Shape::Capsule { half_height: half_height * scale, radius: radius * scale },
            posed(center, *rotation),
        ),
        FileShape::Cylinder { center, rotation, half_height, radius } => (
            Shape::Cylinder { half_height: half_height * scale, radius: radius * scale },
            posed(center, *rotation),
        ),
        FileShape::Frustum { center, rotation, half_height, radius_bottom, radius_top } => (
            Shape::Hull {
                points: frustum_corners(half_height * scale, radius_bottom * scale, radius_top * scale),
            },
            posed(center, *rotation),
        ),
        FileShape::Hull { points: corners } => (Shape::Hull { points: points(corners) }, Pose::IDENTITY),
        FileShape::TriangleMesh { positions, triangles } => (
            Shape::TriangleMesh { positions: points(positions), triangles: triangles.clone() },
            Pose::IDENTITY,
        ),
    };
    ChildShape { shape, body_from_shape, surface, part: 0 }
}

/// Mass with the inertia of its distribution; of the collider's bounds where the mesh gives none that is real.
fn mass(asset: &Asset, mapped: &Mapped, shapes: &[ChildShape]) -> Option<Mass> {
    let mass_kg = mapped.number("mass").filter(|mass| mass.is_finite() && *mass > 0.0)?;
    let spread = distribution(asset, mapped.mass_model);
    let scale = mapped.scale.metres_per_unit;
    let turn = upright(asset.frame.up);
    if spread.measure > 0.0 {
        let per_mass = scale * scale * mass_kg / spread.measure;
        let inertia = turn_inertia(turn, spread.inertia.map(|entry| entry * per_mass));
        if inertia_is_real(inertia) {
            return Some(Mass { mass_kg, inertia_kg_m2: inertia });
        }
    }
    let [low, high] = bounds(shapes)?;
    let side: [f64; 3] = std::array::from_fn(|axis| high[axis] - low[axis]);
    let about = |a: f64, b: f64| mass_kg * (a * a + b * b) / 12.0;
    let moments = [about(side[1], side[2]), about(side[0], side[2]), about(side[0], side[1])];
    Some(Mass { mass_kg, inertia_kg_m2: [moments[0], moments[1], moments[2], 0.0, 0.0, 0.0] })
}

/// A scene in which the model settles from a small height onto the floor: entity 0 is the floor, entity 1 the
/// model, upright, its lowest point a tenth of its height above the floor, at least 1 cm and at most 0.5 m.
///
/// # Errors
/// [`SceneError`] says what is missing.
pub fn drop_scene(
    model: &str,
    asset: &Asset,
    mapped: &Mapped,
    floor: Surface,
    rules: &Ruleset,
) -> Result<Scene, SceneError> {
    let mut entity = drop_entity(model, asset, mapped, rules)?;
    let [low, high] =
        bounds(&entity.shapes).ok_or_else(|| SceneError::NoExtent { model: model.to_owned() })?;
    let height = ((high[1] - low[1]) * 0.1).clamp(0.01, 0.5);
    let clearance = if mapped.anchored { 0.0 } else { height };
    entity.pose = Pose::at([0.0, clearance - low[1], 0.0]);
    let mut scene = Scene::new(model, vec![floor_entity(floor), entity]);
    rules.lay_pairs(&mut scene);
    Ok(scene)
}

/// A floor at height 0.
#[must_use]
pub fn floor_entity(surface: Surface) -> Entity {
    Entity {
        name: "floor".to_owned(),
        motion: Motion::Static,
        pose: Pose::IDENTITY,
        velocity: Velocity::default(),
        shapes: vec![ChildShape {
            shape: Shape::HalfSpace,
            body_from_shape: Pose::IDENTITY,
            surface,
            part: 0,
        }],
    }
}

/// Bounds of shapes in the body's frame, exact for every shape but the cylinder's tilted rim, which is close.
#[must_use]
pub fn bounds(shapes: &[ChildShape]) -> Option<[[f64; 3]; 2]> {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for child in shapes {
        let pose = child.body_from_shape;
        let mut reach = |center: [f64; 3], extent: [f64; 3]| {
            for axis in 0..3 {
                low[axis] = low[axis].min(center[axis] - extent[axis]);
                high[axis] = high[axis].max(center[axis] + extent[axis]);
            }
        };
        let columns: [[f64; 3]; 3] = std::array::from_fn(|axis| {
            rotate(pose.rotation, std::array::from_fn(|other| f64::from(u8::from(axis == other))))
        });
        match &child.shape {
            Shape::Sphere { radius } => reach(pose.position, [*radius; 3]),
            Shape::Box { half_extents } => {
                let extent = std::array::from_fn(|axis| {
                    (0..3).map(|column| (columns[column][axis] * half_extents[column]).abs()).sum()
                });
                reach(pose.position, extent);
            }
            Shape::Capsule { half_height, radius } => {
                reach(pose.position, columns[1].map(|up| (up * half_height).abs() + radius));
            }
            Shape::Cylinder { half_height, radius } => {
                reach(
                    pose.position,
                    columns[1].map(|up| (up * half_height).abs() + radius * (1.0 - up * up).max(0.0).sqrt()),
                );
            }
            Shape::Hull { points } | Shape::TriangleMesh { positions: points, .. } => {
                for point in points {
                    reach(add(rotate(pose.rotation, *point), pose.position), [0.0; 3]);
                }
            }
            Shape::Cone { half_height, radius } => {
                let up = columns[1];
                let along = |by: f64| std::array::from_fn(|axis| pose.position[axis] + by * up[axis]);
                reach(along(*half_height), [0.0; 3]);
                reach(along(-half_height), up.map(|up| radius * (1.0 - up * up).max(0.0).sqrt()));
            }
            Shape::HeightField(field) => {
                for point in field.mesh().0 {
                    reach(add(rotate(pose.rotation, point), pose.position), [0.0; 3]);
                }
            }
            Shape::HalfSpace => return None,
        }
    }
    low.iter().chain(&high).all(|bound| bound.is_finite()).then_some([low, high])
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `q * v * q⁻¹` of a unit quaternion `x, y, z, w`.
#[must_use]
pub fn rotate(q: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let axis = [q[0], q[1], q[2]];
    let turn = cross(axis, v).map(|entry| 2.0 * entry);
    let twist = cross(axis, turn);
    std::array::from_fn(|index| v[index] + q[3] * turn[index] + twist[index])
}

/// Hamilton product: first `b`, then `a`.
#[must_use]
pub fn multiply(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
        a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
        a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
    ]
}

/// `R I Rᵀ` of `[xx, yy, zz, xy, xz, yz]`.
#[must_use]
pub fn turn_inertia(rotation: [f64; 4], inertia: [f64; 6]) -> [f64; 6] {
    let [xx, yy, zz, xy, xz, yz] = inertia;
    let tensor = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    // Row i of R Tᵀ is R applied to row i of T; doing it twice gives R T Rᵀ for a symmetric T.
    let once = tensor.map(|row| rotate(rotation, row));
    let transposed: [[f64; 3]; 3] =
        std::array::from_fn(|row| std::array::from_fn(|column| once[column][row]));
    let turned = transposed.map(|row| rotate(rotation, row));
    [turned[0][0], turned[1][1], turned[2][2], turned[0][1], turned[0][2], turned[1][2]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_up_axis_turns_to_y() {
        for (axis, up) in [(Axis::X, [1.0, 0.0, 0.0]), (Axis::Y, [0.0, 1.0, 0.0]), (Axis::Z, [0.0, 0.0, 1.0])]
        {
            let turned = rotate(upright(axis), up);
            assert!((turned[1] - 1.0).abs() < 1e-12, "{axis:?}: {turned:?}");
        }
        let forward = rotate(upright(Axis::Z), [0.0, 1.0, 0.0]);
        assert!((forward[2] + 1.0).abs() < 1e-12, "{forward:?}");
    }

    #[test]
    fn inertia_turns_with_the_body() {
        let turned = turn_inertia(upright(Axis::Z), [1.0, 2.0, 3.0, 0.0, 0.0, 0.5]);
        let expected = [1.0, 3.0, 2.0, 0.0, 0.0, -0.5];
        assert!(turned.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{turned:?}");
    }

    #[test]
    fn bounds_of_a_tilted_box_reach_its_corners() {
        let half = (std::f64::consts::PI / 8.0).sin_cos();
        let pose = Pose { position: [1.0, 0.0, 0.0], rotation: [0.0, 0.0, half.0, half.1] };
        let surface = Surface::new(0.5, 0.0);
        let shape = Shape::Box { half_extents: [1.0, 1.0, 1.0] };
        let [low, high] = bounds(&[ChildShape { shape, body_from_shape: pose, surface, part: 0 }]).unwrap();
        let root = std::f64::consts::SQRT_2;
        for (bound, expected) in low.iter().chain(&high).zip([1.0 - root, -root, -1.0, 1.0 + root, root, 1.0])
        {
            assert!((bound - expected).abs() < 1e-12, "{low:?} {high:?}");
        }
    }
}
