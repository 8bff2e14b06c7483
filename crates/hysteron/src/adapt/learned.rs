//! What an estimator made of recordings, compared with the model left alone.

use super::session::SELDOM;
use super::{
    AdaptOptions, Adapted, Begun, Compared, Drift, EstimatorOptions, OutcomeCounts, ShiftFound,
    Stuck, no_samples,
};
use crate::error::Result;
use crate::model::{FitSummary, Model, Start};
use crate::recording::{Origin, Recording};
use crate::series::clipped::clipped;
use crate::series::{CutOff, Errors, mean_and_deviation, range};
use hysteron_core::{Adaptation, Learning, Method, Outcome};
use serde_json::json;
use std::ops::Range;

/// Differences below this share are rounding, because two ways to sum have different orders.
pub(super) const ROUNDING: f64 = 1e-9;

/// A model that errs by this share of its range more than it did where learning began is spoilt, if
/// that is all that it learned.
const SPOILT: f64 = 0.01;

/// A model that gains less than this share of the error is not worth a change.
const WORTH: f64 = 0.01;

/// Learning that leaves more than this share of the error gains little.
const GAINS: f64 = 0.9;

/// [`Adapted::worse`].
fn is_worse(late: Option<&Compared>, changed: bool, range: (f64, f64)) -> bool {
    match late {
        Some(late) => {
            let (loss, (off, on)) = (late.loss(range), range);
            let least = WORTH * late.fixed.rmse / (on - off).abs();
            loss > ROUNDING || changed && loss >= -least.max(ROUNDING)
        }
        // Nothing says that it is better.
        None => changed,
    }
}

/// Whether learning gained much over the last third of the samples: while it lasted, and as the last
/// model runs over them again. It does where a plant has changed. A hum can be followed, but not
/// learned.
fn is_of_use(latest: Option<&Compared>, again: Option<&Compared>) -> bool {
    let gains = |with: &Compared| with.adapting.rmse < GAINS * with.fixed.rmse;
    latest.is_none_or(gains) && again.is_none_or(gains)
}

/// Whether the axis of the `offline` model has moved.
fn shifted(found: Option<&ShiftFound>, offline: &Model) -> bool {
    let plane = offline.plane();
    let least = ROUNDING * (plane.max() - plane.min());
    found.is_some_and(|found| found.shift.abs() > least)
}

/// What an estimator made of recordings.
pub(super) struct Learned {
    /// Where the operators started, and the model left alone.
    pub(super) begun: Begun,
    pub(super) last: Model,
    pub(super) learned: Vec<Learning<f64>>,
    /// The outputs of the last model, run again from there.
    pub(super) again: Vec<f64>,
    pub(super) probation: usize,
    /// How many of the last samples have an output that seems to stand still.
    pub(super) still: usize,
    /// The samples over which the output was held.
    pub(super) held: Vec<Range<usize>>,
    /// As [`Adapted::covered`].
    pub(super) covered: f64,
    pub(super) shares: Vec<(&'static str, f64)>,
    /// As [`Adapted::session`].
    pub(super) session: bool,
    pub(super) shift: Option<ShiftFound>,
    pub(super) options: EstimatorOptions,
}

impl Learned {
    /// Lets all outputs pass the stages behind the operators of `model`.
    pub(super) fn pass(&mut self, model: &Model, recordings: &[Recording]) {
        let learned = self.learned.iter().map(|learning| learning.output);
        let learned: Vec<f64> = learned.collect();
        for (learning, output) in self
            .learned
            .iter_mut()
            .zip(model.behind_operators(recordings, &learned))
        {
            learning.output = output;
        }
        self.begun.output = model.behind_operators(recordings, &self.begun.output);
        self.again = model.behind_operators(recordings, &self.again);
    }

