//! Convex outlines in the plane.

/// Convex outline of points in the plane, counter-clockwise (Andrew's monotone chain).
pub(super) fn convex_outline(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    // Rounded, so that points in line across the sorting direction are in line to the last bit.
    let mut sorted: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| (x * 1e12).round() / 1e12)).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut outline: Vec<[f64; 2]> = Vec::new();
    for pass in 0..2 {
        let start = outline.len();
        let mut visit = |p: [f64; 2]| {
            while outline.len() >= start + 2
                && turn(outline[outline.len() - 2], outline[outline.len() - 1], p) <= 0.0
            {
                outline.pop();
            }
            outline.push(p);
        };
        if pass == 0 {
            sorted.iter().for_each(|p| visit(*p));
        } else {
            sorted.iter().rev().for_each(|p| visit(*p));
        }
        outline.pop();
    }
    outline
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
