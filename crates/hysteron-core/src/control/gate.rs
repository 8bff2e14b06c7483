//! Holds back single wrong readings, before a controller or a learner sees them.

/// Number of last deviations that the usual one is taken from.
const REMEMBERED: usize = 15;
/// A deviation so many times the usual one is no noise. The second difference of white noise has a
/// median of 1.65 standard deviations, so that ten of them pass.
const FACTOR: f64 = 6.0;
/// So many readings on one side are believed: the plant has moved.
const BURST: u32 = 3;

/// Tells spikes from readings. The last two readings that were believed lead to the next one, and
/// the median of the last deviations from there is the usual one. A reading is held back where it is
/// far from there, and from where the model expects it. A plant that jumps is believed at the third
/// reading.
///
/// ```
/// use hysteron_core::control::Gate;
/// let mut gate = Gate::new(0.1);
/// let readings = [1.0, 1.05, 9.0, 1.1]; // one of them is wild
/// assert_eq!(readings.map(|y| gate.passes(y, || 0.0)), [true, true, false, true]);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Gate {
    /// Deviations up to this are never held back.
    least: f64,
    /// The last reading that was believed, and the change from sample to sample that led to it.
    believed: f64,
    slope: f64,
    /// Samples since then.
    steps: f64,
    /// Sizes of the last deviations, how many are known, and where the next one goes.
    deviations: [f64; REMEMBERED],
    known: usize,
    next: usize,
    /// Readings beyond the gate in a row, and whether they are above it.
    beyond: (u32, bool),
}

impl Gate {
    /// A gate that never holds back what deviates by `least`, in the output's unit, zero or above.
    #[must_use]
    pub fn new(least: f64) -> Self {
        Self {
            least,
            believed: f64::NAN,
            slope: 0.0,
            steps: 0.0,
            deviations: [0.0; REMEMBERED],
            known: 0,
            next: 0,
            beyond: (0, false),
        }
    }

    /// Changes the size that is never held back.
    pub fn set(&mut self, least: f64) {
        self.least = least;
    }

    /// Whether a finite `reading` is believed. `expected` is asked only where it is far from where
    /// the last ones lead: by how much the output changes, in the model's opinion.
    pub fn passes(&mut self, reading: f64, expected: impl FnOnce() -> f64) -> bool {
        if self.believed.is_nan() {
            self.believed = reading;
            return true;
        }
        self.steps += 1.0;
        let deviation = reading - (self.believed + self.slope * self.steps);
        let change = reading - self.believed;
        let width = self.width();
        self.remember(deviation.abs());
        let above = deviation > 0.0;
        if deviation.abs() > width && !within(change - expected(), width) {
            self.beyond = match self.beyond {
                (count, side) if side == above => (count + 1, side),
                _ => (1, above),
            };
            if self.beyond.0 < BURST {
                return false;
            }
            // A jump leads nowhere.
            self.slope = 0.0;
        } else {
            self.slope = change / self.steps;
        }
        (self.believed, self.steps, self.beyond.0) = (reading, 0.0, 0);
        true
    }

    /// How far a reading may be from where the last ones lead.
    fn width(&self) -> f64 {
        let mut sizes = self.deviations;
        let sizes = &mut sizes[..self.known];
        sizes.sort_unstable_by(f64::total_cmp);
        // While few are known, the largest may be the usual one.
        let usual = match sizes.len() < REMEMBERED / 2 {
            true => sizes.last(),
            false => sizes.get(sizes.len() / 2),
        };
        (FACTOR * usual.copied().unwrap_or(0.0)).max(self.least)
    }

    fn remember(&mut self, deviation: f64) {
        self.deviations[self.next] = deviation;
        self.known = REMEMBERED.min(self.known + 1);
        self.next = (self.next + 1) % REMEMBERED;
    }
}

/// NaN is within nothing.
fn within(size: f64, width: f64) -> bool {
    size.abs() <= width
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of ±0.01 about a steep ramp, from a fixed sequence.
    fn noisy(n: u32) -> f64 {
        let turns = (f64::from(n) * 12.9898).sin() * 43758.5453;
        0.3 * f64::from(n) + 0.02 * (turns - turns.floor() - 0.5)
    }

    #[test]
    fn a_spike_is_held_back_and_noise_is_not() {
        for at in 20..60 {
            for size in [-1e9, -0.5, 0.4, 3.0] {
                let mut gate = Gate::new(0.02);
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
        let mut gate = Gate::new(0.02);
        for n in 0..40 {
            gate.passes(noisy(n), || 0.0);
        }
        let later = [40, 41, 42].map(|n| gate.passes(noisy(n) + 2.0, || 0.0));
        assert_eq!(later, [false, false, true]);
    }

    #[test]
    fn what_the_model_expects_is_no_spike() {
        let mut gate = Gate::new(0.02);
        for n in 0..40 {
            gate.passes(noisy(n), || 0.0);
        }
        assert!(gate.passes(noisy(40) + 2.0, || 2.3));
    }
}
