//! Error measures between a measured and a modelled series.

use crate::series::fair_range;
use serde::{Deserialize, Serialize};

/// The differences between a measured and a modelled series.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Root of the mean squared difference, in the unit of the series.
    pub rmse: f64,
    /// Largest absolute difference, in the unit of the series.
    pub max_abs: f64,
    /// `rmse` in percent of the measured range of the whole series, which wrong readings do not set
    /// ([`crate::fair_range`]); `None` where that range is zero.
    pub nrmse_percent: Option<f64>,
    /// Number of samples compared.
    pub samples: usize,
}

impl Errors {
    /// Compares the samples for which `which` is true. `None` if there are none.
    ///
    /// ```
    /// use hysteron::Errors;
    /// let errors = Errors::between(&[0.0, 2.0, 4.0], &[0.0, 2.0, 1.0], |_| true).unwrap();
    /// assert_eq!((errors.rmse, errors.max_abs, errors.samples), (3f64.sqrt(), 3.0, 3));
    /// assert!((errors.nrmse_percent.unwrap() - 43.3).abs() < 0.01);
    /// ```
    #[must_use]
    pub fn between(
        measured: &[f64],
        modelled: &[f64],
        which: impl Fn(usize) -> bool,
    ) -> Option<Self> {
        Self::of_each(measured, modelled.iter().copied(), which)
    }

    /// As [`Errors::between`], for modelled values that come one after the other.
    pub(crate) fn of_each(
        measured: &[f64],
        modelled: impl IntoIterator<Item = f64>,
        which: impl Fn(usize) -> bool,
    ) -> Option<Self> {
        let (mut squares, mut max_abs, mut samples) = (0.0, 0.0_f64, 0_usize);
        for (n, (a, b)) in measured.iter().zip(modelled).enumerate() {
            if which(n) {
                squares += (b - a) * (b - a);
                max_abs = max_abs.max((b - a).abs());
                samples += 1;
            }
        }
        if samples == 0 {
            return None;
        }
        let rmse = (squares / samples as f64).sqrt();
        let (low, high) = fair_range(measured);
        let nrmse_percent = (high > low).then(|| 100.0 * rmse / (high - low));
        Some(Self {
            rmse,
            max_abs,
            nrmse_percent,
            samples,
        })
    }

    /// Errors over several series, whose measured values together have this range. `None` for no
    /// series.
    pub(crate) fn joined(
        parts: impl IntoIterator<Item = Self>,
        (low, high): (f64, f64),
    ) -> Option<Self> {
        let mut parts = parts.into_iter().peekable();
        let first = parts.next()?;
        if parts.peek().is_none() {
            // Not a digit changes.
            return Some(first);
        }
        let (mut squares, mut max_abs, mut samples) = (0.0, 0.0_f64, 0);
        for part in std::iter::once(first).chain(parts) {
            squares += part.rmse * part.rmse * part.samples as f64;
            max_abs = max_abs.max(part.max_abs);
            samples += part.samples;
        }
        let rmse = (squares / samples as f64).sqrt();
        Some(Self {
            rmse,
            max_abs,
            nrmse_percent: (high > low).then(|| 100.0 * rmse / (high - low)),
            samples,
        })
    }
}
