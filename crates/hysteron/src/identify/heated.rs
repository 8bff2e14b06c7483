//! Looks for a thermal body in front of the operators that nobody asked for.

use crate::error::{Error, Result};
use crate::identify::delay;
use crate::identify::options::{Choice, FitOptions};
use crate::identify::outliers::mended_by;
use crate::identify::stages::{may_heat, step_of, time_passes, with_right_input};
use crate::model::{Delay, FitSummary, Model, Validation};
use crate::progress::{Progress, ended_by_callback};
use crate::recording::{Recording, one_speed};
use serde_json::json;

/// A model that errs less on what was left out, in percent of the range, needs no body: it would
/// cost more than it could gain.
const WELL: f64 = 1.0;

/// With a body, both errors have to be at most this part of those without it: where whole branches
/// were left out; and where there are so few that parts of them were, where a lag or a ring stands
/// in its place, where the input had one speed, or where the body did not begin at rest. A body
/// smooths as a lag does, and gains a little where only the lag is true. A rest moves the plane, and
/// gains a little where the levels are few. At one speed it widens a loop that the operators could have as well:
/// models of two plants that nothing heats erred 4.4 and 7.5 % on another recording with a body, and
/// 1.9 and 1.6 % without.
const WORTH: f64 = 0.9;
const CLEAR_WORTH: f64 = 0.5;

/// A time constant has to be longer than this many sampling steps.
const STEPS: f64 = 1.5;

/// More than this part of all readings is not wrong: a drive of steps looks like it.
const FEW: f64 = 0.02;

/// What the record of a body says of the error without it.
const WITHOUT: &str = "without_body";

/// What the record says where one was looked for and not taken.
const NONE_FOUND: &str = "no_body";

/// How a fit is run again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Again {
    /// As it is, and without a bootstrap.
    Cold,
    /// With a body, and without a bootstrap.
    Trial,
    /// With a body.
    Warm,
}

