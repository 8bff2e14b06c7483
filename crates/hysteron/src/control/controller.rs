//! One controller for all schemes: inverse feedforward, PID feedback, or both, with an optional
//! inner loop around the input.

use super::pid::clamp;
use super::sensor::{Sensed, Sensor};
use super::{LoopStatus, Pid, Reading, Scheme};
use crate::error::Result;
use crate::model::Policy;
use hysteron_core::{Direction, Outcome};

/// The wanted output, and the direction it takes next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// The output wanted now.
    pub output: f64,
    /// The direction it takes next, if known. *Anticipate* needs it.
    pub heading: Option<Direction>,
}

/// What a controller does at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Action {
    /// The input asked for.
    pub command: f64,
    /// The drive to write to the device.
    pub drive: f64,
    /// The output that the model expected at the last measured input, before it learned from this
    /// sample. NaN without a model.
    pub prediction: f64,
    /// The filtered readings. NaN where there is no new valid reading.
    pub filtered: Reading,
    /// Flags for this sample.
    pub status: LoopStatus,
}

/// A [`Scheme`] at work. At each sample: read the device, call [`step`](Controller::step), write
/// the drive.
///
/// If the output's sensor gives nothing new, the feedback is held, the feedforward continues and
/// nothing is learned. If the input's sensor gives nothing new, the inner loop holds the drive for
/// [`Scheme::stuck_s`] and then sets the lowest drive.
///
/// ```
/// use hysteron::control::{Controller, Device, Gains, Reading, Scheme, Reference};
///
/// /// A motor on a spring, as its driver would show it: volts in, millimetres out.
/// struct Stage { volts: f64, mm: f64 }
///
/// impl Device for Stage {
///     fn read(&mut self) -> Reading {
///         Reading { output: self.mm, input: None } // the drive is all that is known of the input
///     }
///     fn write(&mut self, drive: f64) {
///         self.volts = drive;
///         // The physics until the next sample.
///         self.mm += 0.1 * (0.5 * self.volts - self.mm);
///     }
/// }
///
/// let mut controller = Controller::new(Scheme {
///     pid: Some(Gains { gain: 2.0, integral_s: 0.1, derivative_s: 0.0 }),
///     ..Scheme::new(0.01, (0.0, 10.0))
/// })?;
/// let mut device = Stage { volts: 0.0, mm: 0.0 };
/// for _ in 0..500 {
///     let action = controller.step(Reference { output: 3.0, heading: None }, device.read())?;
///     device.write(action.drive);
///     // here a real loop waits for its next sample
/// }
/// assert!((device.mm - 3.0).abs() < 1e-3);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Controller {
    scheme: Scheme,
    pid: Option<Pid>,
    inner: Option<Pid>,
    output: Sensor,
    input: Sensor,
    /// The last input that was commanded.
    last: Option<f64>,
    /// Whether the drive is at its lower and at its upper limit.
    held: (bool, bool),
    /// The output that the model expected at the last measured input.
    prediction: f64,
    /// Whether the input's sensor was taken as broken. Then the path of the input is not known.
    lost: bool,
}

impl Controller {
    /// A controller at rest.
    ///
    /// # Errors
    /// [`crate::Error::Control`] for settings that no loop can run with.
    pub fn new(scheme: Scheme) -> Result<Self> {
        scheme.check()?;
        let sensor = || Sensor::new(scheme.interval_s, scheme.filter_s, scheme.stuck_s);
        Ok(Self {
            pid: scheme.pid.map(Pid::new),
            inner: scheme.inner.map(|inner| Pid::new(inner.gains)),
            output: sensor(),
            input: sensor(),
            last: None,
            held: (false, false),
            prediction: f64::NAN,
            lost: false,
            scheme,
        })
    }

    /// Runs one sample: takes the target and the readings, returns the drive to write. The drive is
    /// finite and within its limits, whatever the readings are.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a target that is not finite; nothing is changed then.
    pub fn step(&mut self, target: Reference, reading: Reading) -> Result<Action> {
        self.step_ahead(target, &[], reading)
    }

    /// As [`Controller::step`], for a reference that is known ahead: `next` has its values at the
    /// samples after this one. The feedforward of a fixed model with a thermal body may then start
    /// to heat or to cool before they are due ([`crate::Inverse::step_ahead`]). Earlier targets are
    /// missed by up to a tenth of the range for that. Other feedforward takes no notice of them.
    ///
    /// As many samples as heating or cooling through the range takes are enough.
    ///
    /// ```
    /// use hysteron::control::{Compensator, Controller, Reading, Reference, Scheme};
    /// use hysteron::{FirstOrder, Model, Operator, Plane, Sign};
    /// let plane = Plane::new(30.0, 90.0, 6)?;
    /// let mut model = Model::new(Operator::Mkp, plane, vec![0.2; 21], 0.0, Sign::Positive)?;
    /// model.thermal = Some(FirstOrder { gain: 100.0, ..FirstOrder::default() });
    /// let scheme = Scheme {
    ///     compensator: Some(Compensator::fixed(&model)?),
    ///     ..Scheme::new(0.2, (0.0, 1.0))
    /// };
    /// let mut controller = Controller::new(scheme)?;
    /// let reading = Reading { output: 0.0, input: None };
    /// let target = Reference { output: 0.1, heading: None };
    /// let action = controller.step_ahead(target, &[0.1, 2.0, 4.0], reading)?;
    /// assert!(action.drive >= 0.0);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Controller::step`], also for a target ahead.
    pub fn step_ahead(
        &mut self,
        target: Reference,
        next: &[f64],
        reading: Reading,
    ) -> Result<Action> {
        refuse_not_finite(target.output)?;
        next.iter()
            .try_for_each(|&output| refuse_not_finite(output))?;
        let (output, input) = self.read(reading);
        let mut status = LoopStatus::default();
        if let Some(compensator) = &mut self.scheme.compensator {
            if let Some(input) = input.and_then(Sensed::value) {
                if std::mem::take(&mut self.lost) {
                    compensator.set_out_again();
                }
                let (prediction, outcome) =
                    compensator.follow(input, Some(self.scheme.interval_s), output.value())?;
                self.prediction = prediction;
                status.adapted = outcome == Some(Outcome::Learned);
                status.rejected = outcome == Some(Outcome::Rejected);
                status.stuck = outcome.is_some_and(Outcome::is_stuck);
            }
            self.lost |= input == Some(Sensed::Broken);
        }
        let command = self.command(target, next, output.value(), &mut status)?;
        Ok(self.act(command, self.prediction, (output, input), status))
    }

