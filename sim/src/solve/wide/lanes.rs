//! Eight numbers at a time, and the portable twin of every wide operation.
//!
//! Only operations that IEEE 754 rounds in one way are here (no fused multiply-add, no approximate reciprocal), so
//! that every implementation gives the same bits. Minimum and maximum are those of x86: of two numbers of which one
//! is NaN they return the second, which is how the kernels keep a bad number from spreading.

use std::ops::{Add, Mul, Neg, Sub};

/// Lanes of every wide number.
pub(crate) const WIDTH: usize = 8;

/// A number that the kernels can be built for: f32 for speed, f64 for the reference.
pub(crate) trait Scalar:
    Copy
    + Default
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + 'static
{
    fn of(x: f64) -> Self;
    fn wide(self) -> f64;
}

impl Scalar for f32 {
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "the solver's precision is single by choice")]
    fn of(x: f64) -> Self {
        x as Self
    }
    #[inline(always)]
    fn wide(self) -> f64 {
        f64::from(self)
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn wide(self) -> f64 {
        self
    }
}

/// Eight numbers as they lie in memory, and the row of one body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Eight<S>(pub(crate) [S; WIDTH]);

/// Eight numbers in registers.
pub(crate) trait Lanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    type Scalar: Scalar;

    fn splat(x: Self::Scalar) -> Self;
    fn load(from: &Eight<Self::Scalar>) -> Self;
    fn store(self, to: &mut Eight<Self::Scalar>);
    fn divided_by(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
    /// `self` where it is the smaller, else `other`, also where `self` is NaN.
    fn min(self, other: Self) -> Self;
    /// `self` where it is the larger, else `other`, also where `self` is NaN.
    fn max(self, other: Self) -> Self;
    /// `yes` where `self <= bound`, else `no`.
    fn where_at_most(self, bound: Self, yes: Self, no: Self) -> Self;
    /// Whether `self <= bound` in some lane.
    fn any_at_most(self, bound: Self) -> bool;
    /// Eight rows as eight columns.
    fn transpose(rows: [Self; WIDTH]) -> [Self; WIDTH];

    #[inline(always)]
    fn zero() -> Self {
        Self::splat(Self::Scalar::default())
    }
    #[inline(always)]
    fn number(x: f64) -> Self {
        Self::splat(Self::Scalar::of(x))
    }
}

/// Calls the first of `items` from memory before it is needed, half a kilobyte of it at most: a hint that changes nothing.
#[inline(always)]
pub(crate) fn prefetch<T>(items: &[T]) {
    const LINE: usize = 64;
    const MOST: usize = 512;
    #[cfg(target_arch = "x86_64")]
    if let Some(first) = items.first() {
        super::avx2::prefetch(std::ptr::from_ref(first).cast(), LINE, size_of::<T>().min(MOST));
    }
}

/// The portable twin: plain arrays, which the compiler turns into whatever the target has.
#[derive(Clone, Copy)]
pub(crate) struct Portable<S>([S; WIDTH]);

macro_rules! portable {
    ($scalar:ty, $sqrt:path) => {
        impl Add for Portable<$scalar> {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
            }
        }
        impl Sub for Portable<$scalar> {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
            }
        }
        impl Mul for Portable<$scalar> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i] * other.0[i]))
            }
        }
        impl Neg for Portable<$scalar> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(self.0.map(|x| -x))
            }
        }
        impl Lanes for Portable<$scalar> {
            type Scalar = $scalar;
            #[inline(always)]
            fn splat(x: $scalar) -> Self {
                Self([x; WIDTH])
            }
            #[inline(always)]
            fn load(from: &Eight<$scalar>) -> Self {
                Self(from.0)
            }
            #[inline(always)]
            fn store(self, to: &mut Eight<$scalar>) {
                to.0 = self.0;
            }
            #[inline(always)]
            fn divided_by(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i] / other.0[i]))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(self.0.map($sqrt))
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] }))
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] }))
            }
            #[inline(always)]
            fn where_at_most(self, bound: Self, yes: Self, no: Self) -> Self {
                Self(std::array::from_fn(|i| if self.0[i] <= bound.0[i] { yes.0[i] } else { no.0[i] }))
            }
            #[inline(always)]
            fn any_at_most(self, bound: Self) -> bool {
                self.0.iter().zip(&bound.0).any(|(x, bound)| x <= bound)
            }
            #[inline(always)]
            fn transpose(rows: [Self; WIDTH]) -> [Self; WIDTH] {
                std::array::from_fn(|i| Self(std::array::from_fn(|j| rows[j].0[i])))
            }
        }
    };
}
portable!(f32, f32::sqrt);
portable!(f64, f64::sqrt);

/// Three wide numbers as a vector.
#[derive(Clone, Copy)]
pub(crate) struct V3<L>(pub(crate) L, pub(crate) L, pub(crate) L);

impl<L: Lanes> V3<L> {
    #[inline(always)]
    pub(crate) fn load(from: &[Eight<L::Scalar>; 3]) -> Self {
        Self(L::load(&from[0]), L::load(&from[1]), L::load(&from[2]))
    }
    #[inline(always)]
    pub(crate) fn dot(self, o: Self) -> L {
        self.0 * o.0 + self.1 * o.1 + self.2 * o.2
    }
    #[inline(always)]
    pub(crate) fn cross(self, o: Self) -> Self {
        Self(self.1 * o.2 - self.2 * o.1, self.2 * o.0 - self.0 * o.2, self.0 * o.1 - self.1 * o.0)
    }
    #[inline(always)]
    pub(crate) fn scaled(self, by: L) -> Self {
        Self(self.0 * by, self.1 * by, self.2 * by)
    }
    /// Product with a symmetric matrix `[xx, yy, zz, xy, xz, yz]`.
    #[inline(always)]
    pub(crate) fn through(self, m: &[Eight<L::Scalar>; 6]) -> Self {
        let (xx, yy, zz) = (L::load(&m[0]), L::load(&m[1]), L::load(&m[2]));
        let (xy, xz, yz) = (L::load(&m[3]), L::load(&m[4]), L::load(&m[5]));
        Self(
            xx * self.0 + xy * self.1 + xz * self.2,
            xy * self.0 + yy * self.1 + yz * self.2,
            xz * self.0 + yz * self.1 + zz * self.2,
        )
    }
}

impl<L: Lanes> Add for V3<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self(self.0 + o.0, self.1 + o.1, self.2 + o.2)
    }
}

impl<L: Lanes> Neg for V3<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1, -self.2)
    }
}

impl<L: Lanes> Sub for V3<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(self.0 - o.0, self.1 - o.1, self.2 - o.2)
    }
}
