//! The best estimate of the solid that a surface bounds, with what it may be off by.

use crate::asset::Mesh;

use super::cap::area;
use super::moments::Volume;
use super::open::{self, Piece};
use super::shells::shells;
use super::topology::Topology;
use super::{BodyRole, BodyVolume, MOST_BODIES, MassProperties, VolumeMethod, bounds, nesting, repair};

/// A surface whose volume is a smaller share than this of its bounding cube encloses nothing.
const NOTHING: f64 = 1e-12;

/// A guess that comes to more than the convex hull by up to this factor is cut to it; beyond, it is no guess at all.
const OVER_HULL: f64 = 2.0;

/// A piece of a smaller share than this of the volume does not decide by which method the whole is known.
const MINOR: f64 = 1e-6;

#[derive(Default)]
pub(super) struct Estimate {
    /// Of positive volume, with an inertia tensor that a body could have.
    pub solid: Option<Solid>,
    pub bodies: Vec<BodyVolume>,
}

pub(super) struct Solid {
    pub properties: MassProperties,
    pub method: VolumeMethod,
    /// Half width of the bound as a share of the volume.
    pub error: f64,
    pub confidence: f64,
}

/// `hull` is that of the whole mesh.
pub(super) fn estimate(mesh: &Mesh, topology: &Topology, hull: Option<&Volume>) -> Estimate {
    let (min, max) = bounds(&mesh.positions);
    let size: [f64; 3] = std::array::from_fn(|axis| max[axis] - min[axis]);
    let least = NOTHING * size.iter().fold(0.0_f64, |longest, &side| longest.max(side)).powi(3);
    let repaired = if topology.boundary_edges > 0 { repair::close_rims(mesh, size) } else { None };
    let mesh = repaired.as_ref().unwrap_or(mesh);
    let pieces = pieces(mesh, repaired.is_some());
    let solid = sum_of(&pieces, least, hull).or_else(|| by_hull(hull));
    Estimate { solid, bodies: bodies(&pieces) }
}

fn pieces(mesh: &Mesh, repaired: bool) -> Vec<Piece> {
    let shells = shells(mesh);
    let roles = nesting::roles(mesh, &shells);
    let mut pieces = Vec::new();
    let mut open: Vec<[u32; 3]> = Vec::new();
    for (shell, role) in shells.iter().zip(roles) {
        let Some(volume) = shell.volume else {
            open.extend(&shell.triangles);
            continue;
        };
        let inside_out = volume.total() < 0.0;
        let turned = shell.turned > 0.0 || (inside_out && role != BodyRole::Cavity);
        pieces.push(Piece {
            role,
            triangles: shell.triangles.len() as u64,
            volume: if inside_out { volume.negated() } else { volume },
            method: if turned || repaired { VolumeMethod::Oriented } else { VolumeMethod::Closed },
            half_width: 0.0,
            confidence: 1.0,
        });
    }
    pieces.extend(open::pieces(&mesh.positions, &open, area(&mesh.positions, &mesh.triangles)));
    pieces
}

fn sum_of(pieces: &[Piece], least: f64, hull: Option<&Volume>) -> Option<Solid> {
    let signed = |piece: &Piece| match piece.role {
        BodyRole::Cavity => piece.volume.negated(),
        _ => piece.volume,
    };
    let sum = pieces.iter().fold(Volume::default(), |sum, piece| sum.plus(&signed(piece)));
    let total = sum.total();
    let guessed = pieces.iter().any(|piece| piece.method >= VolumeMethod::Capped);
    // Exact bodies may overlap; a guess may not come to more than the whole could hold.
    let hull = if guessed { hull?.total() } else { f64::INFINITY };
    if total <= least || total > OVER_HULL * hull {
        return None;
    }
    let over = (total - hull * (1.0 + 1e-3)).max(0.0);
    let major = pieces.iter().filter(|piece| piece.volume.total() > MINOR * total);
    let method = major.map(|piece| piece.method).max()?;
    let half_width = pieces.iter().map(|piece| piece.half_width.powi(2)).sum::<f64>().sqrt();
    let unsure = pieces.iter().filter(|piece| piece.half_width > 0.0);
    let confidence = unsure.map(|piece| piece.confidence).fold(1.0, f64::min);
    let sum = if over > 0.0 { sum.times(hull / total) } else { sum };
    let error = half_width.hypot(over) / sum.total();
    Some(Solid { properties: sum.properties()?, method, error, confidence })
}

/// The truth lies between nothing and the hull, whatever the surface.
fn by_hull(hull: Option<&Volume>) -> Option<Solid> {
    let properties = hull?.properties()?;
    Some(Solid { properties, method: VolumeMethod::Hull, error: 1.0, confidence: 1.0 })
}

fn bodies(pieces: &[Piece]) -> Vec<BodyVolume> {
    let mut order: Vec<&Piece> = pieces.iter().collect();
    order.sort_by(|a, b| b.volume.total().total_cmp(&a.volume.total()));
    order
        .into_iter()
        .take(MOST_BODIES)
        .map(|piece| {
            let volume = piece.volume.total().max(0.0);
            let is_sheet = piece.role == BodyRole::Sheet;
            BodyVolume {
                role: piece.role,
                triangles: piece.triangles,
                volume,
                method: (!is_sheet).then_some(piece.method),
                error: if volume > 0.0 { piece.half_width / volume } else { 0.0 },
                confidence: piece.confidence,
            }
        })
        .collect()
}
