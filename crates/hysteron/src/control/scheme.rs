//! What a controller is made of.

use super::{Compensator, Gains};
use crate::error::{Error, Result};
use crate::model::Policy;

/// The loop inside, which brings the input (a temperature) to the one commanded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InnerLoop {
    /// Its gains: power for each degree.
    pub gains: Gains,
    /// The drive is the square root of what the gains give: a current, whose heat goes with its
    /// square.
    pub square_root: bool,
}

/// What a [`Controller`](super::Controller) is made of.
#[derive(Debug, Clone)]
pub struct Scheme {
    /// Time between samples, s.
    pub interval_s: f64,
    /// The model, for feedforward through its inverse.
    pub compensator: Option<Compensator>,
    /// What the inverse does where the target rests.
    pub policy: Policy,
    /// Reversals of the target up to this size are not followed by the inverse, in the output's
    /// unit.
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
    /// Time without news (readings missing, or the same to the last bit) after which a sensor is
    /// taken as broken, s; until then the loop inside holds the drive. `None` where a sensor has no
    /// noise to tell a broken one from one at rest: then equal readings are believed, and a missing
    /// one counts at once.
    pub stuck_s: Option<f64>,
}

impl Scheme {
    /// A loop that samples every `interval_s` and commands inputs within `commands`, which are the
    /// drive too. Without a model, feedback or filter: set the fields that differ.
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
        }
    }

    /// Refuses numbers that no loop can run with.
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
                "a drive that is a square root cannot be below zero: `drives`",
            )?;
        }
        Ok(())
    }
}
