//! The settings of a control loop, and what it answers at a sample.

use crate::codes::HYSTERON_VALUE;
use crate::fault::{Fault, Result, guard};
use crate::model::MODELS;
use crate::pointer::Arguments;
use crate::types::given;
use hysteron::Policy;
use hysteron::control::{Action, Gains, InnerLoop, LoopStatus, Safety, Scheme};

/// Flag of a sample: the drive or the command is at a limit, or the drive changes as fast as it
/// may.
pub const HYSTERON_AT_LIMIT: i32 = 1;
/// Flag of a sample: no input gives the reference. The nearest one was taken.
pub const HYSTERON_OUT_OF_REACH: i32 = 2;
/// Flag of a sample: a reading was missing or held back. The loop went on without it.
pub const HYSTERON_NO_READING: i32 = 4;
/// Flag of a sample: the output or the input stands still where it has to move.
pub const HYSTERON_STUCK: i32 = 8;
/// Flag of a sample: the loop is given up, and the drive is the safe one.
pub const HYSTERON_SAFE: i32 = 16;
/// Flag of a sample: the model learned from it.
pub const HYSTERON_ADAPTED: i32 = 32;
/// Flag of a sample: the reading was taken as an outlier.
pub const HYSTERON_OUTLIER: i32 = 64;

/// The settings of a controller. `hysteron_control_default` fills them in.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronControl {
    /// Time between samples, s, above 0.
    pub interval_s: f64,
    /// Lowest drive, in its unit.
    pub drive_min: f64,
    /// Highest drive, above the lowest.
    pub drive_max: f64,
    /// Lowest command: the input that is asked for, in its unit. Without an inner loop the command
    /// is the drive.
    pub command_min: f64,
    /// Highest command, above the lowest.
    pub command_max: f64,
    /// The command without feedback, for a loop without a model.
    pub bias: f64,
    /// Reversals of the reference up to this are noise, in the output's unit, from 0.
    pub tolerance: f64,
    /// Feedback: gain, command per unit of the error. `NAN` for the inverse alone.
    pub gain: f64,
    /// Feedback: integral time, s; 0 for no such term.
    pub integral_s: f64,
    /// Feedback: derivative time, s; 0 for no such term.
    pub derivative_s: f64,
    /// Inner loop around the input: gain, power per unit of the input. `NAN` for no inner loop.
    pub inner_gain: f64,
    /// Inner loop: integral time, s; 0 for no such term.
    pub inner_integral_s: f64,
    /// Inner loop: derivative time, s; 0 for no such term.
    pub inner_derivative_s: f64,
    /// Time constant of the low-pass filter on both readings, s, from 0.
    pub filter_s: f64,
    /// Time after which equal readings of a sensor are no readings, s, above 0. `NAN` where they
    /// are normal, as those of a coarse converter.
    pub repeats_s: f64,
    /// The gate against spikes never holds back what deviates by this, in the output's unit, from
    /// 0. `NAN` for no gate.
    pub gate: f64,
    /// The fastest change of the drive, in its unit per second, above 0. `NAN` for no such limit.
    pub slew: f64,
    /// Time without a reading after which the loop is given up, s, above 0. `NAN` for never.
    pub lost_s: f64,
    /// The same for an output that stands still where it has to move.
    pub stuck_s: f64,
    /// Samples until a drive moves the output that is read, up to 1001. -1 for one more than the
    /// dead time of the model, without a model for none.
    pub delay: i32,
    /// 1 for the policy *anticipate*, which takes the headings; 0 for *hold*, which does not.
    pub anticipate: i32,
    /// 1 if the drive is the square root of the power of the inner loop, else 0.
    pub square_root: i32,
    /// 1 if a sensor measures the input, else 0.
    pub input_measured: i32,
}

/// What a controller does at a sample.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronAction {
    /// The input that is asked for.
    pub command: f64,
    /// The drive to write to the device.
    pub drive: f64,
    /// The output that the model expected at the last input, before it learned from the reading.
    /// `NAN` without a model.
    pub prediction: f64,
    /// The filtered output. `NAN` where there is no new valid reading.
    pub output: f64,
    /// The filtered input. `NAN` where there is none.
    pub input: f64,
    /// Flags, added: `HYSTERON_AT_LIMIT` to `HYSTERON_OUTLIER`.
    pub status: i32,
}

