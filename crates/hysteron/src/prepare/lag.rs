//! The lag of the input's sensor.
//!
//! A thermocouple behind the wire follows it as `τ dT/dt + T = T_wire`. With `τ` known the lag is
//! undone; it can be estimated where the material itself does not depend on rate, for then a static
//! model fits best when the lag is gone.

use crate::error::{Error, Result};
use crate::identify::{FitOptions, fit_weights};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::filter::low_pass;

/// Levels of the models that compare lags: enough to tell loops apart, few enough to be fitted
/// forty times.
const LEVELS: usize = 12;

/// The longest lag tried, as a part of the duration.
const LONGEST: f64 = 0.05;
/// Lags of the first search, from the time between samples to the longest.
const TRIED: usize = 12;
/// Steps of the second: each narrows the interval to 0.618 of itself.
const NARROWED: usize = 10;

/// The model's error has to fall by this part of itself, or the lag is not taken for one.
pub(super) const WORTHWHILE: f64 = 0.1;

/// What a search for the lag found.
pub(super) struct Estimate {
    /// The lag of the best fit, s.
    pub(super) tau: f64,
    /// RMSE of a static model with the input as it is, in the output's unit.
    pub(super) rmse_before: f64,
    /// RMSE with the lag undone.
    pub(super) rmse_after: f64,
}

/// The input before a sensor of time constant `tau` (s), from readings at every `step` (s).
///
/// `x + τ dx/dt`, with the derivative of the zero-phase low-passed input: cut off at `1/τ`, where
/// the sensor leaves a sixth of the signal, so that noise grows about three times and not without
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

/// By how many times white noise below `cutoff` (cycles a sample; 0.5 for all of it) grows when a
/// lag is undone.
pub(super) fn growth(step: f64, tau: f64, cutoff: f64) -> f64 {
    let edge = (cutoff / step).min(1.0 / tau);
    // The mean of (2π f τ)² up to the edge is a third of that at the edge.
    (1.0 + (std::f64::consts::TAU * tau * edge).powi(2) / 3.0).sqrt()
}

/// The lag whose undoing lets a static model fit best: tried on a grid of ratios, then narrowed by
/// golden section (Kiefer 1953).
pub(super) fn estimate(
    recording: &Recording,
    step: f64,
    progress: Progress<'_>,
) -> Result<Estimate> {
    let told = |_: &'static str, _: f64| progress.tell("sensor lag", f64::NAN);
    let progress = Progress::new(&told);
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
        ..FitOptions::default()
    };
    let model = fit_weights(std::slice::from_ref(recording), &options, progress)?;
    model
        .fit
        .map(|fit| fit.rmse)
        .ok_or_else(|| Error::Preparation("a fit did not say how it went".into()))
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
        // ω τ = 0.2: the reading is off by 0.2 of the amplitude, the filter at 1/τ by (ωτ/2π)⁴.
        assert!(largest(&read) > 5.0);
        assert!(largest(&undone) < 0.05, "{}", largest(&undone));
    }

    #[test]
    fn the_lag_of_two_rates_is_found() {
        let (step, tau) = (0.25, 3.0);
        let mut recording = two_rates(step);
        recording.input = behind_sensor(&recording.input, step, tau);
        let found = estimate(&recording, step, Progress::NONE).unwrap();
        // Grid and golden section end within 1 %; the filter of the derivative and 12 levels cost
        // more.
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
