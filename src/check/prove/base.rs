//! The base that a body stands on, and by the statics of it when it tips.

use sim::{ChildShape, Pose, Shape, measure};

/// How near to the lowest point a point counts as one that the body stands on, as a share of its size and, if that
/// is less, of the height of its centre of mass: a round body of that radius then seems to have a base on which it
/// rocks by `sqrt(2 * 1e-3)`, 2.6 degrees, and what is flat loses nothing.
const NEAR_SHARE: f64 = 2e-3;
const NEAR_SHARE_OF_HEIGHT: f64 = 1e-3;

/// Points that stand for the rim of a round base.
const RIM: u32 = 32;

/// Height of the lowest point of a body in a pose, m.
pub(super) fn lowest(shapes: &[ChildShape], pose: &Pose) -> f64 {
    measure::body_support(shapes, pose, [0.0, -1.0, 0.0]).map_or(0.0, |reach| -reach)
}

/// What a body in a pose stands on: the convex hull of the points that carry it.
pub(super) struct Base {
    /// Half-planes `normal . x <= offset` of the level `[x, z]` about the foot of the centre of mass, m. None where
    /// the body stands on a point or a line, which carries nothing sideways.
    edges: Vec<([f64; 2], f64)>,
    /// Of the centre of mass above the floor, m.
    height: f64,
}

impl Base {
    pub(super) fn of(shapes: &[ChildShape], pose: &Pose) -> Self {
        let height = pose.position[1] - lowest(shapes, pose);
        let corners = convex_hull(carrying(shapes, pose));
        let edges = if corners.len() < 3 {
            Vec::new()
        } else {
            let next = corners.iter().cycle().skip(1);
            corners.iter().zip(next).map(|(from, to)| edge(*from, *to)).collect()
        };
        Self { edges, height }
    }

    /// Tilt at which it tips over in the direction where it does so soonest, radians.
    pub(super) fn tips_at_rad(&self) -> f64 {
        let nearest = self.edges.iter().map(|(_, offset)| *offset).reduce(f64::min);
        nearest.unwrap_or(0.0).max(0.0).atan2(self.height)
    }

    /// Slope down a level direction on which it tips over, radians: where the vertical through its centre of mass
    /// leaves the base. How far the base reaches along the direction does not tell, for that may be a corner beside
    /// the vertical: a plank a little askew holds along itself and falls across.
    fn tips_along_rad(&self, [x, z]: [f64; 2]) -> f64 {
        let way_out = |(normal, offset): &([f64; 2], f64)| {
            let towards = normal[0] * x + normal[1] * z;
            (towards > 0.0).then(|| offset.max(0.0) / towards)
        };
        self.edges.iter().filter_map(way_out).reduce(f64::min).unwrap_or(0.0).atan2(self.height)
    }

    /// The level direction in which the slope may be steepest, with that slope in radians.
    pub(super) fn steadiest(&self) -> ([f64; 3], f64) {
        let mut best = ([1.0, 0.0, 0.0], f64::NEG_INFINITY);
        for direction in around() {
            let slope = self.tips_along_rad(direction);
            if slope > best.1 {
                best = ([direction[0], 0.0, direction[1]], slope);
            }
        }
        best
    }
}

/// The half-plane on whose border an edge of a hull lies, with the hull to the left of the edge.
fn edge(from: [f64; 2], to: [f64; 2]) -> ([f64; 2], f64) {
    let [x, z] = [to[0] - from[0], to[1] - from[1]];
    let length = x.hypot(z);
    let normal = [z / length, -x / length];
    (normal, normal[0] * from[0] + normal[1] * from[1])
}

/// Corners of the convex hull, counter-clockwise; fewer than three where all points are in a line (Andrew's monotone
/// chain).
fn convex_hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let turns_left = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0
    };
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && !turns_left(a, b, point)
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}

/// Points `[x, z]` of the floor that carry a body in a pose, about its centre of mass.
fn carrying(shapes: &[ChildShape], pose: &Pose) -> Vec<[f64; 2]> {
    let size = measure::extents(shapes).into_iter().fold(0.0, f64::max);
    let low = lowest(shapes, pose);
    let near = (NEAR_SHARE * size).min(NEAR_SHARE_OF_HEIGHT * (pose.position[1] - low));
    let mut points = Vec::new();
    for child in shapes {
        for point in surface(child, pose) {
            let world = measure::transform(pose, measure::transform(&child.body_from_shape, point));
            if world[1] <= low + near {
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

/// Level directions all around.
fn around() -> impl Iterator<Item = [f64; 2]> {
    (0..RIM).map(|index| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(index) / f64::from(RIM)).sin_cos();
        [cos, sin]
    })
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
        let base = Base::of(&shapes, &Pose::at([5.0, 0.2, -7.0]));
        assert!((base.tips_at_rad() - 0.1_f64.atan2(0.2)).abs() < 1e-9);
        let (_, slope) = base.steadiest();
        assert!(slope >= 0.3_f64.atan2(0.2), "the diagonal is longer still: {slope}");
    }

    #[test]
    fn a_plank_across_the_slope_tips_over_its_long_edge() {
        let shapes = child(Shape::Box { half_extents: [0.5, 0.1, 0.05] });
        let base = Base::of(&shapes, &Pose::at([0.0, 0.1, 0.0]));
        let askew = std::f64::consts::FRAC_1_SQRT_2;
        let way_out = 0.05 / askew;
        assert!((base.tips_along_rad([askew, -askew]) - way_out.atan2(0.1)).abs() < 1e-9);
        assert!((base.tips_along_rad([1.0, 0.0]) - 0.5_f64.atan2(0.1)).abs() < 1e-9);
    }

    #[test]
    fn what_is_round_has_no_base() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let lying = Pose { position: [0.0, 0.1, 0.0], rotation: [0.0, 0.0, half, half] };
        let cylinder = child(Shape::Cylinder { half_height: 0.5, radius: 0.1 });
        let ball = child(Shape::Sphere { radius: 0.1 });
        for (shapes, pose) in [(ball, Pose::at([0.0, 0.1, 0.0])), (cylinder, lying)] {
            let base = Base::of(&shapes, &pose);
            assert_eq!((base.tips_at_rad(), base.steadiest().1), (0.0, 0.0));
        }
        // A hull with facets has one, which is too narrow for a slope to be tried on it.
        let rims = (0..96).flat_map(|index| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(index) / 96.0).sin_cos();
            [[-0.5, 0.1 * sin, 0.1 * cos], [0.5, 0.1 * sin, 0.1 * cos]]
        });
        let faceted = child(Shape::Hull { points: rims.collect() });
        let tips = Base::of(&faceted, &Pose::at([0.0, 0.1, 0.0])).tips_at_rad().to_degrees();
        assert!(tips < 3.0, "{tips}");
    }
}
