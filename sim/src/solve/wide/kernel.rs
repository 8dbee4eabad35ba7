//! The sweeps over contact blocks, written once for every width and precision.
//!
//! Symbols follow Catto's papers: K is the Delassus block of a point (inverse effective mass), λ an impulse. A point's
//! normal impulse is found first, then both tangents at once inside Coulomb's cone; both are applied together.

use crate::math::Vec3;

use super::block::{Block, GROUND, PointRow};
use super::lanes::{Eight, Lanes, Scalar, V3, WIDTH};
use super::share::Shared;

/// What a sweep does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    /// Finds the masses that the points' Delassus blocks stand for.
    Weigh,
    /// Applies the impulses of the substep before.
    WarmStart,
    /// Solves with position bias: velocities that also remove overlap.
    Bias,
    /// Solves without: takes out the speed that the bias put in, so that it never becomes energy.
    Relax,
}

/// What all blocks of a substep share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Substep {
    /// s
    pub(crate) h: f64,
    /// m/s
    pub(crate) max_push_speed: f64,
    /// m/s²
    pub(crate) gravity: Vec3,
    /// The first of its step.
    pub(crate) first: bool,
}

/// Share of gravity's speed in a substep below which a contact's impulse is rounding.
const ROUNDING_SHARE: f64 = 3e-4;

/// Sweeps over the points of a manifold that begins to carry.
const FRESH_SWEEPS: usize = 6;

/// The columns of a body row.
pub(crate) const CARRIED: usize = 6;
pub(crate) const FLIES: usize = 7;

/// Rows of the bodies: `[v, ω, carried, flies]` and `[displacement, rotation vector θ, sin θ / θ, (1 - cos θ) / θ²]`
/// since the step began.
pub(crate) struct BodyRows<'a, S> {
    pub(crate) velocity: Shared<'a, Eight<S>>,
    pub(crate) moved: Shared<'a, Eight<S>>,
}

/// One sweep over `range` of the blocks with the lanes `L`.
#[inline(always)]
fn sweep<L: Lanes>(
    blocks: &mut [Block<L::Scalar>],
    points: &Shared<'_, PointRow<L::Scalar>>,
    bodies: &BodyRows<'_, L::Scalar>,
    pass: Pass,
    substep: &Substep,
) {
    for block in blocks {
        let rows = points_of(points, block);
        match pass {
            Pass::Weigh => weigh::<L>(block, rows),
            Pass::WarmStart => warm_start::<L>(block, rows, bodies),
            Pass::Bias => solve::<L, true>(block, rows, bodies, substep),
            Pass::Relax => solve::<L, false>(block, rows, bodies, substep),
        }
    }
}

#[inline(always)]
#[allow(unsafe_code, clippy::mut_from_ref, reason = "see share.rs")]
fn points_of<'a, S>(points: &'a Shared<'_, PointRow<S>>, block: &Block<S>) -> &'a mut [PointRow<S>] {
    // SAFETY: a block's points are its own, and each block has one worker.
    unsafe { points.range(block.first..block.first + block.count) }
}

#[inline(always)]
#[allow(unsafe_code, reason = "see share.rs")]
fn gather<L: Lanes>(rows: &Shared<'_, Eight<L::Scalar>>, at: &[u32; WIDTH]) -> [L; WIDTH] {
    // Written out: a closure would not be compiled for the kernel's processor.
    // SAFETY: no other block of this colour names these bodies, except the ground, which nobody writes.
    unsafe {
        L::transpose([
            L::load(rows.read(at[0] as usize)),
            L::load(rows.read(at[1] as usize)),
            L::load(rows.read(at[2] as usize)),
            L::load(rows.read(at[3] as usize)),
            L::load(rows.read(at[4] as usize)),
            L::load(rows.read(at[5] as usize)),
            L::load(rows.read(at[6] as usize)),
            L::load(rows.read(at[7] as usize)),
        ])
    }
}

