//! How far off may a filled hole be? Asked of the same surface: it is damaged anew in the same way, filled in the same
//! way, and compared with what was there.
//!
//! A piece cut out and the caps over its rims make a closed surface; its signed volume is what the filling misses.

use super::cap::{area, cap};
use super::moments::{Point, Volume, cross, dot, minus, norm};
use super::rims::{Turn, rims};
use super::topology::{edges, sides};

/// A hole of the surface, filled.
pub(super) struct Hole {
    pub rim: Vec<u32>,
    pub cap: Vec<[u32; 3]>,
    pub area: f64,
}

/// What the true volume is more than the filled one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Shift {
    pub mean: f64,
    /// About the mean, at the confidence that `open` states.
    pub half_width: f64,
}

/// A hole whose cap has more than this share of the surface's area is of a piece broken off, and so is each where there are
/// only so many: a limb may have hung on a thin neck. Unless its rim is flat and of no more than so many edges: then it is
/// of faces lost, as all others are.
const PIECE: f64 = 0.06;
const LONE: usize = 4;
const FACES: usize = 6;

/// Holes of more edges are looked at as of so many.
const SMALL: usize = 12;

/// How often the surface is damaged anew in the way of its small holes, at most.
const REPEATS: usize = 64;
/// Holes of each size that are looked at, at least, before the sizes next to it are asked as well.
const FEW: usize = 12;

/// Pieces cut out for each large hole, and for all of them.
const CUTS: usize = 24;
const MOST_CUTS: usize = 480;
/// Triangles in a piece at most: a larger hole is compared with smaller pieces, by scale.
const MOST_TRIANGLES: usize = 4_096;
/// Triangles in all pieces together.
const MOST_WORK: usize = 400_000;

/// What a piece broken off may hold beyond its like, in deviations: as a share of the cap's area to 3/2 (a hemisphere
/// has 0.38, the fifth of a sphere 0.15), and of the volume that is left, since a limb may hang on a thin neck.
const BULGE: f64 = 0.1;
const LIMB: f64 = 0.12;

/// `triangles` are wound consistently; the holes are of this surface; `volume` is what it encloses once they are filled.
pub(super) fn shift(positions: &[Point], triangles: &[[u32; 3]], holes: &[Hole], volume: f64) -> Shift {
    if holes.is_empty() || triangles.is_empty() {
        return Shift::default();
    }
    let surface = Surface::of(positions, triangles);
    let piece = PIECE * area(positions, triangles);
    let (large, small): (Vec<&Hole>, Vec<&Hole>) = holes.iter().partition(|hole| {
        (hole.area > piece || holes.len() <= LONE)
            && (hole.rim.len() > FACES || unevenness(positions, &hole.rim) > BENDS[0])
    });
    let mut chance = Chance(0x9E37_79B9_7F4A_7C15);
    let scattered = scattered(&surface, &small, &mut chance);
    let broken = broken(&surface, &large, volume, &mut chance);
    let half_width = scattered.half_width.hypot(DEVIATIONS * broken.half_width);
    Shift { mean: broken.mean + scattered.mean, half_width }
}

/// Deviations from which a mean is believed.
const CERTAIN: f64 = 2.0;

/// Sums of losses drawn, at most.
const DRAWS: usize = 200;

/// The damage that is drawn is a little more even than the one that is there. Measured by
/// `importer/tests/open_meshes.rs`, as the next one is.
const WIDER: f64 = 1.4;

/// Half widths of what large pieces hide.
const DEVIATIONS: f64 = 1.6;

/// A hole as far as its loss can be compared: its edges, how uneven its rim is, what its cap covers.
#[derive(Clone, Copy)]
struct Kind {
    edges: usize,
    bend: usize,
    scale: f64,
}

/// Steps of unevenness: flat up to rounding, nearly flat, bent, folded.
const BENDS: [f64; 3] = [1e-7, 5e-3, 3e-2];

impl Kind {
    fn of(positions: &[Point], rim: &[u32], area: f64) -> Self {
        let uneven = unevenness(positions, rim);
        let bend = BENDS.iter().filter(|&&step| uneven > step).count();
        Self { edges: rim.len().min(SMALL), bend, scale: area.powf(1.5) }
    }
}

