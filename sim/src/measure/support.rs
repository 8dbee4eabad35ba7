//! How deep is a body below a plane, how large is it, what energy and momentum has it.

use crate::scene::{ChildShape, Entity, Mass, Motion, Pose, Shape, Velocity};

/// `rotation * vector` for a unit quaternion `x, y, z, w`.
#[must_use]
pub fn rotate([x, y, z, w]: [f64; 4], vector: [f64; 3]) -> [f64; 3] {
    let axis = [x, y, z];
    let twice = cross(axis, vector).map(|value| 2.0 * value);
    let turned = cross(axis, twice);
    std::array::from_fn(|i| vector[i] + w * twice[i] + turned[i])
}

/// The inverse of [`rotate`].
#[must_use]
pub fn rotate_back([x, y, z, w]: [f64; 4], vector: [f64; 3]) -> [f64; 3] {
    rotate([-x, -y, -z, w], vector)
}

/// A point of the body's frame in the world's.
#[must_use]
pub fn transform(world_from_body: &Pose, point: [f64; 3]) -> [f64; 3] {
    let turned = rotate(world_from_body.rotation, point);
    std::array::from_fn(|axis| turned[axis] + world_from_body.position[axis])
}

/// The scalar product.
#[must_use]
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The Euclidean norm.
#[must_use]
pub fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// The vector product.
#[must_use]
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The support function of a shape about its own origin: the largest `direction · point` over its points, in m
/// for a unit `direction`. `None` for shapes without an inside.
#[must_use]
pub fn support(shape: &Shape, direction: [f64; 3]) -> Option<f64> {
    let [x, y, z] = direction;
    let across = x.hypot(z);
    Some(match shape {
        Shape::Sphere { radius } => radius * length(direction),
        Shape::Box { half_extents: h } => h[0] * x.abs() + h[1] * y.abs() + h[2] * z.abs(),
        Shape::Capsule { half_height, radius } => half_height * y.abs() + radius * length(direction),
        Shape::Cylinder { half_height, radius } => half_height * y.abs() + radius * across,
        Shape::Cone { half_height, radius } => (half_height * y).max(radius * across - half_height * y),
        Shape::HeightField(field) => farthest(&field.mesh().0, direction)?,
        Shape::Hull { points } => farthest(points, direction)?,
        Shape::TriangleMesh { positions, .. } => farthest(positions, direction)?,
        Shape::HalfSpace => return None,
    })
}

fn farthest(points: &[[f64; 3]], direction: [f64; 3]) -> Option<f64> {
    points.iter().map(|&point| dot(point, direction)).reduce(f64::max)
}

/// The support function of a body in the world; `None` for a body without a bounded shape.
#[must_use]
pub fn body_support(shapes: &[ChildShape], world_from_body: &Pose, direction: [f64; 3]) -> Option<f64> {
    let in_body = rotate_back(world_from_body.rotation, direction);
    shapes
        .iter()
        .filter_map(|child| {
            let in_shape = rotate_back(child.body_from_shape.rotation, in_body);
            Some(support(&child.shape, in_shape)? + dot(child.body_from_shape.position, in_body))
        })
        .reduce(f64::max)
        .map(|reach| reach + dot(world_from_body.position, direction))
}

/// A half-space that the scene's static bodies are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    pub point: [f64; 3],
    /// Unit, out of the solid.
    pub normal: [f64; 3],
}

impl Plane {
    /// Every half-space of `entity`, in the world.
    pub fn of(entity: &Entity) -> impl Iterator<Item = Self> + '_ {
        entity.shapes.iter().filter(|child| child.shape == Shape::HalfSpace).map(|child| Self {
            point: transform(&entity.pose, child.body_from_shape.position),
            normal: rotate(entity.pose.rotation, rotate(child.body_from_shape.rotation, [0.0, 1.0, 0.0])),
        })
    }

    /// How far the lowest point of a body is above the plane, m; negative where it is inside.
    #[must_use]
    pub fn clearance(&self, shapes: &[ChildShape], world_from_body: &Pose) -> Option<f64> {
        let lowest = -body_support(shapes, world_from_body, self.normal.map(|value| -value))?;
        Some(lowest - dot(self.point, self.normal))
    }
}

