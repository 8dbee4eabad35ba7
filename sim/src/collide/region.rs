//! The polygonal contact region of two faces: one clipped against the sides of the other.

use crate::collide::relative::Relative;
use crate::math::{Vec3, tangents};

/// A corner of a polygon and the two edges that meet in it, by which it is known again in the next step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    pub(crate) position: Vec3,
    /// The edge that ends here and the one that begins here.
    edges: [u32; 2],
}

/// A point of a region, in the frame of shape A.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionPoint {
    /// On the surface of A.
    pub(crate) on_a: Vec3,
    /// Along the region's normal, negative where the shapes overlap.
    pub(crate) separation: f64,
    pub(crate) feature: u64,
}

/// What two shapes have in common, in the frame of shape A; buffers are kept from pair to pair.
#[derive(Clone, Debug, Default)]
pub(crate) struct Region {
    /// From A to B.
    pub(crate) normal: Vec3,
    /// In the order round the polygon, where it is one.
    pub(crate) points: Vec<RegionPoint>,
}

/// Buffers of the clipping.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClipBuffers {
    pub(crate) reference: Vec<Vec3>,
    pub(crate) incident: Vec<Corner>,
    spare: Vec<Corner>,
}

/// Share of a side's length by which a point may lie beyond it and still be over the face.
const ON_SEAM: f64 = 1e-9;

/// Marks the sides of the reference polygon among the edges of the incident one.
const SIDE: u32 = 1 << 31;

impl ClipBuffers {
    /// Takes the incident polygon's corners, in order, each with its number.
    pub(crate) fn set_incident(&mut self, corners: impl Iterator<Item = (Vec3, u32)>) {
        self.incident.clear();
        let corner = |(position, number)| Corner { position, edges: [number, number] };
        self.incident.extend(corners.map(corner));
        // The edge that begins in a corner has the corner's number.
        let mut before = self.incident.last().map_or(0, |last| last.edges[1]);
        for corner in &mut self.incident {
            corner.edges[0] = std::mem::replace(&mut before, corner.edges[1]);
        }
    }

    pub(crate) fn set_reference(&mut self, corners: impl Iterator<Item = Vec3>) {
        self.reference.clear();
        self.reference.extend(corners);
    }

    /// Cuts the incident polygon (or segment, or point) to what lies over the reference face with outward `normal`
    /// (Sutherland and Hodgman 1974).
    pub(crate) fn clip(&mut self, normal: &Vec3) {
        let Self { reference, incident, spare } = self;
        let count = reference.len();
        for (side, (from, to)) in
            (0..).zip(reference.iter().zip(reference.iter().cycle().skip(1))).take(count)
        {
            let outward = (to - from).cross(normal);
            let height = |corner: &Corner| (corner.position - from).dot(&outward);
            if incident.len() == 1 {
                // A seam between two faces belongs to both.
                let seam = ON_SEAM * outward.norm_squared();
                incident.retain(|corner| height(corner) <= seam);
            } else if incident.len() == 2 {
                clip_segment(incident, SIDE | side, height);
            } else {
                clip_polygon(incident, spare, SIDE | side, height);
                std::mem::swap(incident, spare);
            }
        }
    }

    /// Cuts the incident segment to what lies between the planes square to `p`-`q` through its ends.
    pub(crate) fn clip_between(&mut self, p: &Vec3, q: &Vec3) {
        let along = q - p;
        for (side, (end, outward)) in (0..).zip([(p, -along), (q, along)]) {
            if self.incident.len() == 2 {
                clip_segment(&mut self.incident, SIDE | side, |corner| (corner.position - end).dot(&outward));
            }
        }
    }

