//! Distances between points, segments and triangles (Ericson, Real-Time Collision Detection, 5.1).

use crate::math::Vec3;

/// The point of a triangle nearest to `point`.
pub(super) fn nearest_on_triangle(point: &Vec3, [a, b, c]: &[Vec3; 3]) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = point - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = point - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let scale = 1.0 / (va + vb + vc);
    a + ab * (vb * scale) + ac * (vc * scale)
}

/// Distance between two segments.
pub(super) fn segments([p1, q1]: &[Vec3; 2], [p2, q2]: &[Vec3; 2]) -> f64 {
    let (d1, d2, r) = (q1 - p1, q2 - p2, p1 - p2);
    let (a, e, f) = (d1.norm_squared(), d2.norm_squared(), d2.dot(&r));
    let c = d1.dot(&r);
    let (s, t) = if a <= f64::MIN_POSITIVE {
        (0.0, if e <= f64::MIN_POSITIVE { 0.0 } else { (f / e).clamp(0.0, 1.0) })
    } else if e <= f64::MIN_POSITIVE {
        ((-c / a).clamp(0.0, 1.0), 0.0)
    } else {
        let b = d1.dot(&d2);
        let denominator = a * e - b * b;
        let s = if denominator > 0.0 { ((b * f - c * e) / denominator).clamp(0.0, 1.0) } else { 0.0 };
        let t = (b * s + f) / e;
        if t < 0.0 {
            ((-c / a).clamp(0.0, 1.0), 0.0)
        } else if t > 1.0 {
            (((b - c) / a).clamp(0.0, 1.0), 1.0)
        } else {
            (s, t)
        }
    };
    (p1 + d1 * s - p2 - d2 * t).norm()
}

/// Distance of a segment (or a point, as both ends) from a triangle that it does not pierce.
pub(super) fn segment_to_triangle(segment: &[Vec3; 2], triangle: &[Vec3; 3]) -> f64 {
    let [a, b, c] = triangle;
    let ends = segment.iter().map(|end| (end - nearest_on_triangle(end, triangle)).norm());
    let sides = [[*a, *b], [*b, *c], [*c, *a]];
    ends.chain(sides.iter().map(|side| segments(segment, side))).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_the_textbook() {
        let triangle = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        for (point, expected) in [
            (Vec3::new(0.25, 0.25, 2.0), 2.0),
            (Vec3::new(-3.0, -4.0, 0.0), 5.0),
            (Vec3::new(0.5, -1.0, 0.0), 1.0),
            (Vec3::new(1.0, 1.0, 0.0), 0.5f64.sqrt()),
        ] {
            let near = nearest_on_triangle(&point, &triangle);
            assert!(((point - near).norm() - expected).abs() < 1e-15, "{point:?}");
        }
        let crossing = segments(&[-Vec3::x(), Vec3::x()], &[Vec3::z() - Vec3::y(), Vec3::z() + Vec3::y()]);
        assert!((crossing - 1.0).abs() < 1e-15);
        let apart = segments(&[Vec3::zeros(), Vec3::x()], &[Vec3::x() * 3.0, Vec3::x() * 5.0]);
        assert!((apart - 2.0).abs() < 1e-15);
        let over = [Vec3::new(-1.0, 0.2, 0.3), Vec3::new(2.0, 0.2, 0.3)];
        assert!((segment_to_triangle(&over, &triangle) - 0.3).abs() < 1e-15);
    }
}
