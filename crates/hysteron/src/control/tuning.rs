//! PID gains from a relay test or a step test on a device, real or simulated.

use super::Gains;
use crate::error::{Error, Result};
use crate::series::mean_and_deviation;

/// Number of periods of the relay test that are left out because the oscillation has not settled,
/// and number of periods that count.
const SETTLED: usize = 3;
const COUNTED: usize = 5;
/// Number of samples that a level is averaged over, before the step and at the end.
const LEVEL: usize = 50;
/// A response smaller than this many standard deviations of the noise does not count.
const ANSWER: f64 = 3.0;

/// The relay test (Åström & Hägglund 1984): a relay in place of the controller makes the loop
/// oscillate.
///
/// ```
/// use hysteron::control::RelayTest;
/// let (mut test, mut y) = (RelayTest::new((0.0, 2.0), 1.0, 0.05)?, [0.0; 8]);
/// while !test.is_done() {
///     y.rotate_right(1); // seven samples of delay behind a lag
///     y[0] = y[1] + 0.1 * (test.command() - y[1]);
///     test.push(y[7]);
/// }
/// let (ultimate_gain, period) = test.oscillation().unwrap(); // period in samples
/// assert!(ultimate_gain > 1.0 && (20.0..40.0).contains(&period));
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RelayTest {
    commands: (f64, f64),
    middle: f64,
    hysteresis: f64,
    high: bool,
    count: usize,
    /// Range of the output since the last period began, and over the whole test.
    range: (f64, f64),
    all: (f64, f64),
    /// For each period, the sample at its end and the amplitude of the output in it.
    periods: Vec<(usize, f64)>,
}

impl RelayTest {
    /// A relay between two `commands`, which switches when the output is `hysteresis` beyond
    /// `middle`.
    ///
    /// # Errors
    /// [`Error::Control`] for commands that are equal and for numbers that are not finite.
    pub fn new(commands: (f64, f64), middle: f64, hysteresis: f64) -> Result<Self> {
        let (low, high) = commands;
        let fine = low < high && (high - low).is_finite() && middle.is_finite();
        if !(fine && hysteresis >= 0.0 && hysteresis.is_finite()) {
            return Err(Error::Control(format!(
                "`commands` {low} to {high}, `middle` {middle}, `hysteresis` {hysteresis}: finite \
                 numbers are needed, the lower command first and the hysteresis from 0 on"
            )));
        }
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        Ok(Self {
            commands,
            middle,
            hysteresis,
            high: true,
            count: 0,
            range: none,
            all: none,
            periods: Vec::new(),
        })
    }

    /// The command for the next sample.
    #[must_use]
    pub fn command(&self) -> f64 {
        match self.high {
            true => self.commands.1,
            false => self.commands.0,
        }
    }

    /// Takes the output of the next sample. For NaN only the time advances.
    pub fn push(&mut self, output: f64) {
        let widened = |(low, high): (f64, f64)| (low.min(output), high.max(output));
        (self.range, self.all) = (widened(self.range), widened(self.all));
        if self.high && output > self.middle + self.hysteresis {
            self.high = false;
        } else if !self.high && output < self.middle - self.hysteresis {
            self.high = true;
            let half = 0.5 * (self.range.1 - self.range.0);
            self.periods.push((self.count, half));
            self.range = (f64::INFINITY, f64::NEG_INFINITY);
        }
        self.count += 1;
    }

    /// Whether enough periods have been recorded.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.periods.len() > SETTLED + COUNTED
    }

    /// Lowest and highest output so far; `None` before the first sample.
    #[must_use]
    pub fn outputs(&self) -> Option<(f64, f64)> {
        (self.all.0 <= self.all.1).then_some(self.all)
    }

    /// The ultimate gain (from the describing function of the relay) and the period in samples,
    /// over the periods that count. `None` before the test is done.
    #[must_use]
    pub fn oscillation(&self) -> Option<(f64, f64)> {
        let counted = self.periods.get(SETTLED..=SETTLED + COUNTED)?;
        let [first, rest @ ..] = counted else {
            return None;
        };
        let count = rest.len() as f64;
        let last = rest.last().map_or(first.0, |(n, _)| *n);
        let amplitude = rest.iter().map(|(_, half)| half).sum::<f64>() / count;
        let swing = 0.5 * (self.commands.1 - self.commands.0);
        let gain = 4.0 * swing / (std::f64::consts::PI * amplitude);
        Some((gain, (last - first.0) as f64 / count))
    }
}

impl Gains {
    /// Proportional and integral gain by Tyreus & Luyben 1992, from the ultimate gain and the
    /// period in seconds. The rule with a derivative term is not used, because with noisy sensors
    /// the derivative drives the output from limit to limit.
    #[must_use]
    pub fn from_oscillation(ultimate_gain: f64, period_s: f64) -> Self {
        Self {
            gain: ultimate_gain / 3.2,
            integral_s: 2.2 * period_s,
            derivative_s: 0.0,
        }
    }

    /// Gains by SIMC (Skogestad 2003) from the `output` of a step test. Before the sample `begin`
    /// the command is constant; from there on it is larger by `step`. The response is modelled as a
    /// first-order lag with a delay, from the times at which it has reached 28.3 % and 63.2 % of
    /// its final change. `None` if the response is not larger than the noise.
    ///
    /// ```
    /// use hysteron::control::Gains;
    /// // A lag of 2 s with a gain of 3, 0.5 s late, sampled every 0.1 s.
    /// let answer = |n: i32| 3.0 * (1.0 - (-0.1 * f64::from(n - 55) / 2.0).exp()).max(0.0);
    /// let output: Vec<f64> = (0..400).map(answer).collect();
    /// let gains = Gains::from_step(&output, 50, 1.0, 0.1).unwrap();
    /// assert!((gains.gain - 2.0 / (3.0 * 2.0 * 0.5)).abs() < 0.1);
    /// ```
    #[must_use]
    pub fn from_step(output: &[f64], begin: usize, step: f64, interval_s: f64) -> Option<Self> {
        let resting = output.get(..begin)?;
        let answer = &output[begin..];
        let (before, noise) = mean_and_deviation(&resting[begin.saturating_sub(LEVEL)..]);
        let (after, _) = mean_and_deviation(&answer[answer.len().saturating_sub(LEVEL)..]);
        if (after - before).abs() < ANSWER * noise {
            return None;
        }
        let gain = (after - before) / step;
        let reached = |share: f64| {
            let there = |y: &f64| (y - before) / (after - before) >= share;
            let first = answer.iter().position(there)?.max(1);
            let (y, z) = (answer[first - 1], *answer.get(first)?);
            let part = (before + share * (after - before) - y) / (z - y);
            Some((first as f64 - 1.0 + part.clamp(0.0, 1.0)) * interval_s)
        };
        let (early, late) = (reached(0.283)?, reached(0.632)?);
        let lag = 1.5 * (late - early);
        let delay = (late - lag).max(0.5 * interval_s);
        (gain.is_finite() && gain != 0.0 && lag > 0.0).then(|| Self {
            // With τ_c = θ.
            gain: lag / (gain * 2.0 * delay),
            integral_s: lag.min(8.0 * delay),
            derivative_s: 0.0,
        })
    }
}