/// Runs a fit again, tested on what is left out. Returns its model and the dead time.
pub(super) type Run<'a> = &'a dyn Fn(&[Recording], Again, Progress<'_>) -> Result<(Model, Delay)>;

/// The model of a fit and its dead time, or in their place those with a thermal body, where the
/// whole model is better with it on what was left out and on what was fitted. What a drive heats
/// looks like a dead time or a lag, and is predicted by neither.
///
/// # Errors
/// Those of `run`, and of the callback of `progress`.
pub(super) fn or_cold(
    recordings: &[Recording],
    options: &FitOptions,
    cold: (Model, Delay),
    run: Run<'_>,
    progress: Progress<'_>,
) -> Result<(Model, Delay)> {
    let tested;
    let judged = match validation(&cold.0) {
        Some(_) => &cold.0,
        None => {
            tested = run(recordings, Again::Cold, progress)?.0;
            &tested
        }
    };
    if !may_gain(judged) {
        return Ok(cold);
    }
    if let Some(warm) = warm(recordings, options, judged, run, progress)? {
        return Ok(warm);
    }
    let (mut model, delay) = cold;
    if let Some(fit) = &mut model.fit {
        fit.other.insert(NONE_FOUND.to_owned(), json!(true));
    }
    Ok((model, delay))
}

/// The model with a body, where it is better than the `cold` one.
fn warm(
    recordings: &[Recording],
    options: &FitOptions,
    cold: &Model,
    run: Run<'_>,
    progress: Progress<'_>,
) -> Result<Option<(Model, Delay)>> {
    // A look at a few time constants costs little beside a search for both, and for bound heat.
    // What cannot be looked at is searched.
    let late = match options.delay {
        Choice::Fixed(samples) => delay::fixed(samples, recordings)?,
        Choice::Auto => Delay::NONE,
    };
    let seen = late.of_recordings(recordings);
    let seen = mended_by(&seen, cold);
    let looked = ended_by_callback(progress, |progress| {
        Ok(may_heat(&seen, options, WORTH, progress))
    })?;
    if matches!(looked, Ok(false)) {
        return Ok(None);
    }
    if let Some(right) = without_wrong_input(recordings) {
        let plain = run(&right, Again::Cold, progress)?.0;
        if better(&right, &plain, Again::Trial, run, progress)?.is_none() {
            return Ok(None);
        }
    }
    better(recordings, cold, Again::Warm, run, progress)
}

/// Whether recordings can show a body.
pub(super) fn can_show(recordings: &[Recording]) -> bool {
    let shows = |one: &Recording| one.load.is_none() && time_passes(one);
    recordings.iter().all(shows)
}

/// The recordings with lines in place of a few wrong readings of the input; `None` without any. A
/// wrong reading moves a model at once and the output not at all, as if something heated. So a body
/// has to be there without it, too.
fn without_wrong_input(recordings: &[Recording]) -> Option<Vec<Recording>> {
    let right: Vec<Recording> = recordings.iter().map(with_right_input).collect();
    let wrong = right.iter().zip(recordings).map(|(right, read)| {
        let pairs = right.input.iter().zip(&read.input);
        pairs.filter(|(right, read)| right != read).count()
    });
    let (wrong, all): (usize, usize) = (wrong.sum(), recordings.iter().map(Recording::len).sum());
    (wrong > 0 && (wrong as f64) < FEW * all as f64).then_some(right)
}

/// The model of a run with a body, where it is better than the `cold` one.
fn better(
    recordings: &[Recording],
    cold: &Model,
    again: Again,
    run: Run<'_>,
    progress: Progress<'_>,
) -> Result<Option<(Model, Delay)>> {
    if !may_gain(cold) {
        return Ok(None);
    }
    let found = ended_by_callback(progress, |progress| Ok(run(recordings, again, progress)))?;
    let (mut warm, delay) = match found {
        // No body keeps the operators inside the plane.
        Err(error) if matches!(error.parts().0, Error::Fit(_) | Error::Thermal(_)) => {
            return Ok(None);
        }
        found => found?,
    };
    // A body about as fast as the samples cannot be told from how a drive is held between them.
    let step = recordings.iter().map(step_of).fold(0.0, f64::max);
    let is_seen = warm
        .thermal
        .is_some_and(|body| body.tau_heating.min(body.tau_cooling) > STEPS * step);
    let rests = warm.fit.as_ref().map(FitSummary::rests);
    let is_clear = one_speed(recordings).is_none() && rests.is_none_or(|rests| rests.is_empty());
    if !(is_seen && is_worth(&warm, cold, is_clear)) {
        return Ok(None);
    }
    if let (Some(fit), Some(without)) = (&mut warm.fit, validation(cold)) {
        let without = json!(without.nrmse_percent);
        fit.other.insert(WITHOUT.to_owned(), without);
    }
    Ok(Some((warm, delay)))
}

/// Whether a model errs enough on what was left out for a body to gain something.
fn may_gain(model: &Model) -> bool {
    validation(model).is_some_and(|found| found.nrmse_percent >= WELL)
}

fn validation(model: &Model) -> Option<&Validation> {
    model.fit.as_ref()?.validation.as_ref()
}

/// Whether a body is worth its constants: with it, what was left out is predicted better, and what
/// was fitted is followed better. Parts of few branches say less than whole ones, and inputs of one
/// speed are not `is_clear`.
fn is_worth(warm: &Model, cold: &Model, is_clear: bool) -> bool {
    let (Some(with), Some(without)) = (validation(warm), validation(cold)) else {
        return false;
    };
    let is_whole = with.whole_branches && without.whole_branches;
    let most = match is_whole && is_clear && !cold.is_timed() {
        true => WORTH,
        false => CLEAR_WORTH,
    };
    let rmse = |model: &Model| model.fit.as_ref().map_or(f64::INFINITY, |fit| fit.rmse);
    with.rmse < most * without.rmse && rmse(warm) < most * rmse(cold)
}

impl FitSummary {
    /// Where a thermal body was found that nobody asked for: the error on what was left out without
    /// it, in percent of the range.
    #[must_use]
    pub fn error_without_body(&self) -> Option<f64> {
        self.other.get(WITHOUT)?.as_f64()
    }

    /// Whether a thermal body that nobody asked for was looked for, and none was taken.
    pub(crate) fn found_no_body(&self) -> bool {
        self.other.contains_key(NONE_FOUND)
    }
}
