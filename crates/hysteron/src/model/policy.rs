//! What the inverse does where the target rests.

use serde::{Deserialize, Serialize};

/// What the inverse does where the target rests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Policy {
    /// The input rests too (equation 14).
    #[default]
    Hold,
    /// The input crosses the dead band as soon as it is known that the target reverses.
    Anticipate,
}
