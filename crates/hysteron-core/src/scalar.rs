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
    /// One half.
    const HALF: Self;
    /// Larger than every number.
    const INFINITY: Self;
    /// Distance from one to the next larger number.
    const EPSILON: Self;

    /// The nearest number to a count.
    fn from_index(n: usize) -> Self;
    /// `⌊self⌋` of a number in `0 ≤ self < 2³¹`; 0 below that range, 2³¹ − 1 above.
    fn floor_index(self) -> usize;
    /// The nearest whole number to `self` in `−½ ≤ self < 2²²`, ties to even, as a number and as an index.
    fn nearest_index(self) -> (Self, usize);
    /// Whether `self < other`, both at least 0 and neither −0. The bits of such numbers are in the
    /// same order, and comparing those shortens the wait of a branch that was predicted wrongly.
    fn precedes(self, other: Self) -> bool;
    /// The bits of the number.
    fn bits(self) -> u64;
    /// Neither NaN nor infinite.
    fn is_finite(self) -> bool;

    /// The larger of two numbers, neither of them NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    /// The smaller of two numbers, neither of them NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    /// `self` limited to `[low, high]`.
    #[inline(always)]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
}

macro_rules! real {
    ($t:ty, $round:expr) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const INFINITY: Self = <$t>::INFINITY;
            const EPSILON: Self = <$t>::EPSILON;

            #[inline(always)]
            fn from_index(n: usize) -> Self {
                // Through i32: one conversion instruction on every target, Cortex-M4F included.
                n as u32 as i32 as $t
            }

            #[inline(always)]
            fn floor_index(self) -> usize {
                (self as i32).max(0) as usize
            }

            #[inline(always)]
            fn nearest_index(self) -> (Self, usize) {
                // Added to 1.5 · 2^(mantissa bits), the fraction is rounded off and the whole number
                // stands in the low bits: no conversion instruction, no range check.
                const ROUND: $t = $round;
                const LOW_BITS: u32 = (1 << 22) - 1;
                let shifted = self + ROUND;
                (
                    shifted - ROUND,
                    (shifted.to_bits() as u32 & LOW_BITS) as usize,
                )
            }

            #[inline(always)]
            fn precedes(self, other: Self) -> bool {
                self.to_bits() < other.to_bits()
            }

            #[inline(always)]
            fn bits(self) -> u64 {
                u64::from(self.to_bits())
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                <$t>::is_finite(self)
            }
        }
    };
}
real!(f32, 12_582_912.0); // 1.5 · 2²³
real!(f64, 6_755_399_441_055_744.0); // 1.5 · 2⁵²
