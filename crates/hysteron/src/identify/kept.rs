//! The start that a model keeps, and the errors of a fit from that start.

use crate::error::Result;
use crate::identify::changed::on_grid;
use crate::identify::history::{self, find_start};
use crate::identify::options::FitOptions;
use crate::identify::rest::after;
use crate::model::{FitSummary, Model, Start, Surroundings};
use crate::recording::{Recording, one_speed};
use crate::series::{Errors, different_branches};
use serde_json::json;
use std::collections::HashSet;

/// The model with the start that was chosen, or found before its recordings. It stands in the model
/// file, so whoever reads the file starts where the fit did.
///
/// An unknown start is found from the beginning of the first recording. A model keeps one start. If
/// off or on explain all recordings better, it keeps that.
///
/// # Errors
/// As [`Model::run_in`].
pub(super) fn with_start(
    model: Model,
    recordings: &[Recording],
    options: &FitOptions,
) -> Result<Model> {
    match options.start {
        Start::Off | Start::Fitted => return model.with_start(None),
        Start::On => {
            let on = model.saturated();
            return at_first(model.starting_from(&on)?, recordings);
        }
        Start::Rest => {
            let inputs = options.rest.unwrap_or_default();
            let seen = inputs.map(on_grid(model.spacing(), model.plane()));
            let rested = after(&model, seen)?;
            let mut model = match rested == model.off() {
                true => model.with_start(None)?,
                false => at_first(model.starting_from(&rested)?, recordings)?,
            };
            if let Some(fit) = &mut model.fit {
                fit.other.insert("rest".into(), json!(inputs));
            }
            return Ok(model);
        }
        Start::Unknown => {}
    }
    let (found, samples) = find_start(&model, &*model.rested(&recordings[0])?)?;
    let mut best = model.with_start(Some(found))?;
    // With one recording, the search has had both as candidates.
    if recordings.len() > 1 {
        let on = best.saturated();
        let others = [
            best.clone().with_start(None)?,
            best.clone().starting_from(&on)?,
        ];
        let mut least = squares(&best, recordings)?;
        for other in others {
            let error = squares(&other, recordings)?;
            if error < least {
                (best, least) = (other, error);
            }
        }
    }
    if let Some(fit) = &mut best.fit {
        let (rmse, percent) = (fit.rmse, fit.nrmse_percent);
        let said = json!({"samples": samples, "free_rmse": rmse, "free_nrmse_percent": percent});
        fit.other.insert("start_found".into(), said);
    }
    Ok(best)
}

/// A start before the first input has to explain several recordings better by this share.
const WORSE: f64 = 0.01;

/// The model with its start moved to the first input of the first recording: an inverse and a loop
/// begin there, as the actuator did. Others that begin elsewhere may lead to other branches; if all
/// then err more by this share, the start stays as it was.
fn at_first(model: Model, recordings: &[Recording]) -> Result<Model> {
    let first = model.rested(&recordings[0])?.part(0..1);
    let around = Surroundings::from_recording(&model, &first);
    let seen = model.seen(&first.input, around)?;
    let mut state = model.start();
    model.operators().step(&mut state.operators, seen[0])?;
    let moved = model.clone().starting_from(&state)?;
    // One recording goes on from there as it did.
    let is_kept = recordings.len() > 1
        && squares(&moved, recordings)? > (1.0 + WORSE) * squares(&model, recordings)?;
    Ok(if is_kept { model } else { moved })
}

/// The sum of the squared errors from the start that the model keeps.
fn squares(model: &Model, recordings: &[Recording]) -> Result<f64> {
    let mut sum = 0.0;
    for recording in &*model.all_rested(recordings)? {
        sum += history::squares(model, model.start(), recording)?;
    }
    Ok(sum)
}

/// The entry of a fit's record with the number of branches that are unlike each other.
pub(crate) const DIFFERENT: &str = "different_branches";

/// Writes how many branches of the recordings are unlike each other into the record of the fit.
pub(super) fn tell_different(model: &mut Model, recordings: &[Recording]) {
    if let Some(fit) = &mut model.fit {
        let count = different_branches(recordings.iter().map(|one| &one.input[..]));
        fit.other.insert(DIFFERENT.into(), count.into());
    }
}

