//! The errors of the core.

use core::fmt;

/// Why the core refused a call. A call that returns an error has changed nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// Fewer than 2 or more than [`crate::MAX_LEVELS`] levels.
    Levels(usize),
    /// The plane's range is not finite, is empty, or is so narrow that neighbouring levels
    /// coincide.
    Range,
    /// The number of weights is not that of the operators, `K(K + 1)/2`, or of a basis, that for
    /// each of its members.
    WeightCount {
        /// How many are needed.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// A weight is NaN or infinite, or the weights' sum overflows.
    WeightNotFinite {
        /// Index of the weight, from 0, row by row ([`operators`](crate::operators)).
        index: usize,
    },
    /// The inverse and estimators need weights that are not negative.
    NegativeWeights(NegativeWeights),
    /// Memory that the caller provides is too small.
    MemoryTooSmall {
        /// Elements needed.
        needed: usize,
        /// Elements given.
        found: usize,
    },
    /// An input, a target or a reading is NaN or infinite.
    InputNotFinite {
        /// Index in the array, from 0. 0 for a single sample.
        index: usize,
    },
    /// Turning points to restore do not nest. They must be finite, lie in `[0, K]`, start with a
    /// maximum and alternate, each within the two before it.
    TurningPoints {
        /// Index of the first one that does not fit, from 0.
        index: usize,
    },
    /// A state was used with a model other than the one that made it.
    StateMismatch,
    /// There is no operator `(i, j)`: `1 ≤ i ≤ j ≤ K` does not hold.
    Operator {
        /// Index of the level `α`, at which the operator switches off.
        i: usize,
        /// Index of the level `β`, at which the operator switches on.
        j: usize,
    },
    /// An option of an estimator is out of its range.
    Adaptation {
        /// Name of the option, as in [`Adaptation`](crate::Adaptation) and
        /// [`Method`](crate::Method).
        option: &'static str,
    },
    /// The model needs the time since the sample before: a finite number of seconds, 0 or more.
    TimeStep,
    /// The model needs a load that is a finite number.
    Load,
    /// The constants of a stage cannot be: a time constant that is not above zero, knots that do
    /// not ascend, lists of different lengths.
    Stage {
        /// Name of the constant, as in [`Stages`](crate::Stages).
        stage: &'static str,
    },
}

impl Error {
    /// The number of the kind of error, for interfaces without enumerations. It never changes.
    #[must_use]
    pub const fn code(self) -> i32 {
        match self {
            Error::Levels(_) => 1,
            Error::Range => 2,
            Error::WeightCount { .. } => 3,
            Error::WeightNotFinite { .. } => 4,
            Error::NegativeWeights(_) => 5,
            Error::MemoryTooSmall { .. } => 6,
            Error::InputNotFinite { .. } => 7,
            Error::TurningPoints { .. } => 8,
            Error::StateMismatch => 9,
            Error::Operator { .. } => 10,
            Error::Adaptation { .. } => 11,
            Error::TimeStep => 12,
            Error::Load => 13,
            Error::Stage { .. } => 14,
        }
    }
}

/// Which weights are negative: their number, and the first three of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NegativeWeights {
    /// How many weights are below zero.
    pub count: usize,
    /// `(i, j)` of the first three, counted from 1 as in equation (3).
    pub first: [Option<(usize, usize)>; 3],
}

impl fmt::Display for NegativeWeights {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} negative weight(s)", self.count)?;
        for (n, (i, j)) in self.first.iter().flatten().enumerate() {
            write!(
                f,
                "{} i={i} j={j}",
                if n == 0 { ": operators" } else { "," }
            )?;
        }
        if self.count > self.first.len() {
            write!(f, ", …")?;
        }
        Ok(())
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Levels(k) => write!(
                f,
                "{k} levels: a plane has from 2 to {} levels",
                crate::limits::MAX_LEVELS
            ),
            Error::Range => write!(
                f,
                "the plane's range must be finite, with min below max by more than rounding"
            ),
            Error::WeightCount { expected, found } => {
                write!(f, "{found} weights where K(K+1)/2 = {expected} are needed")
            }
            Error::WeightNotFinite { index } => {
                write!(
                    f,
                    "weight number {index} (from 0) or the sum up to it is not finite"
                )
            }
            Error::NegativeWeights(which) => {
                write!(
                    f,
                    "the inverse needs weights that are not negative, but there are {which}"
                )
            }
            Error::MemoryTooSmall { needed, found } => {
                write!(
                    f,
                    "memory for {found} elements given where {needed} are needed"
                )
            }
            Error::InputNotFinite { index } => {
                write!(f, "sample number {index} (from 0) is not a finite number")
            }
            Error::TurningPoints { index } => {
                write!(
                    f,
                    "turning point number {index} (from 0) does not lie within the two before it"
                )
            }
            Error::Adaptation { option } => {
                let range = crate::limits::range_of(option);
                write!(f, "the estimator's option `{option}` must be {range}")
            }
            Error::TimeStep => write!(
                f,
                "the model needs the time since the sample before, in seconds: a finite number \
                 from 0 on"
            ),
            Error::Load => write!(f, "the model needs a load that is a finite number"),
            Error::Stage { stage } => write!(f, "the model's `{stage}` cannot be used as given"),
            Error::StateMismatch => write!(f, "the state belongs to another model"),
            Error::Operator { i, j } => {
                write!(
                    f,
                    "there is no operator ({i}, {j}): 1 ≤ i ≤ j ≤ K is needed"
                )
            }
        }
    }
}

impl core::error::Error for Error {}
