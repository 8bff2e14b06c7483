//! The model in a loop: what it expects at the input that it is told of, and the input that it
//! wants.
//!
//! These are two states of one model. The first follows the input as measured, for prediction and
//! learning. The second follows the inputs that the inverse asked for, as in the chapter's
//! compensator: were the inverse to set out from the measured input, each overshoot of the loop
//! behind it would send it back across the dead band. But a turning point that was asked for by
//! weights long changed stays in that memory until it is wiped out. So with weights that learn the
//! inverse sets out again from the measured input wherever the target turns, when it has to cross
//! the dead band anyway.

use crate::adapt::Adaptive;
use crate::error::Result;
use crate::model::{Model, OperatorState, Operators, Sign};
use crate::series::Turning;
use hysteron_core::{Direction, Outcome, Solution, Target};

/// Weights that learn move the output that they expect a little to and fro. While the target itself
/// has not turned, the inverse goes back across the dead band only for a difference of this many
/// tolerances.
const NOT_TURNED: f64 = 8.0;

/// Samples after a jump of the input from which nothing is learned.
const JUMP: u32 = 10;

/// A hysteresis model and its inverse in the loop, fixed or adapting.
#[derive(Debug, Clone)]
pub struct Compensator {
    kind: Kind,
    /// Where the inverse stands; none before the first sample.
    wanted: Option<OperatorState>,
    /// The branch that the target is on.
    target: Option<Turning>,
    /// The last input followed.
    input: Option<f64>,
    /// Samples for which learning rests.
    resting: u32,
}

#[derive(Debug, Clone)]
enum Kind {
    Fixed {
        operators: Box<Operators>,
        state: OperatorState,
    },
    Adaptive(Box<Adaptive>),
}

impl Compensator {
    /// A model that stays as it is, from every operator off.
    ///
    /// # Errors
    /// As [`Model::inverse`], for a model that has none.
    pub fn fixed(model: &Model) -> Result<Self> {
        let operators = model.plain()?;
        operators.inverse()?;
        Ok(Self::new(Kind::Fixed {
            operators: Box::new(operators.clone()),
            state: operators.start(),
        }))
    }

    /// A model that learns.
    #[must_use]
    pub fn adaptive(adaptive: Adaptive) -> Self {
        Self::new(Kind::Adaptive(Box::new(adaptive)))
    }

    fn new(kind: Kind) -> Self {
        Self {
            kind,
            wanted: None,
            target: None,
            input: None,
            resting: 0,
        }
    }

    /// Moves to the input and gives the output expected there and what was done with the one
    /// measured, if it was shown to a model that learns.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for numbers that are not finite.
    pub(super) fn follow(
        &mut self,
        input: f64,
        measured: Option<f64>,
    ) -> Result<(f64, Option<Outcome>)> {
        let from = self.input.replace(input).unwrap_or(input);
        match (&mut self.kind, measured) {
            (Kind::Fixed { operators, state }, _) => {
                Ok((operators.step(state, input)?.output, None))
            }
            (Kind::Adaptive(adaptive), measured) => {
                self.resting = match (input - from).abs() > adaptive.offline().plane().step() {
                    true => JUMP,
                    false => self.resting.saturating_sub(1),
                };
                let Some(measured) = measured.filter(|_| self.resting == 0) else {
                    return Ok((adaptive.predict(input)?, None));
                };
                let learning = adaptive.step(input, measured)?;
                Ok((learning.output, Some(learning.outcome)))
            }
        }
    }

    /// The input that gives `target`, on the way from the last one asked for. Where the target goes
    /// next is for *anticipate*; a target that goes back by up to the `tolerance` is not followed.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a target that is not finite.
    pub(super) fn solve(
        &mut self,
        target: f64,
        heading: Option<Direction>,
        tolerance: f64,
    ) -> Result<Solution<f64>> {
        let branch = self.target.get_or_insert_with(|| Turning::new(tolerance));
        let turns = branch.push(target).is_some();
        let branch = branch.branch();
        if turns && self.adapting().is_some() {
            self.set_out_again();
        }
        let (state, sign) = match &self.kind {
            Kind::Fixed { operators, state } => (state, operators.sign()),
            Kind::Adaptive(adaptive) => (adaptive.state(), adaptive.offline().sign()),
        };
        let wanted = self.wanted.get_or_insert_with(|| state.clone());
        let rises = wanted.is_rising() == (sign == Sign::Positive);
        let turned = match branch {
            Some((branch, _)) => rises != (branch == Direction::Rising),
            None => false,
        };
        let tolerance = match heading {
            None if !turned => NOT_TURNED * tolerance,
            _ => tolerance,
        };
        let target = Target::new(target).heading(heading).tolerance(tolerance);
        match &self.kind {
            Kind::Fixed { operators, .. } => operators.inverse()?.step_operators(wanted, target),
            Kind::Adaptive(adaptive) => adaptive.solve_from(wanted, target),
        }
    }

    /// Lets the inverse set out from where the input was last seen. After a time without seeing it,
    /// the input may have been anywhere, and what was asked for in the meantime was not done.
    pub(super) fn set_out_again(&mut self) {
        self.wanted = None;
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