/// The entries of a fit's record with the speed of the input, if all was recorded at one, and with
/// the lag of its sensor that was undone.
const SPEED: &str = "one_speed";
pub(crate) const UNDONE_LAG: &str = "sensor_lag";

/// The speed of the input, if all that was fitted had one.
pub(crate) fn speed_fitted(fit: &FitSummary) -> Option<f64> {
    fit.other.get(SPEED)?.as_f64()
}

/// Writes how the recordings came about into the record of the fit, as far as the verdict on others
/// asks for it.
pub(super) fn tell_recorded(model: &mut Model, recordings: &[Recording]) {
    let Some(fit) = &mut model.fit else { return };
    if let Some(speed) = one_speed(recordings) {
        fit.other.insert(SPEED.into(), json!(speed));
    }
    if let Some(undone) = recordings.first().and_then(|first| first.undone) {
        fit.other.insert(UNDONE_LAG.into(), json!(undone));
    }
}

/// The entry of a fit's record with the drives at which the body was at rest before each recording;
/// null for that of its first sample.
const RESTS: &str = "rests";

impl FitSummary {
    /// The drives at which the body was at rest before each recording that was fitted
    /// ([`crate::Evaluation::rests`]); empty where each was that of the first sample.
    #[must_use]
    pub fn rests(&self) -> Vec<Option<f64>> {
        let rests = self.other.get(RESTS).and_then(|rests| rests.as_array());
        let rests = rests.map(|rests| rests.iter().map(serde_json::Value::as_f64).collect());
        rests.unwrap_or_default()
    }
}

/// Writes the errors from the start that the model keeps into the record of its fit, over those of
/// all samples that are `fitted`. Outliers do not count.
///
/// # Errors
/// As [`Model::run_in`].
pub(crate) fn tell_errors(
    model: &mut Model,
    recordings: &[Recording],
    fitted: impl Fn(usize) -> bool,
) -> Result<()> {
    let outliers = model.fit.iter().flat_map(|fit| &fit.outliers);
    let left_out: HashSet<(usize, usize)> = outliers.map(|o| (o.recording, o.sample)).collect();
    let (mut measured, mut modelled, mut before) = (Vec::new(), Vec::new(), 0);
    let rested = model.all_rested(recordings)?;
    let rests: Vec<Option<f64>> = rested.iter().map(|one| one.rest).collect();
    for (n, recording) in rested.iter().enumerate() {
        let (output, _) = model.run_over(&mut model.start(), recording)?;
        let counts = |sample| fitted(before + sample) && !left_out.contains(&(n, sample));
        for (sample, h) in output.into_iter().enumerate().filter(|(n, _)| counts(*n)) {
            measured.push(recording.output[sample]);
            modelled.push(h);
        }
        before += recording.len();
    }
    let errors = Errors::between(&measured, &modelled, |_| true);
    if let (Some(fit), Some(errors)) = (&mut model.fit, errors) {
        fit.rmse = errors.rmse;
        fit.max_abs = errors.max_abs;
        fit.nrmse_percent = errors.nrmse_percent.unwrap_or_default();
        match model.thermal.is_some() && rests.iter().any(Option::is_some) {
            true => fit.other.insert(RESTS.into(), json!(rests)),
            false => fit.other.remove(RESTS),
        };
    }
    Ok(())
}

/// Tells the error on what was left out behind the stages, in the same measure as that of the fit.
/// It was found with the stages undone, where noise is larger, by as much as that of the fit was.
pub(crate) fn tell_left_out(model: &mut Model) {
    let Some(fit) = &mut model.fit else { return };
    let undone = fit.other.remove("undone");
    let undone = undone.and_then(|found| found["rmse"].as_f64());
    let (Some(undone), Some(found)) = (undone, &mut fit.validation) else {
        return;
    };
    let share = (fit.rmse / undone).min(1.0);
    found.rmse *= share;
    // In percent of what was measured, and not of what the operators gave.
    found.nrmse_percent = found.rmse * fit.nrmse_percent / fit.rmse;
    for score in &mut found.scores {
        score.rmse *= share;
    }
}
