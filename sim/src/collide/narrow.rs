//! Manifolds between two bodies: one query a pair of child shapes near each other, and for how long nothing changes
//! between them, so that the pair costs a comparison until then.

use crate::body::Body;
use crate::collide::cache::Cache;
use crate::collide::near::{Found, Holds, Near};
use crate::collide::pair::Pair;
use crate::collide::polytope::Polytope;
use crate::collide::sat::SatBuffers;
use crate::collide::surface::SurfaceBuffers;
use crate::collide::touch::TouchBuffers;
use crate::collide::travel::Travel;

/// Shares of the smaller body's inner radius: how far beyond what they may move in a step shapes are looked at, from
/// what way in a step on their meeting is foreseen, and from what overlap on a pose is reported as one that cannot be.
const MARGIN_SHARE: f64 = 0.05;
const FAST_SHARE: f64 = 0.5;
const DEEP_SHARE: f64 = 0.25;

/// Buffers of the narrow phase, one a thread.
#[derive(Clone, Debug)]
pub(crate) struct NarrowBuffers {
    pub(crate) sat: SatBuffers,
    pub(crate) touch: TouchBuffers,
    pub(crate) out: Found,
    pub(crate) surface: SurfaceBuffers,
    /// Numbers of a surface's planes, with the plane.
    pub(crate) named: Vec<(u32, usize)>,
    pub(crate) triangles: Vec<u32>,
    pub(crate) sheet: Polytope,
    /// Children of B near A.
    near_b: Vec<u32>,
}

impl Default for NarrowBuffers {
    fn default() -> Self {
        Self {
            sat: SatBuffers::default(),
            touch: TouchBuffers::default(),
            out: Found::default(),
            surface: SurfaceBuffers::default(),
            named: Vec::new(),
            triangles: Vec::new(),
            sheet: Polytope::sheet(),
            near_b: Vec::new(),
        }
    }
}

/// What a step may bring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ahead {
    /// s
    pub(crate) dt: f64,
    /// m/s², its magnitude.
    pub(crate) gravity: f64,
    /// [`crate::Settings::contact_keep_share`]
    pub(crate) keep_share: f64,
    /// Whether the kernels of this processor may be used.
    pub(crate) simd: bool,
    /// Impacts and small steps each add to what a step's contacts have carried; else one solve says it.
    pub(crate) piecewise: bool,
}

impl Ahead {
    /// How far two bodies move against each other in the step at most if nothing turns them back, m.
    fn straight_way(&self, a: &Travel, b: &Travel) -> f64 {
        self.way((a.velocity - b.velocity).norm(), a, b)
    }

    /// How far apart surfaces are still looked at, m.
    ///
    /// What bounces off something else may come back at the other, however little both close in now.
    pub(crate) fn reach(&self, a: &Travel, b: &Travel) -> f64 {
        let (u, v) = (&a.velocity, &b.velocity);
        let closing = if self.piecewise { u.norm() + v.norm() } else { (u - v).norm() };
        MARGIN_SHARE * a.inner_radius.min(b.inner_radius) + self.way(closing, a, b)
    }

    /// m at `closing` m/s, with what the bodies' spins and gravity add.
    fn way(&self, closing: f64, a: &Travel, b: &Travel) -> f64 {
        self.dt * (closing + a.rim_speed + b.rim_speed + self.dt * self.gravity)
    }
}

/// For how long nothing changes between two bodies, in terms of their paths together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outlook {
    /// m of path that what is apart needs to touch.
    clear_until: f64,
    /// m of path for which the manifolds are kept, and the reach in m that their points were made for.
    kept_until: f64,
    kept_reach: f64,
}

impl Default for Outlook {
    /// Nothing is known.
    fn default() -> Self {
        Self { clear_until: f64::NEG_INFINITY, kept_until: f64::NEG_INFINITY, kept_reach: f64::NEG_INFINITY }
    }
}

impl Outlook {
    /// Of shapes that touch when their paths together reach `path`, m, no sooner.
    pub(crate) fn apart(path: f64) -> Self {
        Self { clear_until: path, ..Self::default() }
    }

