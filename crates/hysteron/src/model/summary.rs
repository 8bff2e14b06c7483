//! How a model was obtained, as it stands in the model file.

use crate::model::confidence::Confidence;
use serde::{Deserialize, Serialize};

/// How the weights are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Solver {
    /// Non-negative least squares: a monotone model, which has an inverse.
    #[default]
    Nnls,
    /// Plain least squares, the chapter's; of all solutions that of smallest norm. Weights of
    /// either sign, which a material with a butterfly loop needs; as a rule without an inverse.
    Ols,
}

/// Where the operators stand before the first sample of each recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Start {
    /// All off, as after the lowest input.
    #[default]
    Off,
    /// All on, as after the highest input.
    On,
    /// Not known: what the operators that the input has not reached yet contribute is estimated
    /// with the weights.
    Unknown,
}

/// How a model was obtained; it goes into the model file.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct FitSummary {
    /// How the weights were found.
    pub solver: Solver,
    /// Strength of the smoothness.
    pub smooth: f64,
    /// Where the operators were taken to stand before each recording.
    pub start: Start,
    /// Operators that the first sample of a recording leaves open: on or off there by `start`
    /// alone.
    pub open_at_start: usize,
    /// Samples fitted.
    pub samples: usize,
    /// Root mean squared error over them, in the output's unit.
    pub rmse: f64,
    /// Largest absolute error, in the output's unit.
    pub max_abs: f64,
    /// `rmse` in percent of the measured range.
    pub nrmse_percent: f64,
    /// Weights that are not zero.
    pub weights_not_zero: usize,
    /// Whether the data came from a simulated plant.
    pub simulated: bool,
    /// The file fitted, the first where there were several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// SHA-256 of its bytes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
    /// The other files fitted with it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub other_files: Vec<String>,
    /// How smoothness and levels were chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub validation: Option<super::Validation>,
    /// What the data say, and what not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confidence: Option<Confidence>,
    /// What else a model file says of its fit.
    #[serde(flatten)]
    pub other: std::collections::BTreeMap<String, serde_json::Value>,
}
