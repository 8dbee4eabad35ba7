//! The base that a body stands on, and by the statics of it when it tips.

use sim::{ChildShape, Pose, Shape, measure};

/// How near to the lowest point a point counts as one that the body stands on, as a share of its size.
const NEAR_SHARE: f64 = 2e-3;

/// Points that stand for the rim of a round base.
const RIM: u32 = 32;

/// Height of the lowest point of a body in a pose, m.
pub(super) fn lowest(shapes: &[ChildShape], pose: &Pose) -> f64 {
    measure::body_support(shapes, pose, [0.0, -1.0, 0.0]).map_or(0.0, |reach| -reach)
}

/// Points `[x, z]` of the floor that carry a body in a pose, about its centre of mass.
pub(super) fn carrying(shapes: &[ChildShape], pose: &Pose) -> Vec<[f64; 2]> {
    let size = measure::extents(shapes).into_iter().fold(0.0, f64::max);
    let floor = lowest(shapes, pose) + NEAR_SHARE * size;
    let mut points = Vec::new();
    for child in shapes {
        for point in surface(child, pose) {
            let world = measure::transform(pose, measure::transform(&child.body_from_shape, point));
            if world[1] <= floor {
                points.push([world[0] - pose.position[0], world[2] - pose.position[2]]);
            }
        }
    }
    points
}

/// A cylinder or cone whose axis is nearer to the vertical than this stands on its rim, radians; another lies or leans.
const UPRIGHT_RAD: f64 = 0.05;

/// Points of a shape that can be a corner of what it stands on.
fn surface(child: &ChildShape, pose: &Pose) -> Vec<[f64; 3]> {
    let ring = |radius: f64, y: f64| {
        (0..RIM).map(move |index| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(index) / f64::from(RIM)).sin_cos();
            [radius * cos, y, radius * sin]
        })
    };
    match &child.shape {
        Shape::Hull { points } | Shape::TriangleMesh { positions: points, .. } => points.clone(),
        Shape::Box { half_extents: [x, y, z] } => (0..8)
            .map(|corner: u32| {
                let sign = |bit: u32, half: f64| if corner >> bit & 1 == 1 { half } else { -half };
                [sign(0, *x), sign(1, *y), sign(2, *z)]
            })
            .collect(),
        Shape::Cylinder { half_height, radius } | Shape::Cone { half_height, radius } => {
            let upper = if matches!(child.shape, Shape::Cone { .. }) { 0.0 } else { *radius };
            let turned = |vector| {
                measure::rotate_back(
                    child.body_from_shape.rotation,
                    measure::rotate_back(pose.rotation, vector),
                )
            };
            let [x, y, z] = turned([0.0, -1.0, 0.0]);
            let across = x.hypot(z);
            if across < UPRIGHT_RAD * y.abs() {
                return ring(upper, *half_height).chain(ring(*radius, -half_height)).collect();
            }
            // The line that it lies on: the lowest point of each end.
            let end = |radius: f64, y: f64| [x * radius / across, y, z * radius / across];
            vec![end(upper, *half_height), end(*radius, -half_height)]
        }
        // A ball touches in one point and a lying capsule in a line: both roll, so that their points do not matter
        // as long as they carry nothing sideways.
        Shape::Sphere { .. } | Shape::Capsule { .. } | Shape::HalfSpace | Shape::HeightField(_) => Vec::new(),
    }
}

/// How far the base reaches from below the centre of mass along a level direction, m; negative where the centre
/// of mass hangs over.
fn reach(points: &[[f64; 2]], [x, z]: [f64; 2]) -> f64 {
    points.iter().map(|point| point[0] * x + point[1] * z).fold(f64::NEG_INFINITY, f64::max)
}

/// Level directions all around.
pub(super) fn around() -> impl Iterator<Item = [f64; 2]> {
    (0..RIM).map(|index| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(index) / f64::from(RIM)).sin_cos();
        [cos, sin]
    })
}

/// Tilt at which a body in a pose tips over in the direction where it does so soonest, radians. The base is the
/// convex hull of the carrying points, whose support function is their own.
pub(super) fn tips_at_rad(shapes: &[ChildShape], pose: &Pose) -> f64 {
    let points = carrying(shapes, pose);
    let height = pose.position[1] - lowest(shapes, pose);
    around().map(|direction| reach(&points, direction).max(0.0).atan2(height)).fold(f64::INFINITY, f64::min)
}

/// The level direction in which it can be tilted the most, with that tilt in radians.
pub(super) fn steadiest(shapes: &[ChildShape], pose: &Pose) -> ([f64; 3], f64) {
    let points = carrying(shapes, pose);
    let height = pose.position[1] - lowest(shapes, pose);
    let mut best = ([1.0, 0.0, 0.0], f64::NEG_INFINITY);
    for direction in around() {
        // Sideways it must not tip either: a plank on its edge slides along itself and falls across.
        let tilt = reach(&points, direction).atan2(height);
        if tilt > best.1 {
            best = ([direction[0], 0.0, direction[1]], tilt);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use sim::Surface;

    use super::*;

    fn child(shape: Shape) -> Vec<ChildShape> {
        let surface = Surface::new(0.5, 0.0);
        vec![ChildShape { shape, body_from_shape: Pose::IDENTITY, surface, part: 0 }]
    }

    #[test]
    fn a_box_tips_where_its_centre_passes_its_edge() {
        let shapes = child(Shape::Box { half_extents: [0.1, 0.2, 0.3] });
        let pose = Pose::at([5.0, 0.2, -7.0]);
        assert!((tips_at_rad(&shapes, &pose) - 0.1_f64.atan2(0.2)).abs() < 1e-9);
        let (_, tilt) = steadiest(&shapes, &pose);
        assert!(tilt >= 0.3_f64.atan2(0.2), "the diagonal is longer still: {tilt}");
    }

    #[test]
    fn what_is_round_has_no_base() {
        let shapes = child(Shape::Sphere { radius: 0.1 });
        assert_eq!(tips_at_rad(&shapes, &Pose::at([0.0, 0.1, 0.0])), 0.0);
        let lying = child(Shape::Cylinder { half_height: 0.5, radius: 0.1 });
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let pose = Pose { position: [0.0, 0.1, 0.0], rotation: [0.0, 0.0, half, half] };
        assert!(tips_at_rad(&lying, &pose) < 0.1, "it rolls across its axis");
    }
}
