//! Preparation: turns a recording as measured into one that a model can be identified from.
//!
//! `sign` repairs single samples. `resample` makes equal time steps. `smooth` is
//! the low-pass that removes the noise. `lag` undoes a sensor's lag. `band` removes
//! false reversals of the input. `rate` tests whether the material depends on rate. `report`
//! records what was done.

mod band;
mod lag;
mod rate;
mod report;
mod resample;
mod sign;
mod smooth;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod test_series;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

pub use rate::{RateDependence, rate_dependence};
pub use report::{DeadBand, LowPass, Preparation, Repairs, SensorLag, Smoothed, Spikes};

use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use crate::series::NOISE;
use crate::series::filter::low_pass;
use crate::series::noise::noise;
use crate::series::{range, spikes};

/// What a step of the preparation does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Step {
    /// Use the value that follows from the data.
    #[default]
    Auto,
    /// Skip the step.
    Off,
    /// Use this value.
    Value(f64),
}

/// The steps of [`prepare`], in their order.
///
/// | field | default | value | unit |
/// | --- | --- | --- | --- |
/// | `spikes` | auto | above 0 | median absolute deviations |
/// | `resample` | auto | above 0 | s |
/// | `low_pass` | auto | above 0, below half the sampling rate | Hz; without time cycles/sample |
/// | `lag` | off | above 0 | s |
/// | `dead_band` | auto | 0 or more | unit of the input |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrepareOptions {
    /// Repair of lost signs, then removal of isolated spikes. The value is the number of deviations
    /// from which on a sample is a spike. Auto: 4.
    pub spikes: Step,
    /// Resampling to equal time steps of this length. Auto: the median step, and only if the time
    /// is irregular and a filter needs equal steps.
    pub resample: Step,
    /// Zero-phase low-pass filter; the value is the cut-off for both series. Auto: for each series,
    /// the cut-off that removes as much as the noise. No filter if the noise is below 0.05 % of the
    /// range.
    pub low_pass: Step,
    /// Compensation of the lag of the input's sensor; the value is its time constant. Auto: the
    /// time constant that gives the best fit of a static model, if that fit is 10 % better. This is
    /// valid only if the material does not depend on rate.
    pub lag: Step,
    /// Dead band: reversals of the input up to this are noise. Auto: the largest reversal that
    /// noise causes in this number of samples, `2√(2 ln n) σ`.
    pub dead_band: Step,
}

impl Default for PrepareOptions {
    fn default() -> Self {
        Self {
            lag: Step::Off,
            ..Self::all(Step::Auto)
        }
    }
}

impl PrepareOptions {
    /// The same choice for every step.
    #[must_use]
    pub fn all(step: Step) -> Self {
        Self {
            spikes: step,
            resample: step,
            low_pass: step,
            lag: step,
            dead_band: step,
        }
    }

    fn check(&self) -> Result<()> {
        let above_zero = [
            (self.spikes, "the deviations that make a spike"),
            (self.resample, "the step of resampling"),
            (self.low_pass, "the cut-off of the low-pass"),
            (self.lag, "the time constant of the sensor"),
        ];
        for (step, name) in above_zero {
            match step {
                Step::Value(value) if !(value.is_finite() && value > 0.0) => {
                    return Err(Error::Preparation(format!(
                        "{name} must be a number above zero, not {value}"
                    )));
                }
                _ => {}
            }
        }
        match self.dead_band {
            Step::Value(band) if !(band.is_finite() && band >= 0.0) => Err(Error::Preparation(
                format!("the dead band must be zero or above, not {band}"),
            )),
            _ => Ok(()),
        }
    }
}

