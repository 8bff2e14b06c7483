//! What a step of an estimator gives.

use crate::plane::Clipped;

/// The result of a step of an estimator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Learning<T> {
    /// The predicted output, before the estimator learned from the sample. In the output's unit.
    pub output: T,
    /// The measured output less the predicted one.
    pub error: T,
    /// What the estimator did with the sample.
    pub outcome: Outcome,
    /// The end of the plane that the input lay beyond; `None` within the active range.
    pub clipped: Option<Clipped>,
}

/// What an estimator did with a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The parameters moved.
    Learned,
    /// The error lies within the dead zone, or an increment is not finished.
    Waiting,
    /// The input did not move: there is no excitation.
    AtRest,
    /// The estimator is frozen.
    Frozen,
    /// The last good parameters are back, because the present ones predicted far worse or
    /// overflowed.
    RolledBack,
    /// The reading is taken as an outlier: [`Adaptation::gate`](super::Adaptation::gate).
    Rejected,
    /// The output stands still while the input moves. What was learned since is undone.
    OutputStuck,
    /// The input stands still while the output moves. What was learned since is undone.
    InputStuck,
}

impl Outcome {
    /// All outcomes.
    pub const ALL: [Self; 8] = [
        Self::Learned,
        Self::Waiting,
        Self::AtRest,
        Self::Frozen,
        Self::RolledBack,
        Self::Rejected,
        Self::OutputStuck,
        Self::InputStuck,
    ];

    /// The name of the outcome in tables: `learned`, `waiting`, `at-rest`, `frozen`, `rolled-back`,
    /// `rejected`, `output-stuck`,
    /// `input-stuck`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Learned => "learned",
            Self::Waiting => "waiting",
            Self::AtRest => "at-rest",
            Self::Frozen => "frozen",
            Self::RolledBack => "rolled-back",
            Self::Rejected => "rejected",
            Self::OutputStuck => "output-stuck",
            Self::InputStuck => "input-stuck",
        }
    }

    /// Whether the gate accepted the reading.
    pub(super) fn is_of_believed(self) -> bool {
        matches!(self, Self::Learned | Self::Waiting | Self::RolledBack) || self.is_stuck()
    }

    /// Whether a channel stands still.
    #[must_use]
    pub fn is_stuck(self) -> bool {
        matches!(self, Self::OutputStuck | Self::InputStuck)
    }
}
