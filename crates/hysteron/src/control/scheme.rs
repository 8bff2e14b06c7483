//! The configuration of a controller.

use super::{Compensator, Gains, Safety};
use crate::error::{Error, Result};
use crate::model::{Delay, Policy};

/// The inner loop, which brings the input (a temperature) to the commanded value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InnerLoop {
    /// Its gains: power per degree.
    pub gains: Gains,
    /// Whether the drive is the square root of the controller's output. Use it where the drive is a
    /// current, because its heat is proportional to its square.
    pub square_root: bool,
}

/// The configuration of a [`Controller`](super::Controller).
#[derive(Debug, Clone)]
pub struct Scheme {
    /// Time between samples, s.
    pub interval_s: f64,
    /// The model, for feedforward through its inverse; `None` for feedback only.
    pub compensator: Option<Compensator>,
    /// Whether the inverse holds the input or crosses the dead band when the target reverses.
    pub policy: Policy,
    /// Reversals of the target up to this size are noise and the inverse does not follow them; in
    /// the output's unit.
    pub tolerance: f64,
    /// Feedback of the output, added to the feedforward.
    pub pid: Option<Gains>,
    /// Command without feedback, for a scheme without a model.
    pub bias: f64,
    /// Lowest and highest input that may be commanded.
    pub commands: (f64, f64),
    /// Lowest and highest drive.
    pub drives: (f64, f64),
    /// The inner loop. Without one, the command is the drive.
    pub inner: Option<InnerLoop>,
    /// Time constant of the low-pass filter on both readings, s; 0 for no filter. Beside an inverse
    /// without an inner loop the feedback compares the output with a target that is filtered alike.
    pub filter_s: f64,
    /// Time in seconds after which a sensor that gives nothing new is taken as broken. A missing
    /// reading, or one equal to the last to the last bit, is nothing new. Until this time has
    /// passed the inner loop holds the drive.
    ///
    /// `None` for sensors without noise, where an unchanged reading is normal: equal readings are
    /// valid then, and a missing reading counts as broken at once.
    pub stuck_s: Option<f64>,
    /// A gate against spikes: readings of the output that are far from where the last ones lead, and
    /// that the model does not expect, are taken as missing until two more agree with them. So a
    /// spike does not move the drive, and a plant that jumps is believed two samples late. *Far* is
    /// ten standard deviations of the noise, and this size at least, in the output's unit. `None`
    /// for no gate.
    pub gate: Option<f64>,
    /// The fastest change of the drive, in its unit per second; `None` for no such limit.
    pub slew: Option<f64>,
    /// Samples until a drive moves the output that is read. So many samples ahead is the target
    /// that the inverse solves for, as far as it is told ([`super::Controller::step_ahead`]), and
    /// so late the model follows the inputs. The feedback compares what is read now with what is
    /// wanted now. `None`: one sample, and the dead time of the model ([`crate::Delay`]). With an
    /// inner loop the dead time alone: the input then comes to its command in its own time.
    pub delay: Option<usize>,
    /// When the loop is given up.
    pub safety: Safety,
}

impl Scheme {
    /// A loop that samples every `interval_s` seconds and commands inputs within `commands`. The
    /// commands are also the drives. There is no model, no feedback and no filter: set these fields
    /// as needed.
    #[must_use]
    pub fn new(interval_s: f64, commands: (f64, f64)) -> Self {
        Self {
            interval_s,
            compensator: None,
            policy: Policy::Hold,
            tolerance: 0.0,
            pid: None,
            bias: commands.0,
            commands,
            drives: commands,
            inner: None,
            filter_s: 0.0,
            stuck_s: None,
            gate: None,
            slew: None,
            delay: None,
            safety: Safety::default(),
        }
    }

    /// Samples until a drive moves the output that is read. Without a model and a number, 0.
    #[must_use]
    pub fn due(&self) -> usize {
        let next = usize::from(self.inner.is_none());
        let of_model =
            |compensator: &Compensator| next + compensator.delay().at(Some(self.interval_s));
        let of_model = || self.compensator.as_ref().map_or(0, of_model);
        self.delay.unwrap_or_else(of_model)
    }

    /// Samples by which the output answers an input that has acted up to a reading.
    pub(super) fn late(&self) -> usize {
        self.due().saturating_sub(usize::from(self.inner.is_none()))
    }

    /// Refuses settings that no loop can run with.
    ///
    /// # Errors
    /// [`Error::Control`] names the field.
    pub(super) fn check(&self) -> Result<()> {
        let require = |fine: bool, what: &str| match fine {
            true => Ok(()),
            false => Err(Error::Control(what.into())),
        };
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let from_zero = |value: f64| value >= 0.0 && value.is_finite();
        let range = |(low, high): (f64, f64)| low < high && (high - low).is_finite();
        require(positive(self.interval_s), "`interval_s` must be above zero")?;
        require(
            from_zero(self.tolerance),
            "`tolerance` must be zero or above",
        )?;
        require(from_zero(self.filter_s), "`filter_s` must be zero or above")?;
        require(
            self.stuck_s.is_none_or(positive),
            "`stuck_s` must be above zero",
        )?;
        require(self.slew.is_none_or(positive), "`slew` must be above zero")?;
        require(
            self.gate.is_none_or(from_zero),
            "`gate` must be zero or above",
        )?;
        let few = self.delay.is_none_or(|delay| delay <= Delay::MOST + 1);
        require(few, "`delay` must be at most 1001 samples")?;
        let Safety { lost_s, stuck_s } = self.safety;
        require(
            [lost_s, stuck_s].into_iter().flatten().all(positive),
            "the times of `safety` must be above zero",
        )?;
        require(self.bias.is_finite(), "`bias` must be a finite number")?;
        require(
            range(self.commands),
            "`commands` must be finite, the lower one first",
        )?;
        require(
            range(self.drives),
            "`drives` must be finite, the lower one first",
        )?;
        if let Some(gains) = self.pid {
            gains.check()?;
        }
        if let Some(inner) = self.inner {
            inner.gains.check()?;
            let fine = !inner.square_root || self.drives.0 >= 0.0;
            require(
                fine,
                "`drives` must not be negative, because the drive is a square root",
            )?;
        }
        Ok(())
    }
}
