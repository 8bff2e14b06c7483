//! The record of a fit in the model file: options, data and errors.

use crate::model::confidence::Confidence;
use crate::model::smooth::Smooth;
use crate::recording::Recording;
use serde::{Deserialize, Serialize};

/// How the weights are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Solver {
    /// Non-negative least squares: a monotone model, which has an inverse.
    #[default]
    Nnls,
    /// Ordinary least squares, as in the chapter. If there are several solutions, the one of
    /// smallest norm. The weights can have either sign, which a material with a butterfly loop
    /// needs. Such a model usually has no inverse.
    Ols,
}

/// State of the operators before the first sample of each recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Start {
    /// All operators off, as after the lowest input.
    #[default]
    Off,
    /// All operators on, as after the highest input.
    On,
    /// The state that the model's fit found; all operators off for a model without one. A fit
    /// itself cannot start from it.
    Fitted,
    /// All operators off, then at rest at an input that the fit finds. From there the first input
    /// of any recording is reached. What it finds is the state that the model's fit found.
    Rest,
    /// Unknown: the initial states of operators that the first sample does not determine are
    /// estimated together with the weights.
    Unknown,
}

impl Start {
    /// The word for it, as in files and options.
    ///
    /// ```
    /// assert_eq!(hysteron::Start::Rest.name(), "rest");
    /// ```
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::On => "on",
            Self::Fitted => "fitted",
            Self::Rest => "rest",
            Self::Unknown => "unknown",
        }
    }

    /// From where.
    ///
    /// ```
    /// assert_eq!(hysteron::Start::Off.words(), "with all operators off");
    /// ```
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Off => "with all operators off",
            Self::On => "with all operators on",
            Self::Fitted => "from the start of its fit",
            Self::Rest => "from a rest before the first sample",
            Self::Unknown => "from a start that is found",
        }
    }
}

/// A reading that does not belong to its recording. A fit that is robust gives it no weight.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Outlier {
    /// Index of the recording, from 0.
    pub recording: usize,
    /// Index of the sample, from 0.
    pub sample: usize,
    /// How far the output is from where its neighbours say, in its unit.
    pub by: f64,
}

/// A file that a fit has seen.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SeenFile {
    /// Its path, as given by the caller.
    pub file: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

impl SeenFile {
    /// The file that a recording was read from, if any.
    pub(crate) fn from_recording(recording: &Recording) -> Option<Self> {
        recording.source.as_ref().map(|source| Self {
            file: source.path.display().to_string(),
            sha256: source.sha256.clone(),
        })
    }
}

/// How a model was obtained, as stored in the model file.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct FitSummary {
    /// How the weights were found.
    pub solver: Solver,
    /// Strengths of the smoothness.
    pub smooth: Smooth,
    /// Ridge on the weights, relative to the mean diagonal element of the Gram matrix.
    pub ridge: f64,
    /// State of the operators that was assumed before each recording.
    pub start: Start,
    /// Number of operators whose state the first sample of a recording does not determine. Only
    /// `start` decides it.
    pub open_at_start: usize,
    /// Number of samples fitted.
    pub samples: usize,
    /// Root mean squared error over these samples, in the output's unit.
    pub rmse: f64,
    /// Largest absolute error, in the output's unit.
    pub max_abs: f64,
    /// `rmse` in percent of the measured range.
    pub nrmse_percent: f64,
    /// Number of weights that are not zero.
    pub weights_not_zero: usize,
    /// Readings that had no weight. The errors do not count them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub outliers: Vec<Outlier>,
    /// Whether the data came from a simulated plant.
    pub simulated: bool,
    /// The file fitted; the first one if there were several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// SHA-256 of its bytes, in hexadecimal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
    /// The other files fitted together with it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub other_files: Vec<String>,
    /// SHA-256 of the bytes of each of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub other_sha256: Vec<String>,
    /// Files that were not fitted, but widened the band.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub repeats: Vec<SeenFile>,
    /// How smoothness and levels were chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub validation: Option<super::Validation>,
    /// How well the data determine the weights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confidence: Option<Confidence>,
    /// All other entries of the model file under `fit`.
    #[serde(flatten)]
    pub other: std::collections::BTreeMap<String, serde_json::Value>,
}

impl FitSummary {
    /// What the white noise of the readings does not explain of `rmse`, in the output's unit: the
    /// model errs by it. `None` for a fit without confidence.
    #[must_use]
    pub fn misfit(&self) -> Option<f64> {
        let noise = self.confidence.as_ref()?.sensor;
        Some((self.rmse.powi(2) - noise.powi(2)).max(0.0).sqrt())
    }

    /// Where the operators rested before the recording, in the unit of the input; `None` for
    /// another start.
    pub(crate) fn rest(&self) -> Option<[f64; 2]> {
        let rest = self.other.get("rest").filter(|_| self.start == Start::Rest);
        serde_json::from_value(rest?.clone()).ok()
    }

    /// Root mean squared error on what took no part in the fit, in the output's unit: on what was
    /// held out of it, and on the branches that the choice of levels and smoothness left out; the
    /// larger of both. `None` where nothing was.
    #[must_use]
    pub fn held_out(&self) -> Option<f64> {
        let apart = self
            .other
            .get("hold_out")
            .map(|entry| &entry["model"]["rmse"]);
        let apart = apart.and_then(serde_json::Value::as_f64);
        let chosen = self.validation.as_ref();
        let chosen = chosen.filter(|found| found.criterion == super::Criterion::LeftOut);
        let errors = apart.into_iter().chain(chosen.map(|found| found.rmse));
        // What a file says is believed only if it can be an error: it is squared elsewhere.
        errors
            .filter(|rmse| (0.0..=1e140).contains(rmse))
            .reduce(f64::max)
    }

    /// Whether the recording comes from a file that was fitted, by the digest of that file. A model
    /// file of an earlier version knows only the first one of several.
    #[must_use]
    pub fn was_fitted_to(&self, recording: &Recording) -> bool {
        let mut fitted = self.sha256.iter().chain(&self.other_sha256);
        let digest = recording.source.as_ref().map(|source| &source.sha256);
        digest.is_some_and(|digest| fitted.any(|other| other == digest))
    }

    /// Whether the recording comes from a file that widened the band, by the digest of that file.
    #[must_use]
    pub fn was_seen_for_band(&self, recording: &Recording) -> bool {
        let digest = recording.source.as_ref().map(|source| &source.sha256);
        digest.is_some_and(|digest| self.repeats.iter().any(|seen| seen.sha256 == *digest))
    }
}