/// Prepares a recording for [`crate::Fit`] and reports what was done. It restores lost signs,
/// removes spikes, resamples and smooths if the noise requires it, undoes a sensor's lag on
/// request, and removes false reversals of the input.
///
/// A clean recording is not changed. Preparing a prepared recording changes almost nothing. All
/// series of the result have the same length; only resampling changes it.
///
/// ```
/// use hysteron::{PrepareOptions, Progress, Recording, prepare};
/// let mut input: Vec<f64> = (0..300).map(|n| 40.0 * (f64::from(n) * 0.05).sin()).collect();
/// let output = input.iter().map(|t| 0.5 * t).collect();
/// input[100] = 0.0; // a reading that was lost
/// let recording = Recording::new(input, output)?;
/// let (prepared, report) = prepare(&recording, &PrepareOptions::default(), Progress::NONE)?;
/// assert_eq!(report.spikes.map(|spikes| spikes.input.first), Some(vec![101])); // counted from 1
/// assert!((prepared.input[100] + 38.36).abs() < 0.1);
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// - [`Error::Recording`] for an invalid recording.
/// - [`Error::Preparation`] for a value outside the table of [`PrepareOptions`], and for a lag or a
///   time step without time.
/// - [`Error::Filter`] for a cut-off that does not fit the samples.
/// - As [`crate::Fit::run`], if a lag is estimated.
/// - The error that `progress` returns.
pub fn prepare(
    recording: &Recording,
    options: &PrepareOptions,
    progress: Progress<'_>,
) -> Result<(Recording, Preparation)> {
    recording.check()?;
    options.check()?;
    let mut work = recording.clone();
    progress.tell("spikes", f64::NAN)?;
    let spikes = remove_spikes(&mut work, options.spikes);
    let sigma = [noise(&work.input), noise(&work.output)];
    let noisy = [0, 1].map(|n| {
        let (low, high) = range([&work.input, &work.output][n]);
        sigma[n] > smooth::NEGLIGIBLE * (high - low)
    });
    let filtered = match options.low_pass {
        Step::Auto => noisy.contains(&true),
        Step::Off => false,
        Step::Value(_) => true,
    };
    progress.tell("filters", f64::NAN)?;
    let resampled = resample(
        &mut work,
        options.resample,
        filtered || options.lag != Step::Off,
    )?;
    let step = work.time.as_deref().map(resample::step_of);
    let step = step.filter(|step| *step > 0.0);

    let low_pass = smooth(&mut work, options.low_pass, sigma, noisy, step)?;
    let input_filter = low_pass.as_ref().and_then(|filter| filter.input.as_ref());
    let input_cutoff = input_filter.map(|filter| filter.cutoff * step.unwrap_or(1.0));
    let lag = undo_lag(&mut work, options.lag, step, progress)?;

    // Noise that remains on the input after filtering.
    let mut left = sigma[0] * input_cutoff.map_or(1.0, smooth::let_through);
    let undone = lag.as_ref().and_then(|lag| lag.undone);
    if let (Some(tau), Some(step)) = (undone, step) {
        left *= lag::growth(step, tau, input_cutoff.unwrap_or(0.5));
    }
    let as_read = input_cutoff.is_none() && undone.is_none();
    let band = settle(&mut work, options.dead_band, left, as_read)?;
    work.check()?;
    let report = Preparation {
        samples_before: recording.len(),
        samples: work.len(),
        input_noise: sigma[0],
        output_noise: sigma[1],
        spikes,
        resampled,
        low_pass,
        lag,
        dead_band: band,
    };
    Ok((work, report))
}

fn remove_spikes(work: &mut Recording, step: Step) -> Option<Spikes> {
    let deviations = match step {
        Step::Off => return None,
        Step::Auto => spikes::DEVIATIONS,
        Step::Value(deviations) => deviations,
    };
    let repair = |values: &mut [f64]| {
        let signs = sign::restore(values);
        let spikes = spikes::remove(values, deviations);
        Repairs::new(&signs, &spikes)
    };
    Some(Spikes {
        deviations,
        input: repair(&mut work.input),
        output: repair(&mut work.output),
    })
}

/// Returns the time step if the recording was resampled.
fn resample(work: &mut Recording, step: Step, needed: bool) -> Result<Option<f64>> {
    let taken = match (step, &work.time) {
        (Step::Value(_), None) => {
            return Err(needs_time("resampling needs a time column"));
        }
        (Step::Value(step), Some(time)) => {
            let duration = time[time.len() - 1] - time[0];
            if step > duration {
                return Err(Error::Preparation(format!(
                    "a step of {step} s is longer than the recording, {duration} s: \
                     take a shorter one"
                )));
            }
            step
        }
        (Step::Auto, Some(time)) if needed && resample::irregular(time) => {
            resample::fits(time)?;
            resample::step_of(time)
        }
        _ => return Ok(None),
    };
    if taken <= 0.0 {
        return Ok(None); // the time never advances
    }
    resample::resample(work, taken)?;
    Ok(Some(taken))
}

