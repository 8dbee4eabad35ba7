//! The wide numbers of AVX2, in single precision.
//!
//! Every method is inlined into a kernel that is compiled for AVX2 and entered only after the processor has been
//! asked (see [`super::kernel`]): that is the `SAFETY` reason of each block here.
#![allow(unsafe_code, reason = "the one place for SIMD; tests hold it against the portable twin")]

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Neg, Sub};

use super::lanes::{Eight, Lanes, WIDTH};

#[derive(Clone, Copy)]
pub(crate) struct Avx2(__m256);

macro_rules! call {
    ($($body:tt)*) => {
        // SAFETY: reached only from a kernel that runs after AVX2 was detected.
        unsafe { $($body)* }
    };
}

/// Calls `size` bytes from `at` on into the cache.
#[inline(always)]
pub(crate) fn prefetch(at: *const i8, line: usize, size: usize) {
    for offset in (0..size).step_by(line) {
        // SAFETY: a prefetch never faults and writes nothing, and SSE belongs to every x86-64.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(at.wrapping_add(offset)) };
    }
}

impl Add for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(call!(_mm256_add_ps(self.0, other.0)))
    }
}

impl Sub for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(call!(_mm256_sub_ps(self.0, other.0)))
    }
}

impl Mul for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(call!(_mm256_mul_ps(self.0, other.0)))
    }
}

impl Neg for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(call!(_mm256_xor_ps(self.0, _mm256_set1_ps(-0.0))))
    }
}

impl Lanes for Avx2 {
    type Scalar = f32;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(call!(_mm256_set1_ps(x)))
    }
    #[inline(always)]
    fn load(from: &Eight<f32>) -> Self {
        // Aligned: `Eight` is.
        Self(call!(_mm256_load_ps(from.0.as_ptr())))
    }
    #[inline(always)]
    fn store(self, to: &mut Eight<f32>) {
        call!(_mm256_store_ps(to.0.as_mut_ptr(), self.0));
    }
    #[inline(always)]
    fn divided_by(self, other: Self) -> Self {
        Self(call!(_mm256_div_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(call!(_mm256_sqrt_ps(self.0)))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(call!(_mm256_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(call!(_mm256_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn where_at_most(self, bound: Self, yes: Self, no: Self) -> Self {
        Self(call!(_mm256_blendv_ps(no.0, yes.0, _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, bound.0))))
    }
    #[inline(always)]
    fn any_at_most(self, bound: Self) -> bool {
        call!(_mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, bound.0)) != 0)
    }
    #[inline(always)]
    fn transpose(r: [Self; WIDTH]) -> [Self; WIDTH] {
        call! {
            let t0 = _mm256_unpacklo_ps(r[0].0, r[1].0);
            let t1 = _mm256_unpackhi_ps(r[0].0, r[1].0);
            let t2 = _mm256_unpacklo_ps(r[2].0, r[3].0);
            let t3 = _mm256_unpackhi_ps(r[2].0, r[3].0);
            let t4 = _mm256_unpacklo_ps(r[4].0, r[5].0);
            let t5 = _mm256_unpackhi_ps(r[4].0, r[5].0);
            let t6 = _mm256_unpacklo_ps(r[6].0, r[7].0);
            let t7 = _mm256_unpackhi_ps(r[6].0, r[7].0);
            let s0 = _mm256_shuffle_ps::<0x44>(t0, t2);
            let s1 = _mm256_shuffle_ps::<0xEE>(t0, t2);
            let s2 = _mm256_shuffle_ps::<0x44>(t1, t3);
            let s3 = _mm256_shuffle_ps::<0xEE>(t1, t3);
            let s4 = _mm256_shuffle_ps::<0x44>(t4, t6);
            let s5 = _mm256_shuffle_ps::<0xEE>(t4, t6);
            let s6 = _mm256_shuffle_ps::<0x44>(t5, t7);
            let s7 = _mm256_shuffle_ps::<0xEE>(t5, t7);
            [
                Self(_mm256_permute2f128_ps::<0x20>(s0, s4)),
                Self(_mm256_permute2f128_ps::<0x20>(s1, s5)),
                Self(_mm256_permute2f128_ps::<0x20>(s2, s6)),
                Self(_mm256_permute2f128_ps::<0x20>(s3, s7)),
                Self(_mm256_permute2f128_ps::<0x31>(s0, s4)),
                Self(_mm256_permute2f128_ps::<0x31>(s1, s5)),
                Self(_mm256_permute2f128_ps::<0x31>(s2, s6)),
                Self(_mm256_permute2f128_ps::<0x31>(s3, s7)),
            ]
        }
    }
}
