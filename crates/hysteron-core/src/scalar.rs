//! The two number types the core runs on.

use core::fmt::{Debug, Display};
use core::ops::{Add, Div, Mul, Neg, Sub};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A floating-point number: `f32` or `f64`, nothing else (the trait is sealed).
///
/// It holds only what the operators need, so that the core depends on no numeric crate and on no
/// function of `std`.
pub trait Real:
    sealed::Sealed
    + Copy
    + PartialOrd
    + Debug
    + Display
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// Larger than every number.
    const INFINITY: Self;
    /// Distance from one to the next larger number.
    const EPSILON: Self;

    /// The nearest number to a count.
    fn from_index(n: usize) -> Self;
    /// `⌊self⌋` of a number in `0 ≤ self < 2³¹`; 0 below that range, 2³¹ − 1 above.
    fn floor_index(self) -> usize;
    /// Neither NaN nor infinite.
    fn is_finite(self) -> bool;

    /// The larger of two numbers, neither of them NaN.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    /// The smaller of two numbers, neither of them NaN.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    /// `self` limited to `[low, high]`.
    #[inline(always)]
    fn limited(self, low: Self, high: Self) -> Self {
        self.larger(low).smaller(high)
    }
}

macro_rules! real {
    ($t:ty) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const INFINITY: Self = <$t>::INFINITY;
            const EPSILON: Self = <$t>::EPSILON;

            #[inline(always)]
            fn from_index(n: usize) -> Self {
                n as $t
            }

            #[inline(always)]
            fn floor_index(self) -> usize {
                // Through i32: one conversion instruction on every target, Cortex-M4F included.
                (self as i32).max(0) as usize
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                <$t>::is_finite(self)
            }
        }
    };
}
real!(f32);
real!(f64);