/// Extents of a body's shapes along the body's axes, m. Zero for a body without a bounded shape.
#[must_use]
pub fn extents(shapes: &[ChildShape]) -> [f64; 3] {
    std::array::from_fn(|axis| {
        let mut direction = [0.0; 3];
        direction[axis] = 1.0;
        let high = body_support(shapes, &Pose::IDENTITY, direction).unwrap_or(0.0);
        let low = body_support(shapes, &Pose::IDENTITY, direction.map(|value| -value)).unwrap_or(0.0);
        high + low
    })
}

/// A bound on the distance of any point of the body from its centre of mass, m.
#[must_use]
pub fn reach(shapes: &[ChildShape]) -> f64 {
    let corner: [f64; 3] = std::array::from_fn(|axis| {
        let mut direction = [0.0; 3];
        direction[axis] = 1.0;
        let high = body_support(shapes, &Pose::IDENTITY, direction).unwrap_or(0.0);
        let low = body_support(shapes, &Pose::IDENTITY, direction.map(|value| -value)).unwrap_or(0.0);
        high.max(low)
    });
    length(corner)
}

/// Kinetic energy, and potential energy in `gravity` with its zero at the world's origin, J.
#[must_use]
pub fn energy(mass: &Mass, pose: &Pose, velocity: &Velocity, gravity: [f64; 3]) -> f64 {
    let spin = rotate_back(pose.rotation, velocity.angular);
    let moving = 0.5 * mass.mass_kg * dot(velocity.linear, velocity.linear);
    let turning = 0.5 * dot(spin, inertia_times(mass, spin));
    moving + turning - mass.mass_kg * dot(gravity, pose.position)
}

/// Linear (kg m/s) and angular momentum (kg m²/s, about the world's origin), in the world's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Momentum {
    pub linear: [f64; 3],
    pub angular: [f64; 3],
}

/// Momentum of one body.
#[must_use]
pub fn momentum(mass: &Mass, pose: &Pose, velocity: &Velocity) -> Momentum {
    let linear = velocity.linear.map(|v| mass.mass_kg * v);
    let spin = inertia_times(mass, rotate_back(pose.rotation, velocity.angular));
    let own = rotate(pose.rotation, spin);
    let orbital = cross(pose.position, linear);
    Momentum { linear, angular: std::array::from_fn(|axis| own[axis] + orbital[axis]) }
}

/// Moment of inertia about a unit axis of the body's frame through the centre of mass, kg m².
#[must_use]
pub fn moment_about(mass: &Mass, axis: [f64; 3]) -> f64 {
    dot(axis, inertia_times(mass, axis))
}

fn inertia_times(mass: &Mass, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [xx, yy, zz, xy, xz, yz] = mass.inertia_kg_m2;
    [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z]
}

