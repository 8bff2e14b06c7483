//! A simulated sensor: lag, noise, resolution, range and faults, in this order.

use crate::rig::{RigError, Sensor, check};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardUniform};
use serde::Deserialize;

/// Shortest step that a lag asks of its plant, s.
const SHORTEST_STEP_S: f64 = 1e-3;

/// Step (s) in which the answer of a first-order body with the time constant `lag_s` is nearly
/// straight.
pub(super) fn step_for_lag(lag_s: f64) -> f64 {
    (0.1 * lag_s).max(SHORTEST_STEP_S)
}

/// What a simulated sensor does to the truth, in the unit of what it measures. The default is a
/// perfect sensor. A scenario that names a sensor gives all of its faults: each field left out is
/// perfect.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SensorOptions {
    /// Time constant of the first-order lag, s, from 0 (none) to 100.
    pub lag_s: f64,
    /// Largest error of the noise, three of its standard deviations; see [`Sensor`].
    pub accuracy: f64,
    /// Distance between two values that it tells apart; 0 for none.
    pub resolution: f64,
    /// Lowest and highest reading.
    pub range: Option<(f64, f64)>,
    /// Probability that a reading is lost and comes as NaN, from 0 to 1.
    pub dropout: f64,
}

impl SensorOptions {
    /// A thermocouple: the chapter's ±1 °C, a lag of 0.5 s, −50 to 250 °C in steps of 0.1 °C.
    pub const THERMOCOUPLE: Self = Self {
        lag_s: 0.5,
        accuracy: Sensor::THERMOCOUPLE.accuracy,
        resolution: 0.1,
        range: Some((-50.0, 250.0)),
        dropout: 0.0,
    };
    /// A displacement transducer: the chapter's ±0.5 mm, −25 to 25 mm in 12 bits.
    pub const LVDT: Self = Self {
        lag_s: 0.0,
        accuracy: Sensor::LVDT.accuracy,
        resolution: 50.0 / 4096.0,
        range: Some((-25.0, 25.0)),
        dropout: 0.0,
    };

    /// Refuses numbers that no sensor can have.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] names the first number that does not fit.
    pub fn check(&self) -> Result<(), RigError> {
        check("lag of a sensor (s)", self.lag_s, 0.0, 100.0)?;
        self.noise().check()?;
        check("resolution of a sensor", self.resolution, 0.0, 1e6)?;
        check("dropout of a sensor", self.dropout, 0.0, 1.0)?;
        if let Some((low, high)) = self.range {
            check("lower end of a sensor's range", low, -1e9, 1e9)?;
            check("upper end of a sensor's range", high, low, 1e9)?;
        }
        Ok(())
    }

    fn noise(&self) -> Sensor {
        Sensor {
            accuracy: self.accuracy,
        }
    }
}

/// A simulated sensor in motion.
///
/// ```
/// use hysteron_sim::plant::{SensorChain, SensorOptions};
///
/// let options = SensorOptions { lag_s: 0.5, resolution: 0.1, ..SensorOptions::default() };
/// let mut sensor = SensorChain::new(options, 20.0, 1, 0)?;
/// sensor.follow(30.0, 1e-9); // the truth jumps,
/// sensor.follow(30.0, 0.5); // and one time constant later 63 % of it shows
/// assert!((sensor.read() - 26.3).abs() < 1e-9);
/// # Ok::<(), hysteron_sim::rig::RigError>(())
/// ```
#[derive(Debug, Clone)]
pub struct SensorChain {
    options: SensorOptions,
    truth: f64,
    lagged: f64,
    last: f64,
    stuck: bool,
    lost: bool,
    rng: ChaCha8Rng,
}

impl SensorChain {
    /// A sensor settled on `truth`. Equal `seed`s give equal readings; the sensors of one plant
    /// differ by their `stream`.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] as [`SensorOptions::check`].
    pub fn new(
        options: SensorOptions,
        truth: f64,
        seed: u64,
        stream: u64,
    ) -> Result<Self, RigError> {
        options.check()?;
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(stream);
        let mut sensor = Self {
            options,
            truth: f64::NAN,
            lagged: f64::NAN,
            last: f64::NAN,
            stuck: false,
            lost: false,
            rng,
        };
        sensor.settle(truth);
        Ok(sensor)
    }

    /// Sets the sensor as if the truth had always been `truth`.
    pub(super) fn settle(&mut self, truth: f64) {
        self.truth = truth;
        self.lagged = truth;
        // If it sticks before it was ever read, it stands at what it would show without noise.
        self.last = self.shown(truth);
    }

    /// Longest step (s) in which the truth may be taken as moving along a straight line for
    /// [`follow`](Self::follow).
    pub(super) fn longest_step_s(&self) -> f64 {
        if self.options.lag_s > 0.0 {
            step_for_lag(self.options.lag_s)
        } else {
            f64::INFINITY
        }
    }

    /// The truth moves to `truth` in `dt_s` (s). On a straight line, which makes the lag exact.
    pub fn follow(&mut self, truth: f64, dt_s: f64) {
        let lag = self.options.lag_s;
        if lag > 0.0 && dt_s > 0.0 {
            // τ s' + s = x on x(t) = x₀ + r t: s = x − r τ + (s₀ − x₀ + r τ) exp(−t/τ).
            let behind = (truth - self.truth) / dt_s * lag;
            let decay = (-dt_s / lag).exp();
            self.lagged = truth - behind + (self.lagged - self.truth + behind) * decay;
        } else if lag == 0.0 {
            self.lagged = truth;
        }
        self.truth = truth;
    }

