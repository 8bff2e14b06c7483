//! One controller for all schemes: inverse feedforward, PID, both, with a loop around the input inside.

use super::{Compensator, Gains, LoopStatus, Pid, Reading, watch::Watch};
use crate::{Direction, Result, Status};

/// What the output should be, and where it goes next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// The output wanted now.
    pub output: f64,
    /// Where it goes next, where that is known; *anticipate* needs it.
    pub heading: Option<Direction>,
}

/// What the inverse does where the target rests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rest {
    /// The input rests too (equation 14).
    #[default]
    Hold,
    /// The input crosses the dead band as soon as it is known that the target reverses.
    Anticipate,
}

/// The loop inside, which brings the input (a temperature) to the one commanded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InnerLoop {
    /// Its gains: power for each degree.
    pub gains: Gains,
    /// The drive is the square root of what the gains give: a current, whose heat goes with its square.
    pub square_root: bool,
}

/// What a [`Controller`] is made of.
#[derive(Debug, Clone)]
pub struct Scheme {
    /// Time between samples, s.
    pub interval_s: f64,
    /// The model, for feedforward through its inverse.
    pub compensator: Option<Compensator>,
    /// What the inverse does where the target rests.
    pub rest: Rest,
    /// Reversals of the target up to this size are not followed by the inverse, in the output's unit.
    pub tolerance: f64,
    /// Feedback of the output, added to the feedforward.
    pub pid: Option<Gains>,
    /// Without a model the command sets out from here.
    pub bias: f64,
    /// Lowest and highest input that may be commanded.
    pub commands: (f64, f64),
    /// Lowest and highest drive.
    pub drives: (f64, f64),
    /// The loop inside; without one, the command is the drive.
    pub inner: Option<InnerLoop>,
    /// Time constant of the filter on both readings, s; 0 for none.
    pub filter_s: f64,
    /// Time after which an output that reads the same to the last bit is taken as stuck, s. `None` where the sensor has no noise
    /// to tell it from an output at rest.
    pub stuck_s: Option<f64>,
}

/// What a controller does with a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Action {
    /// The input asked for.
    pub command: f64,
    /// The drive to write to the device.
    pub drive: f64,
    /// The output that the model expected before it learned; NaN without a model.
    pub prediction: f64,
    /// The readings as filtered; NaN where there is none to be believed.
    pub filtered: Reading,
    /// What there is to say.
    pub status: LoopStatus,
}

/// A [`Scheme`] in motion. Once a sample: read the device, [`step`](Controller::step), write the drive.
#[derive(Debug, Clone)]
pub struct Controller {
    scheme: Scheme,
    pid: Option<Pid>,
    inner: Option<Pid>,
    output: Watch,
    input: Watch,
    /// The last command.
    last: Option<f64>,
    /// Whether the drive stands at its lower and its upper limit.
    held: (bool, bool),
}

impl Controller {
    /// A controller at rest.
    #[must_use]
    pub fn new(scheme: Scheme) -> Self {
        let (interval_s, filter_s) = (scheme.interval_s, scheme.filter_s);
        Self {
            pid: scheme.pid.map(Pid::new),
            inner: scheme.inner.map(|inner| Pid::new(inner.gains)),
            output: Watch::new(interval_s, filter_s, scheme.stuck_s),
            input: Watch::new(interval_s, filter_s, None),
            last: None,
            held: (false, false),
            scheme,
        }
    }

    /// One sample: from what is wanted and what was read to what is to be written. The drive is finite and within its
    /// limits whatever the readings are.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a target that is not finite; nothing is changed then.
    pub fn step(&mut self, target: Target, reading: Reading) -> Result<Action> {
        if !target.output.is_finite() {
            return Err(hysteron_core::Error::InputNotFinite { index: 0 }.into());
        }
        let (measured, input) = self.read(reading);
        let mut status = LoopStatus {
            sensor_fault: measured.is_none() || (reading.input.is_some() && input.is_none()),
            ..LoopStatus::default()
        };
        let mut prediction = f64::NAN;
        if let (Some(compensator), Some(input)) = (&mut self.scheme.compensator, input) {
            (prediction, status.adapted) = compensator.follow(input, measured)?;
        }
        let command = self.command(target, measured, &mut status)?;
        Ok(self.act(command, prediction, (measured, input), status))
    }

    /// One sample that brings the input to `command`, whatever the output is: for recordings and step tests.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a command that is not finite; nothing is changed then.
    pub fn step_command(&mut self, command: f64, reading: Reading) -> Result<Action> {
        if !command.is_finite() {
            return Err(hysteron_core::Error::InputNotFinite { index: 0 }.into());
        }
        let readings = self.read(reading);
        Ok(self.act(command, f64::NAN, readings, LoopStatus::default()))
    }

    /// The model in the loop.
    #[must_use]
    pub fn compensator(&self) -> Option<&Compensator> {
        self.scheme.compensator.as_ref()
    }

    /// Output and input as filtered. Without a sensor of its own, the input is the one that was commanded.
    fn read(&mut self, reading: Reading) -> (Option<f64>, Option<f64>) {
        let measured = self.output.read(reading.output);
        let input = match reading.input {
            Some(input) => Some(input),
            None => self.last,
        };
        (measured, input.and_then(|input| self.input.read(input)))
    }

    fn act(
        &mut self,
        command: f64,
        prediction: f64,
        (measured, input): (Option<f64>, Option<f64>),
        mut status: LoopStatus,
    ) -> Action {
        let drive = self.drive(command, input);
        let (low, high) = self.scheme.drives;
        self.held = (drive <= low, drive >= high);
        status.saturated = self.held.0 || self.held.1;
        self.last = Some(command);
        Action {
            command,
            drive,
            prediction,
            filtered: Reading {
                output: measured.unwrap_or(f64::NAN),
                input,
            },
            status,
        }
    }

    fn command(
        &mut self,
        target: Target,
        measured: Option<f64>,
        status: &mut LoopStatus,
    ) -> Result<f64> {
        let scheme = &mut self.scheme;
        let heading = match scheme.rest {
            Rest::Anticipate => target.heading,
            Rest::Hold => None,
        };
        let feedforward = match &mut scheme.compensator {
            Some(compensator) => {
                let solution = compensator.solve(target.output, heading, scheme.tolerance)?;
                status.out_of_reach = solution.status != Status::Ok;
                solution.input
            }
            None => scheme.bias,
        };
        let Some(pid) = &mut self.pid else {
            return Ok(feedforward.clamp(scheme.commands.0, scheme.commands.1));
        };
        Ok(match measured {
            Some(measured) => pid.step(
                target.output - measured,
                scheme.interval_s,
                feedforward,
                scheme.commands,
                self.held,
            ),
            None => pid.hold(feedforward, scheme.commands),
        })
    }

    fn drive(&mut self, command: f64, input: Option<f64>) -> f64 {
        let (low, high) = self.scheme.drives;
        let (Some(inner), Some(pid)) = (self.scheme.inner, &mut self.inner) else {
            return command.clamp(low, high);
        };
        // Not knowing how hot it is, it must not be heated.
        let Some(input) = input else { return low };
        let square = |drive: f64| {
            if inner.square_root {
                drive * drive
            } else {
                drive
            }
        };
        let power = pid.step(
            command - input,
            self.scheme.interval_s,
            0.0,
            (square(low), square(high)),
            (false, false),
        );
        match inner.square_root {
            true => power.sqrt(),
            false => power,
        }
    }
}
