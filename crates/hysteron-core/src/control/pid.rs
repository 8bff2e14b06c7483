//! A sampled PID controller with anti-windup.

/// The terms of a PID controller in its ideal form,
/// `u = gain · (e + ∫e dt / integral_s + derivative_s · de/dt)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Terms {
    /// Proportional gain: output of the controller per unit of the error.
    pub gain: f64,
    /// Integral time, s; 0 for no integral term.
    pub integral_s: f64,
    /// Derivative time, s; 0 for no derivative term.
    pub derivative_s: f64,
}

/// The filter's time constant is the derivative time divided by this number (Åström & Hägglund
/// 2006, section 3.3: 2 to 20).
const DERIVATIVE_FILTER: f64 = 8.0;

/// A PID controller with its state.
///
/// Anti-windup by conditional integration: while the output, or the actuator behind it, is at a
/// limit, the integral does not grow further in that direction (Åström & Hägglund 2006, section
/// 3.5). So the output leaves the limit as soon as the error changes its sign.
///
/// ```
/// use hysteron_core::control::{Pid, Terms};
/// let mut pid = Pid::new(Terms { gain: 2.0, integral_s: 1.0, derivative_s: 0.0 });
/// let limits = (0.0, 10.0);
/// for _ in 0..1000 {
///     // The error is out of reach for a long time.
///     assert_eq!(pid.step(100.0, 0.1, 0.0, limits, (false, false)), 10.0);
/// }
/// assert!(pid.step(-1.0, 0.1, 0.0, limits, (false, false)) < 10.0); // and back at once
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Pid {
    terms: Terms,
    integral: f64,
    /// What the derivative acts on at the last sample, and its filtered derivative.
    last: Option<(f64, f64)>,
    /// Sum of all terms at the last sample, within the limits.
    correction: f64,
    /// Whether the integral is still beyond the limits because it began there.
    begun: bool,
}

impl Pid {
    /// A controller at rest, with an empty integral.
    #[must_use]
    pub fn new(terms: impl Into<Terms>) -> Self {
        Self {
            terms: terms.into(),
            integral: 0.0,
            last: None,
            correction: 0.0,
            begun: false,
        }
    }

    /// Changes the terms. The integral stays.
    pub fn set(&mut self, terms: impl Into<Terms>) {
        self.terms = terms.into();
    }

    /// The output for `error`, `dt` s after the last sample: `bias` plus the three terms. The
    /// result is within `limits` for any input. `held` tells whether the actuator is at its lower
    /// and at its upper limit.
    pub fn step(
        &mut self,
        error: f64,
        dt: f64,
        bias: f64,
        limits: (f64, f64),
        held: (bool, bool),
    ) -> f64 {
        self.follow(error, -error, dt, bias, limits, held)
    }

    /// As [`Pid::step`], with the derivative of the `measured` output alone: a step of the
    /// reference gives no kick (Åström & Hägglund 2006, section 3.3).
    ///
    /// ```
    /// use hysteron_core::control::{Pid, Terms};
    /// let mut pid = Pid::new(Terms { gain: 1.0, integral_s: 0.0, derivative_s: 1.0 });
    /// let mut drive = |reference: f64, measured: f64| {
    ///     pid.follow(reference - measured, measured, 0.1, 0.0, (-99.0, 99.0), (false, false))
    /// };
    /// drive(0.0, 0.0);
    /// assert_eq!(drive(2.0, 0.0), 2.0); // the proportional term, and no more
    /// ```
    pub fn follow(
        &mut self,
        error: f64,
        measured: f64,
        dt: f64,
        bias: f64,
        (low, high): (f64, f64),
        held: (bool, bool),
    ) -> f64 {
        let Terms {
            gain,
            integral_s,
            derivative_s,
        } = self.terms;
        let slope = match self.last {
            Some((last, slope)) if derivative_s > 0.0 => {
                let share = dt / (dt + derivative_s / DERIVATIVE_FILTER);
                slope + share * ((last - measured) / dt - slope)
            }
            _ => 0.0,
        };
        // For huge errors the difference can overflow. Then the derivative starts again.
        self.last = (measured + slope).is_finite().then_some((measured, slope));
        let fixed = bias + gain * (error + derivative_s * slope);
        if integral_s > 0.0 {
            let growth = gain * error * dt / integral_s;
            let out = fixed + self.integral + growth;
            let pushes_up = growth > 0.0 && (out > high || held.1);
            let pushes_down = growth < 0.0 && (out < low || held.0);
            // The integral never needs to exceed the limits on its own, unless it began there.
            let (mut lowest, mut highest) = ((low - bias).min(0.0), (high - bias).max(0.0));
            self.begun &= self.integral < lowest || self.integral > highest;
            if self.begun {
                (lowest, highest) = (lowest.min(self.integral), highest.max(self.integral));
            }
            if out.is_finite() && !pushes_up && !pushes_down {
                self.integral += growth;
            }
            self.integral = clamp(self.integral, lowest, highest);
        }
        let out = clamp(fixed + self.integral, low, high);
        self.correction = out - bias;
        out
    }

