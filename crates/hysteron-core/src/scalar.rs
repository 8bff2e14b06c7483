//! The two number types of the core.

use core::fmt::{Debug, Display};
use core::ops::{Add, Div, Mul, Neg, Sub};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A floating-point number: `f32` or `f64`, nothing else (the trait is sealed).
///
/// It has only what the core needs, without `std`. Exponential, sine and root are those of `libm`,
/// which gives the same bits on every platform.
///
/// [`Real::max`], [`Real::min`] and [`Real::clamp`] are for generic code. On a value whose type is
/// known to be `f32` or `f64`, the inherent methods of the same name are called instead. The two
/// differ for NaN, and the inherent `clamp` panics for limits in the wrong order.
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
    + 'static
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// One half.
    const HALF: Self;
    /// A whole turn, 2π.
    const TWO_PI: Self;
    /// Positive infinity.
    const INFINITY: Self;
    /// Distance from one to the next larger number: 2⁻²³ for `f32`, 2⁻⁵² for `f64`.
    const EPSILON: Self;
    /// The largest constant of a stage: its square, and its products with factors of up to a
    /// million, are numbers too. 10¹⁵ for `f32`, 10¹⁴⁰ for `f64`.
    const LARGEST: Self;

    /// The number nearest to `n`, for `n < 2³¹`.
    fn from_index(n: usize) -> Self;
    /// `⌊self⌋` for `0 ≤ self < 2³¹`. Below that range and for NaN it is 0, above it is 2³¹ − 1.
    fn floor_index(self) -> usize;
    /// The whole number nearest to `self`, as a number and as an index, for `−½ ≤ self < 2²²`. Ties
    /// go to the even one.
    fn nearest_index(self) -> (Self, usize);
    /// Whether `self < other`, for numbers that are 0 or above and not −0.
    ///
    /// The bits of such numbers, read as integers, have the same order as the numbers. Comparing
    /// integers is faster: a mispredicted branch is resolved sooner.
    fn precedes(self, other: Self) -> bool;
    /// The bits of the number, as `to_bits` gives them.
    fn bits(self) -> u64;
    /// Whether the number is neither NaN nor infinite.
    fn is_finite(self) -> bool;

    /// `e^self`.
    fn exp(self) -> Self;
    /// `e^self − 1`, with all digits where that is small.
    fn exp_m1(self) -> Self;
    /// The sine of an angle in radians.
    fn sin(self) -> Self;
    /// The cosine of an angle in radians.
    fn cos(self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;

    /// The larger of two numbers. `other` where they are equal or one of them is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    /// The smaller of two numbers. `other` where they are equal or one of them is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    /// `self` limited to `[low, high]`. Does not panic: NaN gives `low`, and so `high` wins where
    /// `low` lies above it.
    #[inline(always)]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
}

macro_rules! real {
    ($t:ident, $round:expr, $largest:expr, $($function:ident = $libm:path),+) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const TWO_PI: Self = core::$t::consts::TAU;
            const INFINITY: Self = <$t>::INFINITY;
            const EPSILON: Self = <$t>::EPSILON;
            const LARGEST: Self = $largest;

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
                // The sum with 1.5 · 2^(mantissa bits) has no fraction bits: the addition rounds,
                // and the low bits are the whole number. No conversion instruction, no range check.
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

            $(
                #[inline]
                fn $function(self) -> Self {
                    $libm(self)
                }
            )+
        }
    };
}
real!(
    f32,
    12_582_912.0, // 1.5 · 2²³
    1e15,
    exp = libm::expf,
    exp_m1 = libm::expm1f,
    sin = libm::sinf,
    cos = libm::cosf,
    sqrt = libm::sqrtf
);
real!(
    f64,
    6_755_399_441_055_744.0, // 1.5 · 2⁵²
    1e140,
    exp = libm::exp,
    exp_m1 = libm::expm1,
    sin = libm::sin,
    cos = libm::cos,
    sqrt = libm::sqrt
);
