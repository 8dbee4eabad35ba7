//! Bodies of uniform density, from their sizes in metres.

use std::f64::consts::{PI, TAU};

use crate::math::Vec3;
use crate::scene::{ChildShape, Entity, Mass, Motion, Pose, Scene, Shape, Surface, Velocity};

/// A scene under standard gravity.
#[must_use]
pub fn scene(name: &str, entities: Vec<Entity>) -> Scene {
    Scene::new(name, entities)
}

/// A surface of these coefficients.
#[must_use]
pub const fn surface(friction: f64, restitution: f64) -> Surface {
    Surface::new(friction, restitution)
}

/// Gravity tilted about z by `degrees`, down the slope being +x: a slope without turning the floor.
#[must_use]
pub fn slope(degrees: f64) -> [f64; 3] {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    [9.81 * sin, -9.81 * cos, 0.0]
}

/// The rotation by `degrees` about a unit axis, as a quaternion `x, y, z, w`.
#[must_use]
pub fn turn(axis: [f64; 3], degrees: f64) -> [f64; 4] {
    let (sin, cos) = libm::sincos(0.5 * degrees.to_radians());
    [axis[0] * sin, axis[1] * sin, axis[2] * sin, cos]
}

/// The rotation `first`, then `second`, both in the world's axes.
#[must_use]
pub fn then(first: [f64; 4], second: [f64; 4]) -> [f64; 4] {
    let [[ax, ay, az, aw], [bx, by, bz, bw]] = [second, first];
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// A dynamic body of one shape, at rest at `position`.
#[must_use]
pub fn body(name: &str, mass: Mass, position: [f64; 3], shape: Shape, surface: Surface) -> Entity {
    Entity {
        name: name.to_owned(),
        motion: Motion::Dynamic(mass),
        pose: Pose::at(position),
        velocity: Velocity::default(),
        shapes: vec![child(shape, surface)],
    }
}

/// A static body of one shape.
#[must_use]
pub fn fixed(name: &str, pose: Pose, shape: Shape, surface: Surface) -> Entity {
    Entity {
        name: name.to_owned(),
        motion: Motion::Static,
        pose,
        velocity: Velocity::default(),
        shapes: vec![child(shape, surface)],
    }
}

/// The ground: everything below y = 0.
#[must_use]
pub fn floor(surface: Surface) -> Entity {
    fixed("floor", Pose::IDENTITY, Shape::HalfSpace, surface)
}

/// A shape at the body's own origin.
#[must_use]
pub fn child(shape: Shape, surface: Surface) -> ChildShape {
    ChildShape { shape, body_from_shape: Pose::IDENTITY, surface, part: 0 }
}

/// A solid sphere; density in kg/m³.
#[must_use]
pub fn sphere(position: [f64; 3], radius: f64, density: f64, surface: Surface) -> Entity {
    let mass_kg = density * 4.0 / 3.0 * PI * radius * radius * radius;
    let i = 0.4 * mass_kg * radius * radius;
    let mass = Mass { mass_kg, inertia_kg_m2: [i, i, i, 0.0, 0.0, 0.0] };
    body("sphere", mass, position, Shape::Sphere { radius }, surface)
}

/// A solid box; density in kg/m³.
#[must_use]
pub fn cuboid(position: [f64; 3], half_extents: [f64; 3], density: f64, surface: Surface) -> Entity {
    let [x, y, z] = half_extents;
    let mass_kg = density * 8.0 * x * y * z;
    let moment = |a: f64, b: f64| mass_kg / 3.0 * (a * a + b * b);
    let mass = Mass { mass_kg, inertia_kg_m2: [moment(y, z), moment(x, z), moment(x, y), 0.0, 0.0, 0.0] };
    body("box", mass, position, Shape::Box { half_extents }, surface)
}

/// A cube of 1 m and 1,000 kg.
#[must_use]
pub fn cube(position: [f64; 3], surface: Surface) -> Entity {
    cuboid(position, [0.5; 3], 1000.0, surface)
}

/// A solid convex hull of uniform density (kg/m³), its points about `position`: the body's frame is put at the
/// centre of mass, and turned into no other axes.
#[must_use]
pub fn hull(position: [f64; 3], points: &[[f64; 3]], density: f64, surface: Surface) -> Entity {
    let solid: Vec<Vec3> = points.iter().map(|point| Vec3::from(*point)).collect();
    let (volume, center, second) = crate::measure::hull_moments(&solid);
    let mass_kg = density * volume;
    // ∫ x_i x_j dm about the centre of mass, then I = tr(C) 1 - C.
    let c = second * density - center * center.transpose() * mass_kg;
    let inertia_kg_m2 = [c.m22 + c.m33, c.m11 + c.m33, c.m11 + c.m22, -c.m12, -c.m13, -c.m23];
    let points = solid.iter().map(|point| (point - center).into()).collect();
    let at = Vec3::from(position) + center;
    body("hull", Mass { mass_kg, inertia_kg_m2 }, at.into(), Shape::Hull { points }, surface)
}

/// A solid cylinder along Y; density in kg/m³.
#[must_use]
pub fn cylinder(position: [f64; 3], half_height: f64, radius: f64, density: f64, surface: Surface) -> Entity {
    let mass_kg = density * TAU * half_height * radius * radius;
    let across = mass_kg * (3.0 * radius * radius + 4.0 * half_height * half_height) / 12.0;
    let along = 0.5 * mass_kg * radius * radius;
    let mass = Mass { mass_kg, inertia_kg_m2: [across, along, across, 0.0, 0.0, 0.0] };
    body("cylinder", mass, position, Shape::Cylinder { half_height, radius }, surface)
}

/// The same number in [0, 1) for the same arguments on every machine: a 24-bit integer hash.
#[must_use]
pub fn noise(n: u32, k: u32) -> f64 {
    let mut x =
        n.wrapping_mul(0x9E37_79B1).wrapping_add(k.wrapping_mul(0x85EB_CA77)).wrapping_add(0x1656_67B1);
    x ^= x >> 15;
    x = x.wrapping_mul(0x2C1B_3C6D);
    x ^= x >> 12;
    x = x.wrapping_mul(0x297A_2D39);
    x ^= x >> 15;
    f64::from(x >> 8) / f64::from(1 << 24)
}
