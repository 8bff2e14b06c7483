//! Adaptation: lets a model follow a plant that changes.
//!
//! This file runs an estimator over a recording: each sample is first compared with the expected
//! output, then learned from. `learner` is the table of learners and their options, `options` what
//! these come to for a model. `adaptive` is the model that learns sample by sample: by an estimator
//! of the core, all weights or a `basis` with few coefficients for drift; or by a `refit` to the
//! samples of a `window`, from their `sums`. `mixture` has several of these side by side, each an
//! `expert` with one of the `shares`; `learns` is the choice among all of these. `load` and
//! `unknown_load` do the same for the shift of an unknown load. `counts` counts what was done with
//! the samples, `stuck` finds where a channel stood still, and `drift` tells how far the model moved.

mod adaptive;
mod basis;
mod counts;
mod drift;
mod expert;
mod learner;
mod learns;
mod load;
mod mixture;
mod options;
mod refit;
mod shares;
mod stuck;
mod sums;
mod unknown_load;
mod window;

pub use adaptive::Adaptive;
pub use basis::DriftBasis;
pub use counts::OutcomeCounts;
pub use drift::Drift;
pub use learner::{ADAPT_OPTIONS, AdaptOption, AdaptOptionKind, AdaptOptions, AdaptValue, Learner};
pub use load::AdaptiveLoad;
pub use mixture::AutoOptions;
pub use options::EstimatorOptions;
pub use refit::Refit;
pub use stuck::Stuck;
pub use unknown_load::ShiftFound;
pub use window::Window;

use crate::error::{Error, Result};
use crate::model::{FitSummary, Model, Start, Surroundings};
use crate::progress::Progress;
use crate::recording::{Recording, no_recordings, one_after_the_other};
use crate::series::{Errors, mean_and_deviation};
use hysteron_core::{Adaptation, Learning, Method, Outcome};
use serde::Serialize;
use serde_json::json;
use std::ops::Range;

/// The result of an adaptation.
#[derive(Debug, Clone, PartialEq)]
pub struct Adapted {
    /// The model with the last weights that are not on [probation](Adapted::probation). Its
    /// [`FitSummary`] gives the errors of these weights over the whole recording. The confidence of
    /// the off-line model does not hold for them and is removed. The field `adapted` records how
    /// they were obtained.
    pub model: Model,
    /// Number of samples at the end that did not change the model, because no later samples can
    /// confirm them: [`AdaptOptions::burst`], or 0 without a [`AdaptOptions::gate`].
    pub probation: usize,
    /// Output expected at each sample before the estimator learned from it.
    pub output_model: Vec<f64>,
    /// What was done with each sample.
    pub outcomes: Vec<Outcome>,
    /// How often each outcome occurred.
    pub counts: OutcomeCounts,
    /// Errors over the whole recording.
    pub whole: Compared,
    /// Errors over the first, second and last third of the samples; empty for fewer than three
    /// samples.
    pub thirds: Vec<Compared>,
    /// Errors over the last third of the samples that are not [stuck](Adapted::stuck), without the
    /// rejected readings and those on probation; [`Adapted::worse`] is based on them. `None` if there
    /// are no such samples.
    pub late: Option<Compared>,
    /// Whether the model that learned is no better than the model left alone: on the last third
    /// its errors, taken before it learned from each sample, are larger than those of the fixed
    /// model, or as large although it changed. Differences of the size of rounding do not count. Or
    /// the final weights have clearly larger errors there ([`Adapted::again_late`]).
    pub worse: bool,
    /// Errors of the final weights over the whole recording, run again from its start. These
    /// weights have seen all of it.
    pub again: Errors,
    /// The same over the samples of [`Adapted::late`], beside the fixed model.
    pub again_late: Option<Compared>,
    /// The standard deviation of the measured output there: what a constant errs. A model that errs
    /// about as much says nothing of an output that no longer follows its input; it is
    /// [worse](Adapted::worse), too.
    pub late_spread: f64,
    /// How the model has changed.
    pub drift: Drift,
    /// Where a channel stood still. What was learned from there is undone.
    pub stuck: Vec<Stuck>,
    /// The learners that [`Learner::Auto`] mixes, each with its share of the model; empty for the
    /// other learners. *trend* is the refit, and half as far beyond it as it moved in a cycle.
    pub shares: Vec<(&'static str, f64)>,
    /// What [`Learner::Load`] found; `None` for the other learners.
    pub shift: Option<ShiftFound>,
    /// The options of what learned.
    pub options: EstimatorOptions,
}

/// Errors of the adapting model, taken before it learned from each sample, beside those of the
/// fixed model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Compared {
    /// Errors of the adapting model.
    pub adapting: Errors,
    /// Errors of the model that was not adapted.
    pub fixed: Errors,
}

