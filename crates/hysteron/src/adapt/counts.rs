//! Counts what an estimator did with the samples.

use hysteron_core::{Learning, Outcome};
use serde::Serialize;

/// How often each [`Outcome`] occurred.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct OutcomeCounts {
    /// Samples that the estimator learned from.
    pub learned: usize,
    /// Samples with an error within the dead zone, or with an increment that was not complete.
    pub waiting: usize,
    /// Samples at which the input did not move.
    pub at_rest: usize,
    /// Times that the last good weights were restored.
    pub rolled_back: usize,
    /// Readings rejected because they were too far from the expected output.
    pub rejected: usize,
    /// Samples at which a channel stood still while the other one moved.
    pub stuck: usize,
    /// Inputs outside the plane, clipped to its end. They are also counted above.
    pub outside: usize,
}

impl OutcomeCounts {
    pub(super) fn of(learned: &[Learning<f64>]) -> Self {
        let mut counts = Self::default();
        for learning in learned {
            counts.outside += usize::from(learning.clipped.is_some());
            *match learning.outcome {
                Outcome::Learned => &mut counts.learned,
                Outcome::Waiting => &mut counts.waiting,
                // Nothing freezes an estimator here, so `Frozen` does not occur.
                Outcome::AtRest | Outcome::Frozen => &mut counts.at_rest,
                Outcome::RolledBack => &mut counts.rolled_back,
                Outcome::Rejected => &mut counts.rejected,
                Outcome::OutputStuck | Outcome::InputStuck => &mut counts.stuck,
            } += 1;
        }
        counts
    }
}
