//! Filters a sensor's readings, and detects readings that are missing or stuck.

use hysteron_core::control::LowPass;

/// What a sensor's reading means at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sensed {
    /// A new reading, filtered.
    New(f64),
    /// Equal to the last reading to the last bit: by chance, or because the sensor begins to stick.
    Repeated,
    /// No reading, but not for long.
    Missing,
    /// No new reading for so long that the sensor is taken as broken.
    Broken,
}

impl Sensed {
    pub(super) fn value(self) -> Option<f64> {
        match self {
            Self::New(value) => Some(value),
            _ => None,
        }
    }

    pub(super) fn fault(self) -> bool {
        matches!(self, Self::Missing | Self::Broken)
    }
}

/// Filters a sensor's readings and tells which of them are valid.
///
/// A repeated reading is rejected at once, long before the sensor is taken as broken. Otherwise the
/// loop would integrate an error that does not exist, and a model would learn from it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sensor {
    filter: LowPass,
    /// Longest time without a new reading that a working sensor can give, s; `None` where equal
    /// readings are valid.
    patience: Option<f64>,
    last: f64,
    /// Time since the last new reading, s.
    gap: f64,
}

/// Sums of intervals that differ by less than this share are one time.
const ROUNDING: f64 = 1e-9;

impl Sensor {
    /// A filter with the time constant `filter_s`. Without a new reading for `stuck_s`, the sensor
    /// is taken as broken.
    pub(super) fn new(filter_s: f64, stuck_s: Option<f64>) -> Self {
        Self {
            filter: LowPass::new(filter_s),
            patience: stuck_s.map(|time| time * (1.0 - ROUNDING)),
            last: f64::NAN,
            gap: 0.0,
        }
    }

    /// Classifies and filters the sensor's `reading`, `dt` s after the one before.
    pub(super) fn read(&mut self, reading: f64, dt: f64) -> Sensed {
        let repeated = self.patience.is_some() && reading == self.last;
        if reading.is_finite() && !repeated {
            self.last = reading;
            return Sensed::New(self.filter(reading, dt));
        }
        self.gap += dt;
        if self.patience.is_none_or(|most| self.gap >= most) {
            Sensed::Broken
        } else if repeated {
            Sensed::Repeated
        } else {
            Sensed::Missing
        }
    }

    /// Filters a valid value. After a gap the value counts for the whole time since the last one.
    pub(super) fn filter(&mut self, value: f64, dt: f64) -> f64 {
        let passed = self.gap + dt;
        self.gap = 0.0;
        self.filter.pass(value, passed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_filter_is_that_of_a_first_order_body_whatever_is_lost() {
        let mut whole = Sensor::new(0.5, Some(1.0));
        let mut lossy = whole.clone();
        // For a constant after a different start, both filters read the same values and end at the
        // same state.
        for n in 0..20 {
            let reading = if n == 0 {
                0.0
            } else {
                1.0 + 1e-12 * f64::from(n)
            };
            let lost = n % 3 == 1;
            let seen = whole.read(reading, 0.1).value();
            let sensed = lossy.read(if lost { f64::NAN } else { reading }, 0.1);
            assert_eq!(sensed == Sensed::Missing, lost);
            if let (Some(a), Some(b)) = (seen, sensed.value()) {
                let exact = 1.0 - (-0.1 * f64::from(n) / 0.5).exp();
                assert!((a - exact).abs() < 1e-9 && (b - exact).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_reading_that_stands_still_is_held_back_at_once_and_broken_after_its_time() {
        let mut sensor = Sensor::new(0.0, Some(0.3));
        let readings = [1.0, 1.0, 1.0, 1.0, f64::NAN, 1.0, 2.0, 2.0];
        use Sensed::{Broken, New, Repeated};
        let expected = [
            New(1.0),
            Repeated,
            Repeated,
            Broken,
            Broken,
            Broken,
            New(2.0),
            Repeated,
        ];
        assert_eq!(readings.map(|y| sensor.read(y, 0.1)), expected);
    }

    #[test]
    fn lost_samples_do_not_hide_that_it_sticks() {
        let mut sensor = Sensor::new(0.0, Some(1.0));
        let last = (0..12)
            .map(|n| sensor.read(if n % 2 == 0 { 1.0 } else { f64::NAN }, 0.1))
            .last();
        assert_eq!(last, Some(Sensed::Broken));
    }

    #[test]
    fn without_noise_equal_readings_are_believed() {
        let mut sensor = Sensor::new(0.0, None);
        assert_eq!(
            [1.0, 1.0, f64::NAN].map(|y| sensor.read(y, 0.1)),
            [Sensed::New(1.0), Sensed::New(1.0), Sensed::Broken]
        );
    }

    #[test]
    fn huge_readings_leave_no_trace() {
        let mut sensor = Sensor::new(0.1, None);
        for reading in [f64::MAX, f64::MIN, f64::INFINITY, f64::MAX] {
            assert!(sensor.read(reading, 0.1).value().is_none_or(f64::is_finite));
        }
        let seen = (0..10_000).map(|_| sensor.read(1.0, 0.1)).last();
        assert_eq!(seen, Some(Sensed::New(1.0)));
    }
}
