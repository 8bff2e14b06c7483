//! What the inverse does when the target rests or reverses.

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