    /// Adds the clipped polygon's corners to `region` as points below `reach`; `origin` is a point of the reference
    /// face, whose outward `normal` it is, and which belongs to A or to B.
    pub(crate) fn push_points(
        &self,
        region: &mut Region,
        (origin, normal): (&Vec3, &Vec3),
        of_a: bool,
        reach: f64,
    ) {
        for corner in &self.incident {
            let separation = (corner.position - origin).dot(normal);
            if separation < reach {
                let on_a = if of_a { corner.position - normal * separation } else { corner.position };
                let feature = u64::from(corner.edges[0]) << 32 | u64::from(corner.edges[1]);
                region.points.push(RegionPoint { on_a, separation, feature });
            }
        }
    }
}

impl Region {
    /// Turns a region seen from B, on B and away from it, into one seen from A, on A and towards B.
    pub(crate) fn flip(&mut self, relative: &Relative) {
        let normal = relative.rotation * self.normal;
        self.normal = -normal;
        for point in &mut self.points {
            point.on_a = relative.point(&point.on_a) + normal * point.separation;
        }
    }

    /// Leaves out points over four that the others span without, to within `tolerance` metres: two boxes that lie
    /// flush and turned by a hair share a hexagon, of which two corners say nothing that the others do not, and every
    /// one more makes the manifold stiffer and dearer. Depth counts a hundredfold, or a corner on which a shape
    /// stands might go.
    pub(crate) fn thin(&mut self, tolerance: f64) {
        const SPANNING: usize = 4;
        const DEPTH_OVER_SPAN: f64 = 100.0;
        while self.points.len() > SPANNING {
            let count = self.points.len();
            let mut least = (0, f64::INFINITY);
            for i in 0..count {
                let [before, point, after] = [count + i - 1, i, i + 1].map(|k| &self.points[k % count]);
                let (along, from) = (after.on_a - before.on_a, point.on_a - before.on_a);
                let share = from.dot(&along) / along.norm_squared();
                let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
                let height = before.separation + (after.separation - before.separation) * share;
                let lost =
                    (from - along * share).norm() + DEPTH_OVER_SPAN * (point.separation - height).abs();
                if lost < least.1 {
                    least = (i, lost);
                }
            }
            if least.1 > tolerance {
                return;
            }
            self.points.remove(least.0);
        }
    }

    /// Keeps at most `COUNT` points, in their order: the deepest, those that may carry within the step, and the extreme
    /// ones in eight directions of the plane, so that the polygon they span is nearly the whole region's.
    ///
    /// `clearance` is the separation that a point may come to within the step; what has less than `near` of it may carry,
    /// m both. A hull that rolls over its facets stands on corners in the middle of the region, which span nothing: left
    /// out they sink in, and the push out is energy.
    ///
    /// Depth counts as well as reach, or a shallow corner far away would push out the deep ones. Rejected: the usual
    /// deepest, farthest, largest triangle. With many equally deep corners it picks others each step, and the body
    /// rocks.
    pub(crate) fn reduce<const COUNT: usize>(&mut self, near: f64, clearance: impl Fn(&RegionPoint) -> f64) {
        if self.points.len() <= COUNT {
            return;
        }
        const DEPTH_OVER_REACH: f64 = 4.0;
        // What differs by less lies in one plane, of which the span says more.
        const FLUSH_SHARE: f64 = 0.02;
        const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;
        let [u, v] = tangents(&self.normal);
        let points = &self.points;
        let mut kept = [usize::MAX; COUNT];
        let mut len = 0;
        // The point of the highest score, unless it is kept already; or of the highest that is not.
        let mut keep = |free_only: bool, score: &dyn Fn(&RegionPoint) -> f64| {
            let mut found = (usize::MAX, f64::NEG_INFINITY);
            for (i, point) in points.iter().enumerate() {
                let score = score(point);
                if score > found.1 && !(free_only && kept[..len].contains(&i)) {
                    found = (i, score);
                }
            }
            if len < COUNT && found.1.is_finite() && !kept[..len].contains(&found.0) {
                kept[len] = found.0;
                len += 1;
            }
        };
        keep(false, &|point| -point.separation);
        if points.iter().filter(|point| clearance(point) < FLUSH_SHARE * near).count() <= COUNT {
            let carries = |point: &RegionPoint| {
                let clearance = clearance(point);
                if clearance < near { -clearance } else { f64::NEG_INFINITY }
            };
            (1..COUNT).for_each(|_| keep(true, &carries));
        }
        for [x, y] in [[1.0, 0.0], [DIAGONAL, DIAGONAL], [0.0, 1.0], [-DIAGONAL, DIAGONAL]] {
            let direction = u * x + v * y;
            for direction in [direction, -direction] {
                keep(false, &|point| point.on_a.dot(&direction) - DEPTH_OVER_REACH * clearance(point));
            }
        }
        kept[..len].sort_unstable();
        for (to, &from) in kept[..len].iter().enumerate() {
            self.points[to] = self.points[from];
        }
        self.points.truncate(len);
    }
}

