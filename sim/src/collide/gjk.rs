//! The distance between two convex cores, by Gilbert, Johnson and Keerthi (1988), with the closest point of a simplex
//! after Ericson (2004, "Real-Time Collision Detection", 5.1); and the least way out of an overlap.

use crate::collide::convex::Core;
use crate::collide::relative::Relative;
use crate::math::{Mat3, Vec3};

/// Steps before the search is stopped; a box needs five, a rim twenty.
const MAX_STEPS: usize = 48;
/// Share of the squared distance to which it is found: of the normal, 1e-4 rad.
const PRECISION: f64 = 1e-8;

/// Times the way out of an overlap is turned towards a shorter one, and the square of the angle (rad) that is no turn.
const MAX_TURNS: usize = 8;
const SETTLED: f64 = 1e-9;

/// A vertex of the Minkowski difference B - A and where it comes from.
#[derive(Clone, Copy, Debug, Default)]
struct Vertex {
    difference: Vec3,
    on_a: Vec3,
    weight: f64,
}

/// The nearest points of two cores, in the frame of A.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// Unit, from A to B.
    pub(crate) normal: Vec3,
    pub(crate) on_a: Vec3,
    pub(crate) on_b: Vec3,
    /// m, along the normal; negative where the cores overlap.
    pub(crate) distance: f64,
}

/// Two cores and where the second lies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CorePair<'a> {
    pub(crate) a: Core<'a>,
    pub(crate) b: Core<'a>,
    pub(crate) relative: Relative,
}

