//! Forward and inverse tests of a model on a recording.
use crate::metrics::Errors;

/// Forward and inverse tests of a model on one recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// Modelled output, one value a sample.
    pub output_model: Vec<f64>,
    /// Modelled against measured output.
    pub forward: Errors,
    /// The inverse test, or why there is none (for example weights below zero).
    pub inverse: Result<InverseEvaluation, String>,
}

/// The inverse test with both policies.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseEvaluation {
    /// Whether the measured output moves at each sample (false: dead band).
    pub moving: Vec<bool>,
    /// The chapter's policy: the input rests while the target rests.
    pub hold: InverseRun,
    /// The dead band is crossed as soon as the target is known to reverse.
    pub anticipate: InverseRun,
}

/// One run of the inverse over the measured output.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseRun {
    /// Modelled input, one value a sample.
    pub input_model: Vec<f64>,
    /// Over all samples.
    pub all: Errors,
    /// Over the samples where the output moves.
    pub moving: Errors,
    /// Over the samples in the dead band; `None` where there is none.
    pub dead_band: Option<Errors>,
}
