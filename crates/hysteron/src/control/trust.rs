//! Chooses between a learner and the fixed model that it began from.

/// What a sample counts relative to the next one: some hundred samples count.
const KEPT: f64 = 0.99;
/// The one that is not used has to err less by this factor, in the mean square, to be used.
const BETTER: f64 = 0.8;
/// Samples before the learner can be used.
const FIRST: u32 = 30;

/// The recent squared errors of both, and which of them is used.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Trust {
    fixed: f64,
    learned: f64,
    samples: u32,
    learner: bool,
}

impl Trust {
    /// Whether the learner is used.
    pub(super) fn learner(&self) -> bool {
        self.learner
    }

    /// Takes the errors of the fixed model and of the learner at a sample. Whether the other one is
    /// used from now on.
    pub(super) fn push(&mut self, (fixed, learned): (f64, f64)) -> bool {
        let follow = |mean: f64, error: f64| KEPT * mean + (1.0 - KEPT) * error * error;
        self.fixed = follow(self.fixed, fixed);
        self.learned = follow(self.learned, learned);
        self.samples = self.samples.saturating_add(1);
        let learner = match self.learner {
            false => self.samples >= FIRST && self.learned < BETTER * self.fixed,
            true => self.fixed >= BETTER * self.learned,
        };
        std::mem::replace(&mut self.learner, learner) != learner
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_better_one_is_used_and_noise_does_not_switch() {
        let mut trust = Trust::default();
        let switches = |trust: &mut Trust, errors: (f64, f64), count: u32| {
            (0..count).filter(|_| trust.push(errors)).count()
        };
        assert_eq!(switches(&mut trust, (1.0, 0.95), 1000), 0);
        assert!(!trust.learner());
        assert_eq!(switches(&mut trust, (1.0, 0.5), 1000), 1);
        assert!(trust.learner());
        assert_eq!(switches(&mut trust, (1.0, 1.05), 1000), 0);
        assert_eq!(switches(&mut trust, (1.0, 2.0), 1000), 1);
        assert!(!trust.learner());
    }
}
