//! The blocks: model, inverse and controller, with offset and sign.

use super::by_load::ByLoad;
use super::settings::{Control, Settings};
use super::stages::Constants;
use super::state::{Loop, Mixed, State};
use super::{Problem, Result};
use crate::delay::{MOST, UnderWay};
use hysteron_core::{
    Clipped, Direction, Model, Output, Sample, Solution, StageState, Stages, Target, Turn, Wanted,
    turn_capacity,
};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// `sf_MKP`: the model, from the input to the output.
    Forward,
    /// `sf_Inverse_MKP`: the inverse, from the wanted output to the input.
    Inverse,
    /// `sf_Controller_MKP`: both in a loop, from reference and reading to the input.
    Controller,
}

/// A model as in the FMU: `output = offset + sign · Σ μ γ`, with the stages around it.
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
    /// `None` for operators alone.
    pub(crate) stages: Option<Constants>,
    /// Weights that depend on the load. `model` is then that of the first part, and `stages` is
    /// there.
    pub(crate) by_load: Option<ByLoad>,
    /// The dead time: samples, and s.
    pub(crate) dead: (usize, f64),
    pub(crate) control: Control,
    /// Turning points and input of the operators at the start; `None` for all of them off.
    pub(crate) start: Option<(Vec<f64>, f64)>,
    /// The start values of signal and load in the FMU's description.
    pub(crate) first: (f64, f64),
}

/// The values that a step needs, and the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Inputs {
    /// Input or target.
    pub(crate) signal: f64,
    /// The load, where the model depends on one.
    pub(crate) load: f64,
    /// Where the target goes next: 1, −1, or 0 for the policy *hold*.
    pub(crate) heading: i32,
    /// How far the target may go back and still be held, from 0.
    pub(crate) tolerance: f64,
    /// Whether all operators are on at the start.
    pub(crate) start_on: bool,
    /// Of a controller: the output that was read, NaN where there is none; by how much the
    /// reference will have changed when the drive is seen to act; manual operation and its drive.
    pub(crate) measured: f64,
    pub(crate) ahead: f64,
    pub(crate) manual: bool,
    pub(crate) manual_drive: f64,
    pub(crate) settings: Settings,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Outputs {
    /// The output, or the input found.
    pub(crate) signal: f64,
    /// Where the input lay (−1, 0 or 1), or whether the target is reached (−1 to 3).
    pub(crate) flag: i32,
    /// The temperature of the body.
    pub(crate) temperature: f64,
}

impl Block {
    pub(crate) fn inputs(&self) -> Inputs {
        let (signal, load) = self.first;
        Inputs {
            signal,
            load,
            heading: 0,
            tolerance: self.control.tolerance,
            start_on: false,
            measured: signal,
            ahead: 0.0,
            manual: false,
            manual_drive: 0.0,
            settings: self.control.settings,
        }
    }

    /// Whether there is a load among the variables.
    pub(crate) fn is_loaded(&self) -> bool {
        self.by_load.is_some() || self.around(|stages| !stages.axis.load.loads.is_empty())
    }

    /// Whether there is a temperature among the variables.
    pub(crate) fn has_body(&self) -> bool {
        self.around(|stages| stages.body.is_some())
    }

