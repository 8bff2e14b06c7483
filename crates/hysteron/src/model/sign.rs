//! Whether the output rises or falls with the input.

/// Direction in which the output moves when operators switch on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sign {
    /// The output rises with the input.
    #[default]
    Positive,
    /// The output falls as the input rises, for example a strain that is recovered on heating.
    Negative,
}

impl Sign {
    /// +1 or −1.
    #[must_use]
    pub fn factor(self) -> f64 {
        match self {
            Sign::Positive => 1.0,
            Sign::Negative => -1.0,
        }
    }
}
