//! A PID controller for samples, with anti-windup.

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
}

impl Pid {
    /// At rest, with nothing integrated.
    #[must_use]
    pub fn new(gains: Gains) -> Self {
        Self {
            gains,
            integral: 0.0,
            last: None,
        }
    }

    /// The output for `error` after `dt` s: `bias` and the three terms, within `limits`. `held` tells whether the actuator
    /// behind stands at its lower and its upper limit.
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
        self.last = Some((error, slope));
        let fixed = bias + gain * (error + derivative_s * slope);
        if integral_s > 0.0 {
            let growth = gain * error * dt / integral_s;
            let out = fixed + self.integral + growth;
            let pushes_up = growth > 0.0 && (out > high || held.1);
            let pushes_down = growth < 0.0 && (out < low || held.0);
            if !pushes_up && !pushes_down {
                self.integral += growth;
            }
            // What the integral alone would add beyond the limits serves nothing.
            self.integral = self
                .integral
                .clamp((low - bias).min(0.0), (high - bias).max(0.0));
        }
        (fixed + self.integral).clamp(low, high)
    }

    /// The output without a reading: what has been integrated stays, proportional and derivative rest.
    #[must_use]
    pub fn hold(&mut self, bias: f64, (low, high): (f64, f64)) -> f64 {
        self.last = None;
        (bias + self.integral).clamp(low, high)
    }
}