    /// Compares it with the model left alone. `joined` are the recordings one after the other.
    pub(super) fn judged(self, joined: &Recording, options: &AdaptOptions) -> Result<Adapted> {
        let Self {
            begun,
            mut last,
            mut learned,
            again,
            ..
        } = self;
        let (offline, fixed) = (begun.model, begun.output);
        let count = joined.len();
        let output_model: Vec<f64> = learned.iter().map(|learning| learning.output).collect();
        for learning in &mut learned[count - self.still..] {
            learning.outcome = Outcome::OutputStuck;
        }
        let outcomes = learned.iter().map(|learning| learning.outcome);
        let mut outcomes: Vec<Outcome> = outcomes.collect();
        let stuck = Stuck::all(&outcomes, joined, &fixed, self.still, &self.held);
        for n in self.held.iter().cloned().flatten() {
            (learned[n].outcome, outcomes[n]) = (Outcome::OutputStuck, Outcome::OutputStuck);
        }
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
        // Where many readings were rejected, the others flatter what learned.
        let rejected = last_third
            .iter()
            .filter(|n| outcomes[**n] == Outcome::Rejected);
        let latest = match rejected.count() * SELDOM > last_third.len() {
            true => compare(&|n| last_third.binary_search(&n).is_ok()),
            false => late,
        };
        let again_late = beside_fixed(&again, &is_late);
        let again_first = beside_fixed(&again, &|n| third(0).contains(&n));
        let late_outputs = (0..count).filter(|n| is_late(*n)).map(|n| joined.output[n]);
        let (_, late_spread) = mean_and_deviation(&late_outputs.collect::<Vec<_>>());
        let again = Errors::between(&joined.output, &again, |_| true).ok_or_else(no_samples)?;
        last.fit = Some(summary(
            &last,
            &offline,
            joined,
            options,
            self.options.described(),
            (&again, counts, begun.start, self.session),
        ));
        let drift = Drift::between(&offline, &last, self.shift.as_ref());
        let changed = drift.is_change() || shifted(self.shift.as_ref(), &offline);
        // A load goes on moving: its last shift is not that of the samples before.
        let stays = self.shift.is_none();
        let range = offline.output_range();
        let ends_worse = again_late.is_some_and(|again| again.loss(range) > ROUNDING);
        // A model of another session has not been learned: it was judged by the whole loop.
        let worse = match self.session {
            // Where it lost at the beginning, it may be a sensor that ends.
            true => ends_worse || again_first.is_some_and(|first| first.loss(range) > ROUNDING),
            false => {
                is_worse(late.as_ref(), changed, range)
                    || late.is_some_and(|late| late.says_nothing(late_spread))
                    || stays && ends_worse
                    || stays
                        && again_first.is_some_and(|first| first.loss(range) > SPOILT)
                        && !is_of_use(latest.as_ref(), again_late.as_ref())
            }
        };
        Ok(Adapted {
            worse,
            drift,
            stuck,
            cut_off: inside(&offline, clipped(&joined.input, &joined.output)),
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
            again_first,
            late_spread,
            start: begun.taken,
            covered: self.covered,
            shares: self.shares,
            session: self.session,
            one_load: false,
            shift: self.shift,
            options: self.options,
        })
    }
}

/// The summary for the file of the adapted model.
fn summary(
    model: &Model,
    offline: &Model,
    recording: &Recording,
    options: &AdaptOptions,
    described: serde_json::Value,
    (again, counts, start, session): (&Errors, OutcomeCounts, Start, bool),
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
            "session": session,
            "from": offline.fit.as_ref().map(|fit| json!({
                "file": fit.file, "sha256": fit.sha256, "samples": fit.samples, "rmse": fit.rmse,
            })),
        }),
    );
    FitSummary {
        start,
        open_at_start: 0,
        samples: again.samples,
        rmse: again.rmse,
        max_abs: again.max_abs,
        nrmse_percent: again.nrmse_percent.unwrap_or_default(),
        weights_not_zero: model.weights().iter().filter(|mu| **mu != 0.0).count(),
        simulated: before.simulated || recording.origin == Origin::Simulated,
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

/// [`Adapted::covered`], by inputs as the operators see them.
pub(super) fn covered(model: &Model, inputs: &[f64]) -> f64 {
    let (plane, (low, high)) = (model.plane(), range(inputs));
    let seen = high.min(plane.max()) - low.max(plane.min());
    (seen / (plane.max() - plane.min())).max(0.0)
}

/// The end of a sensor that the model goes beyond. Where the model ends as well, it may be a stop,
/// which is to be learned.
fn inside(model: &Model, end: Option<CutOff>) -> Option<CutOff> {
    let (off, on) = model.output_range();
    let beyond = model.usual_tolerance();
    let (least, most) = (off.min(on) + beyond, off.max(on) - beyond);
    end.filter(|end| least < end.value && end.value < most)
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
