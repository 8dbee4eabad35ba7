//! Convex hulls with a budget of corners.
//!
//! A hull stopped early knows how much it leaves outside. Flat input is thickened by the caller's choice.

use super::prepared::{Vec3, bounds, tangents};
use super::quickhull::{Builder, COPLANAR, first_simplex};

/// How far corners move towards covering the points that a hull with few corners leaves outside.
const HALF_WAY: f64 = 0.6;

/// A convex polyhedron; faces counter-clockwise seen from outside.
#[derive(Clone, Debug)]
pub(super) struct Hull {
    pub vertices: Vec<Vec3>,
    pub faces: Vec<[u32; 3]>,
    /// Which of the given points every corner is; empty where they were thickened.
    pub of: Vec<u32>,
    /// Outward unit normal and offset of every distinct face plane: outside is `n·p > d`.
    pub planes: Vec<(Vec3, f64)>,
    /// How far the farthest of the given points lies outside of the face it is nearest the middle of.
    pub residual: f64,
    /// The same for each face.
    pub(super) shortfall: Vec<f64>,
}

/// Why there is no solid hull of the points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Flat {
    Empty,
    Point(Vec3),
    /// A point and a unit direction.
    Line(Vec3, Vec3),
    /// A point and a unit normal.
    Plane(Vec3, Vec3),
}

impl Hull {
    /// The hull of `points` with at most `budget` corners (never fewer than four), left off early once no
    /// point lies more than `tolerance` outside.
    pub fn of(points: &[Vec3], budget: usize, tolerance: f64) -> Result<Self, Flat> {
        let simplex = first_simplex(points)?;
        Ok(Builder::new(points, simplex).grow(budget.max(4), tolerance.max(COPLANAR)))
    }

