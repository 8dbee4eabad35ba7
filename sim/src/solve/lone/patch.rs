//! Friction of a face that lies flat.
//!
//! Corners can carry any load of a face, but friction on them alone resists a spin by too much: a disc on its rim by
//! μ N R, where a pressure that is the same everywhere gives 2/3 μ N R. So the points at which friction acts are drawn in
//! towards the middle of the contact until the moment is that of an even pressure: by 2/3 for a disc, by half for an edge,
//! by the mean distance from the middle over that of the corners for a polygon. A disc that slides and spins then ends both at
//! once with v / Rω = 0.63, where Farkas et al. (2003) find 0.653 for an even pressure.

use crate::collide::manifold::MAX_POINTS;
use crate::math::{Mat3, Vec2, Vec3};

use super::row::Row;

const DISC: f64 = 2.0 / 3.0;
const EDGE: f64 = 0.5;

/// Draws in the friction of the closed points of every region. Rows of one region stand together.
pub(super) fn draw_in(rows: &mut [Row], axes: &Mat3) {
    for region in rows.chunk_by_mut(|a, b| a.region() == b.region()) {
        let closed = || region.iter().filter(|row| row.closed);
        let count = closed().count();
        if count < 2 || region[0].is_smooth() {
            region.iter_mut().for_each(|row| row.grips_at(Vec3::zeros(), 1.0));
            continue;
        }
        #[expect(clippy::cast_precision_loss, reason = "a region has few points")]
        let middle = closed().map(Row::core).sum::<Vec3>() / count as f64;
        let share = match count {
            2 => EDGE,
            _ if region.iter().any(Row::has_rim) => DISC,
            _ => {
                let mut corners = [Vec2::zeros(); MAX_POINTS];
                let found = closed().map(|row| row.across(&(axes * (row.core() - middle))));
                corners.iter_mut().zip(found).for_each(|(corner, found)| *corner = found);
                polygon(&mut corners[..count.min(MAX_POINTS)])
            }
        };
        region.iter_mut().for_each(|row| row.grips_at(middle, share));
    }
}

/// Mean distance of the points of a convex polygon around 0 from there, over that of its corners.
fn polygon(corners: &mut [Vec2]) -> f64 {
    corners.sort_unstable_by(|a, b| libm::atan2(a.y, a.x).total_cmp(&libm::atan2(b.y, b.x)));
    let (mut moment, mut area, mut reach) = (0.0, 0.0, 0.0);
    for (i, a) in corners.iter().enumerate() {
        let b = &corners[(i + 1) % corners.len()];
        reach += a.norm();
        let length = (b - a).norm();
        let double = a.perp(b);
        if double <= 0.0 || length == 0.0 {
            continue;
        }
        // Over the triangle to 0, at height h above the side: ∫ |r| dA = h³/3 ∫ sec³ φ dφ.
        let (along, h) = ((b - a) / length, double / length);
        let (from, to) = (a.dot(&along) / h, b.dot(&along) / h);
        let secant = |t: f64| 0.5 * (t * (1.0 + t * t).sqrt() + libm::asinh(t));
        moment += h * h * h / 3.0 * (secant(to) - secant(from));
        area += 0.5 * double;
    }
    #[expect(clippy::cast_precision_loss, reason = "a region has few points")]
    let mean = reach / corners.len() as f64;
    if area > 1e-6 * mean * mean { (moment / area / mean).min(1.0) } else { EDGE }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_have_the_moment_of_an_even_pressure() {
        let corner = |x: f64, y: f64| Vec2::new(x, y);
        // (√2 + asinh 1) / 6 of the side, over half the diagonal.
        let mut square = [corner(0.5, 0.5), corner(-0.5, -0.5), corner(0.5, -0.5), corner(-0.5, 0.5)];
        let expected = (2f64.sqrt() + 1f64.asinh()) / 6.0 / 0.5f64.sqrt();
        assert!((polygon(&mut square) - expected).abs() < 1e-12);
        let ring = (0..64).map(|k| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 64.0).sin_cos();
            corner(3.0 * cos, 3.0 * sin)
        });
        assert!((polygon(&mut ring.collect::<Vec<_>>()) - DISC).abs() < 2e-3);
        // What is as thin as a line is one.
        let mut line = [corner(1.0, 1e-9), corner(-1.0, 1e-9), corner(-1.0, -1e-9), corner(1.0, -1e-9)];
        assert!((polygon(&mut line) - EDGE).abs() < 1e-6);
    }
}