    /// Runs one sample with a given `command` for the input, without regard to the output. For
    /// recordings and step tests.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a command that is not finite; nothing is changed then.
    pub fn step_command(&mut self, command: f64, reading: Reading) -> Result<Action> {
        refuse_not_finite(command)?;
        let sights = self.read(reading);
        Ok(self.act(command, f64::NAN, sights, LoopStatus::default()))
    }

    /// Time between samples, s.
    #[must_use]
    pub fn interval_s(&self) -> f64 {
        self.scheme.interval_s
    }

    /// The model in the loop, if there is one.
    #[must_use]
    pub fn compensator(&self) -> Option<&super::Compensator> {
        self.scheme.compensator.as_ref()
    }

    /// Filters the readings of output and input. If no sensor measures the input, the last command
    /// is used in its place, except where an inner loop needs a measurement.
    fn read(&mut self, reading: Reading) -> (Sensed, Option<Sensed>) {
        let output = self.output.read(reading.output);
        let input = match (reading.input, self.scheme.inner) {
            (Some(input), _) => Some(self.input.read(input)),
            (None, Some(_)) => Some(self.input.read(f64::NAN)),
            (None, None) => self.last.map(|last| Sensed::New(self.input.filter(last))),
        };
        (output, input)
    }

    fn act(
        &mut self,
        command: f64,
        prediction: f64,
        (output, input): (Sensed, Option<Sensed>),
        status: LoopStatus,
    ) -> Action {
        let drive = self.drive(command, input);
        let (low, high) = self.scheme.drives;
        self.held = (drive <= low, drive >= high);
        let (lowest, highest) = self.scheme.commands;
        let limits = [
            self.held.0,
            self.held.1,
            command <= lowest,
            command >= highest,
        ];
        self.last = Some(match self.inner {
            Some(_) => command,
            None => drive,
        });
        let sensed = input.map(|input| input.value().unwrap_or(f64::NAN));
        Action {
            command,
            drive,
            prediction,
            filtered: Reading {
                output: output.value().unwrap_or(f64::NAN),
                input: sensed,
            },
            status: LoopStatus {
                saturated: limits.contains(&true),
                sensor_fault: output.fault() || input.is_some_and(Sensed::fault),
                ..status
            },
        }
    }

    fn command(
        &mut self,
        target: Reference,
        next: &[f64],
        measured: Option<f64>,
        status: &mut LoopStatus,
    ) -> Result<f64> {
        let scheme = &mut self.scheme;
        let heading = match scheme.policy {
            Policy::Anticipate => target.heading,
            Policy::Hold => None,
        };
        let feedforward = match &mut scheme.compensator {
            Some(compensator) => {
                let solution = compensator.solve(
                    target.output,
                    heading,
                    scheme.tolerance,
                    Some(scheme.interval_s),
                    next,
                )?;
                status.out_of_reach = solution.status.is_out_of_reach();
                solution.input
            }
            None => scheme.bias,
        };
        let (low, high) = scheme.commands;
        Ok(match (&mut self.pid, measured) {
            (None, _) => clamp(feedforward, low, high),
            (Some(pid), None) => pid.hold(feedforward, scheme.commands),
            (Some(pid), Some(measured)) => pid.step(
                target.output - measured,
                scheme.interval_s,
                feedforward,
                scheme.commands,
                self.held,
            ),
        })
    }

    fn drive(&mut self, command: f64, input: Option<Sensed>) -> f64 {
        let (low, high) = self.scheme.drives;
        let (Some(inner), Some(pid)) = (self.scheme.inner, &mut self.inner) else {
            return clamp(command, low, high);
        };
        let square = |drive: f64| match inner.square_root {
            true => drive * drive,
            false => drive,
        };
        let limits = (square(low), square(high));
        let power = match input {
            Some(Sensed::New(input)) => pid.step(
                command - input,
                self.scheme.interval_s,
                0.0,
                limits,
                (false, false),
            ),
            Some(Sensed::Repeated | Sensed::Missing) => pid.hold(0.0, limits),
            // Without a temperature reading, heating is not safe.
            Some(Sensed::Broken) | None => {
                pid.hold(0.0, limits);
                limits.0
            }
        };
        // The square of a root may differ from the limit by rounding.
        let drive = if inner.square_root {
            power.sqrt()
        } else {
            power
        };
        clamp(drive, low, high)
    }
}

fn refuse_not_finite(value: f64) -> Result<()> {
    match value.is_finite() {
        true => Ok(()),
        false => Err(hysteron_core::Error::InputNotFinite { index: 0 }.into()),
    }
}
