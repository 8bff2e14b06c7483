//! Preparation: turns a recording as measured into one that a model can be identified from.
//!
//! `doubt` finds what cannot be believed. `sign` and `single` repair single samples. `resample`
//! makes equal time steps. `smooth` is the low-pass that removes the noise. `lag` undoes a sensor's
//! lag. `band` removes false reversals of the input. Each step that is left to the data is a
//! candidate: `judge` keeps it only if a model then errs less on data that it did not see. `rate`
//! tests whether the material depends on rate. `report` records what was done.

mod band;
mod doubt;
mod judge;
mod lag;
mod options;
mod rate;
mod report;
mod resample;
mod sign;
mod single;
mod smooth;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod test_series;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

pub use doubt::{Doubt, doubts};
pub use judge::Judged;
pub use options::{PrepareOptions, Step};
pub use rate::{RateDependence, rate_dependence};
pub use report::{DeadBand, LowPass, Preparation, Repairs, SensorLag, Smoothed, Spikes};

use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use crate::series::NOISE;
use crate::series::filter::low_pass;
use crate::series::noise::noise;
use crate::series::range;
use judge::Judge;

/// Prepares a recording for [`crate::Fit`] and reports what was done, and what each step gained. It
/// removes spikes, resamples and smooths if the noise requires it, undoes a sensor's lag on request,
/// and removes false reversals of the input.
///
/// A step that is left to the data is taken only if it lowers the error on data that the model did
/// not see. So a clean recording is not changed. All series of the result have the same length; only
/// resampling changes it.
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
/// - [`Error::Preparation`] for a value outside the table of [`PrepareOptions`], for a lag or a
///   time step without time, and for a recording that cannot be believed.
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
    let mut judge = Judge::new(recording);
    progress.tell("spikes", f64::NAN)?;
    let spikes = single::repair(&mut work, options, &mut judge);
    if !options.believe {
        doubt::refuse(&work, options.spikes)?;
    }
    let sigma = [noise(&work.input), noise(&work.output)];
    progress.tell("filters", f64::NAN)?;
    let mut clock = Clock::new(&mut work, options)?;
    let low_pass = filter(&mut work, options.low_pass, sigma, &mut clock, &mut judge)?;
    let lag = undo_lag(&mut work, options.lag, &mut clock, &mut judge, progress)?;

    // Noise that remains on the input after filtering.
    let step = clock.step;
    let input_filter = low_pass.as_ref().and_then(|filter| filter.input.as_ref());
    let input_cutoff = input_filter.map(|filter| filter.cutoff * step.unwrap_or(1.0));
    let mut left = sigma[0] * input_cutoff.map_or(1.0, smooth::let_through);
    let undone = lag.as_ref().and_then(|lag| lag.undone);
    if let (Some(tau), Some(step)) = (undone, step) {
        left *= lag::growth(step, tau, input_cutoff.unwrap_or(0.5));
    }
    let as_read = input_cutoff.is_none() && undone.is_none();
    let band = settle(&mut work, options.dead_band, left, as_read, &mut judge)?;
    work.check()?;
    let report = Preparation {
        samples_before: recording.len(),
        samples: work.len(),
        input_noise: sigma[0],
        output_noise: sigma[1],
        spikes,
        resampled: clock.resampled,
        low_pass,
        lag,
        dead_band: band,
        judged: judge.judged,
    };
    Ok((work, report))
}

/// The steps of time: filters need equal ones.
struct Clock {
    how: Step,
    /// The time between samples; `None` without time that passes.
    step: Option<f64>,
    /// The time step, if the recording was resampled.
    resampled: Option<f64>,
}

impl Clock {
    /// Resamples to a step that was asked for.
    fn new(work: &mut Recording, options: &PrepareOptions) -> Result<Self> {
        let mut clock = Self {
            how: options.resample,
            step: None,
            resampled: None,
        };
        if let Step::Value(step) = options.resample {
            let time = work
                .time
                .as_deref()
                .ok_or_else(|| needs_time("resampling needs a time column"))?;
            let duration = time[time.len() - 1] - time[0];
            if step > duration {
                return Err(Error::Preparation(format!(
                    "a step of {step} s is longer than the recording, {duration} s: \
                     take a shorter one"
                )));
            }
            resample::resample(work, step)?;
            clock.resampled = Some(step);
        }
        let step = work.time.as_deref().map(resample::step_of);
        clock.step = step.filter(|step| *step > 0.0);
        Ok(clock)
    }

