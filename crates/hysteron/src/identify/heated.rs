//! Looks for a thermal body in front of the operators that nobody asked for.

use crate::error::{Error, Result};
use crate::identify::fit::Fit;
use crate::identify::options::{Dynamics, Thermal};
use crate::identify::stages::{step_of, with_right_input};
use crate::model::{Delay, FitSummary, Model, Validation};
use crate::progress::ended_by_callback;
use crate::recording::Recording;
use serde_json::json;

/// A model that errs less on what was left out, in percent of the range, needs no body: it would
/// cost more than it could gain.
const WELL: f64 = 1.0;

/// With a body, both errors have to be at most this part of those without it: where whole branches
/// were left out; and where there are so few that parts of them were, or where a lag or a ring stands
/// in its place. A body smooths as a lag does, and gains a little where only the lag is true.
const WORTH: f64 = 0.9;
const CLEAR_WORTH: f64 = 0.5;

/// A time constant has to be longer than this many sampling steps.
const STEPS: f64 = 1.5;

/// What the record of a body says of the error without it.
const WITHOUT: &str = "without_body";

/// The model of the fit and its dead time, or in their place those with a thermal body, where the
/// whole model is better with it on what was left out and on what was fitted. What a drive heats
/// looks like a dead time or a lag, and is predicted by neither.
///
/// # Errors
/// As [`Fit::run`].
pub(super) fn or_cold(
    fit: &Fit<'_>,
    recordings: &[Recording],
    cold: (Model, Delay),
) -> Result<(Model, Delay)> {
    if !may_be_heated(fit, recordings) {
        return Ok(cold);
    }
    // A wrong reading of the input moves a model at once and the output not at all, as if something
    // heated. So a body has to be there without it, too.
    let right: Vec<Recording> = recordings.iter().map(with_right_input).collect();
    let mut pairs = right.iter().zip(recordings);
    if pairs.any(|(right, read)| right.input != read.input) {
        let mut trial = fit.clone().bootstrap(0);
        trial.auto_bootstrap = false;
        let plain = trial.timed(&right)?;
        if better(&trial, &right, plain)?.0.thermal.is_none() {
            return Ok(cold);
        }
    }
    better(fit, recordings, cold)
}

/// The better one of both.
fn better(fit: &Fit<'_>, recordings: &[Recording], cold: (Model, Delay)) -> Result<(Model, Delay)> {
    let mut heated = fit.clone();
    heated.tested = true;
    let judged = match validation(&cold.0) {
        Some(_) => cold.0.clone(),
        None => {
            let mut tested = heated.clone().bootstrap(0);
            tested.auto_bootstrap = false;
            tested.timed(recordings)?.0
        }
    };
    let without = validation(&judged).map(|without| without.nrmse_percent);
    let Some(without) = without.filter(|error| *error >= WELL) else {
        return Ok(cold);
    };
    heated.thermal = Thermal::Auto;
    let found = ended_by_callback(fit.progress, |progress| {
        // No body keeps the operators inside the plane.
        let found = heated.progress(progress).timed(recordings);
        Ok(found)
    })?;
    let (mut warm, delay) = match found {
        Err(error) if matches!(error.parts().0, Error::Fit(_) | Error::Thermal(_)) => {
            return Ok(cold);
        }
        found => found?,
    };
    // A body about as fast as the samples cannot be told from how a drive is held between them.
    let step = recordings.iter().map(step_of).fold(0.0, f64::max);
    let is_seen = warm
        .thermal
        .is_some_and(|body| body.tau_heating.min(body.tau_cooling) > STEPS * step);
    if !(is_seen && is_worth(&warm, &judged)) {
        return Ok(cold);
    }
    if let Some(fit) = &mut warm.fit {
        let without = json!(without);
        fit.other.insert(WITHOUT.to_owned(), without);
    }
    Ok((warm, delay))
}

/// Whether the recordings can show a body, and nothing that was asked for stands in its place.
fn may_be_heated(fit: &Fit<'_>, recordings: &[Recording]) -> bool {
    let rises = |time: &Vec<f64>| time.windows(2).all(|pair| pair[1] > pair[0]);
    let can_show = |one: &Recording| one.load.is_none() && one.time.as_ref().is_some_and(rises);
    let is_open = fit.options.dynamics == Dynamics::Auto
        && fit.thermal == Thermal::None
        && !fit.options.asks_after()
        && fit.prior.is_none();
    is_open && recordings.iter().all(can_show) && fit.repeats.iter().all(can_show)
}

fn validation(model: &Model) -> Option<&Validation> {
    model.fit.as_ref()?.validation.as_ref()
}

/// Whether a body is worth its constants: with it, what was left out is predicted better, and what
/// was fitted is followed better. Parts of few branches say less than whole ones.
fn is_worth(warm: &Model, cold: &Model) -> bool {
    let (Some(with), Some(without)) = (validation(warm), validation(cold)) else {
        return false;
    };
    let is_whole = with.whole_branches && without.whole_branches;
    let most = match is_whole && !cold.is_timed() {
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
}
