//! What the inverse does when the target rests or reverses.

use crate::series::headings;
use hysteron_core::Direction;
use serde::{Deserialize, Serialize};

/// What the inverse does when the target rests or reverses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Policy {
    /// The input is held while the target rests (equation 14).
    #[default]
    Hold,
    /// The input crosses the dead band as soon as it is known that the target reverses.
    Anticipate,
}

impl Policy {
    /// The direction that each target takes next, as far as the policy wants to know it.
    pub(crate) fn headings(self, targets: &[f64], tolerance: f64) -> Vec<Option<Direction>> {
        match self {
            Policy::Hold => Vec::new(),
            Policy::Anticipate => headings(targets, tolerance),
        }
    }
}