impl CorePair<'_> {
    fn vertex(&self, direction: &Vec3) -> Vertex {
        let on_a = self.a.support(&-direction);
        let on_b = self.relative.point(&self.b.support(&self.relative.rotation.tr_mul(direction)));
        Vertex { difference: on_b - on_a, on_a, weight: 1.0 }
    }

    /// From the middle of A to that of B.
    pub(crate) fn between(&self) -> Option<Vec3> {
        let center = |core: &Core<'_>| match core {
            Core::Polytope(polytope) => (polytope.low + polytope.high) * 0.5,
            _ => Vec3::zeros(),
        };
        (self.relative.point(&center(&self.b)) - center(&self.a)).try_normalize(1e-12)
    }

    /// The best of a few normals along which many shapes lie on each other.
    pub(crate) fn first_guess(&self) -> Vec3 {
        let mut best = (f64::NEG_INFINITY, Vec3::y());
        let mut offer = |normal: Vec3| {
            let distance = self.separation_along(&normal).distance;
            if distance > best.0 {
                best = (distance, normal);
            }
        };
        if let Some(normal) = self.between() {
            offer(normal);
        }
        for (core, rotation, sign) in
            [(&self.a, &Mat3::identity(), 1.0), (&self.b, &self.relative.rotation, -1.0)]
        {
            match core {
                Core::Polytope(polytope) => {
                    polytope.faces.iter().for_each(|face| offer(rotation * face.normal * sign));
                }
                Core::Cylinder { .. } | Core::Cone { .. } => {
                    let axis = rotation * Vec3::y();
                    offer(axis);
                    offer(-axis);
                }
                Core::Point | Core::Segment { .. } => {}
            }
        }
        // A straight side that crosses an edge: the normals that are square to both.
        for (edged, straight, sign) in [(&self.a, &self.b, 1.0), (&self.b, &self.a, -1.0)] {
            let (Core::Polytope(polytope), Core::Segment { .. } | Core::Cylinder { .. }) = (edged, straight)
            else {
                continue;
            };
            let (to_a, axis) = if sign > 0.0 {
                (Mat3::identity(), self.relative.rotation * Vec3::y())
            } else {
                (self.relative.rotation, Vec3::y())
            };
            for edge in &polytope.edges {
                let along = polytope.vertices[edge.head as usize] - polytope.vertices[edge.tail as usize];
                let cross = (to_a * along).cross(&axis);
                let outward = (to_a * edge.outward(polytope)) * sign;
                if let Some(normal) = cross.try_normalize(1e-9 * along.norm()) {
                    offer(normal * normal.dot(&outward).signum());
                }
            }
        }
        best.1
    }

    /// A normal to start from where nothing is known, already turned: the better of two starts, since a deep overlap has
    /// more than one way out.
    pub(crate) fn start(&self, gap: f64) -> Vec3 {
        let first = self.touching(&self.first_guess(), gap);
        if first.distance > 0.0 {
            return first.normal;
        }
        let second = self.touching(&self.between().unwrap_or(first.normal), gap);
        if second.distance > first.distance { second.normal } else { first.normal }
    }

    /// How far B reaches beyond A against `normal`: the distance of the supporting planes, exact.
    pub(crate) fn separation_along(&self, normal: &Vec3) -> Nearest {
        let vertex = self.vertex(&-normal);
        Nearest {
            normal: *normal,
            on_a: vertex.on_a,
            on_b: vertex.on_a + vertex.difference,
            distance: vertex.difference.dot(normal),
        }
    }

    /// The nearest points of cores that are apart by more than `touching` metres; `None` for others. `guess` points
    /// from A to B.
    pub(crate) fn nearest(&self, guess: &Vec3, touching: f64) -> Option<Nearest> {
        let mut simplex = Simplex::default();
        simplex.push(self.vertex(&-guess));
        let mut nearest = simplex.vertices[0].difference;
        for _ in 0..MAX_STEPS {
            let square = nearest.norm_squared();
            if square <= touching * touching {
                return None;
            }
            let next = self.vertex(&-nearest);
            // `nearest` is the answer when no vertex lies farther towards the origin.
            if square - next.difference.dot(&nearest) <= PRECISION * square || simplex.has(&next) {
                break;
            }
            let before = simplex;
            simplex.push(next);
            let reduced = simplex.reduce();
            // A plane square to `nearest` parts them, whatever rounding makes of a flat tetrahedron.
            let apart = next.difference.dot(&nearest) > 0.0;
            if simplex.len == 4 && !apart {
                return None;
            }
            if simplex.len == 4 || reduced.norm_squared() >= square {
                simplex = before;
                break;
            }
            nearest = reduced;
        }
        let on_a = simplex.held().iter().map(|v| v.on_a * v.weight).sum::<Vec3>();
        let distance = nearest.norm();
        (distance > touching).then(|| Nearest {
            normal: nearest / distance,
            on_a,
            on_b: on_a + nearest,
            distance,
        })
    }

    /// The nearest points of cores that are apart or overlap by less than their size, from a `guess` of the normal.
    ///
    /// Overlapping, B is moved out along the guess until there is a gap of `gap` metres; the normal there is a better
    /// one, because the distance along it is the gap or more, so that moved back B overlaps no deeper. Where the
    /// guess was right, it comes back itself. Rejected: the expanding polytope, which on a rim converges with its
    /// facets only.
    pub(crate) fn touching(&self, guess: &Vec3, gap: f64) -> Nearest {
        let mut best = self.separation_along(guess);
        if best.distance > gap
            && let Some(nearest) = self.nearest(guess, 0.5 * gap)
        {
            return nearest;
        }
        for _ in 0..MAX_TURNS {
            let out = (gap - best.distance).max(0.0);
            let mut moved = *self;
            moved.relative.translation += best.normal * out;
            let Some(mut nearest) = moved.nearest(&best.normal, 0.01 * gap) else { break };
            let turned = (nearest.normal - best.normal).norm_squared();
            let separation = self.separation_along(&nearest.normal);
            if separation.distance < best.distance {
                break;
            }
            nearest.on_b -= best.normal * out;
            nearest.distance = separation.distance;
            best = nearest;
            if turned < SETTLED {
                break;
            }
        }
        best
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Simplex {
    vertices: [Vertex; 4],
    len: usize,
}

impl Simplex {
    fn push(&mut self, vertex: Vertex) {
        self.vertices[self.len] = vertex;
        self.len += 1;
    }

    fn held(&self) -> &[Vertex] {
        &self.vertices[..self.len]
    }

    fn has(&self, vertex: &Vertex) -> bool {
        self.held().iter().any(|held| held.difference == vertex.difference)
    }

    /// Keeps the vertices of the smallest face that holds the point nearest to the origin, with their weights, and
    /// returns that point; all four where the origin is inside.
    fn reduce(&mut self) -> Vec3 {
        match self.len {
            1 => self.vertices[0].weight = 1.0,
            2 => self.keep(&segment(self.at(0), self.at(1))),
            3 => self.keep(&triangle(self.at(0), self.at(1), self.at(2))),
            _ => self.reduce_tetrahedron(),
        }
        self.held().iter().map(|v| v.difference * v.weight).sum()
    }

    fn at(&self, i: usize) -> &Vec3 {
        &self.vertices[i].difference
    }

    fn keep(&mut self, weights: &[f64]) {
        let mut kept = 0;
        for (i, &weight) in weights.iter().enumerate() {
            if weight > 0.0 {
                self.vertices[kept] = Vertex { weight, ..self.vertices[i] };
                kept += 1;
            }
        }
        self.len = kept;
    }

    /// The newest vertex is the last; the face opposite to it was the simplex before, and lies farther away.
    fn reduce_tetrahedron(&mut self) {
        let mut best: Option<(f64, [usize; 3], [f64; 3])> = None;
        for [i, j, k, opposite] in [[0, 2, 3, 1], [0, 3, 1, 2], [1, 3, 2, 0]] {
            let (p, q, r, s) = (self.at(i), self.at(j), self.at(k), self.at(opposite));
            let normal = (q - p).cross(&(r - p));
            let (origin, inside) = (-p.dot(&normal), (s - p).dot(&normal));
            // The origin on the far side of this face, or a tetrahedron without volume.
            if origin * inside < 0.0
                || inside * inside <= 1e-28 * normal.norm_squared() * (s - p).norm_squared()
            {
                let weights = triangle(p, q, r);
                let square = (p * weights[0] + q * weights[1] + r * weights[2]).norm_squared();
                if best.is_none_or(|(least, ..)| square < least) {
                    best = Some((square, [i, j, k], weights));
                }
            }
        }
        if let Some((_, face, weights)) = best {
            let mut spread = [0.0; 4];
            face.iter().zip(weights).for_each(|(&vertex, weight)| spread[vertex] = weight);
            self.keep(&spread);
        }
    }
}

fn segment(p: &Vec3, q: &Vec3) -> [f64; 2] {
    let along = q - p;
    let share = -p.dot(&along) / along.norm_squared();
    if share.is_nan() || share <= 0.0 {
        [1.0, 0.0]
    } else if share >= 1.0 {
        [0.0, 1.0]
    } else {
        [1.0 - share, share]
    }
}

/// Barycentric weights of the point of a triangle nearest to the origin.
fn triangle(p: &Vec3, q: &Vec3, r: &Vec3) -> [f64; 3] {
    let (u, v) = (q - p, r - p);
    let (d1, d2) = (-u.dot(p), -v.dot(p));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let (d3, d4) = (-u.dot(q), -v.dot(q));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let share = d1 / (d1 - d3);
        return [1.0 - share, share, 0.0];
    }
    let (d5, d6) = (-u.dot(r), -v.dot(r));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let share = d2 / (d2 - d6);
        return [1.0 - share, 0.0, share];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - share, share];
    }
    let sum = va + vb + vc;
    [va / sum, vb / sum, vc / sum]
}
