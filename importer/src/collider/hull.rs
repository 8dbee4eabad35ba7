//! Convex hulls with a budget of corners.
//!
//! Quickhull in f64, always adding the point farthest outside, so that a hull stopped early is the best that
//! this order gives and its remaining error is known. Flat and thin input is thickened by the caller's choice.

use std::collections::BinaryHeap;

use super::prepared::{Vec3, bounds, tangents};

/// Points nearer than this to a face count as on it. A share of the mesh's diagonal.
const COPLANAR: f64 = 1e-7;
/// How far corners move towards covering the points that a hull with few corners leaves outside.
const HALF_WAY: f64 = 0.6;

/// A convex polyhedron; faces counter-clockwise seen from outside.
#[derive(Clone, Debug)]
pub(super) struct Hull {
    pub vertices: Vec<Vec3>,
    pub faces: Vec<[u32; 3]>,
    /// Outward unit normal and offset of every distinct face plane: outside is `n·p > d`.
    pub planes: Vec<(Vec3, f64)>,
    /// How far the farthest of the given points lies outside of the face it is nearest the middle of.
    pub residual: f64,
    /// The same for each face.
    shortfall: Vec<f64>,
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

struct Face {
    corners: [u32; 3],
    /// The face across the edge from `corners[i]` to `corners[i + 1]`.
    neighbours: [u32; 3],
    normal: Vec3,
    offset: f64,
    outside: Vec<u32>,
    alive: bool,
}

/// A face waiting with its farthest outside point; the farthest of all comes first, ties by age.
#[derive(PartialEq)]
struct Pending {
    distance: f64,
    face: u32,
    point: u32,
}

impl Eq for Pending {}
impl Ord for Pending {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.distance.total_cmp(&other.distance).then(other.face.cmp(&self.face))
    }
}
impl PartialOrd for Pending {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
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
        let hull = Self::of(&thick, budget.max(8), tolerance).unwrap_or_else(|_| {
            let (low, high) = bounds(points);
            Self::of_box(low - Vec3::repeat(half), high + Vec3::repeat(half))
        });
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
        Self { vertices, faces, planes, residual: 0.0, shortfall: vec![0.0; 12] }
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

    pub fn face_points(&self) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        self.faces.iter().map(|face| face.map(|i| self.vertices[i as usize]))
    }
}

fn first_simplex(points: &[Vec3]) -> Result<[u32; 4], Flat> {
    let Some(&origin) = points.first() else { return Err(Flat::Empty) };
    let farthest = |measure: &dyn Fn(&Vec3) -> f64| {
        points.iter().enumerate().fold((0, f64::NEG_INFINITY), |best, (i, p)| {
            let value = measure(p);
            if value > best.1 { (i, value) } else { best }
        })
    };
    let mut pair = (0, 0, 0.0);
    for axis in 0..3 {
        let (high, _) = farthest(&|p| p[axis]);
        let (low, _) = farthest(&|p| -p[axis]);
        let span = (points[high] - points[low]).norm();
        if span > pair.2 {
            pair = (low, high, span);
        }
    }
    let (a, b, span) = pair;
    if span < COPLANAR {
        return Err(Flat::Point(origin));
    }
    let direction = (points[b] - points[a]) / span;
    let (c, width) = farthest(&|p| (p - points[a]).cross(&direction).norm());
    if width < COPLANAR {
        return Err(Flat::Line(points[a], direction));
    }
    let normal = direction.cross(&(points[c] - points[a])).normalize();
    let (d, height) = farthest(&|p| (p - points[a]).dot(&normal).abs());
    // Sheets thinner than a thousandth of their width behave as flat ones in any solver, but are kept exact.
    if height < COPLANAR * 4.0 {
        return Err(Flat::Plane(points[a], normal));
    }
    let [a, b, c, d] = [a, b, c, d].map(|i| i as u32);
    Ok(if (points[d as usize] - points[a as usize]).dot(&normal) < 0.0 { [a, b, c, d] } else { [a, c, b, d] })
}

struct Builder<'a> {
    points: &'a [Vec3],
    faces: Vec<Face>,
    pending: BinaryHeap<Pending>,
    corners: usize,
    /// Farthest point given up because adding it would have broken the surface.
    given_up: f64,
    // Scratch, kept between insertions.
    visible: Vec<u32>,
    mark: Vec<u32>,
    round: u32,
}

