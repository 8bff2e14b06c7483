//! A first-order low-pass filter, for samples at any distance in time.

use crate::scalar::Real;

/// A low-pass filter of readings. It begins at its first value.
///
/// ```
/// use hysteron_core::control::LowPass;
/// let mut filter = LowPass::new(0.5);
/// assert_eq!(filter.pass(1.0, 0.1), 1.0);
/// let later = filter.pass(3.0, 0.5); // after one time constant
/// assert!((later - (3.0 - 2.0 * (-1.0_f64).exp())).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct LowPass {
    time_s: f64,
    filtered: f64,
}

impl LowPass {
    /// A filter with a time constant in seconds; at 0 every value passes as it is.
    #[must_use]
    pub fn new(time_s: f64) -> Self {
        Self {
            time_s,
            filtered: f64::NAN,
        }
    }

    /// Changes the time constant.
    pub fn set(&mut self, time_s: f64) {
        self.time_s = time_s;
    }

    /// The filtered value, `passed` seconds after the last one.
    pub fn pass(&mut self, value: f64, passed: f64) -> f64 {
        let kept = match self.filtered.is_nan() || self.time_s <= 0.0 {
            true => 0.0,
            // Exported C has the same exponential, to the last bit.
            false => Real::exp(-passed / self.time_s),
        };
        self.filtered = match kept > 0.0 {
            true => kept * self.filtered + (1.0 - kept) * value,
            false => value,
        };
        self.filtered
    }
}