impl Compared {
    /// By how much the adapting model has larger errors, as a share of the model's range.
    fn loss(&self, (off, on): (f64, f64)) -> f64 {
        (self.adapting.rmse - self.fixed.rmse) / (on - off).abs()
    }

    /// Whether what learned is clearly the worse one, or says nothing of outputs of that `spread`.
    fn is_harm(&self, spread: f64) -> bool {
        self.adapting.rmse > HARM * self.fixed.rmse || self.adapting.rmse > NOTHING * spread
    }
}

impl Adapted {
    /// Measured minus expected output, for each sample of the recordings.
    #[must_use]
    pub fn errors(&self, recordings: &(impl AsRef<[Recording]> + ?Sized)) -> Vec<f64> {
        let measured = recordings.as_ref().iter().flat_map(|r| &r.output);
        let pairs = measured.zip(&self.output_model);
        pairs.map(|(measured, model)| measured - model).collect()
    }
}

/// Runs an estimator over a recording. For each sample it returns the expected output before it
/// learns from the measured one. Several recordings are parts of one experiment, such as the segments
/// of a file: the operators start anew in each, and what was learned goes on.
///
/// ```
/// use hysteron::{AdaptOptions, Model, Operator, Plane, Progress, Recording, Sign, adapt};
/// let plane = Plane::new(20.0, 80.0, 5)?;
/// let (mkp, sign) = (Operator::Mkp, Sign::Positive);
/// let model = |weight: f64| Model::new(mkp, plane, vec![weight; 15], 0.0, sign);
/// let input: Vec<f64> = (0..1000).map(|n| 50.0 - 40.0 * (0.05 * f64::from(n)).cos()).collect();
/// let output = model(1.5)?.simulate(&input)?;
/// let recording = Recording::new(input, output)?;
/// let adapted = adapt(&model(1.0)?, &recording, &AdaptOptions::default(), Progress::NONE)?;
/// let last = adapted.thirds[2];
/// assert!(last.adapting.rmse < 0.05 * last.fixed.rmse);
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// - [`Error::Recording`] for an invalid recording.
/// - [`Error::Fit`] for a model with a thermal body, for a model that depends on a load with a
///   learner other than [`Learner::Auto`], [`Learner::Refit`], [`Learner::Drift`] and
///   [`Learner::Load`], and for
///   options that the learner does not use.
/// - [`Error::Core`] for options out of range and negative weights.
/// - The error that `progress` returns.
pub fn adapt(
    model: &Model,
    recordings: &(impl AsRef<[Recording]> + ?Sized),
    options: &AdaptOptions,
    progress: Progress<'_>,
) -> Result<Adapted> {
    let recordings = recordings.as_ref();
    recordings.iter().try_for_each(Recording::check)?;
    recordings.iter().try_for_each(|r| model.check_units(r))?;
    let recordings = &*model.delay().of_recordings(recordings);
    let joined = one_after_the_other(recordings).ok_or_else(no_recordings)?;
    if options.learner == Learner::Load {
        return unknown_load::adapt(model, (recordings, &joined), options, progress);
    }
    // The operators between the stages of a model learn, and what it gives behind them is judged.
    if model.is_plain() || model.load.is_some() {
        return learn(model, recordings, options, progress)?.judged(&joined, options);
    }
    let seen = recordings.iter().map(|recording| {
        let seen = model.recording_within(recording)?;
        Ok(seen.into_owned())
    });
    let seen: Vec<Recording> = seen.collect::<Result<_>>()?;
    let mut learned = learn(&model.within(), &seen, options, progress)?;
    learned.pass(model, recordings);
    let mut adapted = learned.judged(&joined, options)?;
    let mut whole = model.around(adapted.model.operators().clone());
    whole.fit = adapted.model.fit.take();
    adapted.model = whole;
    Ok(adapted)
}