    /// Begins from `out`: the next step with this `error` and `bias` gives it, so that a loop that
    /// is closed takes over without a bump. Without an integral term nothing can be done.
    ///
    /// ```
    /// use hysteron_core::control::{Pid, Terms};
    /// let mut pid = Pid::new(Terms { gain: 2.0, integral_s: 1.0, derivative_s: 0.0 });
    /// pid.begin(0.3, 5.0, 0.0);
    /// let drive = pid.step(5.0, 1e-6, 0.0, (0.0, 1.0), (false, false));
    /// assert!((drive - 0.3).abs() < 1e-4);
    /// ```
    pub fn begin(&mut self, out: f64, error: f64, bias: f64) {
        let integral = out - bias - self.terms.gain * error;
        if self.terms.integral_s > 0.0 && integral.is_finite() {
            self.integral = integral;
            self.correction = out - bias;
            self.begun = true;
        }
        self.last = None;
    }

    /// The output for a sample without a reading: the last sum of the terms is kept, so the output
    /// does not jump. When readings return, the output changes only by the change of the error. The
    /// derivative starts again.
    pub fn hold(&mut self, bias: f64, (low, high): (f64, f64)) -> f64 {
        self.last = None;
        clamp(bias + self.correction, low, high)
    }

    /// As [`Pid::hold`], `dt` s after the last sample, for a loop with a feedforward in `bias`. The
    /// feedforward goes on, and the integral is a memory of what it lacks on the average. The other
    /// terms answered to a moment that has passed: they fade with the integral time, and come back
    /// at once with a reading. Without an integral term all is held. So it is while `bias` is at a
    /// limit or beyond, which no term of the feedback shall leave without a reading.
    ///
    /// ```
    /// use hysteron_core::control::{Pid, Terms};
    /// let mut pid = Pid::new(Terms { gain: 2.0, integral_s: 10.0, derivative_s: 0.0 });
    /// let drive = pid.step(1.0, 1.0, 5.0, (0.0, 10.0), (false, false));
    /// assert_eq!(drive, 5.0 + 2.0 + 0.2);
    /// let later = (0..100).map(|_| pid.relax(1.0, 5.0, (0.0, 10.0))).last();
    /// assert!((later.unwrap() - (5.0 + 0.2)).abs() < 1e-3);
    /// ```
    pub fn relax(&mut self, dt: f64, bias: f64, limits: (f64, f64)) -> f64 {
        let time = self.terms.integral_s;
        if time > 0.0 && limits.0 < bias && bias < limits.1 {
            self.correction += (self.integral - self.correction) * (dt / (dt + time));
        }
        self.hold(bias, limits)
    }
}

/// As [`f64::clamp`], without its panic for limits in the wrong order. NaN gives `low`.
#[must_use]
pub fn clamp(value: f64, low: f64, high: f64) -> f64 {
    value.max(low).min(high)
}
