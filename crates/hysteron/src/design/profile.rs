//! Ramps over time through given turning points, within the rates of the actuator.

use crate::error::{Error, Result};

/// How fast the input can change, in its unit per second. Both rates are above zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rates {
    /// Rate of a rising input.
    pub heating: f64,
    /// Rate of a falling input.
    pub cooling: f64,
}

impl Rates {
    pub(super) fn check(self) -> Result<()> {
        for (name, rate) in [("heating", self.heating), ("cooling", self.cooling)] {
            if !(rate.is_finite() && rate > 0.0) {
                return Err(Error::Design(format!(
                    "the {name} rate is {rate}, but must be above zero, in units of the input per \
                     second"
                )));
            }
        }
        Ok(())
    }

    pub(super) fn fastest(self) -> f64 {
        self.heating.max(self.cooling)
    }

    /// Time in seconds from one input to another.
    pub(super) fn seconds(self, from: f64, to: f64) -> f64 {
        if to > from {
            (to - from) / self.heating
        } else {
            (from - to) / self.cooling
        }
    }

    /// Time in seconds along all turning points.
    pub(super) fn duration(self, turns: &[f64]) -> f64 {
        turns
            .windows(2)
            .map(|leg| self.seconds(leg[0], leg[1]))
            .sum()
    }
}

/// Straight ramps through the inputs `turns`. Returns time (in seconds, from 0) and input. Each
/// turning point is a sample. The samples between two turning points are evenly spread, at most
/// `step_s` apart.
#[must_use]
pub fn ramps(turns: &[f64], rates: Rates, step_s: f64) -> (Vec<f64>, Vec<f64>) {
    let mut time: Vec<f64> = turns.first().map(|_| 0.0).into_iter().collect();
    let mut input: Vec<f64> = turns.first().copied().into_iter().collect();
    let mut began = 0.0;
    for leg in turns.windows(2) {
        let (from, to) = (leg[0], leg[1]);
        let duration = rates.seconds(from, to);
        // The factor keeps a whole number of steps from being rounded up to one more.
        let count = (duration / step_s * (1.0 - 1e-9)).ceil().max(1.0);
        for k in 1..=count as usize {
            let part = k as f64 / count;
            time.push(began + part * duration);
            // The last sample of a ramp is exactly the turning point.
            input.push(if k as f64 == count {
                to
            } else {
                from + part * (to - from)
            });
        }
        began += duration;
    }
    (time, input)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_points_are_samples_and_rates_are_kept() {
        let rates = Rates {
            heating: 2.0,
            cooling: 0.5,
        };
        let turns = [20.0, 80.3, 21.7, 50.0];
        let (time, input) = ramps(&turns, rates, 0.25);
        assert_eq!(time.len(), input.len());
        for turn in turns {
            assert!(input.contains(&turn));
        }
        for (t, x) in time.windows(2).zip(input.windows(2)) {
            let (step, rate) = (t[1] - t[0], (x[1] - x[0]) / (t[1] - t[0]));
            assert!(step > 0.2 && step <= 0.25 + 1e-9);
            // Times of some hundred seconds are exact to 1e-13; their differences are divided by a
            // quarter of a second.
            assert!(
                (rate - 2.0).abs() < 1e-9 || (rate + 0.5).abs() < 1e-9,
                "{rate}"
            );
        }
        let end = time.last().copied().unwrap_or_default();
        assert!((end - rates.duration(&turns)).abs() < 1e-9);
        assert_eq!(ramps(&[], rates, 1.0), (vec![], vec![]));
    }
}
