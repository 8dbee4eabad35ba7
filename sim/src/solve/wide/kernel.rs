//! The sweeps over contact blocks, written once for every width and precision; `solving` is what two of them do.
//!
//! Symbols follow Catto's papers: K is the Delassus block of a point (inverse effective mass), λ an impulse.

use crate::math::Vec3;

use super::block::{Block, GROUND, PointRow};
use super::lanes::{Eight, Lanes, Scalar, V3, WIDTH};
use super::share::Shared;
use super::solving;

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
    match pass {
        Pass::Weigh => {
            for block in blocks {
                weigh::<L>(block, points_of(points, block));
            }
        }
        Pass::WarmStart => {
            for block in blocks {
                warm_start::<L>(block, points_of(points, block), bodies);
            }
        }
        Pass::Bias => solving::sweep::<L, true>(blocks, points, bodies, substep),
        Pass::Relax => solving::sweep::<L, false>(blocks, points, bodies, substep),
    }
}

#[inline(always)]
#[allow(unsafe_code, clippy::mut_from_ref, reason = "see share.rs")]
pub(super) fn points_of<'a, S>(
    points: &'a Shared<'_, PointRow<S>>,
    block: &Block<S>,
) -> &'a mut [PointRow<S>] {
    // SAFETY: a block's points are its own, and each block has one worker.
    unsafe { points.range(block.first..block.first + block.count) }
}

#[inline(always)]
#[allow(unsafe_code, reason = "see share.rs")]
pub(super) fn gather<L: Lanes>(rows: &Shared<'_, Eight<L::Scalar>>, at: &[u32; WIDTH]) -> [L; WIDTH] {
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
pub(super) struct Motion<L> {
    linear: V3<L>,
    angular: V3<L>,
    pub(super) carried: L,
    pub(super) flies: L,
}

impl<L: Lanes> Motion<L> {
    #[inline(always)]
    pub(super) fn gather(rows: &Shared<'_, Eight<L::Scalar>>, at: &[u32; WIDTH]) -> Self {
        let [x, y, z, p, q, r, carried, flies] = gather(rows, at);
        Self { linear: V3(x, y, z), angular: V3(p, q, r), carried, flies }
    }

    #[inline(always)]
    pub(super) fn scatter(self, rows: &Shared<'_, Eight<L::Scalar>>, at: &[u32; WIDTH]) {
        let (v, w) = (self.linear, self.angular);
        scatter([v.0, v.1, v.2, w.0, w.1, w.2, self.carried, self.flies], rows, at);
    }

    #[inline(always)]
    pub(super) fn at(&self, arm: V3<L>) -> V3<L> {
        self.linear + self.angular.cross(arm)
    }

    #[inline(always)]
    pub(super) fn push(
        &mut self,
        impulse: V3<L>,
        arm: V3<L>,
        inv_mass: L,
        inv_inertia: &[Eight<L::Scalar>; 6],
    ) {
        self.linear = self.linear + impulse.scaled(inv_mass);
        self.angular = self.angular + arm.cross(impulse).through(inv_inertia);
    }
}

#[inline(always)]
pub(super) fn axes<L: Lanes>(block: &Block<L::Scalar>) -> [V3<L>; 3] {
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
