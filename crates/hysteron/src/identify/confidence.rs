//! What the data say of the weights, and what not.

use super::Watch;
use super::problem::{Fitted, Problem};
use crate::Result;
use serde::{Deserialize, Serialize};

/// What the data say of the weights, and what not.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Confidence {
    /// Branches of the input.
    pub branches: usize,
}

/// x
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Factor {
    /// x
    pub offset: f64,
}

pub(super) fn of(problem: &Problem, _fitted: &Fitted, _watch: Watch<'_>) -> Result<Confidence> {
    Ok(Confidence {
        branches: problem.experiment.branches(),
    })
}
