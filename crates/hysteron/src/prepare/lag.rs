//! Removes the lag of the input's sensor, and estimates its time constant.
//!
//! A thermocouple behind the wire follows it as `τ dT/dt + T = T_wire`. With a known `τ` the lag
//! can be undone. `τ` can be estimated if the material itself does not depend on rate, because then
//! a static model fits best without lag.

use crate::error::{Error, Result};
use crate::identify::{FitOptions, fit_weights};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::filter::low_pass;

/// Number of levels of the models that compare lags: enough to resolve the loops, and few enough to
/// fit forty models.
const LEVELS: usize = 12;

/// The longest lag tried, as a share of the duration.
const LONGEST: f64 = 0.05;
/// Number of lags in the first search, from the time between samples to the longest.
const TRIED: usize = 12;
/// Number of steps of the second search. Each narrows the interval to 0.618 of its length.
const NARROWED: usize = 10;

/// A lag is accepted only if it reduces the model's error by at least this share.
pub(super) const WORTHWHILE: f64 = 0.1;

/// The result of a search for the lag.
pub(super) struct Estimate {
    /// The lag of the best fit, s.
    pub(super) tau: f64,
    /// RMSE of a static model with the input as it is, in the output's unit.
    pub(super) rmse_before: f64,
    /// RMSE with the lag undone.
    pub(super) rmse_after: f64,
}

/// The input in front of a sensor with the time constant `tau` (s), from readings at every `step`
/// (s).
///
/// `x + τ dx/dt`, with the derivative of the zero-phase low-passed input. The cut-off is `1/τ`,
/// where the sensor passes a sixth of the signal. So noise grows about three times, and not without
/// bound.
pub(super) fn undo(values: &[f64], step: f64, tau: f64) -> Result<Vec<f64>> {
    let (rate, cutoff) = (1.0 / step, 1.0 / tau);
    let smooth = match cutoff < 0.45 * rate {
        true => low_pass(values, rate, cutoff)?,
        false => values.to_vec(),
    };
    let last = values.len() - 1;
    let slope = |n: usize| {
        let (before, after) = (n.saturating_sub(1), (n + 1).min(last));
        (smooth[after] - smooth[before]) / ((after - before).max(1) as f64 * step)
    };
    Ok((0..).zip(values).map(|(n, x)| x + tau * slope(n)).collect())
}

/// The factor by which white noise grows when a lag is undone. The noise is limited to frequencies
/// below `cutoff` (cycles per sample; 0.5 for all frequencies).
pub(super) fn growth(step: f64, tau: f64, cutoff: f64) -> f64 {
    let edge = (cutoff / step).min(1.0 / tau);
    // The mean of (2π f τ)² up to the cut-off is a third of its value there.
    (1.0 + (std::f64::consts::TAU * tau * edge).powi(2) / 3.0).sqrt()
}

/// The lag that gives the best fit of a static model. It is found on a logarithmic grid, then
/// narrowed by golden section search (Kiefer 1953).
pub(super) fn estimate(
    recording: &Recording,
    step: f64,
    progress: Progress<'_>,
) -> Result<Estimate> {
    let report = |_: &'static str, _: f64| progress.tell("sensor lag", f64::NAN);
    let progress = Progress::new(&report);
    let error = |tau: f64| -> Result<f64> {
        let mut candidate = recording.clone();
        candidate.input = undo(&recording.input, step, tau)?;
        rmse(&candidate, progress)
    };
    let rmse_before = rmse(recording, progress)?;
    let longest = LONGEST * step * (recording.len() - 1) as f64;
    if longest <= step {
        return Err(Error::Preparation(
            "the recording is too short to estimate a lag from: give its time constant".into(),
        ));
    }
    let ratio = (longest / step).powf(1.0 / (TRIED - 1) as f64);
    let mut best = (f64::INFINITY, step);
    for n in 0..TRIED {
        let tau = step * ratio.powi(n as i32);
        let found = error(tau)?;
        if found < best.0 {
            best = (found, tau);
        }
    }
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = ((best.1 / ratio).ln(), (best.1 * ratio).ln());
    let inner = |low: f64, high: f64| (high - golden * (high - low), low + golden * (high - low));
    let (mut left, mut right) = inner(low, high);
    let (mut at_left, mut at_right) = (error(left.exp())?, error(right.exp())?);
    for _ in 0..NARROWED {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = inner(low, high).0;
            at_left = error(left.exp())?;
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = inner(low, high).1;
            at_right = error(right.exp())?;
        }
    }
    for candidate in [(at_left, left.exp()), (at_right, right.exp())] {
        if candidate.0 < best.0 {
            best = candidate;
        }
    }
    Ok(Estimate {
        tau: best.1,
        rmse_before,
        rmse_after: best.0,
    })
}

fn rmse(recording: &Recording, progress: Progress<'_>) -> Result<f64> {
    let options = FitOptions {
        levels: LEVELS,
        ..FitOptions::plain()
    };
    let model = fit_weights(std::slice::from_ref(recording), &options, progress)?;
    model
        .fit
        .map(|fit| fit.rmse)
        .ok_or_else(|| Error::Preparation("a fit returned no summary".into()))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::prepare::test_series::{behind_sensor, two_rates};

    #[test]
    fn a_known_lag_is_undone() {
        let step = 0.1;
        let truth: Vec<f64> = (0..4000)
            .map(|n| 50.0 - 30.0 * (f64::from(n) * 0.01).cos())
            .collect();
        let read = behind_sensor(&truth, step, 2.0);
        let undone = undo(&read, step, 2.0).unwrap();
        let largest = |a: &[f64]| {
            let errors = a.iter().zip(&truth).skip(200).map(|(a, b)| (a - b).abs());
            errors.take(3600).fold(0.0, f64::max)
        };
        // ω τ = 0.2: the reading is wrong by 0.2 of the amplitude, the filter at 1/τ by (ωτ/2π)⁴.
        assert!(largest(&read) > 5.0);
        assert!(largest(&undone) < 0.05, "{}", largest(&undone));
    }

    #[test]
    fn the_lag_of_two_rates_is_found() {
        let (step, tau) = (0.25, 3.0);
        let mut recording = two_rates(step);
        recording.input = behind_sensor(&recording.input, step, tau);
        let found = estimate(&recording, step, Progress::NONE).unwrap();
        // Grid and golden section are within 1 %. The filter of the derivative and 12 levels add
        // more error.
        assert!((found.tau / tau - 1.0).abs() < 0.15, "{}", found.tau);
        assert!(found.rmse_after < 0.5 * found.rmse_before);
    }

    #[test]
    fn without_a_lag_none_is_worth_while() {
        let step = 0.25;
        let found = estimate(&two_rates(step), step, Progress::NONE).unwrap();
        assert!(
            found.rmse_after > (1.0 - WORTHWHILE) * found.rmse_before,
            "{} {}",
            found.tau,
            found.rmse_after / found.rmse_before
        );
    }
}
