//! One controller for all schemes: inverse feedforward, PID feedback, or both, with an optional
//! inner loop around the input.

use super::sensor::{Sensed, Sensor};
use super::{Gains, LoopStatus, Reading, Scheme};
use crate::error::{Error, Result};
use crate::model::{Policy, UnderWay};
use hysteron_core::control::{Cause, Gate, Pid, Silence, Standstill, clamp};
use hysteron_core::{Direction, Outcome};

/// Samples within which a difference of the feedforward fades.
const FADE: u32 = 10;

/// The wanted output, and the direction it takes next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// The output wanted now.
    pub output: f64,
    /// The direction that the output due takes next, if known: this one, or the one that the
    /// inverse is told ahead. *Anticipate* needs it.
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
/// If the output's sensor gives nothing new, nothing is learned, and the feedback is held; beside
/// an inverse, which continues, only its integral stays ([`Pid::relax`]). If the input's sensor
/// gives nothing new, the inner loop holds the drive for [`Scheme::stuck_s`] and then sets the
/// lowest drive.
///
/// A reading that stands still to the last bit where the output has to move is taken as missing too
/// ([`Controller::stuck_s`]), and so is a spike, with [`Scheme::gate`].
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
    /// Time since the sample before, s.
    dt: f64,
    gate: Option<Gate>,
    standstill: Standstill,
    silence: Silence,
    /// The drive to go on from at the next sample.
    from: Option<f64>,
    /// What is added to the feedforward for a few samples, so that it does not jump, and for how
    /// many more.
    fade: (f64, u32),
    /// The last feedforward.
    feedforward: Option<f64>,
    /// The last drive.
    drive: Option<f64>,
    pid: Option<Pid>,
    inner: Option<Pid>,
    output: Sensor,
    input: Sensor,
    /// The wanted output, as late as the filter makes the measured one.
    wanted: Sensor,
    /// Samples until a drive moves the output.
    due: usize,
    /// The inputs under way: given, and not yet answered by the output.
    under_way: UnderWay<Option<f64>>,
    /// The input that the output now answers, where it is known.
    acting: Option<f64>,
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
        let sensor = || Sensor::new(scheme.filter_s, scheme.stuck_s);
        Ok(Self {
            dt: scheme.interval_s,
            gate: scheme.gate.map(Gate::new),
            standstill: Standstill::default(),
            silence: Silence::default(),
            from: None,
            fade: (0.0, 0),
            feedforward: None,
            drive: None,
            pid: scheme.pid.map(Pid::new),
            inner: scheme.inner.map(|inner| Pid::new(inner.gains)),
            output: sensor(),
            input: sensor(),
            wanted: Sensor::new(scheme.filter_s, None),
            due: scheme.due(),
            under_way: UnderWay::new(scheme.late()),
            acting: None,
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
    /// samples after this one. The inverse solves for the one that is due when the drive of this
    /// sample is seen to act ([`Controller::due`]), or for the last one that it is told. The
    /// feedforward of a model with a thermal body may then start to heat or to cool before
    /// they are due ([`crate::Inverse::step_ahead`]). Earlier targets are missed by up to a tenth
    /// of the range for that. Other feedforward takes no notice of those after the one that is due.
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
        self.step_after(self.scheme.interval_s, target, next, reading)
    }

    /// As [`Controller::step_ahead`], `dt` s after the sample before: for a device whose intervals
    /// are measured.
    ///
    /// # Errors
    /// As [`Controller::step_ahead`]; [`Error::Control`] for a `dt` that is not finite or not above
    /// zero.
    pub fn step_after(
        &mut self,
        dt: f64,
        target: Reference,
        next: &[f64],
        reading: Reading,
    ) -> Result<Action> {
        self.pass(dt)?;
        refuse_not_finite(target.output)?;
        next.iter()
            .try_for_each(|&output| refuse_not_finite(output))?;
        let (output, input, mut status) = self.read(reading, target.output);
        self.follow((output, input), &mut status)?;
        let command = self.command(target, next, output.value(), &mut status)?;
        status.safe = self.silence.given_up();
        Ok(self.act(command, self.prediction, (output, input), status))
    }

    /// Lets the model follow the input that acts, and learn from the output.
    fn follow(
        &mut self,
        (output, input): (Sensed, Option<Sensed>),
        status: &mut LoopStatus,
    ) -> Result<()> {
        let Some(compensator) = &mut self.scheme.compensator else {
            return Ok(());
        };
        if let Some(input) = self.acting {
            if std::mem::take(&mut self.lost) {
                compensator.set_out_again();
            }
            let (prediction, outcome) = compensator.follow(input, Some(self.dt), output.value())?;
            self.prediction = prediction;
            status.adapted = outcome == Some(Outcome::Learned);
            status.rejected |= outcome == Some(Outcome::Rejected);
            status.stuck |= outcome.is_some_and(Outcome::is_stuck);
        }
        self.lost |= input == Some(Sensed::Broken);
        Ok(())
    }

    /// Runs one sample with a given `command` for the input, without regard to the output: manual
    /// operation, recordings, step tests. The model follows, and its inverse begins anew from there.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a command that is not finite; nothing is changed then.
    pub fn step_command(&mut self, command: f64, reading: Reading) -> Result<Action> {
        self.step_command_after(self.scheme.interval_s, command, reading)
    }

    /// As [`Controller::step_command`], `dt` s after the sample before.
    ///
    /// # Errors
    /// As [`Controller::step_command`]; [`Error::Control`] for a `dt` that is not finite or not
    /// above zero.
    pub fn step_command_after(
        &mut self,
        dt: f64,
        command: f64,
        reading: Reading,
    ) -> Result<Action> {
        refuse_not_finite(command)?;
        self.pass(dt)?;
        let (output, input, mut status) = self.read(reading, f64::NAN);
        self.follow((output, input), &mut status)?;
        if let Some(compensator) = &mut self.scheme.compensator {
            compensator.set_out_again();
        }
        Ok(self.act(command, self.prediction, (output, input), status))
    }

    /// Tells that `drive` has acted up to the next reading, where that is not the drive of the last
    /// sample: before the first sample, or where a drive was lost on its way. Without an inner loop
    /// the model follows it.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a drive that is not finite.
    pub fn applied(&mut self, drive: f64) -> Result<()> {
        refuse_not_finite(drive)?;
        if self.scheme.inner.is_none() {
            self.last = Some(drive);
        }
        self.drive.get_or_insert(drive);
        Ok(())
    }

    /// Goes on from `drive` at the next sample, without a bump: from manual to automatic. The
    /// integral begins so that the first drive is this one. What it cannot take, such as the
    /// feedforward of an inverse alone, fades within ten samples. A loop that was given up
    /// ([`Scheme::safety`]) goes on.
    ///
    /// ```
    /// use hysteron::control::{Controller, Gains, Reading, Reference, Scheme};
    /// let mut controller = Controller::new(Scheme {
    ///     pid: Some(Gains { gain: 2.0, integral_s: 1.0, derivative_s: 0.0 }),
    ///     ..Scheme::new(0.01, (0.0, 10.0))
    /// })?;
    /// controller.go_on_from(3.0)?;
    /// let (target, reading) = (Reference { output: 9.0, heading: None }, Reading { output: 1.0, input: None });
    /// let action = controller.step(target, reading)?;
    /// assert!((action.drive - 3.0).abs() < 0.2); // and not 16
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a drive that is not finite.
    pub fn go_on_from(&mut self, drive: f64) -> Result<()> {
        self.applied(drive)?;
        (self.from, self.drive) = (Some(drive), Some(drive));
        self.wanted = Sensor::new(self.scheme.filter_s, None);
        if self.silence.given_up() {
            self.silence = Silence::default();
            self.standstill.forgive();
        }
        Ok(())
    }

    /// Lets the model follow a sample that another controller has answered: `drive` acted up to
    /// `output`, which may be NaN. A run that goes on begins so.
    ///
    /// # Errors
    /// As [`Controller::step_after`] and [`Controller::applied`].
    pub fn replay(&mut self, dt: f64, drive: f64, output: f64) -> Result<()> {
        self.pass(dt)?;
        self.applied(drive)?;
        self.drive = Some(drive);
        let reading = Reading {
            output,
            input: None,
        };
        let (output, ..) = self.read(reading, f64::NAN);
        if let (Some(compensator), Some(input)) = (&mut self.scheme.compensator, self.acting) {
            self.prediction = compensator.follow(input, Some(dt), output.value())?.0;
        }
        Ok(())
    }

    /// Gives the compensator weights that were learned beside the loop
    /// ([`super::Compensator::renew`]). The drive does not jump.
    ///
    /// # Errors
    /// As [`super::Compensator::renew`], and [`Error::Control`] without one.
    pub fn renew(&mut self, model: &crate::Model) -> Result<()> {
        match &mut self.scheme.compensator {
            Some(compensator) => compensator.renew(model),
            None => Err(Error::Control("there is no model in this loop".into())),
        }
    }

    /// Changes the gains of the feedback, as a gain schedule or a self-tuning regulator does. The
    /// integral stays, so the drive changes only by what the new gains make of the error of now.
    ///
    /// ```
    /// use hysteron::control::{Controller, Gains, Reading, Reference, Scheme};
    /// let gains = Gains { gain: 2.0, integral_s: 0.0, derivative_s: 0.0 };
    /// let mut controller =
    ///     Controller::new(Scheme { pid: Some(gains), ..Scheme::new(0.01, (0.0, 10.0)) })?;
    /// controller.retune(Gains { gain: 3.0, ..gains })?;
    /// let target = Reference { output: 2.0, heading: None };
    /// let action = controller.step(target, Reading { output: 1.0, input: None })?;
    /// assert_eq!(action.drive, 3.0);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Gains::check`], and [`Error::Control`] for a loop without feedback.
    pub fn retune(&mut self, gains: Gains) -> Result<()> {
        gains.check()?;
        match &mut self.pid {
            Some(pid) => pid.set(gains),
            None => return Err(Error::Control("there is no feedback in this loop".into())),
        }
        self.scheme.pid = Some(gains);
        Ok(())
    }

    /// How long the output has stood still to the last bit where it has to move, s; `None` where
    /// its sensor works. It has to move where the model expects 5 % of its range; without a model,
    /// where the drive has gone almost half its way to a limit since, and no further, once the
    /// sensor has shown that it works. Or it is still but for a noise of 1 % of the model's range,
    /// off what is wanted, with the drive at a limit and the model four tenths of it away.
    #[must_use]
    pub fn stuck_s(&self) -> Option<f64> {
        self.standstill.stuck_s()
    }

    /// Samples until a drive moves the output that is read ([`Scheme::delay`]): how far ahead the
    /// inverse has to be told the reference.
    #[must_use]
    pub fn due(&self) -> usize {
        self.due
    }

    /// Time between samples, s.
    #[must_use]
    pub fn interval_s(&self) -> f64 {
        self.scheme.interval_s
    }

    /// The drive for a loop that is given up: zero, or the one within the limits that is nearest.
    #[must_use]
    pub fn rest_drive(&self) -> f64 {
        clamp(0.0, self.scheme.drives.0, self.scheme.drives.1)
    }

    /// The model in the loop, if there is one.
    #[must_use]
    pub fn compensator(&self) -> Option<&super::Compensator> {
        self.scheme.compensator.as_ref()
    }

    fn pass(&mut self, dt: f64) -> Result<()> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(Error::Control(format!(
                "{dt} s between two samples: a time above zero is needed"
            )));
        }
        self.dt = dt;
        Ok(())
    }

    /// Filters the readings of output and input, and holds back those that cannot be. If no sensor
    /// measures the input, the last command is used in its place, except where an inner loop needs
    /// a measurement. `wanted` is the output that is due, NaN for none.
    fn read(&mut self, reading: Reading, wanted: f64) -> (Sensed, Option<Sensed>, LoopStatus) {
        let dt = self.dt;
        let input = match (reading.input, self.scheme.inner) {
            (Some(input), _) => Some(self.input.read(input, dt)),
            (None, Some(_)) => Some(self.input.read(f64::NAN, dt)),
            (None, None) => self
                .last
                .map(|last| Sensed::New(self.input.filter(last, dt))),
        };
        self.acting = self.arrives(input.and_then(Sensed::value));
        let mut status = LoopStatus::default();
        let mut output = reading.output;
        if output.is_finite() {
            status.stuck = self.stands_still(output, input, wanted);
            status.rejected = !self.passes(output);
            if status.stuck || status.rejected {
                output = f64::NAN;
            }
        }
        let (safety, stuck_s) = (self.scheme.safety, self.stuck_s());
        self.silence.push(safety, reading.output, stuck_s, dt);
        (self.output.read(output, dt), input, status)
    }

    /// The input that the output answers now: the one given before the delay. Before all of them,
    /// the actuator stood at the first.
    fn arrives(&mut self, input: Option<f64>) -> Option<f64> {
        match self.under_way.is_empty() && input.is_none() {
            true => None,
            false => self.under_way.push(input),
        }
    }

    /// Whether the output stands still where it has to move.
    fn stands_still(&mut self, output: f64, input: Option<Sensed>, wanted: f64) -> bool {
        let compensator = self.scheme.compensator.as_ref();
        let expected = compensator.and_then(|compensator| {
            let range = compensator.output_range();
            let expected = compensator.prediction();
            (expected.is_finite() && input.is_some()).then_some((expected, range))
        });
        // The drive of an inner loop goes up and down by itself.
        let (drive, drives) = match self.scheme.inner {
            Some(_) => (self.last, self.scheme.commands),
            None => (self.drive, self.scheme.drives),
        };
        let cause = Cause {
            expected,
            wanted,
            drive: drive.unwrap_or(drives.0),
            drives,
        };
        self.standstill.push(output, cause, self.dt).is_some()
    }

    /// Whether a reading is no spike.
    fn passes(&mut self, output: f64) -> bool {
        let (compensator, dt) = (self.scheme.compensator.as_ref(), self.dt);
        let acting = self.acting;
        let expected = || match (compensator, acting) {
            (Some(compensator), Some(input)) => compensator.expected_change(input, dt),
            _ => 0.0,
        };
        let gate = self.gate.as_mut();
        gate.is_none_or(|gate| gate.passes(output, expected))
    }

    fn act(
        &mut self,
        command: f64,
        prediction: f64,
        (output, input): (Sensed, Option<Sensed>),
        status: LoopStatus,
    ) -> Action {
        let asked = self.driven(command, input);
        let drive = match status.safe {
            true => self.rest_drive(),
            false => self.slewed(asked),
        };
        let (low, high) = self.scheme.drives;
        self.held = (
            drive <= low || drive > asked,
            drive >= high || drive < asked,
        );
        self.drive = Some(drive);
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
        let (mut feedforward, mut changed) = (scheme.bias, false);
        if let Some(compensator) = &mut scheme.compensator {
            // The target that is due when this drive is seen to act, and those after it.
            let ahead = self.due.min(next.len());
            let due = match ahead.checked_sub(1) {
                Some(n) => next[n],
                None => target.output,
            };
            let (tolerance, dt) = (scheme.tolerance, Some(self.dt));
            let solution = compensator.solve(due, heading, tolerance, dt, &next[ahead..])?;
            status.out_of_reach = solution.status.is_out_of_reach();
            feedforward = solution.input;
            changed = compensator.take_changed();
        }
        self.smooth(changed, feedforward);
        // An inverse brings the output to the target in time. The reading is late by the filter:
        // compared with the target of now, the feedback would pull the drive away from where it is
        // right. Without an inverse, or with an inner loop that takes its own time, the lag is one
        // of the loop, and a late target would add to it.
        let wanted = match (&self.scheme.compensator, self.scheme.inner) {
            (Some(_), None) => self.wanted.filter(target.output, self.dt),
            _ => target.output,
        };
        let error = measured.map(|measured| wanted - measured);
        if let Some(from) = self.begins_at() {
            if self.pid.is_some() && measured.is_none() {
                // The loop is not closed before its first reading.
                let (low, high) = self.scheme.commands;
                return Ok(clamp(from, low, high));
            }
            self.from = None;
            let e = error.unwrap_or(0.0);
            let integrates = |gains: &Gains| gains.integral_s > 0.0;
            let offset = match self.scheme.pid {
                // The integral takes all of a constant bias.
                Some(gains) if integrates(&gains) && self.scheme.compensator.is_none() => 0.0,
                Some(gains) if !integrates(&gains) => from - feedforward - gains.gain * e,
                _ => from - feedforward,
            };
            self.fade = (offset, FADE);
            if let Some(pid) = &mut self.pid {
                pid.begin(from, e, feedforward + offset);
            }
        }
        let (offset, left) = &mut self.fade;
        let bias = feedforward + *offset * f64::from(*left) / f64::from(FADE);
        *left = left.saturating_sub(1);
        let (low, high) = self.scheme.commands;
        let commands = match self.standstill.room() {
            Some(room) => (low.max(room.0), high.min(room.1)),
            None => (low, high),
        };
        Ok(match (&mut self.pid, measured, error) {
            (Some(pid), Some(measured), Some(error)) => {
                pid.follow(error, measured, self.dt, bias, commands, self.held)
            }
            (Some(pid), ..) if self.scheme.compensator.is_some() => {
                pid.relax(self.dt, bias, commands)
            }
            (Some(pid), ..) => pid.hold(bias, commands),
            (None, ..) => clamp(bias, commands.0, commands.1),
        })
    }

    /// The command to begin from, where the loop goes on from another drive. The command of an
    /// inner loop is no drive: it begins where it was last.
    fn begins_at(&self) -> Option<f64> {
        let drive = self.from?;
        match self.scheme.inner {
            None => Some(drive),
            Some(_) => self.last,
        }
    }

    /// Lets the feedforward change slowly where other weights have changed it at once.
    fn smooth(&mut self, changed: bool, feedforward: f64) {
        if let (true, Some(last)) = (changed, self.feedforward) {
            let (offset, left) = self.fade;
            let old = offset * f64::from(left) / f64::from(FADE);
            self.fade = (last + old - feedforward, FADE);
        }
        self.feedforward = Some(feedforward);
    }

    /// As far towards a drive as the slew allows.
    fn slewed(&self, drive: f64) -> f64 {
        match (self.scheme.slew, self.drive) {
            (Some(slew), Some(last)) => clamp(drive, last - slew * self.dt, last + slew * self.dt),
            _ => drive,
        }
    }

    fn driven(&mut self, command: f64, input: Option<Sensed>) -> f64 {
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
            Some(Sensed::New(input)) => {
                pid.step(command - input, self.dt, 0.0, limits, (false, false))
            }
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