/// As many triangles lost anywhere, again and again: what holes of so many edges, so uneven, come to for their size.
fn scattered(surface: &Surface<'_>, holes: &[&Hole], chance: &mut Chance) -> Scattered {
    let lost: usize = holes.iter().map(|hole| hole.rim.len() - 2).sum();
    let lost = lost.min(surface.triangles.len() / 2);
    if lost == 0 {
        return Scattered::default();
    }
    let mut order: Vec<u32> = (0_u32..).zip(surface.triangles).map(|(at, _)| at).collect();
    let mut missed: Vec<Vec<f64>> = vec![Vec::new(); (SMALL + 1) * (BENDS.len() + 1)];
    let class = |edges: usize, bend: usize| edges * (BENDS.len() + 1) + bend;
    for _ in 0..(MOST_WORK / lost).clamp(1, REPEATS) {
        for at in 0..lost {
            let left = order.len() - at;
            order.swap(at, at + chance.below(left));
        }
        for piece in surface.connected(&order[..lost]) {
            let rims = rims(&piece, Turn::Along);
            let (loss, capped) = surface.missed(&piece, &rims);
            let Some(rim) = rims.iter().max_by_key(|rim| rim.len()) else { continue };
            let kind = Kind::of(surface.positions, rim, capped);
            if kind.scale > 0.0 {
                missed[class(kind.edges, kind.bend)].push((loss / kind.scale).clamp(-1.0, 1.0));
            }
        }
    }
    // Where there are too few alike, those of a few edges more or less.
    let like = |kind: &Kind| {
        let mut reach = 0;
        loop {
            let range = kind.edges.saturating_sub(reach)..=(kind.edges + reach).min(SMALL);
            let like: Vec<f64> = range.flat_map(|edges| &missed[class(edges, kind.bend)]).copied().collect();
            if like.len() >= FEW || reach > SMALL {
                return like;
            }
            reach += 1;
        }
    };
    let kinds: Vec<Kind> =
        holes.iter().map(|hole| Kind::of(surface.positions, &hole.rim, hole.area)).collect();
    let mut of_class: std::collections::BTreeMap<(usize, usize), Vec<f64>> =
        std::collections::BTreeMap::new();
    for kind in &kinds {
        of_class.entry((kind.edges, kind.bend)).or_insert_with(|| like(kind));
    }
    let draws = (MOST_WORK / kinds.len()).clamp(20, DRAWS);
    let totals = (0..draws).map(|_| {
        kinds
            .iter()
            .map(|kind| match &of_class[&(kind.edges, kind.bend)] {
                like if like.is_empty() => 0.0,
                like => kind.scale * like[chance.below(like.len())],
            })
            .sum::<f64>()
    });
    Scattered::of(totals.collect())
}

/// What many small holes come to together.
#[derive(Default)]
struct Scattered {
    mean: f64,
    /// From the mean, or from nothing where the mean is not believed: what 95 of 100 draws stay within.
    half_width: f64,
}

impl Scattered {
    fn of(mut totals: Vec<f64>) -> Self {
        let Moments { mean, variance } = of_sample(&totals);
        let deviation = variance.sqrt();
        // A few holes say nothing of the mean; many on a surface that bends one way all miss in one way.
        let mean = if mean.abs() > CERTAIN * deviation { mean } else { 0.0 };
        totals.iter_mut().for_each(|total| *total = (*total - mean).abs());
        totals.sort_by(f64::total_cmp);
        let half_width = WIDER * totals[(0.95 * (totals.len() - 1) as f64) as usize];
        Self { mean, half_width }
    }
}

/// Pieces of the size of each large hole cut out anywhere; the half width is one deviation.
fn broken(surface: &Surface<'_>, holes: &[&Hole], volume: f64, chance: &mut Chance) -> Shift {
    let (mut total, mut variance) = (Shift::default(), 0.0);
    if holes.is_empty() {
        return total;
    }
    let each = (MOST_CUTS / holes.len()).clamp(1, CUTS);
    let mut work = MOST_WORK;
    for hole in holes {
        let mut missed = Vec::with_capacity(each);
        while missed.len() < each && work > 0 {
            let cut = surface.cut_like(hole, chance);
            work = work.saturating_sub(cut.triangles);
            missed.push(cut.missed);
        }
        let one = of_sample(&missed);
        let bulge = BULGE * hole.area.powf(1.5);
        // Of few edges it is rather of a face or two, which bulged by nothing.
        total.mean += if hole.rim.len() > FACES { one.mean } else { 0.0 };
        variance += one.variance * (1.0 + 1.0 / missed.len().max(1) as f64) + bulge * bulge;
    }
    variance += (LIMB * volume).powi(2);
    total.half_width = variance.sqrt();
    total
}

/// What a sample says of the next.
#[derive(Default)]
struct Moments {
    mean: f64,
    variance: f64,
}

/// Of a sample of none or one nothing is known.
fn of_sample(sample: &[f64]) -> Moments {
    if sample.len() < 2 {
        return Moments::default();
    }
    let count = sample.len() as f64;
    let mean = sample.iter().sum::<f64>() / count;
    let squares: f64 = sample.iter().map(|value| (value - mean) * (value - mean)).sum();
    Moments { mean, variance: squares / (count - 1.0) }
}

