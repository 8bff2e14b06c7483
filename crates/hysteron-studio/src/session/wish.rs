//! What is asked of a profile.

use super::id::Id;
use serde::Deserialize;

/// What an experiment has to keep to.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct Wish {
    /// The fit whose plane is to be determined.
    pub fit: Id,
    /// How fast the input can rise, in its unit per second.
    pub heating: f64,
    /// How fast it can fall.
    pub cooling: f64,
    /// Longest duration in minutes.
    #[serde(default)]
    pub budget: Option<f64>,
    /// A profile for the whole plane, as if nothing were recorded.
    #[serde(default)]
    pub whole: bool,
}
