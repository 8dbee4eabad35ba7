//! Pairs of bodies whose grown bounds overlap: sort and sweep along the axis in which the bodies spread most.

use crate::body::Body;

/// Pairs `(a, b)` with `a < b`, sorted, at least one of them awake.
pub(crate) fn pairs(bodies: &[Body]) -> Vec<(u32, u32)> {
    let axis = widest_axis(bodies);
    // What reaches further than anything moves (a floor, a terrain) would stay open during the whole sweep, so
    // it is tried against every awake body instead.
    let vast = |body: &Body| body.is_static() && body.aabb.max[axis] - body.aabb.min[axis] > 1e3;
    let mut order: Vec<u32> = (0..).zip(bodies).filter(|(_, body)| !vast(body)).map(|(i, _)| i).collect();
    let low = |i: u32| bodies[i as usize].aabb.min[axis];
    order.sort_by(|a, b| low(*a).total_cmp(&low(*b)).then(a.cmp(b)));

    let mut found = Vec::new();
    let mut offer = |i: u32, j: u32| {
        let (a, b) = (&bodies[i as usize], &bodies[j as usize]);
        if (a.is_awake() || b.is_awake()) && a.aabb.overlaps(&b.aabb) {
            found.push((i.min(j), i.max(j)));
        }
    };
    for (at, &i) in order.iter().enumerate() {
        let end = bodies[i as usize].aabb.max[axis];
        for &j in order[at + 1..].iter().take_while(|j| low(**j) <= end) {
            offer(i, j);
        }
    }
    for (i, _) in (0..).zip(bodies).filter(|(_, body)| vast(body)) {
        for (j, _) in (0..).zip(bodies).filter(|(_, body)| body.is_awake()) {
            offer(i, j);
        }
    }
    found.sort_unstable();
    found
}

fn widest_axis(bodies: &[Body]) -> usize {
    let moving = || bodies.iter().filter(|body| !body.is_static());
    let count = moving().count().max(1);
    #[expect(clippy::cast_precision_loss, reason = "a count of bodies")]
    let share = 1.0 / count as f64;
    let mean = moving().map(|body| body.position).sum::<crate::math::Vec3>() * share;
    let spread = moving()
        .map(|body| (body.position - mean).component_mul(&(body.position - mean)))
        .sum::<crate::math::Vec3>();
    spread.imax()
}
