//! Preparation: turns a recording as measured into one that a model can be identified from.
//!
//! `doubt` finds what cannot be believed. `sign` and `single` repair single samples. `resample`
//! makes equal time steps. `smooth` is the low-pass that removes the noise. `lag` undoes a sensor's
//! lag. `band` removes false reversals of the input. Each step that is left to the data is a
//! candidate: `judge` keeps it only if a model then errs less on data that it did not see. `rate`
//! tests whether the material depends on rate. `report` records what was done, and `mended` tells
//! what would be.

mod alike;
mod band;
mod change;
mod disagree;
mod doubt;
mod explained;
mod fill;
mod judge;
mod lag;
pub(crate) mod mended;
mod misread;
mod options;
mod rate;
mod report;
mod resample;
mod sign;
mod single;
mod smooth;
mod suspects;
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
use crate::recording::{Recording, UndoneLag, one_speed};
use crate::remedy::{Remedy, Setting};
use crate::series::NOISE;
use crate::series::filter::low_pass;
use crate::series::noise::noise;
use crate::series::range;
use alike::Alike;
use change::Change;
use judge::{Judge, LOW_PASSES};

/// Prepares a recording for [`crate::Fit`] and reports what was done, and what each step gained. It
/// removes spikes, resamples and smooths if the noise requires it, undoes a sensor's lag on
/// request, and removes false reversals of the input.
///
/// A step that is left to the data is taken only if it lowers the error on data that the model did
/// not see. So a clean recording is not changed. All series of the result have the same length;
/// only resampling changes it.
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

    /// The recording with equal steps of time; `None` if its steps are equal enough.
    fn equal(&self, work: &Recording) -> Result<Option<Recording>> {
        let (Step::Auto, Some(time), Some(step)) = (self.how, &work.time, self.step) else {
            return Ok(None);
        };
        if !resample::irregular(time) {
            return Ok(None);
        }
        resample::fits(time)?;
        let mut even = work.clone();
        resample::resample(&mut even, step)?;
        Ok(Some(even))
    }

    /// What it takes to give a series other `values`, which are those of an equal recording.
    fn change(even: Option<Recording>, series: usize, values: Vec<f64>) -> Change {
        let change = match series {
            0 => Change::Input(values),
            _ => Change::Output(values),
        };
        match even {
            None => change,
            Some(mut even) => {
                let mut change = change;
                change.swap(&mut even);
                Change::Resampled(Box::new(even))
            }
        }
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
    fn series(recording: &Recording, n: usize) -> &[f64] {
        [&recording.input, &recording.output][n]
    }
    let mut alike: Option<Alike> = None;
    let mut done = [None, None];
    for (n, name) in LOW_PASSES.into_iter().enumerate() {
        let (low, high) = range(series(work, n));
        if how == Step::Auto && sigma[n] <= smooth::NEGLIGIBLE * (high - low) {
            continue;
        }
        let rate = clock.rate();
        let cutoff = match how {
            Step::Value(cutoff) => Some(cutoff),
            _ => {
                let even = clock.equal(work)?;
                let values = series(even.as_ref().unwrap_or(work), n);
                smooth::cutoff_for(values, sigma[n])?.map(|cutoff| cutoff * rate)
            }
        };
        let Some(cutoff) = cutoff else { continue };
        let smoothed = |recording: &Recording| -> Result<(Change, f64)> {
            let even = clock.equal(recording)?;
            let values = series(even.as_ref().unwrap_or(recording), n);
            let smoothed = low_pass(values, rate, cutoff)?;
            let removed = smooth::distance(values, &smoothed);
            Ok((Clock::change(even, n, smoothed), removed))
        };
        let (mut change, removed) = smoothed(work)?;
        let resamples = matches!(change, Change::Resampled(_));
        if how == Step::Auto {
            if alike.is_none() {
                alike = Alike::new(work, sigma);
            }
            let Some(alike) = &mut alike else { continue };
            let (like, _) = smoothed(alike.noisy())?;
            if !alike.offer(name, work, (change, like), judge) {
                continue;
            }
        } else {
            judge.take(work, &mut change);
        }
        if resamples {
            clock.resampled = clock.step;
        }
        done[n] = Some(Smoothed { cutoff, removed });
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
    let even = clock.equal(work)?;
    let equal = even.as_ref().unwrap_or(work);
    let mut report = SensorLag::default();
    let tau = match how {
        Step::Value(tau) => Some(tau),
        _ => {
            let found = lag::estimate(equal, step, progress)?;
            let gain = 1.0 - found.rmse_after / found.rmse_before;
            report.estimate = Some(found.tau);
            report.rmse_before = Some(found.rmse_before);
            report.rmse_after = Some(found.rmse_after);
            (gain >= lag::WORTHWHILE).then_some(found.tau)
        }
    };
    if let Some(tau) = tau {
        let undone = lag::undo(&equal.input, step, tau)?;
        let resamples = even.is_some();
        let change = Clock::change(even, 0, undone);
        if judge.offer("lag of the sensor", how, work, change) {
            report.undone = Some(tau);
            let estimated = report.estimate.is_some();
            if estimated {
                report.one_speed = one_speed(std::slice::from_ref(work));
            }
            work.undone = Some(UndoneLag { tau, estimated });
            if resamples {
                clock.resampled = clock.step;
            }
        }
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
            let reach = band::reach(work.len(), left);
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
    let mut settled = before.clone();
    band::settle(&mut settled, size);
    judge.offer("dead band of the input", how, work, Change::Input(settled));
    let pairs = || before.iter().zip(&work.input);
    Ok(Some(DeadBand {
        size,
        false_reversals: band::reversals(&before).saturating_sub(band::reversals(&work.input)),
        samples_changed: pairs().filter(|(a, b)| a != b).count(),
        largest_change: pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
    }))
}
