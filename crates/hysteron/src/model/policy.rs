//! What the inverse does where the target rests, over a series.

use crate::series::Headings;
use hysteron_core::{Direction, Policy};

/// How a table of targets is inverted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Invert {
    /// The input rests while the target rests.
    Hold {
        /// Reversals of the target up to this size are not followed, in its unit.
        band: f64,
    },
    /// The dead band is crossed as soon as the target is known to reverse.
    Anticipate {
        /// Reversals of the target up to this size are not followed, in its unit.
        band: f64,
        /// How many rows to look ahead at most; further on the input rests.
        rows: usize,
    },
}

impl Invert {
    /// The policy for each target of a series.
    #[must_use]
    pub fn policies(self, targets: &[f64]) -> Vec<Policy<f64>> {
        match self {
            Invert::Hold { band } => vec![Policy::Hold { tolerance: band }; targets.len()],
            Invert::Anticipate { band, rows } => {
                let headings = Headings::new(band, rows).all(targets).into_iter();
                headings.map(|heading| anticipate(heading, band)).collect()
            }
        }
    }
}

/// The policy towards a reversal, or at rest where none is in sight.
pub(crate) fn anticipate(heading: Option<Direction>, tolerance: f64) -> Policy<f64> {
    match heading {
        Some(heading) => Policy::Anticipate { heading, tolerance },
        None => Policy::Hold { tolerance },
    }
}