/// Runs an estimator over recordings, for a model of operators alone or with a load.
fn learn(
    model: &Model,
    recordings: &[Recording],
    options: &AdaptOptions,
    progress: Progress<'_>,
) -> Result<Learned> {
    refuse_unusable(model)?;
    let joined = one_after_the_other(recordings).ok_or_else(no_recordings)?;
    let learned_by = options.resolve(model, &joined)?;
    let mut adaptive = options.learner(model, learned_by)?;
    let offline = adaptive.offline().clone();
    let (from_on, fixed) = fixed(&offline, recordings, options.start)?;
    let count = joined.len();
    let probation = on_probation(learned_by, count);
    let still = match learned_by.watches() {
        true => stuck::at_the_end(&offline, recordings, &fixed),
        false => 0,
    };
    // The last samples, which are not to be learned from.
    let unsure = probation.max(still);
    let mut learned = Vec::with_capacity(count);
    let (mut last, mut all_held) = (None, Vec::new());
    for recording in recordings {
        match (from_on, learned.is_empty()) {
            (true, _) => adaptive.saturate()?,
            (false, true) => {}
            (false, false) => adaptive.reset()?,
        }
        // Those up to the last samples, and these.
        let sure = (count - unsure).saturating_sub(learned.len());
        let sure = sure.min(recording.len());
        let first = learned.len();
        let held = match learned_by.watches() {
            true => stuck::held_outputs(recording, &fixed[first..first + recording.len()]),
            false => Vec::new(),
        };
        all_held.extend(held.iter().map(|run| run.start + first..run.end + first));
        for part in [0..sure, sure..recording.len()] {
            let before = learned.len();
            if last.is_none() && before + unsure >= count {
                adaptive.refit()?;
                last = Some((adaptive.model()?, adaptive.shares()));
            }
            let length = part.len() as f64;
            let told = |what: &'static str, share: f64| {
                let done = before as f64 + share * length;
                progress.tell(what, done / count as f64)
            };
            // Nothing is learned from an output that was held. A learner alone sees it too late.
            for (part, is_held) in in_turn(part, &held) {
                adaptive.freeze(is_held);
                let (input, output) = (&recording.input[part.clone()], &recording.output[part]);
                learned.extend(adaptive.run(input, output, Progress::new(&told))?);
            }
            adaptive.freeze(false);
        }
    }
    // One that found a channel still has undone what it learned there, the samples before too.
    if adaptive.stuck().is_some() {
        last = Some((adaptive.model()?, adaptive.shares()));
    }
    let (last, shares) = last.ok_or_else(no_samples)?;
    Ok(Learned {
        again: run_from(&last, from_on, recordings)?,
        offline,
        last,
        learned,
        fixed,
        probation,
        still,
        held: all_held,
        shares,
        shift: None,
        options: learned_by,
    })
}

/// What an estimator made of recordings.
struct Learned {
    offline: Model,
    last: Model,
    learned: Vec<Learning<f64>>,
    /// The outputs of the model left alone.
    fixed: Vec<f64>,
    /// The outputs of the last model, run again from the start.
    again: Vec<f64>,
    probation: usize,
    /// How many of the last samples have an output that seems to stand still.
    still: usize,
    /// The samples over which the output was held.
    held: Vec<Range<usize>>,
    shares: Vec<(&'static str, f64)>,
    shift: Option<ShiftFound>,
    options: EstimatorOptions,
}

impl Learned {
    /// Lets all outputs pass the stages behind the operators of `model`.
    fn pass(&mut self, model: &Model, recordings: &[Recording]) {
        let learned = self.learned.iter().map(|learning| learning.output);
        let learned: Vec<f64> = learned.collect();
        for (learning, output) in self
            .learned
            .iter_mut()
            .zip(model.behind_operators(recordings, &learned))
        {
            learning.output = output;
        }
        self.fixed = model.behind_operators(recordings, &self.fixed);
        self.again = model.behind_operators(recordings, &self.again);
    }

