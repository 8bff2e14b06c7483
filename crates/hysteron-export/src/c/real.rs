//! The number types of C.

use hysteron::{Error, Remedy, Setting};
use hysteron_core::Real;

/// The number type that the C computes in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CReal {
    /// `float`, for processors with a unit for it, such as a Cortex-M4F.
    #[default]
    Float,
    /// `double`, the digits of the library itself.
    Double,
}

impl CReal {
    /// The type's name in C.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::Double => "double",
        }
    }

    /// The line of the header that says it.
    pub(super) fn line(self) -> String {
        format!("typedef {} hys_real;", self.name())
    }
}

/// A number type of C.
pub(super) trait Number: Real {
    /// Its size and alignment.
    const BYTES: usize;
    /// Its name in C.
    const REAL: CReal;
    /// [`Real::EPSILON`].
    const DISTANCE: f64;
    /// The smallest number that has all its digits.
    const SMALLEST: Self;
    /// The nearest number; none where digits are lost beyond that: too large, or too small to be
    /// exact.
    fn nearest(number: f64) -> Option<Self>;
    /// As C reads it back to the same bits.
    fn literal(self) -> String;
}

impl Number for f32 {
    const BYTES: usize = 4;
    const REAL: CReal = CReal::Float;
    const DISTANCE: f64 = f32::EPSILON as f64;
    const SMALLEST: Self = f32::MIN_POSITIVE;

    fn nearest(number: f64) -> Option<Self> {
        let near = number as f32;
        (near.is_normal() || number == 0.0).then_some(near)
    }

    fn literal(self) -> String {
        format!("{self:?}f")
    }
}

impl Number for f64 {
    const BYTES: usize = 8;
    const REAL: CReal = CReal::Double;
    const DISTANCE: f64 = f64::EPSILON;
    const SMALLEST: Self = 0.0;

    fn nearest(number: f64) -> Option<Self> {
        Some(number)
    }

    fn literal(self) -> String {
        format!("{self:?}")
    }
}

pub(super) fn unfit(what: &str) -> Error {
    let double = Setting::word("real", CReal::Double.name());
    let what = format!("{what} does not fit single precision");
    Error::Export(what).remedied(Remedy::new("export with {}", [double]))
}
