//! A sensor under watch: readings that are missing or stand still are not believed.

/// Samples without a reading after which the filter starts afresh.
const FORGET_AFTER: u32 = 10;

/// Filters a sensor's readings and tells when there is none to be believed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Watch {
    /// Share of the way to a new reading.
    share: f64,
    /// Equal readings in a row that a sensor at work does not give.
    most_equal: Option<u32>,
    filtered: f64,
    last: f64,
    equal: u32,
    missing: u32,
}

impl Watch {
    /// A filter with the time constant `filter_s`; a reading that stays the same to the last bit for `stuck_s` is not believed.
    pub(super) fn new(interval_s: f64, filter_s: f64, stuck_s: Option<f64>) -> Self {
        let samples = |time: f64| (time / interval_s).ceil().max(1.0) as u32;
        Self {
            share: 1.0 - (-interval_s / filter_s.max(f64::MIN_POSITIVE)).exp(),
            most_equal: stuck_s.map(samples),
            filtered: f64::NAN,
            last: f64::NAN,
            equal: 0,
            missing: 0,
        }
    }

    /// The filtered reading; `None` where it is not a number, or stuck.
    pub(super) fn read(&mut self, reading: f64) -> Option<f64> {
        self.equal = match reading == self.last {
            true => self.equal.saturating_add(1),
            false => 0,
        };
        self.last = reading;
        let stuck = self.most_equal.is_some_and(|most| self.equal >= most);
        if stuck || !reading.is_finite() {
            self.missing = self.missing.saturating_add(1);
            return None;
        }
        if self.filtered.is_nan() || self.missing > FORGET_AFTER {
            self.filtered = reading;
        }
        self.missing = 0;
        self.filtered += self.share * (reading - self.filtered);
        Some(self.filtered)
    }
}