/// Mass of a body that moves.
#[must_use]
pub fn mass_of(entity: &Entity) -> Option<Mass> {
    match entity.motion {
        Motion::Dynamic(mass) => Some(mass),
        Motion::Static => None,
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a test may stop at the first surprise")]
mod tests {
    use crate::scene::Surface;

    use super::*;

    fn child(shape: Shape, body_from_shape: Pose) -> ChildShape {
        ChildShape { shape, body_from_shape, surface: Surface::new(0.5, 0.0), part: 0 }
    }

    fn about(axis: [f64; 3], degrees: f64) -> [f64; 4] {
        let (sin, cos) = (degrees.to_radians() / 2.0).sin_cos();
        [axis[0] * sin, axis[1] * sin, axis[2] * sin, cos]
    }

    const UP: Plane = Plane { point: [0.0; 3], normal: [0.0, 1.0, 0.0] };

    #[test]
    fn a_box_on_its_edge_stands_half_a_diagonal_high() {
        let shapes = [child(Shape::Box { half_extents: [0.5; 3] }, Pose::IDENTITY)];
        let pose = Pose { position: [0.0, 2.0, 0.0], rotation: about([0.0, 0.0, 1.0], 45.0) };
        let clearance = UP.clearance(&shapes, &pose).expect("bounded");
        assert!((clearance - (2.0 - 0.5_f64.sqrt())).abs() < 1e-15);
    }

    #[test]
    fn shapes_of_revolution_reach_what_their_points_reach() {
        // Against a dense sample of points on each surface.
        let shapes = [
            Shape::Capsule { half_height: 0.7, radius: 0.2 },
            Shape::Cylinder { half_height: 0.4, radius: 0.3 },
            Shape::Sphere { radius: 0.9 },
        ];
        let direction = [0.36, -0.48, 0.8];
        for shape in &shapes {
            let mut sampled = f64::NEG_INFINITY;
            for i in 0..720 {
                let around = f64::from(i).to_radians() / 2.0;
                for j in 0..=360 {
                    let up = (f64::from(j) - 180.0).to_radians() / 2.0;
                    let ball = [up.cos() * around.cos(), up.sin(), up.cos() * around.sin()];
                    let point = match *shape {
                        Shape::Sphere { radius } => ball.map(|v| v * radius),
                        Shape::Capsule { half_height, radius } => {
                            [ball[0] * radius, ball[1] * radius + half_height.copysign(up), ball[2] * radius]
                        }
                        Shape::Cylinder { half_height, radius } => {
                            [radius * around.cos(), half_height.copysign(up), radius * around.sin()]
                        }
                        _ => unreachable!("not among the shapes of this test"),
                    };
                    sampled = sampled.max(dot(point, direction));
                }
            }
            let exact = support(shape, direction).expect("bounded");
            assert!(
                sampled <= exact + 1e-12 && exact - sampled < 1e-4,
                "{shape:?}: {sampled} against {exact}"
            );
        }
    }

    #[test]
    fn a_child_counts_where_it_sits() {
        let pose = Pose { position: [0.0, -1.0, 0.0], rotation: about([1.0, 0.0, 0.0], 90.0) };
        let shapes = [
            child(Shape::Sphere { radius: 0.1 }, Pose::IDENTITY),
            child(Shape::Cylinder { half_height: 0.5, radius: 0.25 }, pose),
        ];
        assert_eq!(extents(&shapes).map(|side| (side * 1e9).round() / 1e9), [0.5, 1.35, 1.0]);
        let clearance = UP.clearance(&shapes, &Pose::at([3.0, 1.0, 0.0])).expect("bounded");
        assert!((clearance + 0.25).abs() < 1e-12, "{clearance}");
    }

    #[test]
    fn energy_of_a_spinning_falling_body_is_the_textbook_sum() {
        let mass = Mass { mass_kg: 2.0, inertia_kg_m2: [1.0, 2.0, 3.0, 0.0, 0.0, 0.0] };
        // A quarter turn about z carries the body's x axis to the world's y axis.
        let pose = Pose { position: [0.0, 5.0, 0.0], rotation: about([0.0, 0.0, 1.0], 90.0) };
        let velocity = Velocity { linear: [0.0, -3.0, 0.0], angular: [0.0, 4.0, 0.0] };
        let energy = energy(&mass, &pose, &velocity, [0.0, -9.81, 0.0]);
        assert!((energy - (9.0 + 8.0 + 2.0 * 9.81 * 5.0)).abs() < 1e-12, "{energy}");
    }

    #[test]
    fn a_tilted_floor_measures_along_its_normal() {
        let floor = Entity {
            name: "floor".to_owned(),
            motion: Motion::Static,
            pose: Pose { position: [0.0; 3], rotation: about([0.0, 0.0, 1.0], 30.0) },
            velocity: Velocity::default(),
            shapes: vec![child(Shape::HalfSpace, Pose::at([0.0, 1.0, 0.0]))],
        };
        let plane = Plane::of(&floor).next().expect("one plane");
        let shapes = [child(Shape::Sphere { radius: 0.5 }, Pose::IDENTITY)];
        let at = plane.normal.map(|value| value * 1.5);
        assert!(plane.clearance(&shapes, &Pose::at(at)).expect("bounded").abs() < 1e-12);
    }
}
