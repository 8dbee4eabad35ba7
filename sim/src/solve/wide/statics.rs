//! A first guess at the loads of contacts that have none yet: what rests on what, from the top down.
//!
//! Sweeps carry a load down a pile of n layers in about n² of them, so a pile that a scene starts with would sink for seconds
//! before its lowest contacts know of its weight. Where bodies at rest meet for the first time, each hands its own weight
//! and what lies on it to what it lies on, in equal shares a contact point: exact for what is stacked evenly, and a start
//! for the sweeps in any case. What meets at speed gets no guess.

use crate::body::Body;
use crate::collide::pair::Pair;
use crate::math::Vec3;

use super::block::{GROUND, PointRow};
use super::graph::Edge;
use super::lanes::Scalar;

/// Cosine between a normal and the vertical from which on one body lies on the other.
const LIES_ON: f64 = 0.5;
/// Share of the smaller body's inner radius up to which a gap is none.
const TOUCHES: f64 = 1e-3;

/// The storage of the guess.
#[derive(Clone, Default)]
pub(crate) struct Statics {
    /// Edges of the graph's order in which one body lies on another, by the height of the upper, from the top.
    supports: Vec<Support>,
    /// N s a substep that each row has to hand down.
    loads: Vec<f64>,
}

#[derive(Clone)]
struct Support {
    /// m, of the upper body's centre along the vertical.
    height: f64,
    upper: u32,
    lower: u32,
    /// Place in the graph's order.
    slot: usize,
    /// Cosine of the normal with the vertical, and points.
    upright: f64,
    points: usize,
    /// N s that it carries already.
    carries: f64,
}

impl Statics {
    /// Gives the contacts of `edges` (in the order of `order`) that carry nothing yet, between bodies at rest, a share of
    /// what lies above; `place` tells where the points of an edge are. `speed` is gravity's in a substep, m/s.
    pub(crate) fn guess<S: Scalar>(
        &mut self,
        (edges, order): (&[Edge], &[u32]),
        (pairs, bodies): (&[Pair], &[Body]),
        (up, speed): (Vec3, f64),
        mut place: impl FnMut(usize) -> (std::ops::Range<usize>, usize),
        points: &mut [PointRow<S>],
        rows: usize,
    ) {
        self.supports.clear();
        let rests = |body: &Body| body.velocity.norm() <= speed && body.spin.norm() * body.reach <= speed;
        let mut fresh = false;
        for (slot, edge) in order.iter().map(|&edge| &edges[edge as usize]).enumerate() {
            let pair = &pairs[edge.pair as usize];
            let manifold = &pair.manifolds[edge.manifold as usize];
            let upright = manifold.normal.dot(&up);
            if upright.abs() < LIES_ON {
                continue;
            }
            let (a, b) = (&bodies[pair.a as usize], &bodies[pair.b as usize]);
            let [upper, lower] = if upright > 0.0 { [1, 0] } else { [0, 1] };
            let carries = manifold.points.iter().map(|point| point.normal_impulse).sum::<f64>();
            let near = TOUCHES * a.inner_radius.min(b.inner_radius);
            let touches = manifold.points.iter().all(|point| point.separation.abs() < near);
            fresh |= carries == 0.0 && touches && rests(a) && rests(b);
            self.supports.push(Support {
                height: [a, b][upper].position.dot(&up),
                upper: edge.rows[upper],
                lower: edge.rows[lower],
                slot,
                upright: upright.abs(),
                points: if touches && rests(a) && rests(b) { manifold.points.len() } else { 0 },
                carries,
            });
        }
        if !fresh {
            return;
        }
        self.supports.sort_unstable_by(|a, b| {
            b.height.total_cmp(&a.height).then(a.upper.cmp(&b.upper)).then(a.slot.cmp(&b.slot))
        });
        self.loads.clear();
        self.loads.resize(rows, 0.0);
        for body_edges in self.supports.chunk_by(|a, b| a.upper == b.upper) {
            let upper = body_edges[0].upper;
            if upper == GROUND {
                continue;
            }
            let carried: f64 = body_edges.iter().map(|support| support.carries * support.upright).sum();
            let waiting = || body_edges.iter().filter(|support| support.carries == 0.0);
            let shares: f64 = waiting().map(|support| support.points as f64 * support.upright).sum();
            let edge = &edges[order[body_edges[0].slot] as usize];
            let pair = &pairs[edge.pair as usize];
            let body = if edge.rows[0] == upper { pair.a } else { pair.b };
            let load = self.loads[upper as usize] + bodies[body as usize].mass * speed;
            let share = if shares > 0.0 { (load - carried).max(0.0) / shares } else { 0.0 };
            for support in body_edges {
                let guessed =
                    if support.carries == 0.0 { share * support.points as f64 } else { support.carries };
                self.loads[support.lower as usize] += guessed * support.upright;
            }
            for support in waiting().filter(|support| support.points > 0) {
                let (range, lane) = place(support.slot);
                for row in &mut points[range] {
                    row.normal_impulse.0[lane] = S::of(share);
                }
            }
        }
    }
}
