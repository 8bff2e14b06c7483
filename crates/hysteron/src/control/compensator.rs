//! A hysteresis model inside a control loop. It predicts the output at the measured input, and its
//! inverse gives the input for a target.
//!
//! These are two states of one model. The first state follows the measured input; it is used to
//! predict the output and to learn. The second state follows the inputs that the inverse has asked
//! for, as in the chapter's compensator. If the inverse started from the measured input instead,
//! each overshoot of the loop behind it would make it cross the dead band again.
//!
//! But weights that learn cause a problem: a turning point asked for with old weights stays in the
//! memory of the inverse until it is wiped out. So with a learning model, the inverse restarts from
//! the measured input wherever the target turns. There it has to cross the dead band anyway.

use crate::adapt::{Adaptive, AdaptiveLoad};
use crate::error::Result;
use crate::model::{Model, Policy, Sample, Sign, State, Wanted};
use crate::series::Turning;
use hysteron_core::{Direction, Outcome, Solution, Target};

/// Learning moves the expected output slightly up and down. While the target itself has not turned,
/// the inverse crosses the dead band only if the difference exceeds this many tolerances.
const NOT_TURNED: f64 = 8.0;

/// Number of samples after a jump of the input during which the model does not learn.
const JUMP: u32 = 10;

/// A hysteresis model and its inverse in the loop, fixed or adaptive.
#[derive(Debug, Clone)]
pub struct Compensator {
    kind: Kind,
    /// State of the inverse; `None` before the first sample.
    wanted: Option<State>,
    /// The branch that the target is on.
    target: Option<Turning>,
    /// The last input that the model followed.
    input: Option<f64>,
    /// Number of samples until learning continues.
    resting: u32,
}

#[derive(Debug, Clone)]
enum Kind {
    Fixed { model: Box<Model>, state: State },
    Adaptive(Box<Adaptive>),
    Load(Box<AdaptiveLoad>),
}

impl Compensator {
    /// A model that does not change. It starts as the model does ([`Model::start`]).
    ///
    /// # Errors
    /// As [`Model::inverse`], for a model that has no inverse.
    pub fn fixed(model: &Model) -> Result<Self> {
        model.inverse()?;
        Ok(Self::new(Kind::Fixed {
            model: Box::new(model.clone()),
            state: model.start(),
        }))
    }

    /// A model that learns while it runs.
    #[must_use]
    pub fn adaptive(adaptive: Adaptive) -> Self {
        Self::new(Kind::Adaptive(Box::new(adaptive)))
    }

