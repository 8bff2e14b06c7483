//! Holds back single wrong readings, before a controller or a learner sees them.

/// Number of last changes that the usual one is taken from.
const REMEMBERED: usize = 15;
/// A change so many times the usual one is no noise: 9.5 standard deviations, since the median
/// change of white noise is 0.95 of them.
const FACTOR: f64 = 10.0;
/// Changes up to this share of what was seen so far are never held back.
const SMALL: f64 = 0.02;
/// So many readings on one side that agree are believed: the plant has moved.
const BURST: u32 = 3;

/// Tells spikes from readings. The median of the last changes is the usual change. A reading is
/// held back where it is far from the last one that was believed, and the model does not expect it
/// to be. A plant that jumps is believed at the third reading.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Gate {
    /// The last reading that was believed.
    believed: f64,
    /// The last reading.
    last: f64,
    /// Sizes of the last changes, from reading to reading.
    changes: Vec<f64>,
    next: usize,
    /// Lowest and highest reading that was believed.
    seen: (f64, f64),
    /// Readings beyond the gate in a row, and whether they are above it.
    beyond: (u32, bool),
}

impl Gate {
    pub(super) fn new() -> Self {
        Self {
            believed: f64::NAN,
            last: f64::NAN,
            changes: Vec::with_capacity(REMEMBERED),
            next: 0,
            seen: (f64::INFINITY, f64::NEG_INFINITY),
            beyond: (0, false),
        }
    }

    /// Whether a finite `reading` is believed. `expected` is asked only where it is far from the
    /// last: by how much the output changes, in the model's opinion.
    pub(super) fn passes(&mut self, reading: f64, expected: impl FnOnce() -> f64) -> bool {
        if self.believed.is_nan() {
            (self.last, self.believed) = (reading, reading);
            self.seen = (reading, reading);
            return true;
        }
        let gate = self.width();
        self.remember((reading - self.last).abs());
        self.last = reading;
        let change = reading - self.believed;
        let above = change > 0.0;
        if change.abs() > gate && !((change - expected()).abs() <= gate) {
            self.beyond = match self.beyond {
                (count, side) if side == above => (count + 1, side),
                _ => (1, above),
            };
            if self.beyond.0 < BURST {
                return false;
            }
        }
        self.beyond.0 = 0;
        self.believed = reading;
        self.seen = (self.seen.0.min(reading), self.seen.1.max(reading));
        true
    }

    /// How far a reading may be from the last one.
    fn width(&self) -> f64 {
        let mut sizes = self.changes.clone();
        sizes.sort_by(f64::total_cmp);
        let usual = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
        // While few changes are known, the largest may be the usual one.
        let few = sizes.len() < REMEMBERED / 2;
        let usual = match few {
            true => sizes.last().copied().unwrap_or(0.0),
            false => usual,
        };
        (FACTOR * usual).max(SMALL * (self.seen.1 - self.seen.0))
    }

    fn remember(&mut self, change: f64) {
        match self.changes.get_mut(self.next) {
            Some(oldest) => *oldest = change,
            None => self.changes.push(change),
        }
        self.next = (self.next + 1) % REMEMBERED;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of ±0.01 about a ramp, from a fixed sequence.
    fn noisy(n: u32) -> f64 {
        let turns = (f64::from(n) * 12.9898).sin() * 43758.5453;
        0.001 * f64::from(n) + 0.02 * (turns - turns.floor() - 0.5)
    }

    #[test]
    fn a_spike_is_held_back_and_noise_is_not() {
        for at in 20..60 {
            for size in [-1e9, -0.5, 0.4, 3.0] {
                let mut gate = Gate::new();
                for n in 0..100 {
                    let spike = if n == at { size } else { 0.0 };
                    let passes = gate.passes(noisy(n) + spike, || 0.0);
                    // The first changes are not known yet.
                    assert!(passes == (n != at) || n < 4, "{at} {size} {n}");
                }
            }
        }
    }

    #[test]
    fn a_jump_is_believed_at_the_third_reading() {
        let mut gate = Gate::new();
        for n in 0..40 {
            gate.passes(noisy(n), || 0.0);
        }
        let later = [40, 41, 42, 43].map(|n| gate.passes(noisy(n) + 2.0, || 0.0));
        assert_eq!(later, [false, false, true, true]);
    }

    #[test]
    fn what_the_model_expects_is_no_spike() {
        let mut gate = Gate::new();
        for n in 0..40 {
            gate.passes(noisy(n), || 0.0);
        }
        assert!(gate.passes(noisy(40) + 2.0, || 2.0));
    }
}
