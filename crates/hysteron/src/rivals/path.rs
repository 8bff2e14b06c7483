//! On which branch each sample is, and the branches that were measured.

use super::curve::Curve;
use crate::recording::Recording;
use crate::series::{NOISE, branch_spans, range};
use std::ops::Range;

/// What a predictor is fitted to: a recording, or a part of one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured<'a> {
    pub(crate) input: &'a [f64],
    pub(crate) output: &'a [f64],
}

impl<'a> From<&'a Recording> for Measured<'a> {
    fn from(recording: &'a Recording) -> Self {
        Self {
            input: &recording.input,
            output: &recording.output,
        }
    }
}

/// A part of the input between two reversals.
#[derive(Debug, Clone)]
pub(super) struct Leg {
    /// Its samples. The reversal at its end is among them; the one at its beginning is not.
    pub(super) samples: Range<usize>,
    pub(super) rises: bool,
    /// The input at the reversal before it, or the first input.
    pub(super) reversal: f64,
    /// The input at its end.
    pub(super) end: f64,
}

/// The legs of an input. Reversals up to [`NOISE`] of the range are noise.
pub(super) fn legs(input: &[f64]) -> Vec<Leg> {
    legs_beyond(input, NOISE)
}

/// The legs of an input, without reversals up to this share of the range.
pub(super) fn legs_beyond(input: &[f64], share: f64) -> Vec<Leg> {
    let (low, high) = range(input);
    let leg = |samples: Range<usize>| {
        let reversal = input[samples.start.saturating_sub(1)];
        let end = input[samples.end - 1];
        Leg {
            rises: end >= reversal,
            samples,
            reversal,
            end,
        }
    };
    branch_spans(input, share * (high - low)).map(leg).collect()
}

/// A leg with the output measured along it.
#[derive(Debug, Clone)]
pub(super) struct Branch {
    pub(super) rises: bool,
    pub(super) reversal: f64,
    pub(super) end: f64,
    pub(super) curve: Curve,
}

/// The branches of one recording, without reversals up to this share of the range. The curve of
/// each begins at its reversal. A branch of a single sample is a jump, and left out as long as
/// there are others.
pub(super) fn measured(recording: Measured<'_>, share: f64) -> Vec<Branch> {
    let legs = legs_beyond(recording.input, share);
    let is_jump = |leg: &Leg| leg.samples.len() < 2;
    let only_jumps = legs.iter().all(is_jump);
    let kept = legs.iter().filter(|leg| only_jumps || !is_jump(leg));
    let branch = |leg: &Leg| {
        let with_reversal = leg.samples.start.saturating_sub(1)..leg.samples.end;
        let point = |n: usize| (recording.input[n], recording.output[n]);
        Branch {
            rises: leg.rises,
            reversal: leg.reversal,
            end: leg.end,
            curve: Curve::new(with_reversal.map(point).collect()),
        }
    };
    kept.map(branch).collect()
}

/// The branches of all recordings.
pub(super) fn all_measured(recordings: &[Measured<'_>]) -> Vec<Branch> {
    let branches = recordings.iter().flat_map(|r| measured(*r, NOISE));
    branches.collect()
}