#[inline(always)]
#[allow(unsafe_code, reason = "see share.rs")]
fn scatter<L: Lanes>(columns: [L; WIDTH], rows: &Shared<'_, Eight<L::Scalar>>, at: &[u32; WIDTH]) {
    for (row, &at) in L::transpose(columns).iter().zip(at) {
        if at != GROUND {
            // SAFETY: as in `gather`.
            row.store(unsafe { rows.at(at as usize) });
        }
    }
}

/// Velocities of eight bodies.
#[derive(Clone, Copy)]
struct Motion<L> {
    linear: V3<L>,
    angular: V3<L>,
    carried: L,
    flies: L,
}

impl<L: Lanes> Motion<L> {
    #[inline(always)]
    fn gather(rows: &Shared<'_, Eight<L::Scalar>>, at: &[u32; WIDTH]) -> Self {
        let [x, y, z, p, q, r, carried, flies] = gather(rows, at);
        Self { linear: V3(x, y, z), angular: V3(p, q, r), carried, flies }
    }

    #[inline(always)]
    fn scatter(self, rows: &Shared<'_, Eight<L::Scalar>>, at: &[u32; WIDTH]) {
        let (v, w) = (self.linear, self.angular);
        scatter([v.0, v.1, v.2, w.0, w.1, w.2, self.carried, self.flies], rows, at);
    }

    #[inline(always)]
    fn at(&self, arm: V3<L>) -> V3<L> {
        self.linear + self.angular.cross(arm)
    }

