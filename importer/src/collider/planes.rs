//! Where a piece might be cut.

use std::collections::HashMap;

use super::piece::{Plane, Surface};
use super::prepared::{Vec3, bounds};

/// Even positions along each axis.
const EVEN: usize = 9;
/// Positions along each axis where flat walls or concave edges ask for a cut.
const PEAKS: usize = 6;
/// Tilted planes, along walls at concave edges.
const TILTED: usize = 8;

/// Planes worth trying: even steps along the file's axes, the offsets at which much wall or much concave
/// edge lies, and the planes of walls that end in a concave edge.
///
/// `middle` is that of the whole mesh: what is round is round about an axis through it, and is cut best by planes
/// through that axis.
pub(super) fn candidates(piece: &Surface, middle: Vec3) -> Vec<Plane> {
    let (low, high) = bounds(&piece.positions);
    let (edges, walls) = concave_edges(piece);
    let mut planes: Vec<Plane> = Vec::new();
    for axis in 0..3 {
        let normal = Vec3::ith(axis, 1.0);
        let span = high[axis] - low[axis];
        if span < 1e-3 {
            continue;
        }
        let margin = (span * 0.01).max(2e-4);
        let inside = |offset: f64| offset > low[axis] + margin && offset < high[axis] - margin;
        let mut votes: Vec<(f64, f64)> = Vec::new();
        for triangle in &piece.triangles {
            let cross = piece.normal(triangle);
            let area = cross.norm();
            if area > 0.0 && cross[axis].abs() > 0.99 * area {
                votes.push((piece.positions[triangle[0] as usize][axis], area / span));
            }
        }
        for (a, b, weight) in &edges {
            if (a[axis] - b[axis]).abs() < span * 0.02 {
                votes.push((a[axis], *weight));
            }
        }
        let peaks = peaks(votes, span * 0.01);
        planes.extend(
            peaks.into_iter().filter(|x| inside(*x)).take(PEAKS).map(|offset| Plane { normal, offset }),
        );
        for step in 1..=EVEN {
            let offset = low[axis] + span * step as f64 / (EVEN + 1) as f64;
            if !planes.iter().any(|p| p.normal == normal && (p.offset - offset).abs() < span * 0.02) {
                planes.push(Plane { normal, offset });
            }
        }
    }
    planes.extend(radial(piece, middle));
    let mut tilted = 0;
    for (plane, _) in walls {
        let upright = plane.normal.abs().max() > 0.999;
        let known = planes.iter().any(|p| {
            let along = p.normal.dot(&plane.normal);
            along.abs() > 0.999 && (p.offset - plane.offset * along.signum()).abs() < 5e-3
        });
        if !upright && !known && tilted < TILTED {
            planes.push(plane);
            tilted += 1;
        }
    }
    planes
}

/// Planes through the middle's axes: that which halves the angle that the piece takes up about the axis, or
/// diagonal ones where it lies all around.
fn radial(piece: &Surface, middle: Vec3) -> Vec<Plane> {
    let mut planes = Vec::new();
    for axis in 0..3 {
        let (u, v) = (Vec3::ith((axis + 1) % 3, 1.0), Vec3::ith((axis + 2) % 3, 1.0));
        let mut angles: Vec<f64> = piece
            .positions
            .iter()
            .map(|p| p - middle)
            .filter(|q| q.dot(&u).hypot(q.dot(&v)) > 0.02)
            .map(|q| q.dot(&v).atan2(q.dot(&u)))
            .collect();
        angles.sort_by(f64::total_cmp);
        let (Some(first), Some(last)) = (angles.first(), angles.last()) else { continue };
        // The widest gap between neighbours, the one across the half turn among them, is where nothing lies.
        let across = (first + std::f64::consts::TAU - last, *last);
        let gaps = angles.windows(2).map(|pair| (pair[1] - pair[0], pair[0]));
        let (gap, before) = gaps.fold(across, |best, gap| if gap.0 > best.0 { gap } else { best });
        let start = before + gap;
        let range = std::f64::consts::TAU - gap;
        let shares: &[f64] = if range < 3.5 { &[0.5] } else { &[0.125, 0.25, 0.375, 0.5] };
        for share in shares {
            let (sin, cos) = (start + range * share).sin_cos();
            let normal = v * cos - u * sin;
            planes.push(Plane { normal, offset: normal.dot(&middle) });
        }
    }
    planes
}

/// The same plane moved and, for the best of them, what lies around it.
pub(super) fn around(plane: &Plane, piece: &Surface) -> [Plane; 2] {
    let along = piece.positions.iter().map(|p| plane.normal.dot(p));
    let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let step = (high - low) / (2.0 * (EVEN + 1) as f64);
    [-step, step].map(|step| Plane { offset: plane.offset + step, ..*plane })
}

/// Offsets with the most votes within `width`, most first: each is one of the votes, never a mean.
fn peaks(mut votes: Vec<(f64, f64)>, width: f64) -> Vec<f64> {
    votes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut groups: Vec<(f64, f64)> = Vec::new();
    for (offset, weight) in votes {
        match groups.last_mut() {
            Some((start, total)) if offset - *start <= width => *total += weight,
            _ => groups.push((offset, weight)),
        }
    }
    groups.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.total_cmp(&b.0)));
    groups.into_iter().map(|(offset, _)| offset).collect()
}

type Edge = (Vec3, Vec3, f64);

/// Edges where the surface folds inwards, weighted by length and angle, and the planes of the two walls at
/// the heaviest of them, heaviest first.
fn concave_edges(piece: &Surface) -> (Vec<Edge>, Vec<(Plane, f64)>) {
    // Lookup only: edges are listed in the order of the triangles.
    let mut open: HashMap<(u32, u32), usize> = HashMap::new();
    let mut edges: Vec<Edge> = Vec::new();
    let mut walls: Vec<(Plane, f64)> = Vec::new();
    for (t, triangle) in piece.triangles.iter().enumerate() {
        for i in 0..3 {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            let Some(other) = open.remove(&(b, a)) else {
                open.insert((a, b), t);
                continue;
            };
            let (Some(n), Some(m)) = (
                piece.normal(triangle).try_normalize(1e-18),
                piece.normal(&piece.triangles[other]).try_normalize(1e-18),
            ) else {
                continue;
            };
            let (p, q) = (piece.positions[a as usize], piece.positions[b as usize]);
            let Some(along) = (q - p).try_normalize(1e-12) else { continue };
            let fold = n.cross(&m).dot(&along);
            let angle = fold.atan2(n.dot(&m));
            // Walls that meet at an inner corner turn towards each other.
            if angle < -0.2 {
                let weight = (q - p).norm() * -angle;
                edges.push((p, q, weight));
                for normal in [n, m] {
                    walls.push((Plane { normal, offset: normal.dot(&p) }, weight));
                }
            }
        }
    }
    walls.sort_by(|a, b| b.1.total_cmp(&a.1));
    walls.truncate(200);
    (edges, walls)
}