fn flag(name: &'static str, value: i32) -> Result<bool> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(Fault::Call(HYSTERON_VALUE, name)),
    }
}

impl HysteronControl {
    /// Of a scheme without a model.
    fn of(scheme: &Scheme) -> Self {
        let none = f64::NAN;
        Self {
            interval_s: scheme.interval_s,
            drive_min: scheme.drives.0,
            drive_max: scheme.drives.1,
            command_min: scheme.commands.0,
            command_max: scheme.commands.1,
            bias: scheme.bias,
            tolerance: scheme.tolerance,
            gain: none,
            integral_s: 0.0,
            derivative_s: 0.0,
            inner_gain: none,
            inner_integral_s: 0.0,
            inner_derivative_s: 0.0,
            filter_s: scheme.filter_s,
            repeats_s: none,
            gate: none,
            slew: none,
            lost_s: none,
            stuck_s: none,
            delay: -1,
            anticipate: 0,
            square_root: 0,
            input_measured: 0,
        }
    }

    /// The settings, without a model.
    pub(crate) fn scheme(&self) -> Result<Scheme> {
        let delay = match self.delay {
            -1 => None,
            delay => match usize::try_from(delay) {
                Ok(delay) => Some(delay),
                Err(_) => return Err(Fault::Call(HYSTERON_VALUE, "delay")),
            },
        };
        let gains = |gain, integral_s, derivative_s| {
            given(gain).map(|gain| Gains {
                gain,
                integral_s,
                derivative_s,
            })
        };
        let square_root = flag("square_root", self.square_root)?;
        let inner = gains(
            self.inner_gain,
            self.inner_integral_s,
            self.inner_derivative_s,
        );
        Ok(Scheme {
            policy: match flag("anticipate", self.anticipate)? {
                true => Policy::Anticipate,
                false => Policy::Hold,
            },
            tolerance: self.tolerance,
            pid: gains(self.gain, self.integral_s, self.derivative_s),
            bias: self.bias,
            drives: (self.drive_min, self.drive_max),
            inner: inner.map(|gains| InnerLoop { gains, square_root }),
            filter_s: self.filter_s,
            stuck_s: given(self.repeats_s),
            gate: given(self.gate),
            slew: given(self.slew),
            delay,
            safety: Safety {
                lost_s: given(self.lost_s),
                stuck_s: given(self.stuck_s),
            },
            ..Scheme::new(self.interval_s, (self.command_min, self.command_max))
        })
    }

    pub(crate) fn input_measured(&self) -> Result<bool> {
        flag("input_measured", self.input_measured)
    }
}

impl From<Action> for HysteronAction {
    fn from(action: Action) -> Self {
        Self {
            command: action.command,
            drive: action.drive,
            prediction: action.prediction,
            output: action.filtered.output,
            input: action.filtered.input.unwrap_or(f64::NAN),
            status: flags(action.status),
        }
    }
}

fn flags(status: LoopStatus) -> i32 {
    let flags = [
        (status.saturated, HYSTERON_AT_LIMIT),
        (status.out_of_reach, HYSTERON_OUT_OF_REACH),
        (status.sensor_fault, HYSTERON_NO_READING),
        (status.stuck, HYSTERON_STUCK),
        (status.safe, HYSTERON_SAFE),
        (status.adapted, HYSTERON_ADAPTED),
        (status.rejected, HYSTERON_OUTLIER),
    ];
    flags.iter().map(|(is, flag)| i32::from(*is) * flag).sum()
}

/// Fills in the settings of a loop that samples every `interval_s` seconds and drives from
/// `drive_min` to `drive_max`. It has no feedback, filter, gate, slew, inner loop or safe state yet.
/// The tolerance is the usual one of `model`, and 0 for `model` 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_control_default(
    model: u64,
    interval_s: f64,
    drive_min: f64,
    drive_max: f64,
    control: *mut HysteronControl,
) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let control = unsafe { Arguments::default().out(control, "control")? };
        let mut scheme = Scheme::new(interval_s, (drive_min, drive_max));
        if model != 0 {
            scheme.tolerance = MODELS.get(model, "model")?.usual_tolerance();
        }
        control.set(HysteronControl::of(&scheme));
        Ok(())
    })
}
