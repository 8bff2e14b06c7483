//! How well recorded inputs determine one operator.

use serde::{Deserialize, Serialize};

/// How well recorded inputs determine one operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Excitation {
    /// Its state never changes, so nothing can be learned about it.
    Never,
    /// It moves on one branch only, together with others.
    Once,
    /// It moves on several branches, but always together with others, so its weight cannot be
    /// separated from theirs.
    Ambiguous,
    /// Its weight follows from the output.
    Determined,
}

impl Excitation {
    /// All classes, from the least known to the best known.
    pub const ALL: [Self; 4] = [Self::Never, Self::Once, Self::Ambiguous, Self::Determined];

    /// The name of the class for people.
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
