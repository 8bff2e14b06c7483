//! Fits a model while part of the data is held out, and tests it there beside simple rivals.

use crate::advice::Advice;
use crate::error::{Error, Result};
use crate::identify::Fit;
use crate::identify::kept::tell_errors;
use crate::model::{Model, Start};
use crate::recording::{HoldOut, Recording, Split, split_each, split_ends};
use crate::remedy::{Remedy, Setting};
use crate::rivals::{Rival, RivalKind};
use crate::series::Errors;
use serde::Serialize;

/// The rivals beside every model.
const RIVALS: [RivalKind; 2] = [RivalKind::Line, RivalKind::Interpolation];

/// The errors over samples that took no part in a fit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HeldOut {
    /// Errors of the model.
    pub model: Errors,
    /// Errors of simple predictors, fitted to the same samples as the model.
    pub rivals: Vec<RivalErrors>,
    /// Whether no dead time, ring, lag or body was looked for, because more than the end of a
    /// recording was held out.
    pub without_dynamics: bool,
    /// Whether a share of the branches was held out at the end ([`Recording::split_end`]), and not
    /// spread over each recording.
    pub at_end: bool,
}

/// Stands in the record of a fit that was tested on a part of its recordings alone.
pub(crate) const PART: &str = "hold_out_part";

/// The errors of one simple predictor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RivalErrors {
    /// Its name, such as `straight line` ([`RivalKind::name`](crate::RivalKind::name)).
    pub name: &'static str,
    /// Its errors over the same samples.
    #[serde(flatten)]
    pub errors: Errors,
}

impl HeldOut {
    /// The rivals with a smaller error than the model. Such a model has learned little.
    pub fn better(&self) -> impl Iterator<Item = &RivalErrors> {
        let model = self.model.rmse;
        self.rivals.iter().filter(move |r| r.errors.rmse < model)
    }

    /// A warning for each rival that is better, and for what was not looked for.
    pub fn advice(&self) -> impl Iterator<Item = Advice> {
        let model = self.model.nrmse_percent.unwrap_or_default();
        let better = self.better().map(move |rival| Advice::RivalWins {
            name: rival.name.to_owned(),
            rival: rival.errors.nrmse_percent.unwrap_or_default(),
            model,
        });
        better.chain(self.without_dynamics.then_some(Advice::NoDynamics))
    }

    /// Reads the result from the entry `hold_out` of a fit's record ([`crate::FitSummary::other`]);
    /// `None` for anything else.
    #[must_use]
    pub fn from_record(entry: &serde_json::Value) -> Option<Self> {
        let errors = |entry: &serde_json::Value| serde_json::from_value(entry.clone()).ok();
        let rival = |entry: &serde_json::Value| {
            let name = entry["name"].as_str()?;
            Some(RivalErrors {
                name: RIVALS.iter().find(|kind| kind.name() == name)?.name(),
                errors: errors(entry)?,
            })
        };
        let rivals = entry["rivals"].as_array()?.iter().map(rival);
        Some(Self {
            model: errors(&entry["model"])?,
            rivals: rivals.collect::<Option<_>>()?,
            without_dynamics: entry["without_dynamics"].as_bool().unwrap_or_default(),
            at_end: entry["at_end"].as_bool().unwrap_or_default(),
        })
    }

    /// Writes the result into the record of the fit, as `hold_out`. The model file keeps it.
    pub fn record_in(&self, model: &mut Model) {
        if let (Some(fit), Ok(value)) = (&mut model.fit, serde_json::to_value(self)) {
            fit.other.insert("hold_out".into(), value);
        }
    }
}

