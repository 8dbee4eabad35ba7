//! A sweep that solves contact points.
//!
//! A point's normal impulse is found first, then both tangents at once inside Coulomb's cone; both are applied together.

use super::block::{Block, PointRow};
use super::kernel::{BodyRows, Motion, Substep, axes, gather, points_of};
use super::lanes::{Lanes, V3};
use super::share::Shared;

/// Share of gravity's speed in a substep below which a contact's impulse is rounding.
const ROUNDING_SHARE: f64 = 3e-4;

/// Sweeps over the points of a manifold that begins to carry.
const FRESH_SWEEPS: usize = 6;

/// One sweep over blocks of one colour, with position bias or without (see [`super::kernel::Pass`]).
#[inline(always)]
pub(super) fn sweep<L: Lanes, const BIAS: bool>(
    blocks: &[Block<L::Scalar>],
    points: &Shared<'_, PointRow<L::Scalar>>,
    bodies: &BodyRows<'_, L::Scalar>,
    substep: &Substep,
) {
    for blocks in blocks.chunks(2) {
        match blocks {
            [a, b] if a.count == b.count && sweeps(a, substep) == sweeps(b, substep) => {
                let rows = [points_of(points, a), points_of(points, b)];
                solve_two::<L, BIAS>([a, b], rows, bodies, substep);
            }
            _ => {
                for block in blocks {
                    solve::<L, BIAS>(block, points_of(points, block), bodies, substep);
                }
            }
        }
    }
}

/// The sweep over the points of one block: its contact axes and the motion of its bodies, which each point changes for the next.
struct Solving<L: Lanes, const BIAS: bool> {
    axes: [V3<L>; 3],
    inv_mass: [L; 2],
    a: Motion<L>,
    b: Motion<L>,
    /// Poses change between the passes, so the first pass of a substep finds what the last of the one before has measured.
    moved: Option<Moved<L>>,
    lag: L,
}

impl<L: Lanes, const BIAS: bool> Solving<L, BIAS> {
    #[inline(always)]
    fn begin(block: &Block<L::Scalar>, bodies: &BodyRows<'_, L::Scalar>, substep: &Substep) -> Self {
        let axes = axes::<L>(block);
        let a = Motion::<L>::gather(&bodies.velocity, &block.bodies[0]);
        let b = Motion::<L>::gather(&bodies.velocity, &block.bodies[1]);
        // What flies moves by the mean of its speeds before and after, so half of what gravity adds does not count.
        let g = V3(
            L::number(0.5 * substep.h * substep.gravity.x),
            L::number(0.5 * substep.h * substep.gravity.y),
            L::number(0.5 * substep.h * substep.gravity.z),
        );
        Self {
            axes,
            inv_mass: [L::load(&block.inv_mass[0]), L::load(&block.inv_mass[1])],
            lag: axes[0].dot(g) * (b.flies - a.flies),
            moved: if BIAS { None } else { Some(Moved::<L>::gather(bodies, block, axes)) },
            a,
            b,
        }
    }

    #[inline(always)]
    fn end(self, block: &Block<L::Scalar>, bodies: &BodyRows<'_, L::Scalar>) {
        self.a.scatter(&bodies.velocity, &block.bodies[0]);
        self.b.scatter(&bodies.velocity, &block.bodies[1]);
    }