impl<'a> Builder<'a> {
    fn new(points: &'a [Vec3], [a, b, c, d]: [u32; 4]) -> Self {
        let mut builder = Self {
            points,
            faces: Vec::new(),
            pending: BinaryHeap::new(),
            corners: 4,
            given_up: 0.0,
            visible: Vec::new(),
            mark: Vec::new(),
            round: 0,
        };
        // `d` lies below the face a, b, c.
        for (corners, neighbours) in
            [([a, b, c], [1, 2, 3]), ([b, a, d], [0, 3, 2]), ([c, b, d], [0, 1, 3]), ([a, c, d], [0, 2, 1])]
        {
            if let Some(face) = builder.face(corners, neighbours) {
                builder.faces.push(face);
                builder.mark.push(0);
            }
        }
        let everything: Vec<u32> = (0..points.len() as u32).collect();
        builder.share(&everything, 0);
        builder
    }

    fn face(&self, corners: [u32; 3], neighbours: [u32; 3]) -> Option<Face> {
        let [a, b, c] = corners.map(|i| self.points[i as usize]);
        let (ab, ac, bc) = (b - a, c - a, c - b);
        let cross = ab.cross(&ac);
        let longest = ab.norm().max(ac.norm()).max(bc.norm());
        let area = cross.norm();
        // A sliver's normal is noise; the point that would make one is given up instead.
        if area < longest * COPLANAR * 0.1 {
            return None;
        }
        let normal = cross / area;
        let offset = normal.dot(&((a + b + c) / 3.0));
        Some(Face { corners, neighbours, normal, offset, outside: Vec::new(), alive: true })
    }

    /// Gives every point to the face from `first` on that it lies farthest outside of, if any.
    fn share(&mut self, points: &[u32], first: usize) {
        for &index in points {
            let p = self.points[index as usize];
            let mut best = COPLANAR;
            let mut owner = None;
            for (f, face) in self.faces.iter().enumerate().skip(first) {
                let distance = face.normal.dot(&p) - face.offset;
                if distance > best {
                    best = distance;
                    owner = Some(f);
                }
            }
            if let Some(f) = owner {
                self.faces[f].outside.push(index);
            }
        }
        for f in first..self.faces.len() {
            self.queue(f);
        }
    }

    fn queue(&mut self, f: usize) {
        let face = &self.faces[f];
        let mut best: Option<(f64, u32)> = None;
        for &index in &face.outside {
            let distance = face.normal.dot(&self.points[index as usize]) - face.offset;
            if best.is_none_or(|(d, _)| distance > d) {
                best = Some((distance, index));
            }
        }
        if let Some((distance, point)) = best {
            self.pending.push(Pending { distance, face: f as u32, point });
        }
    }

    fn grow(mut self, budget: usize, tolerance: f64) -> Hull {
        let mut residual = 0.0;
        while let Some(next) = self.pending.pop() {
            if !self.faces[next.face as usize].alive {
                continue;
            }
            if next.distance <= tolerance || self.corners >= budget {
                residual = next.distance;
                break;
            }
            if self.add(next.point, next.face).is_none() {
                self.given_up = self.given_up.max(next.distance);
                let face = &mut self.faces[next.face as usize];
                face.outside.retain(|&p| p != next.point);
                self.queue(next.face as usize);
            }
        }
        self.finish(residual)
    }

    /// Adds a point outside of face `from`; `None`, with nothing changed, where the surface would break.
    fn add(&mut self, point: u32, from: u32) -> Option<()> {
        let p = self.points[point as usize];
        self.round += 1;
        self.visible.clear();
        self.see(from);
        let first = self.faces.len() as u32;
        // Where the point lies in line with an edge of the rim, the face across is in its plane and goes too.
        let (rim, cone) = loop {
            self.spread(p);
            let rim = self.rim()?;
            let count = rim.len() as u32;
            let mut cone = Vec::with_capacity(rim.len());
            let mut in_line = None;
            for (i, &(a, b, neighbour)) in (0u32..).zip(&rim) {
                let around = [neighbour, first + (i + 1) % count, first + (i + count - 1) % count];
                match self.face([a, b, point], around) {
                    Some(face) => cone.push(face),
                    None => in_line = Some(neighbour),
                }
            }
            match in_line {
                None => break (rim, cone),
                Some(neighbour) => self.see(neighbour),
            }
        };
        for (i, &(a, _, neighbour)) in rim.iter().enumerate() {
            let other = &mut self.faces[neighbour as usize];
            // The neighbour runs the shared edge the other way: it ends at `a`.
            for side in 0..3 {
                if other.corners[(side + 1) % 3] == a && other.corners[side] == rim[i].1 {
                    other.neighbours[side] = first + i as u32;
                }
            }
        }
        let mut orphans = Vec::new();
        let mut gone: Vec<u32> = Vec::new();
        for &f in &self.visible {
            let face = &mut self.faces[f as usize];
            face.alive = false;
            orphans.append(&mut face.outside);
            gone.extend(face.corners);
        }
        gone.sort_unstable();
        gone.dedup();
        self.corners = self.corners + 1 - (gone.len() - rim.len().min(gone.len()));
        orphans.retain(|&q| q != point);
        self.faces.extend(cone);
        self.mark.resize(self.faces.len(), 0);
        self.share(&orphans, first as usize);
        Some(())
    }

