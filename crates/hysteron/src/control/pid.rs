//! The gains of a PID controller.

use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};

/// Gains of a PID controller in its ideal form,
/// `u = gain · (e + ∫e dt / integral_s + derivative_s · de/dt)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gains {
    /// Proportional gain: output of the controller per unit of the error.
    pub gain: f64,
    /// Integral time, s; 0 for no integral term.
    #[serde(default)]
    pub integral_s: f64,
    /// Derivative time, s; 0 for no derivative term. The derivative is low-pass filtered with an
    /// eighth of this time.
    #[serde(default)]
    pub derivative_s: f64,
}

impl Gains {
    /// Refuses gains that no controller can use.
    ///
    /// # Errors
    /// [`Error::Control`] for values that are not finite, and for negative times.
    pub fn check(&self) -> Result<()> {
        let time = |value: f64| value >= 0.0 && value.is_finite();
        match self.gain.is_finite() && time(self.integral_s) && time(self.derivative_s) {
            true => Ok(()),
            false => Err(Error::Control(format!(
                "gain {}, integral time {} s, derivative time {} s: a finite gain and times from \
                 zero are needed",
                self.gain, self.integral_s, self.derivative_s
            ))),
        }
    }
}

impl From<Gains> for hysteron_core::control::Terms {
    fn from(gains: Gains) -> Self {
        Self {
            gain: gains.gain,
            integral_s: gains.integral_s,
            derivative_s: gains.derivative_s,
        }
    }
}
