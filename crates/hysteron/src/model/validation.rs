//! The record of the choice of levels and smoothness in the model file.

use crate::model::smooth::Smooth;
use serde::{Deserialize, Serialize};

/// What chose among candidates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Criterion {
    /// The error on branches that were left out.
    #[default]
    LeftOut,
    /// The evidence: how probable the outputs are under the prior of the weights, whatever the
    /// weights (MacKay 1992). It decides where there are too few branches to leave some out.
    Evidence,
}

impl Criterion {
    /// What this criterion minimises.
    #[must_use]
    pub fn value(self, score: &Score) -> f64 {
        match self {
            Self::LeftOut => score.rmse,
            Self::Evidence => score.log_evidence.map_or(f64::INFINITY, |value| -value),
        }
    }

    /// Whether `value` is better than `other` by this share of the error, or, in percent, by this
    /// much in the logarithm of the evidence.
    pub(crate) fn is_worth(self, value: f64, other: f64, share: f64) -> bool {
        match self {
            _ if other.is_infinite() => value.is_finite(),
            Self::LeftOut => value < (1.0 - share) * other,
            Self::Evidence => value < other - 100.0 * share,
        }
    }
}

/// How good one candidate is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Number of levels.
    pub levels: usize,
    /// Strengths of the smoothness.
    pub smooth: Smooth,
    /// Root mean squared error in the output's unit: over all samples, each left out once. Where
    /// the evidence chose, over the samples fitted.
    pub rmse: f64,
    /// Logarithm of the evidence, up to a constant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub log_evidence: Option<f64>,
}

/// The error of a simple predictor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RivalScore {
    /// Its name, such as `straight line` ([`RivalKind::name`](crate::RivalKind::name)).
    pub name: String,
    /// Root mean squared error on what was left out, in percent of the measured range.
    pub nrmse_percent: f64,
}

/// How levels and smoothness were chosen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Validation {
    /// What chose.
    #[serde(default)]
    pub criterion: Criterion,
    /// Number of folds: groups of branches, or of parts of branches, that were left out in turn.
    pub folds: usize,
    /// Whether whole branches were left out. With fewer than six branches, parts of branches were
    /// left out.
    pub whole_branches: bool,
    /// Error of the candidate that was chosen on what was left out, in the output's unit.
    pub rmse: f64,
    /// The same error in percent of the measured range.
    pub nrmse_percent: f64,
    /// All candidates that were tried.
    pub scores: Vec<Score>,
    /// Simple predictors on the same samples left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rivals: Vec<RivalScore>,
}

impl Validation {
    /// What the criterion says of the candidate that was chosen: the smaller, the better.
    pub(crate) fn value(&self) -> f64 {
        let values = self.scores.iter().map(|score| self.criterion.value(score));
        values.fold(f64::INFINITY, f64::min)
    }

    /// The errors as a table: the numbers of levels tried and the strengths along the diagonal
    /// tried, each ascending, then one row per number of levels with the error at each strength,
    /// at the best strength across. `None` for a combination that was not tried.
    #[must_use]
    pub fn table(&self) -> (Vec<usize>, Vec<f64>, Vec<Vec<Option<f64>>>) {
        let mut levels: Vec<usize> = self.scores.iter().map(|score| score.levels).collect();
        levels.sort_unstable();
        levels.dedup();
        let mut along: Vec<f64> = self.scores.iter().map(|score| score.smooth.along).collect();
        along.sort_by(f64::total_cmp);
        along.dedup();
        let error = |levels: usize, along: f64| {
            let tried = |score: &&Score| score.levels == levels && score.smooth.along == along;
            let value = |score: &&Score| self.criterion.value(score);
            let scores = self.scores.iter().filter(tried);
            let best = scores.min_by(|a, b| value(a).total_cmp(&value(b)));
            best.map(|score| score.rmse)
        };
        let row = |&k: &usize| along.iter().map(|&s| error(k, s)).collect();
        let rows = levels.iter().map(row).collect();
        (levels, along, rows)
    }
}
