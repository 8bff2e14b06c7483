//! How regular the host is: by its own clock, which the model never sees.

use std::time::Instant;

/// Intervals between samples, and answers to them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Jitter {
    first: Option<(Instant, f64)>,
    last: Option<(Instant, f64)>,
    squares: f64,
    count: u64,
    slowest: f64,
}

impl Jitter {
    /// A sample of the device's `time`, that came and was answered at these instants.
    pub(crate) fn push(&mut self, time: f64, came: Instant, answered: Instant) {
        if let Some((before, at)) = self.last {
            let late = came.duration_since(before).as_secs_f64() - (time - at);
            self.squares += late * late;
            self.count += 1;
        }
        self.last = Some((came, time));
        self.first = self.first.or(self.last);
        self.slowest = self
            .slowest
            .max(answered.duration_since(came).as_secs_f64());
    }

    /// Root mean square of what the intervals by the host's clock differ from those by the
    /// device's, s. `None` before the second sample, and for a simulation, which waits for its
    /// drives and keeps no clock: its time runs at another speed.
    pub(crate) fn rms_s(&self) -> Option<f64> {
        let ((begun, from), (now, to)) = (self.first?, self.last?);
        let speed = (to - from) / now.duration_since(begun).as_secs_f64();
        let real = self.count > 0 && (0.5..2.0).contains(&speed);
        real.then(|| (self.squares / self.count as f64).sqrt())
    }

    /// The slowest answer, s.
    pub(crate) fn slowest_s(&self) -> f64 {
        self.slowest
    }
}