    /// A model that follows the shift of its axis by an unknown load while it runs.
    #[must_use]
    pub fn load(adaptive: AdaptiveLoad) -> Self {
        Self::new(Kind::Load(Box::new(adaptive)))
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

    /// Moves the model to `input`. Returns the output expected there and, for a model that learns
    /// from the measured output, what was done with that measurement. `dt` is the time since the
    /// sample before.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for numbers that are not finite.
    pub(super) fn follow(
        &mut self,
        input: f64,
        dt: Option<f64>,
        measured: Option<f64>,
    ) -> Result<(f64, Option<Outcome>)> {
        let from = self.input.replace(input).unwrap_or(input);
        match (&mut self.kind, measured) {
            (Kind::Fixed { model, state }, _) => {
                let sample = Sample {
                    input,
                    dt,
                    load: None,
                };
                Ok((model.step(state, sample)?.output, None))
            }
            (Kind::Load(adaptive), measured) => {
                let sample = Sample {
                    input,
                    dt,
                    load: None,
                };
                let Some(measured) = measured else {
                    return Ok((adaptive.simulate(sample)?, None));
                };
                let learning = adaptive.step(sample, measured)?;
                Ok((learning.output, Some(learning.outcome)))
            }
            (Kind::Adaptive(adaptive), measured) => {
                let offline = adaptive.offline();
                // Stages in front of the operators have inputs of another kind.
                let jumps = offline.is_plain() && (input - from).abs() > offline.plane().step();
                self.resting = match jumps {
                    true => JUMP,
                    false => self.resting.saturating_sub(1),
                };
                let sample = Sample {
                    input,
                    dt,
                    load: None,
                };
                let Some(measured) = measured.filter(|_| self.resting == 0) else {
                    return Ok((adaptive.simulate(sample)?, None));
                };
                let learning = adaptive.step(sample, measured)?;
                Ok((learning.output, Some(learning.outcome)))
            }
        }
    }

    /// Finds the input that gives `target`, starting from the last input asked for. The heading of
    /// the target is used by *anticipate*. Reversals of the target up to `tolerance` are not
    /// followed. `next` are the targets after this one, each after the time `dt`, for a fixed model
    /// with a thermal body.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a target that is not finite.
    pub(super) fn solve(
        &mut self,
        target: f64,
        heading: Option<Direction>,
        tolerance: f64,
        dt: Option<f64>,
        next: &[f64],
    ) -> Result<Solution<f64>> {
        let branch = self.target.get_or_insert_with(|| Turning::new(tolerance));
        let turns = branch.push(target).is_some();
        let branch = branch.branch();
        if turns && !matches!(self.kind, Kind::Fixed { .. }) {
            self.set_out_again();
        }
        let (state, sign) = match &self.kind {
            Kind::Fixed { model, state } => (state.clone(), model.sign()),
            Kind::Adaptive(adaptive) => (adaptive.state().clone(), adaptive.offline().sign()),
            Kind::Load(adaptive) => (adaptive.state().clone(), adaptive.offline().sign()),
        };
        let wanted = self.wanted.get_or_insert(state);
        let rises = wanted.is_rising() == (sign == Sign::Positive);
        let turned = match branch {
            Some((branch, _)) => rises != (branch == Direction::Rising),
            None => false,
        };
        let asked = tolerance;
        let tolerance = match heading {
            None if !turned => NOT_TURNED * tolerance,
            _ => tolerance,
        };
        let after: Vec<Wanted> =
            match &self.kind {
                Kind::Fixed { model, .. } if model.thermal.is_some() => {
                    let policy = match heading {
                        Some(_) => Policy::Anticipate,
                        None => Policy::Hold,
                    };
                    // *Hold* has no headings.
                    let headings = policy.headings(next, asked).into_iter();
                    let ahead = headings.chain(std::iter::repeat(None)).zip(next).map(
                        |(heading, &target)| Wanted {
                            dt,
                            ..Target::new(target).heading(heading).tolerance(asked).into()
                        },
                    );
                    ahead.collect()
                }
                _ => Vec::new(),
            };
        let target = Target::new(target).heading(heading).tolerance(tolerance);
        let wanted_now = Wanted {
            dt,
            ..target.into()
        };
        match &self.kind {
            Kind::Fixed { model, .. } => model.inverse()?.step_ahead(wanted, wanted_now, &after),
            Kind::Adaptive(adaptive) => adaptive.solve_from(wanted, wanted_now),
            Kind::Load(adaptive) => adaptive.solve_from(wanted, wanted_now),
        }
    }

    /// Restarts the inverse from the last measured input. While the input is not measured, it may
    /// go anywhere, and the inputs asked for in that time may not have been reached.
    pub(super) fn set_out_again(&mut self) {
        self.wanted = None;
    }

    /// The model whose weights adapt, if this compensator has one.
    #[must_use]
    pub fn adapting(&self) -> Option<&Adaptive> {
        match &self.kind {
            Kind::Fixed { .. } | Kind::Load(_) => None,
            Kind::Adaptive(adaptive) => Some(adaptive),
        }
    }

    /// The model that follows an unknown load, if this compensator has one.
    #[must_use]
    pub fn following(&self) -> Option<&AdaptiveLoad> {
        match &self.kind {
            Kind::Load(adaptive) => Some(adaptive),
            Kind::Fixed { .. } | Kind::Adaptive(_) => None,
        }
    }
}