    /// As [`Hull::of`], but points in a plane, on a line or in one place get `thickness`; the flag tells that.
    /// `None` only where there are no points.
    pub fn of_any(points: &[Vec3], budget: usize, tolerance: f64, thickness: f64) -> Option<(Self, bool)> {
        let flat = match Self::of(points, budget, tolerance) {
            Ok(hull) => return Some((hull, false)),
            Err(Flat::Empty) => return None,
            Err(flat) => flat,
        };
        let half = thickness.max(1e-6) / 2.0;
        let mut thick: Vec<Vec3> = Vec::new();
        match flat {
            Flat::Plane(origin, normal) => {
                for p in points {
                    let foot = p - normal * normal.dot(&(p - origin));
                    thick.extend([foot + normal * half, foot - normal * half]);
                }
            }
            Flat::Line(origin, direction) => {
                let (u, v) = tangents(direction);
                let along = points.iter().map(|p| (p - origin).dot(&direction));
                let (low, high) =
                    along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), t| (l.min(t), h.max(t)));
                for t in [low, high] {
                    for (a, b) in [(half, half), (half, -half), (-half, half), (-half, -half)] {
                        thick.push(origin + direction * t + u * a + v * b);
                    }
                }
            }
            Flat::Point(p) => {
                for corner in 0..8 {
                    let side = |bit: u32| if corner >> bit & 1 == 0 { -half } else { half };
                    thick.push(p + Vec3::new(side(0), side(1), side(2)));
                }
            }
            Flat::Empty => {}
        }
        let mut hull = Self::of(&thick, budget.max(8), tolerance).unwrap_or_else(|_| {
            let (low, high) = bounds(points);
            Self::of_box(low - Vec3::repeat(half), high + Vec3::repeat(half))
        });
        hull.of.clear();
        Some((hull, true))
    }

    /// An axis-aligned box.
    pub fn of_box(low: Vec3, high: Vec3) -> Self {
        let vertices = (0..8)
            .map(|corner| {
                let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
                Vec3::new(pick(0), pick(1), pick(2))
            })
            .collect();
        let faces: Vec<[u32; 3]> = vec![
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        let planes = (0..3)
            .flat_map(|axis| {
                let n = Vec3::ith(axis, 1.0);
                [(n, high[axis]), (-n, -low[axis])]
            })
            .collect();
        Self { vertices, faces, of: Vec::new(), planes, residual: 0.0, shortfall: vec![0.0; 12] }
    }

    /// A hull cut down to few corners leaves points outside; here its corners are moved outwards so that it
    /// errs by half as much to either side.
    pub fn balanced(self) -> Self {
        if self.residual < 1e-4 {
            return self;
        }
        let mut outward = vec![Vec3::zeros(); self.vertices.len()];
        let mut short = vec![0.0f64; self.vertices.len()];
        for ([a, b, c], (face, e)) in self.face_points().zip(self.faces.iter().zip(&self.shortfall)) {
            let cross = (b - a).cross(&(c - a));
            for &i in face {
                outward[i as usize] += cross;
                short[i as usize] = short[i as usize].max(*e);
            }
        }
        let moved: Vec<Vec3> = self
            .vertices
            .iter()
            .enumerate()
            .map(|(i, v)| {
                v + outward[i].try_normalize(1e-30).unwrap_or_else(Vec3::zeros) * (short[i] * HALF_WAY)
            })
            .collect();
        Self::of(&moved, usize::MAX, 0.0).unwrap_or(self)
    }

    pub fn volume(&self) -> f64 {
        let Some(&origin) = self.vertices.first() else { return 0.0 };
        let corner = |i: u32| self.vertices[i as usize] - origin;
        self.faces.iter().map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c)))).sum::<f64>() / 6.0
    }

    /// Largest signed distance to a face plane: negative inside, where it is minus the distance to the surface.
    pub fn plane_distance(&self, p: Vec3) -> f64 {
        self.planes.iter().map(|(n, d)| n.dot(&p) - d).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Outward normal of the wall that `p` is nearest to from inside, or farthest outside of.
    pub fn wall_at(&self, p: &Vec3) -> Vec3 {
        let planes = self.planes.iter();
        planes
            .max_by(|a, b| (a.0.dot(p) - a.1).total_cmp(&(b.0.dot(p) - b.1)))
            .map_or_else(Vec3::zeros, |(n, _)| *n)
    }

    pub fn face_points(&self) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        self.faces.iter().map(|face| face.map(|i| self.vertices[i as usize]))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn cloud() -> impl Strategy<Value = Vec<Vec3>> {
        let coordinate = prop_oneof![Just(0.0), Just(0.5), Just(1.0), 0.0..1.0f64];
        prop::collection::vec(prop::array::uniform3(coordinate).prop_map(Vec3::from), 1..120)
    }

    fn is_closed(hull: &Hull) -> bool {
        let mut edges: Vec<(u32, u32)> =
            hull.faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
        edges.sort_unstable();
        edges.windows(2).all(|pair| pair[0] != pair[1])
            && edges.iter().all(|&(a, b)| edges.binary_search(&(b, a)).is_ok())
    }

    proptest! {
        #[test]
        fn contains_its_points_and_is_closed(points in cloud()) {
            match Hull::of(&points, usize::MAX, 0.0) {
                Ok(hull) => {
                    prop_assert!(is_closed(&hull));
                    prop_assert!(hull.volume() > 0.0);
                    for p in &points {
                        prop_assert!(hull.plane_distance(*p) < 1e-6, "{}", hull.plane_distance(*p));
                    }
                    for v in &hull.vertices {
                        prop_assert!(points.contains(v));
                    }
                }
                Err(Flat::Plane(origin, normal)) => {
                    for p in &points {
                        prop_assert!((p - origin).dot(&normal).abs() < 1e-6);
                    }
                }
                Err(_) => {}
            }
        }

        #[test]
        fn budget_and_residual_are_kept(points in cloud(), budget in 4usize..20) {
            if let Ok(hull) = Hull::of(&points, budget, 0.0) {
                prop_assert!(hull.vertices.len() <= budget);
                prop_assert!(is_closed(&hull));
                let worst = points.iter().map(|p| hull.plane_distance(*p)).fold(0.0, f64::max);
                prop_assert_eq!(worst > 1e-6, hull.residual > 1e-6, "{} {}", worst, hull.residual);
            }
        }

        #[test]
        fn flat_points_get_thickness(points in cloud(), axis in 0usize..3) {
            let flat: Vec<Vec3> = points.iter().map(|p| { let mut q = *p; q[axis] = 0.25; q }).collect();
            let (hull, thickened) = Hull::of_any(&flat, 512, 0.0, 0.002).expect("there are points");
            prop_assert!(thickened);
            prop_assert!(hull.volume() > 0.0);
            for p in &flat {
                prop_assert!(hull.plane_distance(*p) < LEANS);
            }
        }
    }

    /// By how much a narrow side of a plate of thickness 0.002 may lean over a corner that it leaves out.
    const LEANS: f64 = 1e-2 * 0.002;

    /// A corner that lies 2.4e-5 from the chord of its neighbours: one of its two ends is left out.
    #[test]
    fn a_thin_plate_with_a_blunt_corner_leans_by_a_hundredth_of_its_thickness_at_most() {
        let corners = [
            [0.0, 0.0],
            [0.0, 1.0],
            [0.668_439_933_930_875_3, 1.0],
            [1.0, 0.5],
            [1.0, 0.999_975_936_834_669],
        ];
        let flat: Vec<Vec3> = corners.iter().map(|[x, y]| Vec3::new(*x, *y, 0.25)).collect();
        let (hull, _) = Hull::of_any(&flat, 512, 0.0, 0.002).expect("there are points");
        let outside = flat.iter().map(|p| hull.plane_distance(*p)).fold(0.0, f64::max);
        assert!(outside < LEANS, "{outside:e}");
    }

    #[test]
    fn a_box_has_eight_corners_and_six_planes() {
        let mut points = Hull::of_box(Vec3::zeros(), Vec3::new(1.0, 2.0, 3.0)).vertices;
        points.extend((0..50).map(|i| Vec3::new(0.02 * f64::from(i), 1.0, 3.0)));
        let hull = Hull::of(&points, usize::MAX, 0.0).expect("solid");
        assert_eq!((hull.vertices.len(), hull.planes.len(), hull.faces.len()), (8, 6, 12));
        assert!((hull.volume() - 6.0).abs() < 1e-12);
        assert!((Hull::of_box(Vec3::zeros(), Vec3::new(1.0, 2.0, 3.0)).volume() - 6.0).abs() < 1e-12);
    }

    #[test]
    fn no_points_no_hull() {
        assert_eq!(Hull::of(&[], 8, 0.0).err(), Some(Flat::Empty));
        assert!(Hull::of_any(&[], 8, 0.0, 0.1).is_none());
    }
}
