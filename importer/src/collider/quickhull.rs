//! Quickhull in f64, always adding the point farthest outside, so that a hull stopped early is the best that
//! this order gives (Barber, Dobkin, Huhdanpaa, ACM TOMS 22(4), 1996).

use std::collections::BinaryHeap;

use super::hull::{Flat, Hull};
use super::prepared::Vec3;

/// Points nearer than this to a face count as on it. A share of the mesh's diagonal.
pub(super) const COPLANAR: f64 = 1e-7;

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

pub(super) fn first_simplex(points: &[Vec3]) -> Result<[u32; 4], Flat> {
    let Some(&origin) = points.first() else { return Err(Flat::Empty) };
    let mut pair = (0, 0, 0.0);
    for axis in 0..3 {
        let (high, _) = farthest(points, |p| p[axis]);
        let (low, _) = farthest(points, |p| -p[axis]);
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
    let (c, width) = farthest(points, |p| (p - points[a]).cross(&direction).norm());
    if width < COPLANAR {
        return Err(Flat::Line(points[a], direction));
    }
    let normal = direction.cross(&(points[c] - points[a])).normalize();
    let (d, height) = farthest(points, |p| (p - points[a]).dot(&normal).abs());
    // Sheets thinner than a thousandth of their width behave as flat ones in any solver, but are kept exact.
    if height < COPLANAR * 4.0 {
        return Err(Flat::Plane(points[a], normal));
    }
    let [a, b, c, d] = [a, b, c, d].map(|i| i as u32);
    Ok(if (points[d as usize] - points[a as usize]).dot(&normal) < 0.0 { [a, b, c, d] } else { [a, c, b, d] })
}

/// The first of those with the largest measure.
fn farthest(points: &[Vec3], measure: impl Fn(&Vec3) -> f64) -> (usize, f64) {
    points.iter().enumerate().fold((0, f64::NEG_INFINITY), |best, (i, p)| {
        let value = measure(p);
        if value > best.1 { (i, value) } else { best }
    })
}

pub(super) struct Builder<'a> {
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
    pub(super) fn new(points: &'a [Vec3], [a, b, c, d]: [u32; 4]) -> Self {
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
        let faces = &mut self.faces[first..];
        let mut farthest: Vec<(f64, u32)> = vec![(0.0, 0); faces.len()];
        for &index in points {
            let p = self.points[index as usize];
            let mut best = COPLANAR;
            let mut owner = None;
            for (f, face) in faces.iter().enumerate() {
                let distance = face.normal.dot(&p) - face.offset;
                if distance > best {
                    best = distance;
                    owner = Some(f);
                }
            }
            if let Some(f) = owner {
                faces[f].outside.push(index);
                if best > farthest[f].0 {
                    farthest[f] = (best, index);
                }
            }
        }
        for (face, (distance, point)) in (first as u32..).zip(farthest) {
            if distance > 0.0 {
                self.pending.push(Pending { distance, face, point });
            }
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

    pub(super) fn grow(mut self, budget: usize, tolerance: f64) -> Hull {
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
        let mut of = Vec::new();
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
                    of.push(corner);
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
        Hull { vertices, faces, of, planes, residual: residual.max(self.given_up), shortfall }
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