    #[inline(always)]
    fn push(&mut self, impulse: V3<L>, arm: V3<L>, inv_mass: L, inv_inertia: &[Eight<L::Scalar>; 6]) {
        self.linear = self.linear + impulse.scaled(inv_mass);
        self.angular = self.angular + arm.cross(impulse).through(inv_inertia);
    }
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

#[inline(always)]
fn axes<L: Lanes>(block: &Block<L::Scalar>) -> [V3<L>; 3] {
    let (n, u) = (V3::load(&block.normal), V3::load(&block.tangent));
    [n, u, n.cross(u)]
}

/// nᵀKn, tᵀKn and tᵀKt of every point, K the Delassus block of both bodies, and what the solver needs of them: see
/// [`crate::solve::friction::Friction`] for the tangents' part.
#[inline(always)]
fn weigh<L: Lanes>(block: &Block<L::Scalar>, rows: &mut [PointRow<L::Scalar>]) {
    let (zero, one, half) = (L::zero(), L::number(1.0), L::number(0.5));
    let [n, u, v] = axes::<L>(block);
    let inv_mass = L::load(&block.inv_mass[0]) + L::load(&block.inv_mass[1]);
    for row in rows {
        let mut weights = [inv_mass, zero, zero, inv_mass, zero, inv_mass];
        for side in 0..2 {
            let arm = V3::<L>::load(&row.arm[side]);
            let levers = [arm.cross(n), arm.cross(u), arm.cross(v)];
            let inv_inertia = &block.inv_inertia[side];
            let turned = [levers[0].through(inv_inertia), levers[1].through(inv_inertia)];
            let last = levers[2].through(inv_inertia);
            weights[0] = weights[0] + levers[0].dot(turned[0]);
            weights[1] = weights[1] + levers[1].dot(turned[0]);
            weights[2] = weights[2] + levers[2].dot(turned[0]);
            weights[3] = weights[3] + levers[1].dot(turned[1]);
            weights[4] = weights[4] + levers[2].dot(turned[1]);
            weights[5] = weights[5] + levers[2].dot(last);
        }
        let [nn, un, vn, uu, uv, vv] = weights;
        // Lanes without a manifold weigh nothing.
        let inverse = |x: L| x.where_at_most(zero, zero, one.divided_by(x));
        inverse(nn).store(&mut row.normal_mass);
        un.store(&mut row.coupling[0]);
        vn.store(&mut row.coupling[1]);
        let by_det = inverse(uu * vv - uv * uv);
        (vv * by_det).store(&mut row.tangent_mass[0]);
        (-uv * by_det).store(&mut row.tangent_mass[1]);
        (uu * by_det).store(&mut row.tangent_mass[2]);
        let gap = (uu - vv) * half;
        inverse((uu + vv) * half + (gap * gap + uv * uv).sqrt()).store(&mut row.sliding_step);
    }
}

#[inline(always)]
fn warm_start<L: Lanes>(
    block: &Block<L::Scalar>,
    rows: &[PointRow<L::Scalar>],
    bodies: &BodyRows<'_, L::Scalar>,
) {
    let [n, u, v] = axes::<L>(block);
    let inv_mass = [L::load(&block.inv_mass[0]), L::load(&block.inv_mass[1])];
    let mut a = Motion::<L>::gather(&bodies.velocity, &block.bodies[0]);
    let mut b = Motion::<L>::gather(&bodies.velocity, &block.bodies[1]);
    for row in rows {
        let impulse = n.scaled(L::load(&row.normal_impulse))
            + u.scaled(L::load(&row.tangent_impulse[0]))
            + v.scaled(L::load(&row.tangent_impulse[1]));
        let arms = [V3::load(&row.arm[0]), V3::load(&row.arm[1])];
        a.push(-impulse, arms[0], inv_mass[0], &block.inv_inertia[0]);
        b.push(impulse, arms[1], inv_mass[1], &block.inv_inertia[1]);
    }
    a.scatter(&bodies.velocity, &block.bodies[0]);
    b.scatter(&bodies.velocity, &block.bodies[1]);
}

#[inline(always)]
fn solve<L: Lanes, const BIAS: bool>(
    block: &Block<L::Scalar>,
    rows: &mut [PointRow<L::Scalar>],
    bodies: &BodyRows<'_, L::Scalar>,
    substep: &Substep,
) {
    let (zero, one) = (L::zero(), L::number(1.0));
    let [n, u, v] = axes::<L>(block);
    let inv_mass = [L::load(&block.inv_mass[0]), L::load(&block.inv_mass[1])];
    let friction = L::load(&block.friction);
    let mut a = Motion::<L>::gather(&bodies.velocity, &block.bodies[0]);
    let mut b = Motion::<L>::gather(&bodies.velocity, &block.bodies[1]);
    // Poses change between the passes, so the first pass of a substep finds what the last of the one before has measured.
    let moved = if BIAS { None } else { Some(Moved::<L>::gather(bodies, block, [n, u, v])) };
    // What flies moves by the mean of its speeds before and after, so half of what gravity adds does not count.
    let g = V3(
        L::number(0.5 * substep.h * substep.gravity.x),
        L::number(0.5 * substep.h * substep.gravity.y),
        L::number(0.5 * substep.h * substep.gravity.z),
    );
    let lag = n.dot(g) * (b.flies - a.flies);
    let (per_h, slowest) = (L::number(1.0 / substep.h), L::number(-substep.max_push_speed));
    let (bias_rate, mass_scale, impulse_scale) =
        (L::load(&block.bias_rate), L::load(&block.mass_scale), L::load(&block.impulse_scale));

    // An impulse of the size of rounding carries nothing: the body still flies.
    let noise = L::number(ROUNDING_SHARE * substep.gravity.norm() * substep.h);
    let inv_masses = inv_mass[0] + inv_mass[1];

    // Four corners settle in one sweep a pass; a ring of many shares its load in endless ways, and with one sweep a
    // slender prism on it rocks for ever. What has no load to start from gets its own first.
    let settled = if rows.len() <= 4 { 1 } else { 2 };
    let sweeps = if block.fresh && substep.first { settled.max(FRESH_SWEEPS) } else { settled };
    for sweep in 0..sweeps {
        for row in rows.iter_mut() {
            let arms = [V3::<L>::load(&row.arm[0]), V3::load(&row.arm[1])];
            if let Some(moved) = &moved {
                moved.measure(row, arms);
            }
            let separation = L::load(&row.gap);
            let slid = [L::load(&row.slid[0]), L::load(&row.slid[1])];
            let relative = b.at(arms[1]) - a.at(arms[0]);
            let (speed, slip_u, slip_v) = (n.dot(relative), u.dot(relative), v.dot(relative));

            // Signorini: λ ≥ 0 ⟂ v + bias ≥ 0. Apart, it may close the gap within the substep, no more.
            let old = L::load(&row.normal_impulse);
            let closing = speed + separation * per_h - lag;
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
            let mut at = [
                slip_u + L::load(&row.coupling[0]) * change_n,
                slip_v + L::load(&row.coupling[1]) * change_n,
            ];
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
                if sweep + 1 == sweeps {
                    (L::load(&row.step_impulse) + normal).store(&mut row.step_impulse);
                    (L::load(&row.step_friction[0]) + tangent[0]).store(&mut row.step_friction[0]);
                    (L::load(&row.step_friction[1]) + tangent[1]).store(&mut row.step_friction[1]);
                }
            }

            let impulse =
                n.scaled(change_n) + u.scaled(tangent[0] - olds[0]) + v.scaled(tangent[1] - olds[1]);
            a.push(-impulse, arms[0], inv_mass[0], &block.inv_inertia[0]);
            b.push(impulse, arms[1], inv_mass[1], &block.inv_inertia[1]);
            let carries = (normal * inv_masses).where_at_most(noise, zero, one);
            a.carried = a.carried.max(carries);
            b.carried = b.carried.max(carries);
            normal.store(&mut row.normal_impulse);
            tangent[0].store(&mut row.tangent_impulse[0]);
            tangent[1].store(&mut row.tangent_impulse[1]);
        }
    }
    a.scatter(&bodies.velocity, &block.bodies[0]);
    b.scatter(&bodies.velocity, &block.bodies[1]);
}

