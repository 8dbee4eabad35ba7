//! How far a collider is from the mesh, both ways.

use std::borrow::Cow;

use super::ColliderError;
use super::bvh::Bvh;
use super::hull::Hull;
use super::prepared::{Prepared, Vec3};
use super::sampling::{Samples, r3};
use super::sight::Sight;
use super::solid::Solid;
use crate::measure::{Measures, VolumeMethod};

/// Farthest that any point may be off, in tolerances: these bound the 95th percentile.
pub const REACH: f64 = 1.75;
/// A mesh point this far outside of the collider counts as outside. A share of the diagonal.
const OUTSIDE: f64 = 1e-3;
/// A point of one piece this deep in another is an inner wall between them, no surface.
const CRACK: f64 = 3e-4;
/// Points by which the volume of overlapping pieces is counted.
const VOLUME_POINTS: usize = 20_000;

/// What candidates are held against.
pub(super) struct Reference<'a> {
    pub mesh: &'a Prepared,
    pub tree: Bvh,
    pub samples: Samples,
    /// In the prepared frame; only where the mesh encloses it exactly.
    pub volume: Option<f64>,
    /// Closed, and wound outwards everywhere: what lies behind a face cannot be seen.
    pub closed: bool,
}

impl<'a> Reference<'a> {
    pub fn new(mesh: &'a Prepared, samples: usize, measures: &Measures) -> Self {
        let tree = Bvh::of_mesh(mesh);
        let samples = Samples::of_mesh(mesh, &tree, samples);
        let exact = matches!(measures.solid_method, Some(VolumeMethod::Closed | VolumeMethod::Oriented));
        let volume = measures.solid.filter(|_| exact).map(|solid| solid.measure / mesh.diagonal.powi(3));
        let closed = measures.solid_method == Some(VolumeMethod::Closed);
        Self { mesh, tree, samples, volume, closed }
    }

    /// Mean thickness of what the surface encloses if it is a shell; `None` where it encloses nothing.
    pub fn thickness(&self) -> Option<f64> {
        let area = |[a, b, c]: [Vec3; 3]| (b - a).cross(&(c - a)).norm() / 2.0;
        let surface: f64 = (0..self.mesh.triangles.len()).map(|t| area(self.mesh.corners(t))).sum();
        self.volume.filter(|_| surface > 0.0).map(|volume| 2.0 * volume / surface)
    }

    /// Both ways: mesh points to the union's outer surface, and the union's outer points to the mesh.
    ///
    /// Only what can be seen from outside is counted: nothing touches the engine inside a car or the wall
    /// where two pieces meet.
    pub fn measure(&self, pieces: &[Solid]) -> ColliderError {
        self.measure_each(pieces).1
    }

    /// What each piece is to blame for, and the whole as [`Reference::measure`] has it.
    pub fn measure_each(&self, pieces: &[Solid]) -> (Vec<PieceError>, ColliderError) {
        let bounds: Vec<(Vec3, Vec3)> = pieces.iter().map(Solid::bounds).collect();
        let union = Union { pieces, bounds: &bounds };
        let skin = union.skin(self.samples.points.len().max(500));
        let points: Vec<Vec3> = skin.iter().map(|(p, _)| *p).collect();
        let buried = Buried::new(&union, &points);
        let mut errors = vec![PieceError::default(); pieces.len()];

        let mut distances = Vec::with_capacity(self.samples.points.len());
        let mut outside = 0usize;
        for p in self.samples.seen_points() {
            let (distance, owner) = union.distance(p);
            let Some(error) = errors.get_mut(owner) else { continue };
            if distance > 0.0 {
                outside += usize::from(distance > OUTSIDE);
                error.outside = error.outside.max(distance);
                distances.push(distance);
            } else {
                let depth = if pieces.len() > 1 { buried.distance(p, owner) } else { -distance };
                error.grown = error.grown.max(depth);
                distances.push(depth);
            }
        }
        let mut growths = Vec::with_capacity(skin.len());
        let mut sight = Sight::new(&self.tree);
        for &(p, owner) in &skin {
            let Some(nearest) = self.tree.nearest(p, 2.0) else { continue };
            let error = &mut errors[owner];
            // Whether a point is seen is dear to tell, and matters little where it is near.
            let mut hidden = || self.closed && self.tree.is_behind(p, &nearest) || !sight.sees_out(p);
            if nearest.distance > 1e-3 && hidden() {
                continue;
            }
            error.grown = error.grown.max(nearest.distance);
            growths.push(nearest.distance);
        }
        let count = distances.len().max(1);
        let (surface_p95, surface_max) = p95_and_max(distances);
        let (growth_p95, growth_max) = p95_and_max(growths);
        let whole = ColliderError {
            surface_max,
            surface_p95,
            growth_max,
            growth_p95,
            outside_share: outside as f64 / count as f64,
            volume_ratio: self.volume.filter(|v| *v > 0.0).map(|v| union.volume() / v),
        };
        (errors, whole)
    }
}

fn p95_and_max(mut values: Vec<f64>) -> (f64, f64) {
    values.sort_by(f64::total_cmp);
    let at = |index: usize| values.get(index).or(values.last()).copied().unwrap_or(0.0);
    (at(values.len() * 95 / 100), at(usize::MAX))
}

/// What one piece of a union gets wrong, as shares of the diagonal.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PieceError {
    /// How far its surface reaches beyond the mesh, or lies above seen mesh inside it.
    pub grown: f64,
    /// How far mesh nearest to it lies outside of the union.
    pub outside: f64,
}

impl PieceError {
    pub fn worst(&self) -> f64 {
        self.grown.max(self.outside)
    }
}

