//! What recorded inputs say of one operator.

use serde::{Deserialize, Serialize};

/// What recorded inputs say about one operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Excitation {
    /// Its state never changes: nothing can be learned of it.
    Never,
    /// It moves on one branch only, together with others.
    Once,
    /// It moves on several branches, but never so that it can be told from the others.
    Ambiguous,
    /// Its weight follows from the output.
    Determined,
}

impl Excitation {
    /// All classes, from the least known to the best.
    pub const ALL: [Self; 4] = [Self::Never, Self::Once, Self::Ambiguous, Self::Determined];

    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Never => "never excited",
            Self::Once => "excited once",
            Self::Ambiguous => "excited, not told apart",
            Self::Determined => "well determined",
        }
    }
}