    fn see(&mut self, face: u32) {
        self.mark[face as usize] = self.round;
        self.visible.push(face);
    }

    /// Adds all faces to the visible ones that `p` sees and that hang together with them.
    fn spread(&mut self, p: Vec3) {
        let mut next = 0;
        while next < self.visible.len() {
            let neighbours = self.faces[self.visible[next] as usize].neighbours;
            next += 1;
            for neighbour in neighbours {
                let other = &self.faces[neighbour as usize];
                let unseen = self.mark[neighbour as usize] != self.round;
                if unseen && other.normal.dot(&p) - other.offset > COPLANAR * 0.5 {
                    self.see(neighbour);
                }
            }
        }
    }

    /// The edges around the visible faces in order: start, end, and the face across.
    fn rim(&self) -> Option<Vec<(u32, u32, u32)>> {
        let mut edges = Vec::new();
        for &f in &self.visible {
            let face = &self.faces[f as usize];
            for side in 0..3 {
                let neighbour = face.neighbours[side];
                if self.mark[neighbour as usize] != self.round {
                    edges.push((face.corners[side], face.corners[(side + 1) % 3], neighbour));
                }
            }
        }
        one_loop(&edges)
    }

    fn finish(self, residual: f64) -> Hull {
        let mut new_index = vec![u32::MAX; self.points.len()];
        let mut vertices = Vec::new();
        let mut faces = Vec::new();
        let mut planes: Vec<(Vec3, f64)> = Vec::new();
        let mut shortfall = Vec::new();
        for face in self.faces.iter().filter(|face| face.alive) {
            let outside =
                face.outside.iter().map(|&p| face.normal.dot(&self.points[p as usize]) - face.offset);
            shortfall.push(outside.fold(0.0, f64::max));
            faces.push(face.corners.map(|corner| {
                let index = &mut new_index[corner as usize];
                if *index == u32::MAX {
                    *index = vertices.len() as u32;
                    vertices.push(self.points[corner as usize]);
                }
                *index
            }));
            let known = planes
                .iter()
                .any(|(n, d)| n.dot(&face.normal) > 1.0 - 1e-12 && (d - face.offset).abs() < COPLANAR);
            if !known {
                planes.push((face.normal, face.offset));
            }
        }
        Hull { vertices, faces, planes, residual: residual.max(self.given_up), shortfall }
    }
}

/// Puts the rim's edges in order; `None` where they are not one simple loop.
fn one_loop(edges: &[(u32, u32, u32)]) -> Option<Vec<(u32, u32, u32)>> {
    if edges.len() < 3 {
        return None;
    }
    let mut by_start: Vec<(u32, u32, u32)> = edges.to_vec();
    by_start.sort_unstable();
    if by_start.windows(2).any(|pair| pair[0].0 == pair[1].0) {
        return None;
    }
    let mut rim = Vec::with_capacity(edges.len());
    let mut edge = by_start[0];
    for _ in 0..edges.len() {
        rim.push(edge);
        edge = by_start[by_start.binary_search_by_key(&edge.1, |e| e.0).ok()?];
        if edge.0 == by_start[0].0 {
            break;
        }
    }
    (rim.len() == edges.len()).then_some(rim)
}

/// Convex outline of points in the plane, counter-clockwise (Andrew's monotone chain).
pub(super) fn convex_outline(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    // Rounded, so that points in line across the sorting direction are in line to the last bit.
    let mut sorted: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| (x * 1e12).round() / 1e12)).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut outline: Vec<[f64; 2]> = Vec::new();
    for pass in 0..2 {
        let start = outline.len();
        let mut visit = |p: [f64; 2]| {
            while outline.len() >= start + 2
                && turn(outline[outline.len() - 2], outline[outline.len() - 1], p) <= 0.0
            {
                outline.pop();
            }
            outline.push(p);
        };
        if pass == 0 {
            sorted.iter().for_each(|p| visit(*p));
        } else {
            sorted.iter().rev().for_each(|p| visit(*p));
        }
        outline.pop();
    }
    outline
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
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
                prop_assert!(hull.plane_distance(*p) < 1e-6);
            }
        }
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