impl ColliderError {
    /// How far it is beyond `tolerance`, as a factor: at most one where it keeps to it. The tolerance bounds the
    /// 95th percentile both ways, [`REACH`] tolerances everything.
    #[must_use]
    pub fn excess(&self, tolerance: f64) -> f64 {
        let (common, farthest) = self.excesses(tolerance);
        common.max(farthest)
    }

    /// The same for the 95th percentile and for the farthest point.
    pub(super) fn excesses(&self, tolerance: f64) -> (f64, f64) {
        let farthest = self.surface_max.max(self.growth_max) / (REACH * tolerance);
        (self.surface_p95.max(self.growth_p95) / tolerance, farthest)
    }
}

struct Union<'a> {
    pieces: &'a [Solid],
    bounds: &'a [(Vec3, Vec3)],
}

impl Union<'_> {
    /// Least signed distance to a piece, and that piece.
    fn distance(&self, p: Vec3) -> (f64, usize) {
        let mut best = (f64::INFINITY, 0);
        for (i, piece) in self.pieces.iter().enumerate() {
            let (low, high) = self.bounds[i];
            let gap = (low - p).sup(&(p - high));
            // Outside of its bounds by more than the best so far: it cannot be nearer.
            if gap.map(|x| x.max(0.0)).norm() > best.0.max(0.0) {
                continue;
            }
            let distance = piece.distance(p);
            if distance < best.0 {
                best = (distance, i);
            }
        }
        best
    }

    /// Whether a point on the surface of piece `own` lies in another piece.
    fn covers(&self, p: Vec3, own: usize) -> bool {
        self.pieces.iter().enumerate().any(|(i, piece)| {
            let (low, high) = self.bounds[i];
            i != own && (0..3).all(|k| p[k] > low[k] && p[k] < high[k]) && piece.holds(p, 0.0)
        })
    }

    /// About `count` points of the outer surface, and the piece each lies on.
    fn skin(&self, count: usize) -> Vec<(Vec3, usize)> {
        let areas: Vec<f64> = self
            .bounds
            .iter()
            .map(|(low, high)| {
                let d = high - low;
                d.x * d.y + d.y * d.z + d.z * d.x
            })
            .collect();
        let total: f64 = areas.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let mut skin = Vec::with_capacity(count);
        for (i, piece) in self.pieces.iter().enumerate() {
            // Half of a piece's surface may be covered by its neighbours.
            let wanted =
                (count as f64 * if self.pieces.len() > 1 { 1.6 } else { 1.0 } * areas[i] / total) as usize;
            let centre = (self.bounds[i].0 + self.bounds[i].1) / 2.0;
            let on_piece = piece.surface_points(wanted.max(24));
            // A hair outside, so that the wall shared with a neighbour is told from the outer one.
            let outer = on_piece.into_iter().filter(|p| {
                let outward = (p - centre).normalize() * CRACK;
                self.pieces.len() == 1 || !self.covers(p + outward, i)
            });
            skin.extend(outer.map(|p| (p, i)));
        }
        skin
    }

    fn volume(&self) -> f64 {
        if let [piece] = self.pieces {
            return piece.volume();
        }
        let low = self.bounds.iter().fold(Vec3::repeat(f64::INFINITY), |low, b| low.inf(&b.0));
        let high = self.bounds.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, b| high.sup(&b.1));
        let size = high - low;
        let held =
            (0..VOLUME_POINTS).filter(|&i| self.covers(low + r3(i).component_mul(&size), usize::MAX)).count();
        size.product() * held as f64 / VOLUME_POINTS as f64
    }
}

/// Distance from a point inside the union to its outer surface.
struct Buried<'a> {
    union: &'a Union<'a>,
    skin: Bvh,
    /// The pieces in flat faces.
    hulls: Vec<Cow<'a, Hull>>,
    faces: Bvh,
    owners: Vec<usize>,
}

impl<'a> Buried<'a> {
    fn new(union: &'a Union<'a>, skin: &[Vec3]) -> Self {
        let mut triangles = Vec::new();
        let mut owners = Vec::new();
        let several = union.pieces.len() > 1;
        let hulls: Vec<Cow<'_, Hull>> = union.pieces.iter().filter(|_| several).map(Solid::facets).collect();
        for (i, hull) in hulls.iter().enumerate() {
            triangles.extend(hull.face_points());
            owners.resize(triangles.len(), i);
        }
        let skin = if union.pieces.len() > 1 { skin } else { &[] };
        Self {
            union,
            skin: Bvh::new(skin.iter().map(|p| [*p; 3]).collect()),
            hulls,
            faces: Bvh::new(triangles),
            owners,
        }
    }

    /// The nearest foot point on a face that no other piece covers, or the nearest known point of the outer
    /// surface: exact in the first case, an upper bound within the spacing of those points in the second.
    fn distance(&self, p: Vec3, owner: usize) -> f64 {
        let limit = self.skin.nearest(p, 2.0).map_or(2.0, |nearest| nearest.distance);
        let open = |triangle: usize, foot: Vec3| {
            let own = self.owners[triangle];
            let normal = self.hulls[own]
                .planes
                .iter()
                .max_by(|a, b| (a.0.dot(&foot) - a.1).total_cmp(&(b.0.dot(&foot) - b.1)));
            normal.is_some_and(|(n, _)| !self.union.covers(foot + n * CRACK, own))
        };
        match self.faces.nearest_where(p, limit, open) {
            Some(nearest) => nearest.distance,
            None if limit < 2.0 => limit,
            None => self.union.pieces[owner].distance(p).abs(),
        }
    }
}
