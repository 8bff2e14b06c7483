//! A PID controller for samples, with anti-windup.

use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};

/// Gains of a PID controller in its ideal form, `u = gain · (e + ∫e dt / integral_s + derivative_s · de/dt)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gains {
    /// Proportional gain, in units of what is written for each unit of the error.
    pub gain: f64,
    /// Integral time, s; 0 for none.
    #[serde(default)]
    pub integral_s: f64,
    /// Derivative time, s; 0 for none. The derivative is filtered with an eighth of it.
    #[serde(default)]
    pub derivative_s: f64,
}

impl Gains {
    /// Refuses what no controller can have.
    ///
    /// # Errors
    /// [`Error::Control`].
    pub fn check(&self) -> Result<()> {
        let time = |value: f64| value >= 0.0 && value.is_finite();
        match self.gain.is_finite() && time(self.integral_s) && time(self.derivative_s) {
            true => Ok(()),
            false => Err(Error::Control(format!(
                "gain {}, integral time {} s, derivative time {} s: a finite gain and times from zero are needed",
                self.gain, self.integral_s, self.derivative_s
            ))),
        }
    }
}

/// Filter of the derivative: its time constant is the derivative time over this (Åström & Hägglund 2006, section 3.3: 2 to 20).
const DERIVATIVE_FILTER: f64 = 8.0;

/// A PID controller in motion.
///
/// It stays within limits by conditional integration: while the output stands at a limit, or the actuator behind it does, the
/// integral does not grow any further in that direction (Åström & Hägglund 2006, section 3.5), so that it leaves the limit as
/// soon as the error changes its sign.
///
/// ```
/// use hysteron::control::{Gains, Pid};
/// let mut pid = Pid::new(Gains { gain: 2.0, integral_s: 1.0, derivative_s: 0.0 });
/// let limits = (0.0, 10.0);
/// for _ in 0..1000 {
///     assert_eq!(pid.step(100.0, 0.1, 0.0, limits, (false, false)), 10.0); // out of reach for long
/// }
/// assert!(pid.step(-1.0, 0.1, 0.0, limits, (false, false)) < 10.0); // and back at once
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Pid {
    gains: Gains,
    integral: f64,
    /// Error of the last sample and its filtered derivative.
    last: Option<(f64, f64)>,
    /// What all terms came to at the last sample, within the limits.
    correction: f64,
}

impl Pid {
    /// At rest, with nothing integrated.
    #[must_use]
    pub fn new(gains: Gains) -> Self {
        Self {
            gains,
            integral: 0.0,
            last: None,
            correction: 0.0,
        }
    }

    /// The output for `error` after `dt` s: `bias` and the three terms, within `limits` whatever the numbers are. `held` tells
    /// whether the actuator behind stands at its lower and its upper limit.
    pub fn step(
        &mut self,
        error: f64,
        dt: f64,
        bias: f64,
        (low, high): (f64, f64),
        held: (bool, bool),
    ) -> f64 {
        let Gains {
            gain,
            integral_s,
            derivative_s,
        } = self.gains;
        let slope = match self.last {
            Some((last, slope)) if derivative_s > 0.0 => {
                let share = dt / (dt + derivative_s / DERIVATIVE_FILTER);
                slope + share * ((error - last) / dt - slope)
            }
            _ => 0.0,
        };
        // Errors near the largest number overflow in the difference; the derivative starts again then.
        self.last = (error - slope).is_finite().then_some((error, slope));
        let fixed = bias + gain * (error + derivative_s * slope);
        if integral_s > 0.0 {
            let growth = gain * error * dt / integral_s;
            let out = fixed + self.integral + growth;
            let pushes_up = growth > 0.0 && (out > high || held.1);
            let pushes_down = growth < 0.0 && (out < low || held.0);
            if out.is_finite() && !pushes_up && !pushes_down {
                self.integral += growth;
            }
            // What the integral alone would add beyond the limits serves nothing.
            self.integral = clamp(self.integral, (low - bias).min(0.0), (high - bias).max(0.0));
        }
        let out = clamp(fixed + self.integral, low, high);
        self.correction = out - bias;
        out
    }

    /// The output without a reading: what the terms came to stays, so that nothing jumps when the reading goes. When it is
    /// back, the output moves by what the error has changed in between and no more. The derivative starts again.
    pub fn hold(&mut self, bias: f64, (low, high): (f64, f64)) -> f64 {
        self.last = None;
        clamp(bias + self.correction, low, high)
    }
}

/// Like [`f64::clamp`], but without its panic for limits in the wrong order; NaN comes out as `low`.
pub(super) fn clamp(value: f64, low: f64, high: f64) -> f64 {
    value.max(low).min(high)
}