/// How far a rim strays from its plane, as a share of its length. The plane is M. E. Newell's.
fn unevenness(positions: &[Point], rim: &[u32]) -> f64 {
    if rim.len() < 4 {
        return 0.0;
    }
    let corners: Vec<Point> = rim.iter().map(|&corner| positions[corner as usize]).collect();
    let count = corners.len() as f64;
    let middle: Point =
        std::array::from_fn(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / count);
    let mut normal = [0.0; 3];
    let mut length = 0.0;
    for (at, &corner) in corners.iter().enumerate() {
        let next = corners[(at + 1) % corners.len()];
        let turn = cross(minus(corner, middle), minus(next, middle));
        normal = std::array::from_fn(|axis| normal[axis] + turn[axis]);
        length += norm(minus(next, corner));
    }
    let scale = norm(normal) * length;
    let strays = corners.iter().map(|&corner| dot(minus(corner, middle), normal).abs());
    if scale > 0.0 { strays.fold(0.0, f64::max) / scale } else { f64::INFINITY }
}

struct Surface<'a> {
    positions: &'a [Point],
    triangles: &'a [[u32; 3]],
    /// Across each side, where exactly one other triangle is there.
    across: Vec<[u32; 3]>,
}

const NONE: u32 = u32::MAX;

/// A piece cut out.
struct Cut {
    missed: f64,
    triangles: usize,
}

impl<'a> Surface<'a> {
    fn of(positions: &'a [Point], triangles: &'a [[u32; 3]]) -> Self {
        let mut across = vec![[NONE; 3]; triangles.len()];
        for edge in edges(&sides(triangles)) {
            if let [one, other] = edge {
                for (this, that) in [(one, other), (other, one)] {
                    let corners = triangles[this.triangle as usize];
                    let side = (0..3).find(|&side| {
                        let (a, b) = (corners[side], corners[(side + 1) % 3]);
                        (a.min(b), a.max(b)) == (this.low, this.high)
                    });
                    if let Some(side) = side {
                        across[this.triangle as usize][side] = that.triangle;
                    }
                }
            }
        }
        Self { positions, triangles, across }
    }

    /// A piece of the hole's area anywhere, its loss scaled to the hole's cap.
    fn cut_like(&self, hole: &Hole, chance: &mut Chance) -> Cut {
        let seed = chance.below(self.triangles.len());
        let piece = self.grow(seed, chance, |count, area| area >= 1.2 * hole.area || count >= MOST_TRIANGLES);
        let (missed, capped) = self.missed(&piece, &rims(&piece, Turn::Along));
        let scale = if capped > 0.0 { (hole.area / capped).powf(1.5) } else { 0.0 };
        // A piece whose cap is all folds says nothing at many times its size.
        Cut { missed: missed * scale.min(4.0), triangles: piece.len() }
    }

    /// What the volume loses where the piece is taken out and its rims are filled, and the area of the filling.
    fn missed(&self, piece: &[[u32; 3]], rims: &[Vec<u32>]) -> (f64, f64) {
        let mut closed = piece.to_vec();
        for rim in rims {
            closed.extend(cap(self.positions, rim));
        }
        let capped = area(self.positions, &closed[piece.len()..]);
        (Volume::of(self.positions, &closed).total(), capped)
    }

    /// The pieces that some triangles make by their sides.
    fn connected(&self, triangles: &[u32]) -> Vec<Vec<[u32; 3]>> {
        let mut sorted = triangles.to_vec();
        sorted.sort_unstable();
        let mut seen = vec![false; sorted.len()];
        let mut pieces = Vec::new();
        for start in 0..sorted.len() {
            if std::mem::replace(&mut seen[start], true) {
                continue;
            }
            let (mut piece, mut open) = (Vec::new(), vec![sorted[start]]);
            while let Some(at) = open.pop() {
                piece.push(self.triangles[at as usize]);
                for next in self.across[at as usize] {
                    if let Ok(place) = sorted.binary_search(&next)
                        && !std::mem::replace(&mut seen[place], true)
                    {
                        open.push(next);
                    }
                }
            }
            pieces.push(piece);
        }
        pieces
    }

    /// Connected triangles around a seed, the nearer ones first, until there are enough.
    fn grow(&self, seed: usize, chance: &mut Chance, enough: impl Fn(usize, f64) -> bool) -> Vec<[u32; 3]> {
        let mut piece = vec![self.triangles[seed]];
        let mut seen = std::collections::HashSet::from([seed as u32]);
        let mut open = std::collections::VecDeque::from([seed as u32]);
        let mut covered = area(self.positions, &piece);
        while let Some(&at) = open.front() {
            if enough(piece.len(), covered) {
                break;
            }
            let turn = chance.below(3);
            let next = (0..3).map(|side| self.across[at as usize][(side + turn) % 3]);
            let Some(next) = next.into_iter().find(|next| *next != NONE && !seen.contains(next)) else {
                open.pop_front();
                continue;
            };
            seen.insert(next);
            open.push_back(next);
            let triangle = self.triangles[next as usize];
            covered += area(self.positions, &[triangle]);
            piece.push(triangle);
        }
        piece
    }
}

/// The same numbers every time. G. Marsaglia, Xorshift RNGs, 2003.
struct Chance(u64);

impl Chance {
    fn below(&mut self, count: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        // The product's upper half is below `count`.
        #[allow(clippy::cast_possible_truncation)]
        let number = ((u128::from(self.0) * count as u128) >> 64) as usize;
        number
    }
}