    /// Solves a point; `last` in the pass's last sweep.
    #[inline(always)]
    fn point(
        &mut self,
        block: &Block<L::Scalar>,
        row: &mut PointRow<L::Scalar>,
        substep: &Substep,
        last: bool,
    ) {
        let (zero, one) = (L::zero(), L::number(1.0));
        let [n, u, v] = self.axes;
        let friction = L::load(&block.friction);
        let (per_h, slowest) = (L::number(1.0 / substep.h), L::number(-substep.max_push_speed));
        let (bias_rate, mass_scale, impulse_scale) =
            (L::load(&block.bias_rate), L::load(&block.mass_scale), L::load(&block.impulse_scale));
        // An impulse of the size of rounding carries nothing: the body still flies.
        let noise = L::number(ROUNDING_SHARE * substep.gravity.norm() * substep.h);

        let arms = [V3::<L>::load(&row.arm[0]), V3::load(&row.arm[1])];
        if let Some(moved) = &self.moved {
            moved.measure(row, arms);
        }
        let separation = L::load(&row.gap);
        let slid = [L::load(&row.slid[0]), L::load(&row.slid[1])];
        let relative = self.b.at(arms[1]) - self.a.at(arms[0]);
        let (speed, slip_u, slip_v) = (n.dot(relative), u.dot(relative), v.dot(relative));

        // Signorini: λ ≥ 0 ⟂ v + bias ≥ 0. Apart, it may close the gap within the substep, no more.
        let old = L::load(&row.normal_impulse);
        let closing = speed + separation * per_h - self.lag;
        let mass = L::load(&row.normal_mass);
        let rigid = old - mass * closing;
        let touching = if BIAS {
            let push = (bias_rate * separation).max(slowest);
            old - mass * mass_scale * (speed + push) - impulse_scale * old
        } else {
            old - mass * speed
        };
        let gap = if BIAS {
            rigid
        } else {
            // Nothing to take back, and the next substep decides whether and how it closes the gap.
            old.where_at_most(zero, old, rigid)
        };
        let normal = separation.where_at_most(zero, touching, gap).max(zero);
        let change_n = normal - old;

        // Coulomb: |λ_t| ≤ μ λ_n against the slip. Where it sticks, what it has slipped is pulled back like an
        // overlap: velocities alone would let a stack creep by the residual of every substep.
        let olds = [L::load(&row.tangent_impulse[0]), L::load(&row.tangent_impulse[1])];
        let slips = [L::load(&row.slip[0]) + slid[0], L::load(&row.slip[1]) + slid[1]];
        let mut at =
            [slip_u + L::load(&row.coupling[0]) * change_n, slip_v + L::load(&row.coupling[1]) * change_n];
        if BIAS {
            at = [at[0] + bias_rate * slips[0], at[1] + bias_rate * slips[1]];
        }
        let limit = friction * normal;
        let mass = &row.tangent_mass;
        let (uu, uv, vv) = (L::load(&mass[0]), L::load(&mass[1]), L::load(&mass[2]));
        let sticking = [olds[0] - uu * at[0] - uv * at[1], olds[1] - uv * at[0] - vv * at[1]];
        // Sliding takes a scalar step before the projection: only then is the fixed point opposite to the slip.
        let step = L::load(&row.sliding_step);
        let sliding = [olds[0] - step * at[0], olds[1] - step * at[1]];
        let size = (sliding[0] * sliding[0] + sliding[1] * sliding[1]).sqrt();
        let shrink = size.where_at_most(limit, one, limit.divided_by(size));
        let grip = sticking[0] * sticking[0] + sticking[1] * sticking[1];
        let square = limit * limit;
        let chosen_u = grip.where_at_most(square, sticking[0], sliding[0] * shrink);
        let chosen_v = grip.where_at_most(square, sticking[1], sliding[1] * shrink);
        let tangent = [chosen_u.min(limit).max(-limit), chosen_v.min(limit).max(-limit)];
        if !BIAS {
            let kept_u = grip.where_at_most(square, L::load(&row.slip[0]), -slid[0]);
            let kept_v = grip.where_at_most(square, L::load(&row.slip[1]), -slid[1]);
            limit.where_at_most(zero, -slid[0], kept_u).store(&mut row.slip[0]);
            limit.where_at_most(zero, -slid[1], kept_v).store(&mut row.slip[1]);
            if last {
                (L::load(&row.step_impulse) + normal).store(&mut row.step_impulse);
                (L::load(&row.step_friction[0]) + tangent[0]).store(&mut row.step_friction[0]);
                (L::load(&row.step_friction[1]) + tangent[1]).store(&mut row.step_friction[1]);
            }
        }

        let impulse = n.scaled(change_n) + u.scaled(tangent[0] - olds[0]) + v.scaled(tangent[1] - olds[1]);
        self.a.push(-impulse, arms[0], self.inv_mass[0], &block.inv_inertia[0]);
        self.b.push(impulse, arms[1], self.inv_mass[1], &block.inv_inertia[1]);
        let carries = (normal * (self.inv_mass[0] + self.inv_mass[1])).where_at_most(noise, zero, one);
        self.a.carried = self.a.carried.max(carries);
        self.b.carried = self.b.carried.max(carries);
        normal.store(&mut row.normal_impulse);
        tangent[0].store(&mut row.tangent_impulse[0]);
        tangent[1].store(&mut row.tangent_impulse[1]);
    }
}

/// How often a pass goes over a block's points.
///
/// Four corners settle in one sweep; a ring of many shares its load in endless ways, and with one sweep a slender prism on
/// it rocks for ever. What has no load to start from gets its own first.
#[inline(always)]
fn sweeps<S>(block: &Block<S>, substep: &Substep) -> usize {
    let settled = if block.count <= 4 { 1 } else { 2 };
    if block.fresh && substep.first { settled.max(FRESH_SWEEPS) } else { settled }
}