    /// Compares it with the model left alone. `joined` are the recordings one after the other.
    fn judged(self, joined: &Recording, options: &AdaptOptions) -> Result<Adapted> {
        let Self {
            offline,
            mut last,
            mut learned,
            fixed,
            again,
            ..
        } = self;
        let count = joined.len();
        let output_model: Vec<f64> = learned.iter().map(|learning| learning.output).collect();
        for learning in &mut learned[count - self.still..] {
            learning.outcome = Outcome::OutputStuck;
        }
        let outcomes = learned.iter().map(|learning| learning.outcome);
        let outcomes: Vec<Outcome> = outcomes.collect();
        let stuck = Stuck::all(&outcomes, joined, &fixed, self.still, &self.held);
        for n in self.held.iter().cloned().flatten() {
            learned[n].outcome = Outcome::OutputStuck;
        }
        let outcomes: Vec<Outcome> = learned.iter().map(|learning| learning.outcome).collect();
        let counts = OutcomeCounts::of(&learned);
        let beside_fixed = |outputs: &[f64], which: &dyn Fn(usize) -> bool| {
            Some(Compared {
                adapting: Errors::between(&joined.output, outputs, which)?,
                fixed: Errors::between(&joined.output, &fixed, which)?,
            })
        };
        let compare = |which: &dyn Fn(usize) -> bool| beside_fixed(&output_model, which);
        let whole = compare(&|_| true).ok_or_else(no_samples)?;
        let third = |k: usize| k * count / 3..(k + 1) * count / 3;
        let thirds = (0..3)
            .map(|k| compare(&|n| third(k).contains(&n)))
            .collect::<Option<_>>()
            .unwrap_or_default();
        let judges = |n: usize| n + self.probation < count && outcomes[n] != Outcome::Rejected;
        let alive = |n: &usize| stuck.iter().all(|stuck| !stuck.samples.contains(n));
        let alive: Vec<usize> = (0..count).filter(alive).collect();
        let last_third = &alive[2 * alive.len() / 3..];
        let is_late = |n: usize| last_third.binary_search(&n).is_ok() && judges(n);
        let late = compare(&is_late);
        let again_late = beside_fixed(&again, &is_late);
        let late_outputs = (0..count).filter(|n| is_late(*n)).map(|n| joined.output[n]);
        let (_, late_spread) = mean_and_deviation(&late_outputs.collect::<Vec<_>>());
        let again = Errors::between(&joined.output, &again, |_| true).ok_or_else(no_samples)?;
        last.fit = Some(summary(
            &last,
            &offline,
            joined,
            options,
            self.options.described(),
            (&again, counts),
        ));
        let drift = Drift::between(&offline, &last, self.shift.as_ref());
        let changed = drift.is_change() || shifted(self.shift.as_ref(), &offline);
        // A load goes on moving: its last shift is not that of the samples before.
        let stays = self.shift.is_none();
        Ok(Adapted {
            worse: is_worse(late.as_ref(), changed, offline.output_range())
                || stays && again_late.is_some_and(|again| again.is_harm(late_spread)),
            drift,
            stuck,
            model: last,
            probation: self.probation,
            output_model,
            outcomes,
            counts,
            whole,
            thirds,
            late,
            again,
            again_late,
            late_spread,
            shares: self.shares,
            shift: self.shift,
            options: self.options,
        })
    }
}

/// The samples of a part one stretch after the other, and whether each is among the held ones.
fn in_turn(part: Range<usize>, held: &[Range<usize>]) -> Vec<(Range<usize>, bool)> {
    let mut stretches = Vec::new();
    let mut from = part.start;
    for run in held {
        let (start, end) = (run.start.max(from), run.end.min(part.end));
        if start < end {
            stretches.extend([(from..start, false), (start..end, true)]);
            from = end;
        }
    }
    stretches.push((from..part.end, false));
    stretches.retain(|(stretch, _)| !stretch.is_empty());
    stretches
}

/// How many of `count` samples are at the end and on probation.
fn on_probation(options: EstimatorOptions, count: usize) -> usize {
    match options.gate() {
        (gate, burst) if gate > 0.0 => count.min(burst as usize),
        _ => 0,
    }
}

/// Refuses weights whose squares overflow, because their errors would not be numbers, and weights
/// that are all zero, because they have no basis to adapt.
fn refuse_unusable(model: &Model) -> Result<()> {
    let size: f64 = model.weights().iter().map(|mu| mu * mu).sum();
    match size.is_finite() && size > 0.0 {
        true => Ok(()),
        false => Err(Error::Fit(
            "the model's weights are all zero, or too large to be squared: there is nothing to \
             adapt"
                .into(),
        )),
    }
}

fn no_samples() -> Error {
    Error::Fit("no samples".into())
}

/// Whether the operators start on, and the outputs of the fixed model.
fn fixed(model: &Model, recordings: &[Recording], start: Start) -> Result<(bool, Vec<f64>)> {
    let from = |on| run_from(model, on, recordings);
    let error = |output: &[f64]| {
        let pairs = recordings.iter().flat_map(|r| &r.output).zip(output);
        pairs.map(|(y, h)| (y - h).powi(2)).sum::<f64>()
    };
    match start {
        // A model that adapts starts as it is, with its operators off or on.
        Start::Off | Start::Fitted => Ok((false, from(false)?)),
        Start::On => Ok((true, from(true)?)),
        Start::Rest => Err(Error::Fit(
            "no rest is found for a model that adapts: take the start off, on or unknown".into(),
        )),
        Start::Unknown => {
            let (off, on) = (from(false)?, from(true)?);
            Ok(match error(&on) < error(&off) {
                true => (true, on),
                false => (false, off),
            })
        }
    }
}

/// The outputs of a model that starts off or on in each recording.
fn run_from(model: &Model, on: bool, recordings: &[Recording]) -> Result<Vec<f64>> {
    let mut all = Vec::new();
    for recording in recordings {
        let mut state = match on {
            true => model.saturated(),
            false => model.off(),
        };
        let (begin, around) = (all.len(), Surroundings::from_recording(model, recording));
        all.resize(begin + recording.len(), 0.0);
        model.run_in(&mut state, &recording.input, around, &mut all[begin..])?;
    }
    Ok(all)
}

/// The summary for the file of the adapted model.
fn summary(
    model: &Model,
    offline: &Model,
    recording: &Recording,
    options: &AdaptOptions,
    described: serde_json::Value,
    (again, counts): (&Errors, OutcomeCounts),
) -> FitSummary {
    let before = offline.fit.clone().unwrap_or_default();
    let source = recording.source.as_ref();
    let mut other = before.other;
    other.insert(
        "adapted".into(),
        json!({
            "method": options.learner,
            "options": described,
            "counts": counts,
            "from": offline.fit.as_ref().map(|fit| json!({
                "file": fit.file, "sha256": fit.sha256, "samples": fit.samples, "rmse": fit.rmse,
            })),
        }),
    );
    FitSummary {
        start: options.start,
        open_at_start: 0,
        samples: again.samples,
        rmse: again.rmse,
        max_abs: again.max_abs,
        nrmse_percent: again.nrmse_percent.unwrap_or_default(),
        weights_not_zero: model.weights().iter().filter(|mu| **mu != 0.0).count(),
        simulated: before.simulated || recording.origin == crate::recording::Origin::Simulated,
        file: source.map(|source| source.path.display().to_string()),
        sha256: source.map(|source| source.sha256.clone()),
        other_files: Vec::new(),
        other_sha256: Vec::new(),
        repeats: Vec::new(),
        validation: None,
        confidence: None,
        other,
        ..before
    }
}

impl EstimatorOptions {
    /// The options as a JSON object.
    fn described(&self) -> serde_json::Value {
        match self {
            Self::Fixed => json!({}),
            Self::Auto(auto) => json!({
                "gate": auto.drift.gate,
                "burst": auto.drift.burst,
                "movement": auto.drift.movement,
                "drift": described(&auto.drift),
                "increments": described(&auto.increments),
                "least-squares": auto.least_squares.as_ref().map(described),
                "refit": auto.refit,
            }),
            Self::Weights(adaptation) => described(adaptation),
            Self::Refit(refit) => json!(refit),
            Self::Shift(options) => json!({
                "noise": options.noise,
                "spread": options.spread,
                "walk": options.walk,
                "reach": options.reach,
                "dead_zone": options.dead_zone,
                "movement": options.movement,
                "gate": options.gate,
                "burst": options.burst,
            }),
        }
    }
}

/// The options as a JSON object: those of the method, and those that guard against bad readings.
fn described(options: &Adaptation<f64>) -> serde_json::Value {
    let mut object = match options.method {
        Method::Increments { gain, span } => json!({"gain": gain, "span": span}),
        Method::LeastSquares {
            forgetting,
            noise,
            spread,
            correlation,
        } => {
            json!({
                "forgetting": forgetting,
                "noise": noise,
                "spread": spread,
                "correlation": correlation,
            })
        }
    };
    object["offset_share"] = json!(options.offset_share);
    object["dead_zone"] = json!(options.dead_zone);
    object["leakage"] = json!(options.leakage);
    object["movement"] = json!(options.movement);
    object["trial"] = json!(options.trial);
    object["gate"] = json!(options.gate);
    object["burst"] = json!(options.burst);
    object
}

/// The model that learned goes on learning, so a little more than the error of the fixed one is no
/// harm. A model that is written stays as it is.
const HARM: f64 = 1.1;

/// From this share of a constant's error on, a model says nothing of the output.
const NOTHING: f64 = 0.9;

/// Differences below this share are rounding, because two ways to sum have different orders.
const ROUNDING: f64 = 1e-9;

/// [`Adapted::worse`].
fn is_worse(late: Option<&Compared>, changed: bool, range: (f64, f64)) -> bool {
    match late.map(|late| late.loss(range)) {
        Some(loss) => loss > ROUNDING || changed && loss >= -ROUNDING,
        // Nothing says that it is better.
        None => changed,
    }
}

/// Whether the axis of the `offline` model has moved.
fn shifted(found: Option<&ShiftFound>, offline: &Model) -> bool {
    let plane = offline.plane();
    let least = ROUNDING * (plane.max() - plane.min());
    found.is_some_and(|found| found.shift.abs() > least)
}
