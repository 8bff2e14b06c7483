//! A sensor under watch: readings that are missing or stand still are not believed.

/// Seconds that a reading may stay the same to the last bit, while others move, before it is taken as stuck.
const STUCK_S: f64 = 2.0;

/// Filters a sensor's readings and tells when there is none to be believed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Watch {
    interval_s: f64,
    /// Share of the way to a new reading.
    share: f64,
    filtered: Option<f64>,
    last: f64,
    same_s: f64,
}

impl Watch {
    pub(super) fn new(interval_s: f64, filter_s: f64) -> Self {
        Self {
            interval_s,
            share: 1.0 - (-interval_s / filter_s.max(f64::MIN_POSITIVE)).exp(),
            filtered: None,
            last: f64::NAN,
            same_s: 0.0,
        }
    }

    /// The filtered reading; `None` where it is not a number, or stuck.
    pub(super) fn read(&mut self, reading: f64) -> Option<f64> {
        if !reading.is_finite() {
            return None;
        }
        if reading == self.last {
            self.same_s += self.interval_s;
        } else {
            self.same_s = 0.0;
        }
        self.last = reading;
        let filtered = self.filtered.unwrap_or(reading);
        let filtered = filtered + self.share * (reading - filtered);
        self.filtered = Some(filtered);
        (self.same_s < STUCK_S).then_some(filtered)
    }
}
