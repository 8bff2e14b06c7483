//! The direction of the output.

/// Direction in which the output moves when the operators switch on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sign {
    /// The output rises with the input.
    #[default]
    Positive,
    /// The output falls as the input rises, as a strain does that is recovered on heating.
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
