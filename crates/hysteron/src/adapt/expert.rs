//! A learner of a mixture, with a state of its own and what it had learned before.

use super::learns::Learns;
use super::refit::Core;
use crate::error::Result;
use crate::model::OperatorState;

/// A learner that shares no state with the others.
#[derive(Debug, Clone)]
pub(super) struct Expert {
    pub(super) name: &'static str,
    pub(super) core: Core,
    pub(super) state: OperatorState,
    pub(super) learns: Learns,
    /// What it had learned at the last turning points of the input, the last one first.
    pub(super) kept: [Kept; 2],
}

impl Expert {
    /// An expert at `state`, which may be one of other weights. `core` is one whose weights can be
    /// written.
    pub(super) fn new(
        name: &'static str,
        (own, learns): (Core, Learns),
        core: &Core,
        state: &OperatorState,
    ) -> Result<Self> {
        let mut kept = Kept {
            core: core.clone(),
            weights: learns.weights(),
            offset: learns.level(),
        };
        kept.take(&learns);
        let mut expert = Self {
            name,
            core: own,
            state: state.clone(),
            learns,
            kept: [kept.clone(), kept],
        };
        expert.rebase()?;
        Ok(expert)
    }

    /// Moves its state to where another one is.
    pub(super) fn move_to(&mut self, state: &OperatorState) -> Result<()> {
        self.state.clone_from(state);
        self.rebase()
    }

    /// Uses what has come since its last refit. Returns whether its weights changed.
    pub(super) fn refit(&mut self) -> Result<bool> {
        let changed = self.learns.refit(&mut self.core)?;
        if changed {
            self.rebase()?;
        }
        Ok(changed)
    }

    /// Returns to its last good weights.
    pub(super) fn roll_back(&mut self) -> Result<()> {
        self.learns.roll_back(&mut self.core)?;
        self.rebase()
    }

    /// Takes weights that others found, unless they cannot be summed.
    pub(super) fn set(&mut self, weights: Vec<f64>, offset: f64) -> Result<()> {
        if self.core.set_weights(&weights).is_ok() {
            self.learns = Learns::Fixed(weights, offset);
            self.rebase()?;
        }
        Ok(())
    }

    fn rebase(&mut self) -> Result<()> {
        Ok(self.core.rebase(&mut self.state)?)
    }
}

/// Weights that nothing changes, and the offset.
#[derive(Debug, Clone)]
pub(super) struct Kept {
    core: Core,
    pub(super) weights: Vec<f64>,
    pub(super) offset: f64,
}

impl Kept {
    /// Takes what `learns` has learned, unless its weights cannot be summed.
    pub(super) fn take(&mut self, learns: &Learns) {
        let (weights, offset) = (learns.weights(), learns.level());
        if self.core.set_weights(&weights).is_ok() {
            (self.weights, self.offset) = (weights, offset);
        }
    }

    /// The output at a state, which may be one of other weights.
    pub(super) fn output(&self, state: &mut OperatorState) -> Result<f64> {
        self.core.rebase(state)?;
        Ok(self.core.output(state) + self.offset)
    }
}