#[inline(always)]
fn solve<L: Lanes, const BIAS: bool>(
    block: &Block<L::Scalar>,
    rows: &mut [PointRow<L::Scalar>],
    bodies: &BodyRows<'_, L::Scalar>,
    substep: &Substep,
) {
    let mut solving = Solving::<L, BIAS>::begin(block, bodies, substep);
    let sweeps = sweeps(block, substep);
    for sweep in 1..=sweeps {
        for row in rows.iter_mut() {
            solving.point(block, row, substep, sweep == sweeps);
        }
    }
    solving.end(block, bodies);
}

/// [`solve`] for two blocks of a colour, in turn: a point waits for the one before it, and meanwhile the processor has
/// those of the other block to do.
#[inline(always)]
fn solve_two<L: Lanes, const BIAS: bool>(
    blocks: [&Block<L::Scalar>; 2],
    rows: [&mut [PointRow<L::Scalar>]; 2],
    bodies: &BodyRows<'_, L::Scalar>,
    substep: &Substep,
) {
    let [a, b] = blocks;
    let mut solving =
        (Solving::<L, BIAS>::begin(a, bodies, substep), Solving::<L, BIAS>::begin(b, bodies, substep));
    let sweeps = sweeps(a, substep);
    let [rows_a, rows_b] = rows;
    for sweep in 1..=sweeps {
        for (row_a, row_b) in rows_a.iter_mut().zip(rows_b.iter_mut()) {
            solving.0.point(a, row_a, substep, sweep == sweeps);
            solving.1.point(b, row_b, substep, sweep == sweeps);
        }
    }
    solving.0.end(a, bodies);
    solving.1.end(b, bodies);
}

/// How far the surfaces have moved since the step began, as linear forms of the arms.
///
/// Along the normal by Rodrigues' formula for the rotation θ of a body, arm · (n × θ sin θ / θ + Q) with
/// Q = (θ (n·θ) - |θ|² n) (1 - cos θ) / θ², less what of the arm does not turn; along the tangents to first order.
struct Moved<L> {
    normal: L,
    tangents: [L; 2],
    by_arm: [[V3<L>; 3]; 2],
}

impl<L: Lanes> Moved<L> {
    #[inline(always)]
    fn gather(bodies: &BodyRows<'_, L::Scalar>, block: &Block<L::Scalar>, [n, u, v]: [V3<L>; 3]) -> Self {
        let a = SideMoved::gather(bodies, block, 0, [n, u, v]);
        let b = SideMoved::gather(bodies, block, 1, [n, u, v]);
        let apart = b.displacement - a.displacement;
        Self {
            normal: n.dot(apart) - b.round + a.round,
            tangents: [u.dot(apart), v.dot(apart)],
            by_arm: [a.by_arm, b.by_arm],
        }
    }

    /// Brings the gap and the slip of a point up to the bodies' poses.
    #[inline(always)]
    fn measure(&self, row: &mut PointRow<L::Scalar>, arms: [V3<L>; 2]) {
        let [a, b] = &self.by_arm;
        (L::load(&row.separation) + self.normal + b[0].dot(arms[1]) - a[0].dot(arms[0])).store(&mut row.gap);
        (self.tangents[0] + b[1].dot(arms[1]) - a[1].dot(arms[0])).store(&mut row.slid[0]);
        (self.tangents[1] + b[2].dot(arms[1]) - a[2].dot(arms[0])).store(&mut row.slid[1]);
    }
}

/// One body's part of [`Moved`].
struct SideMoved<L> {
    displacement: V3<L>,
    round: L,
    by_arm: [V3<L>; 3],
}

impl<L: Lanes> SideMoved<L> {
    #[inline(always)]
    fn gather(
        bodies: &BodyRows<'_, L::Scalar>,
        block: &Block<L::Scalar>,
        side: usize,
        [n, u, v]: [V3<L>; 3],
    ) -> Self {
        let [x, y, z, p, q, r, by_sin, by_cos] = gather::<L>(&bodies.moved, &block.bodies[side]);
        let turn = V3(p, q, r);
        let even = (turn.scaled(n.dot(turn)) - n.scaled(turn.dot(turn))).scaled(by_cos);
        Self {
            displacement: V3(x, y, z),
            round: L::load(&block.offset[side]) * n.dot(even),
            by_arm: [n.cross(turn).scaled(by_sin) + even, u.cross(turn), v.cross(turn)],
        }
    }
}
