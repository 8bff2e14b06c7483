//! The record of a cross-validation in the model file.

use serde::{Deserialize, Serialize};

/// The cross-validation error of one candidate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Number of levels.
    pub levels: usize,
    /// Strength of the smoothness.
    pub smooth: f64,
    /// Root mean squared error over all samples, each left out once, in the output's unit.
    pub rmse: f64,
}

/// The result of a cross-validation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Validation {
    /// Number of folds: groups of branches that were left out in turn.
    pub folds: usize,
    /// Whether whole branches were left out. With fewer than six branches, parts of branches were
    /// left out.
    pub whole_branches: bool,
    /// Cross-validation error of the candidate that was chosen, in the output's unit.
    pub rmse: f64,
    /// The same error in percent of the measured range.
    pub nrmse_percent: f64,
    /// The errors of all candidates.
    pub scores: Vec<Score>,
}

impl Validation {
    /// The scores as a table: the numbers of levels tried and the strengths of the smoothness
    /// tried, each ascending, then one row per number of levels with the error at each strength.
    /// `None` for a combination that was not tried.
    #[must_use]
    pub fn table(&self) -> (Vec<usize>, Vec<f64>, Vec<Vec<Option<f64>>>) {
        let mut levels: Vec<usize> = self.scores.iter().map(|score| score.levels).collect();
        levels.sort_unstable();
        levels.dedup();
        let mut smooth: Vec<f64> = self.scores.iter().map(|score| score.smooth).collect();
        smooth.sort_by(f64::total_cmp);
        smooth.dedup();
        let error = |levels: usize, smooth: f64| {
            let tried = |score: &&Score| score.levels == levels && score.smooth == smooth;
            self.scores.iter().find(tried).map(|score| score.rmse)
        };
        let row = |&k: &usize| smooth.iter().map(|&s| error(k, s)).collect();
        let rows = levels.iter().map(row).collect();
        (levels, smooth, rows)
    }
}
