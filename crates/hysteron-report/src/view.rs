//! What every figure and caption reads: the report's parts in the words and units that are shown.

use crate::quantity::Labelled;
use crate::report::Report;
use crate::source::Source;
use hysteron::{BandEvaluation, Confidence, Evaluation, InverseEvaluation, Validation};
use hysteron::{Origin, Recording};
use std::borrow::Cow;
use std::ops::Range;

/// A report, ready to be drawn.
pub(crate) struct View<'a> {
    pub(crate) recording: &'a Recording,
    pub(crate) evaluation: &'a Evaluation,
    pub(crate) source: Source<'a>,
    pub(crate) input: Labelled,
    pub(crate) output: Labelled,
    /// Seconds, or sample numbers where the recording has no time.
    pub(crate) time: Cow<'a, [f64]>,
    pub(crate) time_label: Labelled,
}

impl<'a> View<'a> {
    pub(crate) fn new(report: &Report<'a>) -> Self {
        let &Report {
            model,
            recording,
            evaluation,
            ..
        } = report;
        let source = Source::new(model);
        let samples = recording.input.len();
        let (time, name, unit) = match recording.time.as_deref() {
            Some(time) if time.len() == samples => {
                (Cow::Borrowed(time), "time", Some("s".to_owned()))
            }
            _ => (
                Cow::Owned((0..samples).map(|k| k as f64).collect()),
                "sample number",
                None,
            ),
        };
        Self {
            recording,
            evaluation,
            source,
            input: Labelled::first([&recording.input_quantity, source.input()], "input"),
            output: Labelled::first([&recording.output_quantity, source.output()], "output"),
            time,
            time_label: Labelled {
                name: name.to_owned(),
                unit,
            },
        }
    }

    pub(crate) fn inverse(&self) -> Option<&'a InverseEvaluation> {
        self.evaluation.inverse.as_ref().ok()
    }

    /// What the recording fitted says of the weights, where the model tells.
    pub(crate) fn confidence(&self) -> Option<&'a Confidence> {
        self.source.fit()?.confidence.as_ref()
    }

    /// How levels and smoothness were chosen, where the model tells.
    pub(crate) fn validation(&self) -> Option<&'a Validation> {
        let validation = self.source.fit()?.validation.as_ref();
        validation.filter(|validation| !validation.scores.is_empty())
    }

    pub(crate) fn band(&self) -> Option<&'a BandEvaluation> {
        self.evaluation.band.as_ref()
    }

    /// Lower and upper edge of the prediction band.
    pub(crate) fn band_edges(&self) -> Option<[Vec<f64>; 2]> {
        let (lower, upper) = self.band()?.ends(&self.evaluation.output_model);
        Some([lower, upper])
    }

    pub(crate) fn simulated(&self) -> bool {
        self.recording.origin == Origin::Simulated
    }

    /// What the recorded curves are called.
    pub(crate) fn recorded(&self) -> &'static str {
        if self.simulated() {
            "simulated plant"
        } else {
            "measured"
        }
    }

    /// Modelled minus recorded.
    pub(crate) fn discrepancy(modelled: &[f64], recorded: &[f64]) -> Vec<f64> {
        modelled
            .iter()
            .zip(recorded)
            .map(|(modelled, recorded)| modelled - recorded)
            .collect()
    }
}

/// Where in time a stretch of samples begins and ends: halfway to its neighbours, so that one sample has a width.
pub(crate) fn extent(time: &[f64], stretch: &Range<usize>) -> [f64; 2] {
    let between = |before: Option<usize>, after: usize| {
        let after = time.get(after).or(time.last()).copied().unwrap_or(0.0);
        before
            .and_then(|k| time.get(k))
            .map_or(after, |before| 0.5 * (before + after))
    };
    [
        between(stretch.start.checked_sub(1), stretch.start),
        between(stretch.end.checked_sub(1), stretch.end),
    ]
}

/// What stands at the corner of a figure.
pub(crate) fn note(simulated: bool) -> Option<&'static str> {
    simulated.then_some("simulated, not measured")
}