/// Fits a model to what is not held out, and tests it on the rest. What is held out takes no part
/// in the fit, nor in what the fit chooses. The result is also written into the record of the fit,
/// as `hold_out`.
///
/// The model runs over the whole input, and is compared where the output was held out. A percentage
/// is of the range of the whole output.
///
/// A model that depends on time needs every sample before a row. So [`HoldOut::Branches`] holds out
/// the last branches where such a stage is asked for; and where one is looked for, if these are
/// like the rest: within its range of inputs, and over half of it. Else they are spread.
///
/// If rows at the beginning or in the middle are held out, the state of the operators after them is
/// not known. Then the start is [`Start::Unknown`], whatever `fit` says.
///
/// Rows of several recordings are counted through all of them, one after the other. Where a part
/// and other recordings are held out, the errors are over both.
///
/// ```
/// use hysteron::{Fit, HoldOut, Recording, fit_holding_out};
/// let input: Vec<f64> = (0..600).map(|n| (1.0 - (f64::from(n) * 0.05).cos()) * 30.0).collect();
/// let mut y = 0.0_f64;
/// let output = input.iter().map(|x| { y = y.clamp(x - 20.0, *x); y }).collect();
/// let recording = Recording::new(input, output)?;
/// let fit = Fit::new().levels(12).bootstrap(0);
/// let (_, held_out) = fit_holding_out(&fit, &recording, &HoldOut::Branches(0.2))?;
/// assert!(held_out.model.nrmse_percent.is_some_and(|percent| percent < 1.0));
/// assert!(held_out.rivals[0].errors.rmse > 5.0 * held_out.model.rmse); // a straight line
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// - As [`Fit::run`] and [`Recording::split`].
/// - [`Error::Fit`] for a stage that depends on time and is asked for, if rows are held out that
///   are not at the end. [`crate::Dynamics::Auto`] then looks for nothing.
pub fn fit_holding_out(
    fit: &Fit<'_>,
    recordings: &(impl AsRef<[Recording]> + ?Sized),
    what: &HoldOut,
) -> Result<(Model, HeldOut)> {
    let recordings = recordings.as_ref();
    let others = what.recordings();
    others.iter().try_for_each(|other| other.check())?;
    let again = |other: &&Recording| recordings.iter().any(|one| one.has_samples_of(other));
    if others.iter().any(again) {
        let words = "take another recording for {}, or a part of this one";
        let part = Setting::any("hold-out");
        let what = "a recording that is held out is among those fitted".to_owned();
        return Err(Error::Fit(what).remedied(Remedy::new(words, [part])));
    }
    if what.part().is_none() {
        let mut model = fit.run(recordings)?;
        let report = tested(&model, recordings, &others)?;
        report.record_in(&mut model);
        return Ok((model, report));
    }
    let has_dynamics = |one: &Recording| one.time.is_some() && one.load.is_none();
    let looks_for_dynamics = fit.looks_for_dynamics() && recordings.iter().all(has_dynamics);
    // What depends on time needs every sample before a row, so the last branches are held out.
    let ends = match looks_for_dynamics || fit.asks_for_time() {
        true => split_ends(recordings, what)?,
        false => None,
    };
    let (splits, at_end) = match ends {
        Some((ends, are_alike)) if are_alike || fit.asks_for_time() => (ends, true),
        _ => (split_each(recordings, what)?, false),
    };
    let training: Vec<Recording> = splits.iter().flat_map(|s| s.training.clone()).collect();
    let begins_inside = splits.iter().any(|split| split.begins_inside);
    let mut fit = match begins_inside {
        true => fit.clone().start(Start::Unknown),
        false => fit.clone(),
    };
    let ends_alone = splits.iter().all(|split| split.is_head);
    let without_dynamics = !ends_alone && looks_for_dynamics;
    if !ends_alone {
        // What nobody asked for could not be judged.
        fit = fit.without_auto_dynamics();
        if fit.asks_for_time() {
            return Err(Error::Fit(
                "a model that depends on time needs every sample before a row: hold out rows at \
                 the end, a share of the branches, or another recording"
                    .into(),
            ));
        }
    }
    let mut model = fit.run(&training)?;
    // The state was found after rows that were held out. Before them it is not known.
    if splits[0].held_out[0]
        && model
            .fit
            .as_ref()
            .is_some_and(|fit| fit.start == Start::Unknown)
    {
        model = model.with_start(None)?;
    }
    count_in_file(&mut model, &splits);
    let held: Vec<bool> = splits
        .into_iter()
        .flat_map(|split| split.held_out)
        .collect();
    let acting = model.delay().of_recordings(recordings);
    tell_errors(&mut model, &acting, |n| !held[n])?;
    // The other recordings come behind those fitted, and all of them is held out.
    let all: Vec<&Recording> = recordings.iter().chain(others.iter().copied()).collect();
    let outputs = simulated(&model, &all)?;
    let is_held = |n: usize| held.get(n).copied().unwrap_or(true);
    let mut report = compare(&training, &all, &outputs, is_held)?;
    (report.without_dynamics, report.at_end) = (without_dynamics, at_end);
    report.record_in(&mut model);
    if let Some(fit) = &mut model.fit
        && others.is_empty()
    {
        fit.other.insert(PART.into(), true.into());
    }
    Ok((model, report))
}

