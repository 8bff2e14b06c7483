//! The two blocks: model and inverse, with offset and sign.

use super::{Problem, Result};
use hysteron_core::{Clipped, Direction, Model, Solution, Target, Turn, turn_capacity};

pub(crate) type State = hysteron_core::State<f64, Vec<Turn<f64>>>;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// `sf_MKP`: the model, from the input to the output.
    Forward,
    /// `sf_Inverse_MKP`: the inverse, from the wanted output to the input.
    Inverse,
}

/// A model as in the FMU: `output = offset + sign · Σ μ γ`.
#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) kind: Kind,
    /// The token that the description of the FMU has too.
    pub(crate) token: String,
    /// Checksum of the model's text. Saved states belong to it.
    pub(crate) checksum: u64,
    pub(crate) model: Model<f64, Vec<f64>>,
    pub(crate) offset: f64,
    /// +1 or −1.
    pub(crate) sign: f64,
}

/// The values that a step needs, and the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Inputs {
    /// Input or target.
    pub(crate) signal: f64,
    /// Where the target goes next: 1, −1, or 0 for the policy *hold*.
    pub(crate) heading: i32,
    /// How far the target may go back and still be held, from 0.
    pub(crate) tolerance: f64,
    /// Whether all operators are on at the start.
    pub(crate) start_on: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Outputs {
    /// The output, or the input found.
    pub(crate) signal: f64,
    /// −1, 0 or 1: where the input lay, or whether the target can be reached.
    pub(crate) flag: i32,
}

impl Block {
    /// The start value in the FMU's description: the bottom of the plane, or the output with all
    /// operators off.
    pub(crate) fn inputs(&self) -> Inputs {
        let signal = match self.kind {
            Kind::Forward => self.model.plane().bottom(),
            Kind::Inverse => self.offset + self.sign * self.model.output_range().0,
        };
        Inputs {
            signal,
            heading: 0,
            tolerance: 0.0,
            start_on: false,
        }
    }

    pub(crate) fn start(&self, on: bool) -> Result<State> {
        let memory = vec![Turn::default(); turn_capacity(self.model.plane().levels())];
        let mut state = self.model.state(memory)?;
        if on {
            self.model.reset_on(&mut state)?;
        }
        Ok(state)
    }

    /// After an error the state stays as it is.
    pub(crate) fn step(&self, state: &mut State, inputs: &Inputs) -> Result<Outputs> {
        if !inputs.signal.is_finite() {
            let what = match self.kind {
                Kind::Forward => "input",
                Kind::Inverse => "target",
            };
            return Err(Problem(format!(
                "the {what} is {}, not a finite number",
                inputs.signal
            )));
        }
        match self.kind {
            Kind::Forward => {
                let step = self.model.step(state, inputs.signal)?;
                Ok(Outputs {
                    signal: self.offset + self.sign * step.output,
                    flag: match step.clipped {
                        None => 0,
                        Some(Clipped::Low) => -1,
                        Some(Clipped::High) => 1,
                    },
                })
            }
            Kind::Inverse => {
                let target = self.target(inputs);
                let Solution { input, status } = self.model.inverse()?.step(state, target)?;
                let status = match self.sign < 0.0 {
                    true => status.mirrored(),
                    false => status,
                };
                Ok(Outputs {
                    signal: input,
                    flag: status.number().into(),
                })
            }
        }
    }

    /// The target for the output without sign.
    fn target(&self, inputs: &Inputs) -> Target<f64> {
        let rising = (inputs.heading > 0) == (self.sign > 0.0);
        Target {
            output: self.sign * (inputs.signal - self.offset),
            heading: match (inputs.heading, rising) {
                (0, _) => None,
                (_, true) => Some(Direction::Rising),
                (_, false) => Some(Direction::Falling),
            },
            tolerance: inputs.tolerance,
        }
    }
}