fn clip_polygon(polygon: &[Corner], out: &mut Vec<Corner>, side: u32, height: impl Fn(&Corner) -> f64) {
    out.clear();
    let Some(mut from) = polygon.last() else { return };
    let mut from_height = height(from);
    for to in polygon {
        let to_height = height(to);
        if (from_height <= 0.0) != (to_height <= 0.0) {
            let position = crossing(from, to, from_height, to_height);
            let edge = from.edges[1];
            let edges = if from_height <= 0.0 { [edge, side] } else { [side, edge] };
            out.push(Corner { position, edges });
        }
        if to_height <= 0.0 {
            out.push(*to);
        }
        (from, from_height) = (to, to_height);
    }
}

fn clip_segment(segment: &mut Vec<Corner>, side: u32, height: impl Fn(&Corner) -> f64) {
    let (start, end) = (segment[0], segment[1]);
    let (low, high) = (height(&start), height(&end));
    if low > 0.0 && high > 0.0 {
        segment.clear();
    } else if low > 0.0 {
        segment[0] = Corner { position: crossing(&start, &end, low, high), edges: [side, start.edges[1]] };
    } else if high > 0.0 {
        segment[1] = Corner { position: crossing(&start, &end, low, high), edges: [end.edges[0], side] };
    }
}

fn crossing(from: &Corner, to: &Corner, from_height: f64, to_height: f64) -> Vec3 {
    let share = from_height / (from_height - to_height);
    from.position + (to.position - from.position) * share
}