    fn rate(&self) -> f64 {
        self.step.map_or(1.0, |step| 1.0 / step)
    }

    /// The recording with equal steps of time, if it needs them.
    fn equal(&self, work: &Recording) -> Result<Recording> {
        let mut even = work.clone();
        if let (Step::Auto, Some(time), Some(step)) = (self.how, &work.time, self.step)
            && resample::irregular(time)
        {
            resample::fits(time)?;
            resample::resample(&mut even, step)?;
        }
        Ok(even)
    }

    /// Takes a candidate that was asked for, or that is worth it.
    fn offer(
        &mut self,
        name: &'static str,
        how: Step,
        work: &mut Recording,
        candidate: Recording,
        judge: &mut Judge<'_>,
    ) -> bool {
        let resampled = candidate.time != work.time;
        let taken = judge.offer(name, how, work, candidate);
        if taken && resampled {
            self.resampled = self.step;
        }
        taken
    }
}

fn filter(
    work: &mut Recording,
    how: Step,
    sigma: [f64; 2],
    clock: &mut Clock,
    judge: &mut Judge<'_>,
) -> Result<Option<LowPass>> {
    if how == Step::Off {
        return Ok(None);
    }
    let mut done = [None, None];
    for (n, name) in ["low-pass of the input", "low-pass of the output"]
        .into_iter()
        .enumerate()
    {
        let (low, high) = range([&work.input, &work.output][n]);
        if how == Step::Auto && sigma[n] <= smooth::NEGLIGIBLE * (high - low) {
            continue;
        }
        let mut candidate = clock.equal(work)?;
        let values = [&mut candidate.input, &mut candidate.output]
            .into_iter()
            .nth(n);
        let Some(values) = values else { continue };
        let rate = clock.rate();
        let cutoff = match how {
            Step::Value(cutoff) => Some(cutoff),
            _ => smooth::cutoff_for(values, sigma[n])?.map(|cutoff| cutoff * rate),
        };
        let Some(cutoff) = cutoff else { continue };
        let smoothed = low_pass(values, rate, cutoff)?;
        let removed = smooth::distance(values, &smoothed);
        *values = smoothed;
        if clock.offer(name, how, work, candidate, judge) {
            done[n] = Some(Smoothed { cutoff, removed });
        }
    }
    let [input, output] = done;
    Ok(Some(LowPass {
        input,
        output,
        in_hertz: clock.step.is_some(),
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
    clock: &mut Clock,
    judge: &mut Judge<'_>,
    progress: Progress<'_>,
) -> Result<Option<SensorLag>> {
    if how == Step::Off {
        return Ok(None);
    }
    let Some(step) = clock.step else {
        return Err(needs_time(
            "a sensor lag needs a time column in which time passes",
        ));
    };
    let mut candidate = clock.equal(work)?;
    let mut report = SensorLag::default();
    let tau = match how {
        Step::Value(tau) => Some(tau),
        _ => {
            let found = lag::estimate(&candidate, step, progress)?;
            let gain = 1.0 - found.rmse_after / found.rmse_before;
            report.estimate = Some(found.tau);
            report.rmse_before = Some(found.rmse_before);
            report.rmse_after = Some(found.rmse_after);
            (gain >= lag::WORTHWHILE).then_some(found.tau)
        }
    };
    if let Some(tau) = tau {
        candidate.input = lag::undo(&candidate.input, step, tau)?;
        let taken = clock.offer("lag of the sensor", how, work, candidate, judge);
        report.undone = taken.then_some(tau);
    }
    Ok(Some(report))
}

/// `left` is the standard deviation of the noise that remains on the input. `as_read` is true if
/// the values are still those of the meter.
fn settle(
    work: &mut Recording,
    how: Step,
    left: f64,
    as_read: bool,
    judge: &mut Judge<'_>,
) -> Result<Option<DeadBand>> {
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
    let mut candidate = work.clone();
    band::settle(&mut candidate.input, size);
    judge.offer("dead band of the input", how, work, candidate);
    let pairs = || before.iter().zip(&work.input);
    Ok(Some(DeadBand {
        size,
        false_reversals: band::reversals(&before).saturating_sub(band::reversals(&work.input)),
        samples_changed: pairs().filter(|(a, b)| a != b).count(),
        largest_change: pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
    }))
}
