//! What every figure reads: models and their residuals in the words and units that are shown.

use crate::clock::clock;
use crate::error::ReportError;
use crate::number::difference;
use crate::quantity::Labelled;
use hysteron::{Forward, Origin, Recording, Verdict};
use std::borrow::Cow;

/// One model's run over the recording.
#[derive(Debug, Clone, Copy)]
pub struct NamedForward<'a> {
    /// The model, for example the name of its file.
    pub name: &'a str,
    /// Its output, and its errors.
    pub forward: &'a Forward,
    /// Whether it is good enough; the page shows that of the best.
    pub verdict: Option<&'a Verdict>,
}

/// Models, ready to be drawn.
pub(crate) struct View<'a> {
    pub(super) recording: &'a Recording,
    pub(super) models: &'a [NamedForward<'a>],
    pub(super) input: Labelled,
    pub(super) output: Labelled,
    pub(super) time: Cow<'a, [f64]>,
    pub(super) time_label: Labelled,
    /// Modelled minus measured output of each model.
    pub(super) residuals: Vec<Vec<f64>>,
}

impl<'a> View<'a> {
    /// The parts, once they fit together.
    pub(crate) fn new(
        recording: &'a Recording,
        models: &'a [NamedForward<'a>],
    ) -> Result<Self, ReportError> {
        if models.is_empty() {
            return Err(ReportError::NoModel);
        }
        let expected = recording.input.len();
        let outputs = models.iter().map(|m| m.forward.output_model.len());
        let modelled = outputs.map(|found| ("output_model", found));
        let mut lengths = modelled.chain([("recording.output", recording.output.len())]);
        if let Some((series, found)) = lengths.find(|(_, found)| *found != expected) {
            return Err(ReportError::Length {
                series,
                expected,
                found,
            });
        }
        let label = |quantity, fallback| Labelled::first([quantity, quantity], fallback);
        let (time, time_label) = clock(recording);
        let residuals = models
            .iter()
            .map(|model| difference(&model.forward.output_model, &recording.output))
            .collect();
        Ok(Self {
            recording,
            models,
            input: label(&recording.input_quantity, "input"),
            output: label(&recording.output_quantity, "output"),
            time,
            time_label,
            residuals,
        })
    }

    /// The model of least error.
    pub(super) fn best(&self) -> &NamedForward<'a> {
        let first = &self.models[0];
        self.models.iter().fold(first, |best, model| {
            match model.forward.errors.rmse < best.forward.errors.rmse {
                true => model,
                false => best,
            }
        })
    }

    pub(super) fn is_simulated(&self) -> bool {
        self.recording.origin == Origin::Simulated
    }
}