/// A precision with its kernels: the widest that this processor has, and the portable twin.
pub(crate) trait Precision: Scalar {
    fn sweep(
        blocks: &mut [Block<Self>],
        points: &Shared<'_, PointRow<Self>>,
        bodies: &BodyRows<'_, Self>,
        pass: Pass,
        substep: &Substep,
        simd: bool,
    );
}

impl Precision for f32 {
    fn sweep(
        blocks: &mut [Block<Self>],
        points: &Shared<'_, PointRow<Self>>,
        bodies: &BodyRows<'_, Self>,
        pass: Pass,
        substep: &Substep,
        simd: bool,
    ) {
        #[cfg(target_arch = "x86_64")]
        if simd {
            #[allow(unsafe_code, reason = "the door to the SIMD kernels")]
            // SAFETY: `simd` is true only where `simd_available` has found AVX2.
            return unsafe { avx2_sweep(blocks, points, bodies, pass, substep) };
        }
        sweep::<super::lanes::Portable<Self>>(blocks, points, bodies, pass, substep);
    }
}

impl Precision for f64 {
    fn sweep(
        blocks: &mut [Block<Self>],
        points: &Shared<'_, PointRow<Self>>,
        bodies: &BodyRows<'_, Self>,
        pass: Pass,
        substep: &Substep,
        _: bool,
    ) {
        sweep::<super::lanes::Portable<Self>>(blocks, points, bodies, pass, substep);
    }
}

/// Whether the wide kernels run on this processor.
pub(crate) fn simd_available() -> bool {
    #[cfg(target_arch = "x86_64")]
    return is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    false
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2_sweep(
    blocks: &mut [Block<f32>],
    points: &Shared<'_, PointRow<f32>>,
    bodies: &BodyRows<'_, f32>,
    pass: Pass,
    substep: &Substep,
) {
    sweep::<super::avx2::Avx2>(blocks, points, bodies, pass, substep);
}
