//! Triangles of a convex hull, for drawing a collider of which only the points are known.

use std::collections::BTreeSet;

type Point = [f64; 3];

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A face with its outward unit normal.
struct Face {
    corners: [u32; 3],
    normal: Point,
    offset: f64,
}

impl Face {
    /// `None` where the corners are on a line.
    fn new(points: &[Point], corners: [u32; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|i| points[i as usize]);
        let n = cross(sub(b, a), sub(c, a));
        let length = dot(n, n).sqrt();
        let normal = n.map(|x| x / length);
        (length > 0.0 && length.is_finite()).then(|| Self { corners, normal, offset: dot(normal, a) })
    }

    fn height(&self, point: Point) -> f64 {
        dot(self.normal, point) - self.offset
    }
}

/// Outward triangles over `points` by adding one point after another; `None` where the points are not finite
/// or have no volume.
///
/// A point nearer to a face than 1e-9 of the size counts as on it, so the result is the hull to that tolerance.
pub(crate) fn triangulate(points: &[Point]) -> Option<Vec<[u32; 3]>> {
    if points.iter().flatten().any(|x| !x.is_finite()) || u32::try_from(points.len()).is_err() {
        return None;
    }
    let seed = tetrahedron(points)?;
    let size = points.iter().map(|p| dot(sub(*p, points[0]), sub(*p, points[0]))).fold(0.0, f64::max).sqrt();
    let tolerance = 1e-9 * size;
    let [a, b, c, d] = seed;
    let mut faces: Vec<Face> = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]]
        .into_iter()
        .filter_map(|corners| Face::new(points, corners))
        .collect();
    for (index, point) in (0u32..).zip(points) {
        if seed.contains(&index) {
            continue;
        }
        let (seen, hidden): (Vec<Face>, Vec<Face>) =
            faces.into_iter().partition(|face| face.height(*point) > tolerance);
        faces = hidden;
        let edges: BTreeSet<(u32, u32)> =
            seen.iter().flat_map(|f| [0, 1, 2].map(|k| (f.corners[k], f.corners[(k + 1) % 3]))).collect();
        let horizon = edges.iter().filter(|(from, to)| !edges.contains(&(*to, *from)));
        faces.extend(horizon.filter_map(|&(from, to)| Face::new(points, [from, to, index])));
    }
    Some(faces.into_iter().map(|face| face.corners).collect())
}

/// Four far points in the order that makes the faces of [`triangulate`] look outward.
fn tetrahedron(points: &[Point]) -> Option<[u32; 4]> {
    let farthest = |measure: &dyn Fn(Point) -> f64| {
        let (index, best) = points
            .iter()
            .enumerate()
            .map(|(i, p)| (i, measure(*p)))
            .fold((0, 0.0), |best, next| if next.1 > best.1 { next } else { best });
        (best > 0.0).then_some(index)
    };
    let a = 0;
    let origin = *points.first()?;
    let b = farthest(&|p| dot(sub(p, origin), sub(p, origin)))?;
    let along = sub(points[b], origin);
    let c = farthest(&|p| {
        let n = cross(along, sub(p, origin));
        dot(n, n)
    })?;
    let normal = cross(along, sub(points[c], origin));
    let d = farthest(&|p| dot(normal, sub(p, origin)).abs())?;
    let height = dot(normal, sub(points[d], origin));
    let flat = height.abs() <= 1e-9 * dot(normal, normal).sqrt() * dot(along, along).sqrt();
    if flat {
        return None;
    }
    // With `d` below the plane a, b, c the triangle a, b, c looks outward.
    let (b, c) = if height < 0.0 { (b, c) } else { (c, b) };
    Some([a, b, c, d].map(|i| u32::try_from(i).unwrap_or(0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(points: &[Point], triangles: &[[u32; 3]]) -> f64 {
        triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| points[i as usize]);
                dot(a, cross(b, c)) / 6.0
            })
            .sum()
    }

    #[test]
    fn cube_with_inner_points_has_twelve_faces_and_its_volume() {
        let mut points = vec![[0.1, 0.2, 0.3], [0.0, 0.0, 0.0]];
        points.extend((0..8).map(|i: u8| [0, 1, 2].map(|k| if i >> k & 1 == 1 { 1.0 } else { -1.0 })));
        let triangles = triangulate(&points).unwrap_or_default();
        assert_eq!(triangles.len(), 12);
        assert!((volume(&points, &triangles) - 8.0).abs() < 1e-12);
    }

    #[test]
    fn every_edge_is_shared_by_two_and_no_point_is_outside() {
        // Points of a spiral on an ellipsoid, reproducible and in general position.
        let points: Vec<Point> = (0..200u32)
            .map(|i| {
                let (y, turn) = (1.0 - (2.0 * f64::from(i) + 1.0) / 200.0, f64::from(i) * 2.399_963);
                let r = (1.0 - y * y).sqrt();
                [3.0 * r * turn.cos(), y, 0.5 * r * turn.sin()]
            })
            .collect();
        let triangles = triangulate(&points).unwrap_or_default();
        assert_eq!(triangles.len(), 2 * points.len() - 4, "Euler's formula for a closed triangulation");
        for t in &triangles {
            let face = Face::new(&points, *t);
            assert!(face.is_some_and(|f| points.iter().all(|p| f.height(*p) < 1e-6)));
        }
    }

    #[test]
    fn flat_or_tiny_sets_have_no_hull() {
        assert_eq!(triangulate(&[]), None);
        assert_eq!(triangulate(&[[1.0; 3]; 5]), None);
        assert_eq!(triangulate(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]), None);
        assert_eq!(triangulate(&[[f64::NAN; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0]]), None);
    }
}
