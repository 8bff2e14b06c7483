//! Tests whether the material depends on the rate of the input.
//!
//! The hysteresis models here are rate-independent: only the path of the input counts, not its
//! speed (Visintin 1994). So the test explains the residual of a static model twice, by first-order
//! lags of input and modelled output. The first time the lags are over time, the second time over
//! the length of the path that the input has travelled.
//!
//! If time explains the residual and the path does not, it comes from rate. If both explain it
//! equally, it comes from a plane that is too coarse or an unknown start.

use super::judge::Judge;
use super::options::{PrepareOptions, Step};
use super::single;
use crate::error::Result;
use crate::identify::{Fit, FitOptions};
use crate::model::Surroundings;
use crate::recording::Recording;
use crate::series::{NOISE, fair_range};
use serde::Serialize;

/// Number of time constants tried, from the mean step to a tenth of the whole length.
const CONSTANTS: usize = 12;

/// With fewer samples than this there is no result.
const FEWEST: usize = 20;

/// How much the output depends on the rate of the input, beyond what a static model can follow.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RateDependence {
    /// Root mean square of the residual that only rate explains, in percent of the output's range:
    /// `nrmse_percent · √(r2_time − r2_path)`.
    pub percent: f64,
    /// R² of the static model's residual, explained by lags in time.
    pub r2_time: f64,
    /// R² of the same residual, explained by lags over the path of the input.
    pub r2_path: f64,
    /// The time constant that explains most, s.
    pub time_constant: f64,
    /// Error of the static model (20 levels), in percent of the output's range.
    pub nrmse_percent: f64,
}

impl RateDependence {
    /// Above this share of the range, in percent, the error from rate is larger than noise:
    /// [`NOISE`].
    pub const THRESHOLD: f64 = 100.0 * NOISE;

    /// Whether the dependence on rate is large enough for a warning.
    #[must_use]
    pub fn is_material(&self) -> bool {
        self.percent > Self::THRESHOLD
    }
}

/// How much the recording, without its spikes, depends on rate. `None` without time, with fewer
/// than 20 samples, or if time does not advance.
///
/// ```
/// use hysteron::{Recording, rate_dependence};
/// let input: Vec<f64> = (0..600).map(|n| 50.0 - 30.0 * (f64::from(n * n) * 1e-4).cos()).collect();
/// let mut y = 20.0_f64;
/// let output = input.iter().map(|x| { y = y.clamp(x - 2.0, x + 2.0); y }).collect();
/// let mut recording = Recording::new(input, output)?;
/// recording.time = Some((0..600).map(f64::from).collect());
/// let rate = rate_dependence(&recording)?.unwrap();
/// assert!(!rate.is_material());
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// As [`Fit::run`].
pub fn rate_dependence(recording: &Recording) -> Result<Option<RateDependence>> {
    if recording.time.is_none() {
        return Ok(None);
    }
    // A spike changes fast as well, but this is not a property of the material.
    let without_spikes = PrepareOptions {
        spikes: Step::Auto,
        ..PrepareOptions::all(Step::Off)
    };
    recording.check()?;
    let mut judge = Judge::new(recording);
    let mut recording = recording.clone();
    single::repair(&mut recording, &without_spikes, &mut judge);
    let Some(time) = &recording.time else {
        return Ok(None);
    };
    if time.len() < FEWEST || time[time.len() - 1] <= time[0] {
        return Ok(None);
    }
    let model = Fit::from(FitOptions::plain()).run(&recording)?;
    let around = Surroundings::from_recording(&model, &recording);
    let modelled = model.simulate_in(&recording.input, around)?;
    let pairs = recording.output.iter().zip(&modelled);
    let residual: Vec<f64> = pairs.map(|(y, m)| y - m).collect();
    let path: Vec<f64> = recording
        .input
        .iter()
        .scan((0.0, recording.input[0]), |(length, last), &x| {
            *length += (x - *last).abs();
            *last = x;
            Some(*length)
        })
        .collect();
    let series = [&recording.input, &modelled];
    let (r2_time, time_constant) = explained(&residual, series, time);
    let (r2_path, _) = explained(&residual, series, &path);
    let (low, high) = fair_range(&recording.output);
    let mean_square = residual.iter().map(|r| r * r).sum::<f64>() / residual.len() as f64;
    let nrmse_percent = 100.0 * mean_square.sqrt() / (high - low);
    Ok(Some(RateDependence {
        percent: nrmse_percent * (r2_time - r2_path).max(0.0).sqrt(),
        r2_time,
        r2_path,
        time_constant,
        nrmse_percent,
    }))
}