    /// One reading, NaN where it is lost.
    pub fn read(&mut self) -> f64 {
        // Drawn during faults, too. So the noise after a fault is the same as without it.
        let noisy = self.options.noise().read(self.lagged, &mut self.rng);
        let chance: f64 = StandardUniform.sample(&mut self.rng);
        let dropped = chance < self.options.dropout;
        if self.lost || dropped {
            return f64::NAN;
        }
        if !self.stuck {
            self.last = self.shown(noisy);
        }
        self.last
    }

    /// Lets the sensor stand still at its last reading, or work again.
    pub fn set_stuck(&mut self, stuck: bool) {
        self.stuck = stuck;
    }

    /// Lets the sensor read NaN, or work again.
    pub fn set_lost(&mut self, lost: bool) {
        self.lost = lost;
    }

    /// What the display makes of a value: steps counted from the range's lower end, within the
    /// range.
    fn shown(&self, value: f64) -> f64 {
        let (low, high) = self
            .options
            .range
            .unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let origin = if low.is_finite() { low } else { 0.0 };
        let step = self.options.resolution;
        let stepped = if step > 0.0 {
            origin + ((value - origin) / step).round() * step
        } else {
            value
        };
        stepped.clamp(low, high)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn chain(options: SensorOptions) -> SensorChain {
        SensorChain::new(options, 0.0, 7, 0).unwrap()
    }

    #[test]
    fn the_lag_is_that_of_a_first_order_body_however_time_is_divided() {
        let tau = 0.5;
        for pieces in [1, 3, 100] {
            let mut sensor = chain(SensorOptions {
                lag_s: tau,
                ..SensorOptions::default()
            });
            // A ramp of 4 per second for 2 s, then 1 s at rest.
            for n in 1..=pieces {
                sensor.follow(
                    8.0 * f64::from(n) / f64::from(pieces),
                    2.0 / f64::from(pieces),
                );
            }
            let on_ramp = 8.0 - 4.0 * tau * (1.0 - f64::exp(-2.0 / tau));
            assert!((sensor.read() - on_ramp).abs() < 1e-12);
            for _ in 0..pieces {
                sensor.follow(8.0, 1.0 / f64::from(pieces));
            }
            let at_rest = 8.0 + (on_ramp - 8.0) * f64::exp(-1.0 / tau);
            assert!((sensor.read() - at_rest).abs() < 1e-12);
        }
    }

    #[test]
    fn readings_come_in_steps_within_the_range() {
        let options = SensorOptions {
            accuracy: 0.5,
            resolution: 0.25,
            range: Some((-1.0, 2.0)),
            ..SensorOptions::default()
        };
        let mut sensor = chain(options);
        let mut seen = std::collections::BTreeSet::new();
        for n in 0..2000 {
            sensor.follow(-3.0 + f64::from(n) * 0.004, 0.01);
            let reading = sensor.read();
            assert_eq!((reading / 0.25).fract(), 0.0);
            seen.insert((reading / 0.25) as i32);
        }
        assert!(seen.into_iter().eq(-4..=8));
    }

    #[test]
    fn noise_stays_within_the_accuracy_and_has_no_bias() {
        let mut sensor = chain(SensorOptions {
            accuracy: 3.0,
            ..SensorOptions::default()
        });
        let readings: Vec<f64> = (0..10_000).map(|_| sensor.read()).collect();
        assert!(readings.iter().all(|x| x.abs() <= 3.0));
        let mean = readings.iter().sum::<f64>() / 1e4;
        let deviation = (readings.iter().map(|x| x * x).sum::<f64>() / 1e4).sqrt();
        // Five standard errors; what lies beyond three sigmas is drawn again, which takes 1.4 % off
        // the deviation.
        assert!(mean.abs() < 0.05, "{mean}");
        assert!((deviation - 0.986).abs() < 0.05, "{deviation}");
    }

    #[test]
    fn faults_come_and_go_and_leave_the_noise_as_it_was() {
        let options = SensorOptions {
            accuracy: 1.0,
            ..SensorOptions::default()
        };
        let (mut whole, mut faulty) = (chain(options), chain(options));
        let expected: Vec<f64> = (0..6).map(|_| whole.read()).collect();
        assert_eq!(faulty.read(), expected[0]);
        faulty.set_stuck(true);
        assert_eq!([faulty.read(), faulty.read()], [expected[0]; 2]);
        faulty.set_stuck(false);
        assert_eq!(faulty.read(), expected[3]);
        faulty.set_lost(true);
        assert!(faulty.read().is_nan());
        faulty.set_lost(false);
        assert_eq!(faulty.read(), expected[5]);
    }

    #[test]
    fn dropouts_come_with_their_probability() {
        let mut sensor = chain(SensorOptions {
            dropout: 0.1,
            ..SensorOptions::default()
        });
        let lost = (0..10_000).filter(|_| sensor.read().is_nan()).count();
        // Five standard deviations of a binomial count, 30 each.
        assert!(lost.abs_diff(1000) < 150, "{lost}");
    }

    #[test]
    fn what_no_sensor_can_be_is_refused() {
        let perfect = SensorOptions::default();
        for options in [
            SensorOptions {
                lag_s: -1.0,
                ..perfect
            },
            SensorOptions {
                accuracy: f64::NAN,
                ..perfect
            },
            SensorOptions {
                resolution: f64::INFINITY,
                ..perfect
            },
            SensorOptions {
                dropout: 1.1,
                ..perfect
            },
            SensorOptions {
                range: Some((1.0, 0.0)),
                ..perfect
            },
            SensorOptions {
                range: Some((f64::NAN, 0.0)),
                ..perfect
            },
        ] {
            let refused = SensorChain::new(options, 0.0, 1, 0);
            assert!(
                matches!(refused, Err(RigError::OutOfRange { .. })),
                "{options:?}"
            );
        }
    }
}
