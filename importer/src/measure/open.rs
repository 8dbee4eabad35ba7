//! Surfaces with holes: what they enclose once the holes are filled, or wind around where filling makes no sense.

use super::cap::{area, cap};
use super::filled::filled;
use super::moments::{Point, Volume};
use super::resample::{Hole, shift};
use super::rims::{Turn, rims};
use super::topology::Sets;
use super::{BodyRole, VolumeMethod};

/// A piece whose holes are a larger share than this of its own area is a sheet: it bounds nothing by itself.
const MOST_FILLED: f64 = 0.6;

/// Sheets of less than this share of all area are not asked what they wind around.
const LEAST_SHEETS: f64 = 0.02;

/// Sheets of more triangles are not asked either: they are billboards, leaves and hair.
const MOST_SHEET_TRIANGLES: usize = 200_000;

/// Pieces that do not join may lack as much as another: no bound of what they wind around is tighter than this share of it.
const LOOSE: f64 = 0.35;

/// Of the bounds of filled holes, as `importer/tests/open_meshes.rs` measures it.
const CONFIDENCE: f64 = 0.95;

/// A piece of the surface and what it encloses; a volume that is not positive is of a sheet.
pub(super) struct Piece {
    pub role: BodyRole,
    pub triangles: u64,
    pub volume: Volume,
    pub method: VolumeMethod,
    /// Of the volume, in cubed file units.
    pub half_width: f64,
    pub confidence: f64,
}

/// `triangles` are of shells with rims, each shell wound consistently.
pub(super) fn pieces(positions: &[Point], triangles: &[[u32; 3]], all_area: f64) -> Vec<Piece> {
    if triangles.is_empty() {
        return Vec::new();
    }
    let mut pieces = Vec::new();
    let mut sheets: Vec<[u32; 3]> = Vec::new();
    // A shallow tray and a bent leaf look alike: the volume may be that of the tray.
    let mut trays = 0.0;
    for group in groups(positions, triangles) {
        match group.capped(positions) {
            Some(piece) => pieces.push(piece),
            None => {
                trays += group.filled(positions).total().abs();
                sheets.extend(group.triangles);
            }
        }
    }
    let enough = area(positions, &sheets) > LEAST_SHEETS * all_area && sheets.len() <= MOST_SHEET_TRIANGLES;
    let wound = if enough { filled(positions, &sheets) } else { None };
    if let Some(wound) = wound {
        pieces.push(Piece {
            role: BodyRole::Open,
            triangles: sheets.len() as u64,
            volume: wound.volume,
            method: VolumeMethod::Winding,
            half_width: wound
                .half_width
                .max((trays - wound.volume.total()).abs())
                .max(LOOSE * wound.volume.total()),
            confidence: CONFIDENCE,
        });
    } else if !sheets.is_empty() {
        pieces.push(Piece {
            role: BodyRole::Sheet,
            triangles: sheets.len() as u64,
            volume: Volume::default(),
            method: VolumeMethod::Winding,
            half_width: trays,
            confidence: CONFIDENCE,
        });
    }
    pieces
}

/// Triangles that hang together by corners or by the rims between them.
#[derive(Default)]
struct Group {
    triangles: Vec<[u32; 3]>,
    holes: Vec<Hole>,
}

fn groups(positions: &[Point], triangles: &[[u32; 3]]) -> Vec<Group> {
    let rims = rims(triangles, Turn::Across);
    let mut sets = Sets::new(positions.len());
    for corners in triangles.iter().map(<[u32; 3]>::as_slice).chain(rims.iter().map(Vec::as_slice)) {
        corners.windows(2).for_each(|two| sets.join(two[0], two[1]));
    }
    let (group_of, count) = sets.numbered(triangles.iter().map(|corners| corners[0]));
    let mut groups: Vec<Group> = (0..count).map(|_| Group::default()).collect();
    for triangle in triangles {
        groups[group_of[triangle[0] as usize] as usize].triangles.push(*triangle);
    }
    for rim in rims {
        let cap = cap(positions, &rim);
        let area = area(positions, &cap);
        groups[group_of[rim[0] as usize] as usize].holes.push(Hole { rim, cap, area });
    }
    groups
}

impl Group {
    fn filled(&self, positions: &[Point]) -> Volume {
        let closed: Vec<[u32; 3]> =
            self.triangles.iter().chain(self.holes.iter().flat_map(|hole| &hole.cap)).copied().collect();
        Volume::of(positions, &closed)
    }

    /// `None` for a sheet.
    fn capped(&self, positions: &[Point]) -> Option<Piece> {
        let own = area(positions, &self.triangles);
        let filled: f64 = self.holes.iter().map(|hole| hole.area).sum();
        if filled > MOST_FILLED * own {
            return None;
        }
        let mut volume = self.filled(positions);
        let missed = shift(positions, &self.triangles, &self.holes, volume.total());
        let inside_out = volume.total() < 0.0;
        if (1.0 + missed.mean / volume.total()) > 0.0 {
            volume = volume.times(1.0 + missed.mean / volume.total());
        }
        let volume = if inside_out { volume.negated() } else { volume };
        // A plate of no thickness that is folded back on itself.
        (volume.total() > 1e-6 * own.powf(1.5)).then_some(Piece {
            role: BodyRole::Open,
            triangles: self.triangles.len() as u64,
            volume,
            method: VolumeMethod::Capped,
            half_width: missed.half_width,
            confidence: CONFIDENCE,
        })
    }
}