/// Tests a model on recordings that took no part in its fit, beside rivals fitted to the recordings
/// that did. The model starts where its fit did, see [`Start::Fitted`].
///
/// # Errors
/// As [`crate::evaluate_from`]; [`Error::Fit`] if there is no recording.
pub fn held_out(
    model: &Model,
    fitted: &(impl AsRef<[Recording]> + ?Sized),
    held_out: &(impl AsRef<[Recording]> + ?Sized),
) -> Result<HeldOut> {
    let recordings: Vec<&Recording> = held_out.as_ref().iter().collect();
    recordings.iter().try_for_each(|one| one.check())?;
    tested(model, fitted.as_ref(), &recordings)
}

fn tested(model: &Model, fitted: &[Recording], recordings: &[&Recording]) -> Result<HeldOut> {
    let outputs = simulated(model, recordings)?;
    compare(fitted, recordings, &outputs, |_| true)
}

/// The measured outputs of all recordings, and those of the model from where it starts.
fn simulated(model: &Model, recordings: &[&Recording]) -> Result<(Vec<f64>, Vec<f64>)> {
    let (mut measured, mut modelled) = (Vec::new(), Vec::new());
    for recording in recordings {
        let recording = &*model.delay().of_recording(recording);
        let recording = model.rested(recording)?;
        measured.extend_from_slice(&recording.output);
        modelled.extend(model.run_over(&mut model.start(), &recording)?.0);
    }
    Ok((measured, modelled))
}

/// Counts the outliers of a fit to the training parts as in the whole recordings.
fn count_in_file(model: &mut Model, splits: &[Split]) {
    let mut places = Vec::new();
    for (recording, split) in splits.iter().enumerate() {
        let left = split.held_out.iter().enumerate();
        let mut left = left.filter(|(_, held)| !**held).map(|(sample, _)| sample);
        for part in &split.training {
            let samples: Vec<usize> = left.by_ref().take(part.len()).collect();
            places.push((recording, samples));
        }
    }
    for outlier in model.fit.iter_mut().flat_map(|fit| &mut fit.outliers) {
        let (recording, samples) = &places[outlier.recording];
        (outlier.recording, outlier.sample) = (*recording, samples[outlier.sample]);
    }
}

fn compare(
    training: &[Recording],
    recordings: &[&Recording],
    (measured, modelled): &(Vec<f64>, Vec<f64>),
    which: impl Fn(usize) -> bool,
) -> Result<HeldOut> {
    let nothing = || Error::Fit("nothing was held out".into());
    let model = Errors::between(measured, modelled, &which).ok_or_else(nothing)?;
    let rival = |kind: RivalKind| {
        let rival = Rival::fit(kind, training)?;
        let mut predicted = Vec::with_capacity(measured.len());
        for recording in recordings {
            predicted.extend(rival.predict(recording)?);
        }
        let errors = Errors::between(measured, &predicted, &which).ok_or_else(nothing)?;
        Ok(RivalErrors {
            name: kind.name(),
            errors,
        })
    };
    let rivals = RIVALS.into_iter().map(rival).collect::<Result<_>>()?;
    Ok(HeldOut {
        model,
        rivals,
        without_dynamics: false,
        at_end: false,
    })
}