    /// Whether there are stages of which that is true.
    fn around(&self, is: impl Fn(Stages<'_, f64>) -> bool) -> bool {
        let stages = self.stages.as_ref();
        stages.is_some_and(|stages| stages.core(self.offset, self.sign).is_ok_and(is))
    }

    /// The inverse needs none: its input acts later, and so is its target.
    fn under_way(&self) -> UnderWay<Vec<f64>> {
        let is_late = self.kind == Kind::Forward && self.dead.0 > 0;
        UnderWay::new(self.dead, vec![0.0; if is_late { MOST } else { 0 }])
    }

    pub(crate) fn start(&self, on: bool) -> Result<State> {
        let mut state = self.begin(on)?;
        if self.kind == Kind::Controller {
            state.own = Some(Box::new(Loop::new(self, state.clone())));
        }
        Ok(state)
    }

    fn begin(&self, on: bool) -> Result<State> {
        let memory = vec![Turn::default(); turn_capacity(self.model.plane().levels())];
        let mut operators = self.model.state(memory)?;
        match &self.start {
            _ if on => self.model.reset_on(&mut operators)?,
            Some((points, input)) => self.model.restore(&mut operators, points, *input)?,
            None => {}
        }
        Ok(State {
            operators,
            stages: StageState::default(),
            mixed: self.by_load.as_ref().map(|_| Mixed {
                model: self.model.clone(),
                placed: None,
            }),
            under_way: self.under_way(),
            own: None,
        })
    }

    /// Moves by a step of `dt` seconds, over which the inputs were held. After an error the state
    /// stays as it is.
    pub(crate) fn step(&self, state: &mut State, inputs: &Inputs, dt: f64) -> Result<Outputs> {
        for (what, number, needed) in [
            ("input", inputs.signal, self.kind == Kind::Forward),
            ("target", inputs.signal, self.kind == Kind::Inverse),
            ("reference", inputs.signal, self.kind == Kind::Controller),
            ("load", inputs.load, self.is_loaded()),
        ] {
            if needed && !number.is_finite() {
                let problem = format!("the {what} is {number}, not a finite number");
                return Err(Problem(problem));
            }
        }
        let (signal, flag) = match self.kind {
            Kind::Forward => {
                let acting = Inputs {
                    signal: state.under_way.acting(inputs.signal, Some(dt)),
                    ..*inputs
                };
                let step = self.forward(state, &acting, dt)?;
                state.under_way.push(inputs.signal, Some(dt));
                let flag = match step.clipped {
                    None => 0,
                    Some(Clipped::Low) => -1,
                    Some(Clipped::High) => 1,
                };
                (step.output, flag)
            }
            Kind::Inverse => {
                let Solution { input, status } = self.inverse(state, inputs, dt)?;
                (input, status.number().into())
            }
            Kind::Controller => {
                let Some(mut own) = state.own.take() else {
                    return Err(Problem::new("the loop was lost"));
                };
                let done = match dt > 0.0 {
                    true => self.control(state, &mut own, inputs, dt),
                    false => Ok(own.at_rest(inputs)),
                };
                state.own = Some(own);
                return done;
            }
        };
        Ok(Outputs {
            signal,
            flag,
            temperature: state.stages.temperature(),
        })
    }

    pub(super) fn forward(
        &self,
        state: &mut State,
        inputs: &Inputs,
        dt: f64,
    ) -> Result<Output<f64>> {
        let Some(stages) = &self.stages else {
            let step = self.model.step(&mut state.operators, inputs.signal)?;
            let output = self.offset + self.sign * step.output;
            return Ok(Output { output, ..step });
        };
        let sample = Sample {
            input: inputs.signal,
            dt: Some(dt),
            load: Some(inputs.load),
        };
        let mut stages = stages.core(self.offset, self.sign)?;
        stages.accepts(&state.stages, sample)?;
        stages.offset = self.place(state, inputs.load)?;
        let model = state
            .mixed
            .as_ref()
            .map_or(&self.model, |mixed| &mixed.model);
        Ok(stages.step(model, &mut state.operators, &mut state.stages, sample)?)
    }

    pub(super) fn inverse(
        &self,
        state: &mut State,
        inputs: &Inputs,
        dt: f64,
    ) -> Result<Solution<f64>> {
        let Some(stages) = &self.stages else {
            let inverse = self.model.inverse()?;
            let solution = inverse.step(&mut state.operators, self.inward(inputs))?;
            let status = match self.sign < 0.0 {
                true => solution.status.mirrored(),
                false => solution.status,
            };
            return Ok(Solution { status, ..solution });
        };
        let target = Target {
            output: inputs.signal,
            heading: heading(inputs.heading),
            tolerance: inputs.tolerance,
        };
        let wanted = Wanted {
            dt: Some(dt),
            load: Some(inputs.load),
            drive: stages.drive,
            ..target.into()
        };
        let mut stages = stages.core(self.offset, self.sign)?;
        stages.offset = self.place(state, inputs.load)?;
        let model = state
            .mixed
            .as_ref()
            .map_or(&self.model, |mixed| &mixed.model);
        let inverse = model.inverse()?;
        Ok(stages.invert(&inverse, &mut state.operators, &mut state.stages, wanted)?)
    }

    /// Brings the operators to a load, where their weights depend on it, and returns the offset.
    fn place(&self, state: &mut State, load: f64) -> Result<f64> {
        let (Some(by_load), Some(mixed)) = (&self.by_load, &mut state.mixed) else {
            return Ok(self.offset);
        };
        let Mixed { model, placed } = mixed;
        let parts = by_load.core();
        Ok(parts.place(model, &mut state.operators, placed, Some(load))?)
    }

    /// The target for the output without sign.
    fn inward(&self, inputs: &Inputs) -> Target<f64> {
        let rises = if self.sign > 0.0 { 1 } else { -1 };
        Target {
            output: self.sign * (inputs.signal - self.offset),
            heading: heading(rises * inputs.heading),
            tolerance: inputs.tolerance,
        }
    }
}

fn heading(number: i32) -> Option<Direction> {
    match number {
        0 => None,
        1.. => Some(Direction::Rising),
        _ => Some(Direction::Falling),
    }
}
