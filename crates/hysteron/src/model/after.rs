//! Creep and lag, the stages after the operators.

use serde::{Deserialize, Serialize};

/// One term of the creep: a first-order lag of the operators' sum, which is added to it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct CreepTerm {
    /// Share of the operators' sum that creeps; 0 or more.
    pub coefficient: f64,
    /// Time constant in seconds; above zero.
    pub tau: f64,
}

/// The terms in the form that the core needs, with the time constant of the lag.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct After {
    pub(crate) coefficients: Vec<f64>,
    pub(crate) taus: Vec<f64>,
    pub(crate) lag: f64,
}

impl After {
    pub(crate) fn new(terms: &[CreepTerm], lag: f64) -> Self {
        Self {
            coefficients: terms.iter().map(|term| term.coefficient).collect(),
            taus: terms.iter().map(|term| term.tau).collect(),
            lag,
        }
    }

    pub(crate) fn terms(&self) -> Vec<CreepTerm> {
        let pairs = self.coefficients.iter().zip(&self.taus);
        pairs
            .map(|(&coefficient, &tau)| CreepTerm { coefficient, tau })
            .collect()
    }

    pub(crate) fn is_none(&self) -> bool {
        self.taus.is_empty() && self.lag == 0.0
    }

    pub(crate) fn creep(&self) -> hysteron_core::Creep<'_, f64> {
        hysteron_core::Creep {
            coefficients: &self.coefficients,
            taus: &self.taus,
        }
    }
}
