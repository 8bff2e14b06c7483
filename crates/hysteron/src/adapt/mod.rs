//! Adaptation: lets a model follow a plant that changes.
//!
//! This file runs an estimator over a recording: each sample is first compared with the expected
//! output, then learned from. `begun` says where the operators begin, `learned` compares what came
//! of it with the model left alone, and `adapted` is the result. `learner` is the table of learners
//! and their options, `options` what these come to for a model. `adaptive` is the model that learns
//! sample by sample: by an estimator of the core, all weights or a `basis` with few coefficients for
//! drift; or by a `refit` to the samples of a `window`, from their `sums`. `mixture` has several of
//! these side by side, each an `expert` with one of the `shares`, counts in `strokes` how far the
//! input went, and waits while it is `unsure` how the operators began; `learns` is the choice among
//! all of these. `session` finds what another session changes, from one loop. `load` and
//! `unknown_load` follow the shift of an unknown load. `counts` counts what was done with
//! the samples, `stuck` finds where a channel stood still, and `drift` tells how far the model moved.

mod adapted;
mod adaptive;
mod basis;
mod begun;
mod counts;
mod drift;
mod expert;
mod learned;
mod learner;
mod learns;
mod load;
mod mixture;
mod options;
mod refit;
mod session;
mod shares;
mod strokes;
mod stuck;
mod sums;
mod unknown_load;
mod unsure;
mod window;

pub use adapted::{Adapted, Compared};
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
use crate::model::{Model, Start};
use crate::progress::Progress;
use crate::recording::{Recording, no_recordings, one_after_the_other};
use begun::{Begun, run_from};
use hysteron_core::Outcome;
use learned::{Learned, covered};
use session::session;
use std::borrow::Cow;
use std::ops::Range;

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
    let rested = match options.learner {
        Learner::Load => Cow::Borrowed(recordings),
        _ => model.all_rested(recordings)?,
    };
    let recordings = &*rested;
    let joined = one_after_the_other(recordings).ok_or_else(no_recordings)?;
    let mut adapted = match options.learner {
        Learner::Load => unknown_load::adapt(model, (recordings, &joined), options, progress)?,
        _ => adapt_operators(model, (recordings, &joined), options, progress)?,
    };
    adapted.one_load = model.load.is_some() && adapted.model.load.is_none();
    Ok(adapted)
}

/// As [`adapt`], for the learners of weights and offset. `joined` are the recordings one after the
/// other.
fn adapt_operators(
    model: &Model,
    (recordings, joined): (&[Recording], &Recording),
    options: &AdaptOptions,
    progress: Progress<'_>,
) -> Result<Adapted> {
    // The operators between the stages of a model learn, and what it gives behind them is judged.
    if model.is_plain() || model.load.is_some() {
        return learn(model, (recordings, joined), options, progress)?.judged(joined, options);
    }
    let seen = recordings.iter().map(|recording| {
        let seen = model.recording_within(recording)?;
        Ok(seen.into_owned())
    });
    let seen: Vec<Recording> = seen.collect::<Result<_>>()?;
    let seen_joined = one_after_the_other(&seen).ok_or_else(no_recordings)?;
    let mut learned = learn(&model.within(), (&seen, &seen_joined), options, progress)?;
    learned.pass(model, recordings);
    let mut adapted = learned.judged(joined, options)?;
    let mut whole = model.around_within(adapted.model.operators().clone())?;
    whole.fit = adapted.model.fit.take();
    adapted.model = adapted.model.starts(whole, Start::Fitted)?;
    Ok(adapted)
}

/// Runs an estimator over recordings, for a model of operators alone or with a load. `joined` are
/// the recordings one after the other.
fn learn(
    model: &Model,
    (recordings, joined): (&[Recording], &Recording),
    options: &AdaptOptions,
    progress: Progress<'_>,
) -> Result<Learned> {
    refuse_unusable(model)?;
    let learned_by = options.resolve(model, joined)?;
    let mut adaptive = options.learner(model, learned_by)?;
    let offline = adaptive.offline().clone();
    let others = [Start::Off, Start::On, Start::Rest];
    let begun = Begun::new(&offline, recordings, options.start, &others)?;
    let offline = &begun.model;
    let count = joined.len();
    let probation = on_probation(learned_by, count);
    let still = match learned_by.watches() {
        true => stuck::at_the_end(offline, recordings, &begun.output),
        false => 0,
    };
    // The last samples, which are not to be learned from.
    let unsure = probation.max(still);
    let mut learned = Vec::with_capacity(count);
    let (mut last, mut all_held) = (None, Vec::new());
    for recording in recordings {
        adaptive.start_from(offline.state_at(begun.start).operators)?;
        // Those up to the last samples, and these.
        let sure = (count - unsure).saturating_sub(learned.len());
        let sure = sure.min(recording.len());
        let first = learned.len();
        let held = match learned_by.watches() {
            true => stuck::held_outputs(recording, &begun.output[first..first + recording.len()]),
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
                let (input, output) = (&recording.input[part.clone()], &recording.output[part]);
                if is_held {
                    adaptive.freeze(true);
                }
                learned.extend(adaptive.run(input, output, Progress::new(&told))?);
                if is_held {
                    adaptive.freeze(false);
                }
            }
        }
    }
    // One that found a channel still has undone what it learned there, the samples before too.
    if adaptive.stuck().is_some() {
        last = Some((adaptive.model()?, adaptive.shares()));
    }
    let (last, shares) = last.ok_or_else(no_samples)?;
    let last = offline.starts(last, begun.start)?;
    let again = run_from(&last, Start::Fitted, recordings)?;
    let outcomes = learned.iter().map(|learning| learning.outcome);
    let outcomes: Vec<Outcome> = outcomes.take(count - unsure).collect();
    let stood = outcomes.iter().any(|outcome| outcome.is_stuck());
    let other = match options.learner {
        Learner::Auto if !stood && still == 0 && all_held.is_empty() => {
            session(&begun, (&again, &outcomes), (recordings, joined))?
        }
        _ => None,
    };
    let session = other.is_some();
    let (last, again) = other.unwrap_or((last, again));
    Ok(Learned {
        covered: covered(offline, &joined.input),
        shares: if session { Vec::new() } else { shares },
        begun,
        last,
        again,
        learned,
        probation,
        still,
        held: all_held,
        session,
        shift: None,
        options: learned_by,
    })
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
