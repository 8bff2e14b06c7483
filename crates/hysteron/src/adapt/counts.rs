//! How often an estimator did what.

use hysteron_core::{Learning, Outcome};
use serde::Serialize;

/// How often each [`Outcome`] was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct OutcomeCounts {
    /// Samples learned from.
    pub learned: usize,
    /// Errors within the dead zone, or increments that were not finished.
    pub waiting: usize,
    /// Samples at which the input did not move.
    pub at_rest: usize,
    /// Times the weights went back to the last good ones.
    pub rolled_back: usize,
    /// Readings too far off to be learned from.
    pub rejected: usize,
    /// Inputs outside the plane, taken as its end; they are among the others too.
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
                // Nothing freezes an estimator here.
                Outcome::AtRest | Outcome::Frozen => &mut counts.at_rest,
                Outcome::RolledBack => &mut counts.rolled_back,
                Outcome::Rejected => &mut counts.rejected,
            } += 1;
        }
        counts
    }
}
