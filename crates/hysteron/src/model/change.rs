//! How much an actuator changes between sessions.

use crate::model::FitSummary;
use serde::{Deserialize, Serialize};

/// Standard deviations of what changes from one session of an actuator to another. The offset may
/// change by any amount.
///
/// ```
/// let usual = hysteron::Change::default();
/// assert_eq!((usual.gain, usual.shift), (0.2, 0.02));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// Of the gain: 0.1 for outputs that move by 10 % more or less.
    pub gain: f64,
    /// Of the place of the loops along the input, as a share of the plane.
    pub shift: f64,
}

impl Default for Change {
    /// What is usual, where nothing is known of an actuator.
    fn default() -> Self {
        Self {
            gain: 0.2,
            shift: 0.02,
        }
    }
}

/// The entry of a fit's record.
const ENTRY: &str = "change";

impl FitSummary {
    /// How much the actuator changes between sessions, as its repeats told
    /// ([`crate::Fit::repeats`]); `None` without any.
    #[must_use]
    pub fn change(&self) -> Option<Change> {
        let known: Change = serde_json::from_value(self.other.get(ENTRY)?.clone()).ok()?;
        // A file of somebody else may say anything.
        let can_be = |number: &f64| (1e-6..=1e3).contains(number);
        [known.gain, known.shift]
            .iter()
            .all(can_be)
            .then_some(known)
    }

    pub(crate) fn tell_change(&mut self, change: Change) {
        self.other.insert(ENTRY.into(), serde_json::json!(change));
    }
}
