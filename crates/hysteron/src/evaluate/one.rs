//! Forward and inverse tests of a model on one recording.

use crate::error::Result;
use crate::identify::{find_rest, find_start};
use crate::model::{BandEvaluation, Inverse, Model, Policy, Start, State, Surroundings};
use crate::recording::Recording;
use crate::series::Errors;
use crate::series::range;
use crate::series::{NOISE, Turning};
use hysteron_core::Solution;

/// A model begins elsewhere than its actuator did if it errs so many times less from another start.
/// Under another load a start explains a little that is none.
pub(crate) const OTHER_START: f64 = 1.5;

/// The output stands still while it is within this share of its range from a turning point. The
/// value is twice the noise: after a reversal, the inverse is back on the branch only when the
/// output has moved further than the noise.
const STILL: f64 = 2.0 * NOISE;

/// Forward and inverse tests of a model on a recording, or on several. The series of the model are
/// empty where only errors were asked for ([`crate::evaluate_errors`]). Of several recordings they
/// stand one after the other, and errors are over all samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// Modelled output, one value per sample.
    pub output_model: Vec<f64>,
    /// Modelled against measured output.
    pub forward: Errors,
    /// Number of inputs outside the plane.
    pub clipped: usize,
    /// For a start that was unknown: the number of samples at the beginning of each recording from
    /// which it was estimated, all together.
    pub estimated_from: Option<usize>,
    /// Of each recording the drive at which the body was at rest before it, found from its
    /// beginning; `None` for that of the first sample, and for a model without a body.
    pub rests: Vec<Option<f64>>,
    /// Whether this is a recording that the model was fitted to. Then the errors say how well the
    /// model fits, not how well it predicts.
    pub was_fitted: bool,
    /// Whether this recording was not fitted, but widened the band. Then the band was made to hold
    /// it.
    pub seen_for_band: bool,
    /// The prediction band; `None` for a model without confidence.
    pub band: Option<BandEvaluation>,
    /// The inverse test, or the reason why there is none (for example negative weights).
    pub inverse: std::result::Result<InverseEvaluation, String>,
}

/// The inverse test with both policies.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseEvaluation {
    /// Whether the measured output moves at each sample; false in the dead band after a reversal.
    pub moving: Vec<bool>,
    /// Policy of the chapter, equation (14): the input is held while the target is constant or goes
    /// back by no more than [`NOISE`].
    pub hold: InverseRun,
    /// Policy *anticipate*: the input crosses the dead band as soon as it is known that the target
    /// reverses.
    pub anticipate: InverseRun,
}

/// One run of the inverse over the measured output.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseRun {
    /// Modelled input, one value per sample.
    pub input_model: Vec<f64>,
    /// Number of targets that the model cannot reach.
    pub out_of_reach: usize,
    /// Errors over all samples.
    pub all: Errors,
    /// Errors over the samples where the output moves; `None` if it never does.
    pub moving: Option<Errors>,
    /// Errors over the samples in the dead band; `None` if there are none.
    pub dead_band: Option<Errors>,
}

/// The evaluation, with what `keep` keeps of each series of the model.
pub(super) fn keeping(
    model: &Model,
    recording: &Recording,
    start: Start,
    keep: fn(Vec<f64>) -> Vec<f64>,
) -> Result<Evaluation> {
    recording.check()?;
    model.check_units(recording)?;
    let recording = &*model.delay().of_recording(recording);
    let recording = &*model.rested_from(start, recording)?;
    let (begin, estimated_from) = begin(model, recording, start)?;
    let (output_model, clipped) = model.run_over(&mut begin.clone(), recording)?;
    let forward = compare(&recording.output, &output_model);
    let mut band = BandEvaluation::new(model, &begin, recording, &output_model)?;
    if let Some(band) = &mut band {
        band.half_width = keep(std::mem::take(&mut band.half_width));
    }
    let output_model = keep(output_model);
    let behind = model.behind_body(recording)?;
    let inner = model.without_body();
    let inverse = match inner.inverse() {
        Ok(inverse) => Ok(evaluate_inverse(&inner, &inverse, &begin, &behind, keep)?),
        Err(error) => Err(error.to_string()),
    };
    let fit = model.fit.as_ref();
    Ok(Evaluation {
        was_fitted: fit.is_some_and(|fit| fit.was_fitted_to(recording)),
        seen_for_band: fit.is_some_and(|fit| fit.was_seen_for_band(recording)),
        band,
        output_model,
        forward,
        clipped: clipped.low + clipped.high,
        estimated_from,
        rests: vec![recording.rest],
        inverse,
    })
}