/// The largest R² of `residual`, explained by how far the two series are ahead of their first-order
/// lags on `clock`; and the time constant for it.
fn explained(residual: &[f64], series: [&Vec<f64>; 2], clock: &[f64]) -> (f64, f64) {
    let total = clock[clock.len() - 1] - clock[0];
    let shortest = total / clock.len() as f64;
    let ratio = (total / 10.0 / shortest).powf(1.0 / (CONSTANTS - 1) as f64);
    let constants = (0..CONSTANTS).map(|n| shortest * ratio.powi(n as i32));
    let scores = constants.map(|tau| {
        let [a, b] = series.map(|values| centred(behind(values, clock, tau)));
        (r_squared(&centred(residual.to_vec()), &a, &b), tau)
    });
    scores.fold(
        (0.0, shortest),
        |best, score| {
            if score.0 > best.0 { score } else { best }
        },
    )
}

/// The difference between a series and its first-order lag of time constant `tau`; for a short one,
/// `τ dx/dt`.
fn behind(values: &[f64], clock: &[f64], tau: f64) -> Vec<f64> {
    let mut lagging = values[0];
    let mut last = clock[0];
    let steps = values.iter().zip(clock).map(|(x, &now)| {
        lagging += (x - lagging) * -(-(now - last) / tau).exp_m1();
        last = now;
        x - lagging
    });
    steps.collect()
}

fn centred(mut values: Vec<f64>) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter_mut().for_each(|v| *v -= mean);
    values
}

/// The share of the variance of `y` that the best combination of `a` and `b` explains. All have
/// mean zero.
fn r_squared(y: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let dot = |u: &[f64], v: &[f64]| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
    let (aa, yy) = (dot(a, a), dot(y, y));
    if yy <= 0.0 {
        return 0.0;
    }
    // Gram-Schmidt: first along a, then along the part of b that is orthogonal to a.
    let along = if aa > 0.0 { dot(a, b) / aa } else { 0.0 };
    let rest: Vec<f64> = a.iter().zip(b).map(|(a, b)| b - along * a).collect();
    let first = if aa > 0.0 {
        dot(a, y).powi(2) / aa
    } else {
        0.0
    };
    let (bb, rr) = (dot(b, b), dot(&rest, &rest));
    // If the orthogonal part of b is only rounding, ignore it.
    let second = if rr > 1e-12 * bb {
        dot(&rest, y).powi(2) / rr
    } else {
        0.0
    };
    ((first + second) / yy).min(1.0)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::prepare::test_series::{behind_sensor, two_rates};

    #[test]
    fn a_lag_is_rate_and_hysteresis_is_not() {
        let step = 0.25;
        let quasi_static = two_rates(step);
        let found = rate_dependence(&quasi_static).unwrap().unwrap();
        assert!(!found.is_material(), "{found:?}");
        let mut lagging = quasi_static.clone();
        lagging.output = behind_sensor(&lagging.output, step, 8.0);
        let found = rate_dependence(&lagging).unwrap().unwrap();
        assert!(found.is_material(), "{found:?}");
        lagging.time = None;
        assert_eq!(rate_dependence(&lagging).unwrap(), None);
    }

    #[test]
    fn a_recording_with_a_load_is_rated_too() {
        let mut recording = two_rates(0.25);
        let load = (0..recording.len()).map(|n| f64::from(u8::from(n % 200 < 100)));
        recording.load = Some(load.collect());
        assert!(rate_dependence(&recording).unwrap().is_some());
    }
}