fn smooth(
    work: &mut Recording,
    how: Step,
    sigma: [f64; 2],
    noisy: [bool; 2],
    step: Option<f64>,
) -> Result<Option<LowPass>> {
    if how == Step::Off {
        return Ok(None);
    }
    let rate = step.map_or(1.0, |step| 1.0 / step);
    let mut done = [None, None];
    for (n, values) in [&mut work.input, &mut work.output].into_iter().enumerate() {
        let cutoff = match how {
            Step::Value(cutoff) => Some(cutoff),
            _ if !noisy[n] => None,
            _ => smooth::cutoff_for(values, sigma[n])?.map(|cutoff| cutoff * rate),
        };
        if let Some(cutoff) = cutoff {
            let smoothed = low_pass(values, rate, cutoff)?;
            let removed = smooth::distance(values, &smoothed);
            *values = smoothed;
            done[n] = Some(Smoothed { cutoff, removed });
        }
    }
    let [input, output] = done;
    Ok(Some(LowPass {
        input,
        output,
        in_hertz: step.is_some(),
    }))
}

fn needs_time(what: &str) -> Error {
    let words = "name its column ({}), or leave the step out";
    let remedy = Remedy::new(words, [Setting::any("time")]);
    Error::Preparation(what.into()).remedied(remedy)
}

fn undo_lag(
    work: &mut Recording,
    how: Step,
    step: Option<f64>,
    progress: Progress<'_>,
) -> Result<Option<SensorLag>> {
    if how == Step::Off {
        return Ok(None);
    }
    let Some(step) = step else {
        return Err(needs_time(
            "a sensor lag needs a time column in which time passes",
        ));
    };
    let mut report = SensorLag::default();
    match how {
        Step::Value(tau) => report.undone = Some(tau),
        _ => {
            let found = lag::estimate(work, step, progress)?;
            let gain = 1.0 - found.rmse_after / found.rmse_before;
            report.undone = (gain >= lag::WORTHWHILE).then_some(found.tau);
            report.estimate = Some(found.tau);
            report.rmse_before = Some(found.rmse_before);
            report.rmse_after = Some(found.rmse_after);
        }
    }
    if let Some(tau) = report.undone {
        work.input = lag::undo(&work.input, step, tau)?;
    }
    Ok(Some(report))
}

/// `left` is the standard deviation of the noise that remains on the input. `as_read` is true if
/// the values are still those of the meter.
fn settle(work: &mut Recording, how: Step, left: f64, as_read: bool) -> Result<Option<DeadBand>> {
    let size = match how {
        Step::Off => return Ok(None),
        Step::Value(size) => {
            let (low, high) = range(&work.input);
            if size >= high - low {
                return Err(Error::Preparation(format!(
                    "a dead band of {size} covers the whole range of the input, {low} to {high}: \
                     take a smaller one"
                )));
            }
            size
        }
        Step::Auto => {
            // The largest of n Gaussian values (Donoho & Johnstone 1994), on both sides.
            let reach = 2.0 * (2.0 * (work.len() as f64).ln()).sqrt() * left;
            // Flicker of a meter between two neighbouring readings is not a reversal.
            let (low, high) = range(&work.input);
            let flicker = band::resolution_with_rounding(&work.input);
            match as_read && flicker <= NOISE * (high - low) {
                true => reach.max(flicker),
                false => reach,
            }
        }
    };
    let before = work.input.clone();
    band::settle(&mut work.input, size);
    let pairs = || before.iter().zip(&work.input);
    Ok(Some(DeadBand {
        size,
        false_reversals: band::reversals(&before).saturating_sub(band::reversals(&work.input)),
        samples_changed: pairs().filter(|(a, b)| a != b).count(),
        largest_change: pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
    }))
}