/// The points of two lines, given by a point and a direction each, that are nearest to each other; as shares of the
/// directions. `None` where the lines are parallel.
pub(crate) fn nearest_on_lines(p: &Vec3, d: &Vec3, q: &Vec3, e: &Vec3) -> Option<(f64, f64)> {
    let (dd, ee, de, r) = (d.norm_squared(), e.norm_squared(), d.dot(e), q - p);
    let det = dd * ee - de * de;
    if det <= 1e-12 * dd * ee {
        return None;
    }
    let (dr, er) = (d.dot(&r), e.dot(&r));
    Some(((dr * ee - er * de) / det, (dr * de - er * dd) / det))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(half: f64, turn: f64, height: f64) -> Vec<Vec3> {
        (0..4)
            .map(|i| {
                let (sin, cos) = libm::sincos(turn + std::f64::consts::FRAC_PI_2 * f64::from(i));
                Vec3::new(half * cos, height, -half * sin)
            })
            .collect()
    }

    #[test]
    fn two_squares_turned_by_an_eighth_share_a_regular_octagon() {
        let mut buffers = ClipBuffers::default();
        buffers.set_reference(square(1.0, 0.0, 0.0).into_iter());
        buffers.set_incident(square(1.0, std::f64::consts::FRAC_PI_4, -0.1).into_iter().rev().zip(0..));
        buffers.clip(&Vec3::y());
        let mut region = Region { normal: Vec3::y(), ..Region::default() };
        buffers.push_points(&mut region, (&Vec3::zeros(), &Vec3::y()), true, 1.0);
        assert_eq!(region.points.len(), 8);
        // Both have the incircle of radius 1/sqrt 2, so the octagon's corners lie at that over cos 22.5 degrees.
        let radius = std::f64::consts::FRAC_1_SQRT_2 / libm::cos(std::f64::consts::PI / 8.0);
        let mut features: Vec<u64> = region.points.iter().map(|point| point.feature).collect();
        for point in &region.points {
            assert!((point.on_a.norm() - radius).abs() < 1e-12, "{point:?}");
            assert!((point.separation + 0.1).abs() < 1e-12);
        }
        features.sort_unstable();
        features.dedup();
        assert_eq!(features.len(), 8);
    }

    #[test]
    fn squares_that_lie_flush_but_for_a_hair_share_four_corners() {
        for (turn, count) in [(1e-9, 4), (1e-3, 4), (0.3, 8)] {
            let mut buffers = ClipBuffers::default();
            buffers.set_reference(square(1.0, 0.0, 0.0).into_iter());
            buffers.set_incident(square(1.0, turn, -0.1).into_iter().rev().zip(0..));
            buffers.clip(&Vec3::y());
            let mut region = Region { normal: Vec3::y(), ..Region::default() };
            buffers.push_points(&mut region, (&Vec3::zeros(), &Vec3::y()), true, 1.0);
            region.thin(5e-3);
            assert_eq!(region.points.len(), count, "turned by {turn}");
            let farthest = region.points.iter().map(|point| point.on_a.norm()).fold(0.0, f64::max);
            assert!(farthest > 0.99 || count == 8, "{farthest}");
        }
    }

    #[test]
    fn thinning_keeps_the_corner_that_is_deepest() {
        let at = |x: f64, z: f64, separation: f64, feature| RegionPoint {
            on_a: Vec3::new(x, 0.0, z),
            separation,
            feature,
        };
        let corners = [
            at(-1.0, -1.0, 0.0, 0),
            at(0.0, -1.001, -1e-3, 1),
            at(1.0, -1.0, 0.0, 2),
            at(1.0, 1.0, 0.0, 3),
            at(-1.0, 1.0, 0.0, 4),
        ];
        let mut region = Region { normal: Vec3::y(), points: corners.to_vec() };
        region.thin(5e-3);
        assert_eq!(region.points.len(), 5);
    }

    #[test]
    fn reduction_keeps_the_span_and_the_deepest() {
        let ring = (0..32_u32).map(|i| {
            let (sin, cos) = libm::sincos(f64::from(i) * std::f64::consts::TAU / 32.0);
            RegionPoint {
                on_a: Vec3::new(cos, 0.0, sin),
                separation: if i == 5 { -0.1 } else { 0.0 },
                feature: u64::from(i),
            }
        });
        let mut region = Region { normal: Vec3::y(), points: ring.collect() };
        region.reduce::<8>(0.01, |point| point.separation);
        let kept = &region.points;
        assert!(kept.len() <= 8 && kept.iter().any(|point| point.feature == 5), "{kept:?}");
        let ends = kept.iter().zip(kept.iter().cycle().skip(1));
        let area: f64 = ends.map(|(p, q)| 0.5 * q.on_a.cross(&p.on_a).y).sum();
        assert!(area > 0.85 * std::f64::consts::PI, "span {area}");
    }

    #[test]
    fn lines_are_nearest_where_both_are_square_to_the_way_between() {
        let (p, d) = (Vec3::new(0.0, 0.0, 0.0), Vec3::new(2.0, 0.0, 0.0));
        let (q, e) = (Vec3::new(1.0, 1.0, -1.0), Vec3::new(0.0, 0.0, 4.0));
        let (s, t) = nearest_on_lines(&p, &d, &q, &e).unwrap();
        assert!((s - 0.5).abs() < 1e-15 && (t - 0.25).abs() < 1e-15);
        assert!(nearest_on_lines(&p, &d, &q, &d).is_none());
    }
}
