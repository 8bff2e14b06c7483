//! The model in a loop: what it expects at the input that it is told of, and the input that it wants.

use crate::{Adaptive, Model, Outcome, Policy, Result, Solution, State};

/// A hysteresis model and its inverse in the loop, fixed or adapting.
#[derive(Debug, Clone)]
pub enum Compensator {
    /// A model that stays as it was identified.
    Fixed {
        /// The model.
        model: Box<Model>,
        /// The state that it runs in.
        state: State,
    },
    /// A model that learns.
    Adaptive(Box<Adaptive>),
}

impl Compensator {
    /// A model that stays as it is, from every operator off.
    #[must_use]
    pub fn fixed(model: Model) -> Self {
        let state = model.start();
        Self::Fixed {
            model: Box::new(model),
            state,
        }
    }

    /// A model that learns.
    #[must_use]
    pub fn adaptive(adaptive: Adaptive) -> Self {
        Self::Adaptive(Box::new(adaptive))
    }

    /// Moves to the input and gives the output expected there and whether anything was learned from the one measured.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for numbers that are not finite.
    pub fn follow(&mut self, input: f64, measured: Option<f64>) -> Result<(f64, bool)> {
        match (self, measured) {
            (Self::Fixed { model, state }, _) => Ok((model.step(state, input)?.output, false)),
            (Self::Adaptive(adaptive), Some(measured)) => {
                let learning = adaptive.step(input, measured)?;
                Ok((learning.output, learning.outcome == Outcome::Learned))
            }
            (Self::Adaptive(adaptive), None) => Ok((adaptive.predict(input)?, false)),
        }
    }

    /// The input that gives `target`; nothing moves.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a target that is not finite and weights below zero.
    pub fn solve(&self, target: f64, policy: Policy<f64>) -> Result<Solution<f64>> {
        match self {
            Self::Fixed { model, state } => model.inverse()?.solve(state, target, policy),
            Self::Adaptive(adaptive) => adaptive.solve(target, policy),
        }
    }

    /// Output with every operator off, and the weights, of a model that learns.
    #[must_use]
    pub fn adapted(&self) -> Option<(f64, Vec<f64>)> {
        match self {
            Self::Fixed { .. } => None,
            Self::Adaptive(adaptive) => Some((adaptive.offset(), adaptive.weights())),
        }
    }
}