    pub(crate) fn holds(&self, path: f64, reach: f64, nothing_touches: bool) -> bool {
        path + reach < self.clear_until
            && (nothing_touches || path <= self.kept_until && reach <= self.kept_reach)
    }

    /// Takes in what is known of two child shapes more.
    fn and(&mut self, path: f64, holds: Holds) {
        match holds {
            Holds::Apart(distance) => self.clear_until = self.clear_until.min(path + distance),
            Holds::Stands { way, reach } => {
                self.kept_until = self.kept_until.min(path + way);
                self.kept_reach = self.kept_reach.min(reach);
            }
            Holds::Once => *self = Self::default(),
        }
    }
}

/// Brings the manifolds of a pair up to its bodies' poses; points that cannot meet within the step are left out. Where
/// the bodies have come to overlap so deeply that no motion explains it, returns by how much, m, once.
pub(crate) fn update(
    pair: &mut Pair,
    (a, b): (&Body, &Body),
    (travel_a, travel_b): (&Travel, &Travel),
    ahead: Ahead,
    buffers: &mut NarrowBuffers,
) -> Option<f64> {
    let margin = MARGIN_SHARE * a.inner_radius.min(b.inner_radius);
    let way = ahead.straight_way(travel_a, travel_b);
    // What gravity may add to a straight way.
    let drop = ahead.dt * ahead.dt * ahead.gravity;
    let reach = ahead.reach(travel_a, travel_b);
    let stray = if ahead.piecewise { reach } else { margin + drop };
    let path = travel_a.path + travel_b.path;
    let forever =
        Outlook { clear_until: f64::INFINITY, kept_until: f64::INFINITY, kept_reach: f64::INFINITY };
    let mut outlook = forever;
    // A compound's children that are far from the other body are looked at once, not once for each of its children.
    let mut near_b = std::mem::take(&mut buffers.near_b);
    near_b.clear();
    for (j, child) in (0..).zip(&b.colliders) {
        let gap = child.bounds.gap(&travel_a.bounds);
        if gap > reach {
            outlook.and(path, Holds::Apart(gap));
        } else {
            near_b.push(j);
        }
    }
    let at_origin = |body: &Body| body.velocity - body.spin.cross(&body.position);
    let mut foreseen = false;
    let mut cache = Cache::new(pair);
    for (i, child_a) in (0..).zip(&a.colliders) {
        let gap = child_a.bounds.gap(&travel_b.bounds);
        if gap > reach {
            outlook.and(path, Holds::Apart(gap));
            continue;
        }
        for &j in near_b.iter() {
            let child_b = &b.colliders[j as usize];
            let gap = child_a.bounds.gap(&child_b.bounds);
            let holds = if gap > reach {
                Holds::Apart(gap)
            } else {
                let near = Near {
                    a: child_a,
                    b: child_b,
                    world_a: child_a.world,
                    world_b: child_b.world,
                    velocity: b.velocity - a.velocity,
                    drift: at_origin(b) - at_origin(a),
                    spin: b.spin - a.spin,
                    stands: [a.is_static(), b.is_static()],
                    dt: ahead.dt,
                    keep_share: ahead.keep_share,
                    key: (i, j),
                    reach,
                    foreseen: None,
                };
                let fast = way - drop > FAST_SHARE * near.size();
                if fast && near.foresee((a, b), (margin, stray), &mut cache, buffers) {
                    foreseen = true;
                    Holds::Once
                } else {
                    near.update(&mut cache, buffers)
                }
            };
            outlook.and(path, holds);
        }
    }
    cache.end();
    buffers.near_b = near_b;
    pair.outlook = outlook;
    pair.fast = foreseen;
    let points = pair.manifolds.iter().flat_map(|manifold| &manifold.points);
    let depth = points.map(|point| -point.separation).fold(0.0, f64::max);
    let was_deep = std::mem::replace(&mut pair.deep, depth > DEEP_SHARE * a.inner_radius.min(b.inner_radius));
    (pair.deep && !was_deep).then_some(depth)
}
