//! The model in a loop: what it expects at the input that it is told of, and the input that it wants.
//!
//! These are two states of one model. The first follows the input as measured, for prediction and learning. The second
//! follows the inputs that the inverse asked for, as in the chapter's compensator: were the inverse to
//! set out from the measured input, each overshoot of the loop behind it would send it back across the dead band.

use crate::{Adaptive, Model, Outcome, Policy, Result, Solution, State};

/// A hysteresis model and its inverse in the loop, fixed or adapting.
#[derive(Debug, Clone)]
pub struct Compensator {
    kind: Kind,
    /// Where the inverse stands; none before the first sample.
    wanted: Option<State>,
}

#[derive(Debug, Clone)]
enum Kind {
    Fixed { model: Box<Model>, state: State },
    Adaptive(Box<Adaptive>),
}

impl Compensator {
    /// A model that stays as it is, from every operator off.
    #[must_use]
    pub fn fixed(model: Model) -> Self {
        let state = model.start();
        Self {
            kind: Kind::Fixed {
                model: Box::new(model),
                state,
            },
            wanted: None,
        }
    }

    /// A model that learns.
    #[must_use]
    pub fn adaptive(adaptive: Adaptive) -> Self {
        Self {
            kind: Kind::Adaptive(Box::new(adaptive)),
            wanted: None,
        }
    }

    /// Moves to the input and gives the output expected there and whether anything was learned from the one measured.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for numbers that are not finite.
    pub fn follow(&mut self, input: f64, measured: Option<f64>) -> Result<(f64, bool)> {
        match (&mut self.kind, measured) {
            (Kind::Fixed { model, state }, _) => Ok((model.step(state, input)?.output, false)),
            (Kind::Adaptive(adaptive), Some(measured)) => {
                let learning = adaptive.step(input, measured)?;
                Ok((learning.output, learning.outcome == Outcome::Learned))
            }
            (Kind::Adaptive(adaptive), None) => Ok((adaptive.predict(input)?, false)),
        }
    }

    /// The input that gives `target`, on the way from the last one asked for.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a target that is not finite and weights below zero.
    pub fn solve(&mut self, target: f64, policy: Policy<f64>) -> Result<Solution<f64>> {
        match &self.kind {
            Kind::Fixed { model, state } => {
                let wanted = self.wanted.get_or_insert_with(|| state.clone());
                model.inverse()?.step(wanted, target, policy)
            }
            Kind::Adaptive(adaptive) => {
                let wanted = self.wanted.get_or_insert_with(|| adaptive.state().clone());
                adaptive.solve(wanted, target, policy)
            }
        }
    }

    /// The model that learns.
    #[must_use]
    pub fn adapting(&self) -> Option<&Adaptive> {
        match &self.kind {
            Kind::Fixed { .. } => None,
            Kind::Adaptive(adaptive) => Some(adaptive),
        }
    }
}