/// The state in which the model begins, and the number of samples from which it was estimated.
pub(crate) fn begin(
    model: &Model,
    recording: &Recording,
    start: Start,
) -> Result<(State, Option<usize>)> {
    Ok(match start {
        Start::Fitted => (model.start(), None),
        Start::Off => (model.off(), None),
        Start::On => (model.saturated(), None),
        Start::Rest => {
            let (state, samples) = find_rest(model, recording)?;
            (state, Some(samples))
        }
        Start::Unknown => {
            let (found, samples) = find_start(model, recording)?;
            let state = model.restore(&found.turning_points, found.input)?;
            (state, Some(samples))
        }
    })
}

fn evaluate_inverse(
    model: &Model,
    inverse: &Inverse<'_>,
    begin: &State,
    recording: &Recording,
    keep: fn(Vec<f64>) -> Vec<f64>,
) -> Result<InverseEvaluation> {
    let (low, high) = range(&recording.output);
    let tolerance = NOISE * (high - low);
    let moving = moving(&recording.output, tolerance, STILL * (high - low));
    let around = Surroundings::from_recording(model, recording);
    let run = |policy: Policy| -> Result<InverseRun> {
        let mut state = begin.clone();
        let targets = &recording.output;
        let headings = policy.headings(targets, tolerance);
        let (mut input_model, mut out_of_reach) = (Vec::with_capacity(targets.len()), 0);
        let take = |solution: Solution<f64>| {
            input_model.push(solution.input);
            out_of_reach += usize::from(solution.status.is_out_of_reach());
        };
        inverse.each_headed(&mut state, targets, &headings, tolerance, around, take)?;
        Ok(InverseRun {
            all: compare(&recording.input, &input_model),
            moving: Errors::between(&recording.input, &input_model, |n| moving[n]),
            dead_band: Errors::between(&recording.input, &input_model, |n| !moving[n]),
            input_model: keep(input_model),
            out_of_reach,
        })
    };
    let hold = run(Policy::Hold)?;
    let anticipate = run(Policy::Anticipate)?;
    Ok(InverseEvaluation {
        moving,
        hold,
        anticipate,
    })
}

/// Whether the output moves at each sample. It stands still around a turning point, while it is
/// within `still` of it.
fn moving(output: &[f64], noise: f64, still: f64) -> Vec<bool> {
    let mut turning = Turning::new(noise);
    let mut moving = vec![true; output.len()];
    let turns: Vec<usize> = output
        .iter()
        .filter_map(|&y| turning.push(y))
        .map(|(n, _)| n)
        .collect();
    if turns.is_empty() {
        moving.fill(false);
    }
    // Look at most as far as the neighbouring turning points. The samples beyond belong to those.
    let last = output.len() - 1;
    let ends: Vec<usize> = [0].into_iter().chain(turns).chain([last]).collect();
    for (n, &turn) in ends.iter().enumerate().skip(1) {
        let next = ends.get(n + 1).copied().unwrap_or(last);
        let still = |at: &usize| (output[*at] - output[turn]).abs() <= still;
        let before = (ends[n - 1]..=turn).rev().take_while(still);
        for at in before.chain((turn..=next).take_while(still)) {
            moving[at] = false;
        }
    }
    moving
}

/// Errors over all samples. A recording has at least one sample.
pub(crate) fn compare(measured: &[f64], modelled: &[f64]) -> Errors {
    Errors::between(measured, modelled, |_| true).unwrap_or(Errors {
        rmse: 0.0,
        max_abs: 0.0,
        nrmse_percent: None,
        samples: 0,
    })
}
