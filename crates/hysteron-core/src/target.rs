//! What is wanted of the inverse: an output, and how it is to be held.

use crate::scalar::Real;

/// Where a target goes next.
///
/// It refers to the output of the model without sign, `Σ μ γ`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// To larger outputs.
    Rising,
    /// To smaller outputs.
    Falling,
}

/// A wanted output.
///
/// ```
/// use hysteron_core::{Direction, Target};
/// let held = Target::new(3.0).tolerance(0.1);
/// let anticipated = held.heading(Some(Direction::Falling));
/// assert_eq!(anticipated.output, 3.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target<T> {
    /// The output, in its unit.
    pub output: T,
    /// Where the target goes next, if the input is to anticipate it; `None` to hold the target.
    ///
    /// A held target keeps the input still for as long as the target stands still (equation 14).
    ///
    /// An anticipated target sends the input across the dead band at once, to the edge where the
    /// output starts to move in that direction. This applies only where the target is near the
    /// output at which the dead band began and the output has not moved away from it. Any other
    /// anticipated target is held.
    pub heading: Option<Direction>,
    /// How far the target may go back and still be held, in the output's unit.
    ///
    /// Without a tolerance, each reversal that noise causes sends the input across the whole dead
    /// band and back. A target beyond the range of outputs by up to the tolerance is taken as the
    /// nearest end of the range. Values below zero and NaN count as zero.
    pub tolerance: T,
}

impl<T: Real> Target<T> {
    /// A target by the chapter's policy: held, with tolerance zero.
    #[must_use]
    pub fn new(output: T) -> Self {
        Self {
            output,
            heading: None,
            tolerance: T::ZERO,
        }
    }

    /// The same target with another [`Target::heading`].
    #[must_use]
    pub fn heading(self, heading: Option<Direction>) -> Self {
        Self { heading, ..self }
    }

    /// The same target with another [`Target::tolerance`].
    #[must_use]
    pub fn tolerance(self, tolerance: T) -> Self {
        Self { tolerance, ..self }
    }
}
