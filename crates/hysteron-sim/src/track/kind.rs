//! The controllers that can be compared.

use hysteron::Policy;
use serde::Deserialize;

/// A controller of the comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// PID alone.
    Pid,
    /// The inverse alone, *hold*.
    Inverse,
    /// The inverse alone, *anticipate*.
    InverseAnticipate,
    /// Inverse and PID, *hold*.
    InversePid,
    /// Inverse and PID, *anticipate*.
    InversePidAnticipate,
    /// Adaptive inverse alone, *anticipate*. Only where a scenario names it.
    AdaptiveAnticipate,
    /// Adaptive inverse and PID, *hold*.
    AdaptivePid,
    /// Adaptive inverse and PID, *anticipate*.
    AdaptivePidAnticipate,
}

impl Kind {
    pub(super) fn all() -> Vec<Self> {
        vec![
            Self::Pid,
            Self::Inverse,
            Self::InverseAnticipate,
            Self::InversePid,
            Self::InversePidAnticipate,
            Self::AdaptivePid,
            Self::AdaptivePidAnticipate,
        ]
    }

    /// What to call it.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Pid => "PID",
            Self::Inverse => "inverse, hold",
            Self::InverseAnticipate => "inverse, anticipate",
            Self::InversePid => "inverse + PID, hold",
            Self::InversePidAnticipate => "inverse + PID, anticipate",
            Self::AdaptiveAnticipate => "adaptive inverse, anticipate",
            Self::AdaptivePid => "adaptive inverse + PID, hold",
            Self::AdaptivePidAnticipate => "adaptive inverse + PID, anticipate",
        }
    }

    /// Its name in a scenario.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pid => "pid",
            Self::Inverse => "inverse",
            Self::InverseAnticipate => "inverse-anticipate",
            Self::InversePid => "inverse-pid",
            Self::InversePidAnticipate => "inverse-pid-anticipate",
            Self::AdaptiveAnticipate => "adaptive-anticipate",
            Self::AdaptivePid => "adaptive-pid",
            Self::AdaptivePidAnticipate => "adaptive-pid-anticipate",
        }
    }

    pub(super) fn has_pid(self) -> bool {
        let alone = [
            Self::Inverse,
            Self::InverseAnticipate,
            Self::AdaptiveAnticipate,
        ];
        !alone.contains(&self)
    }

    pub(super) fn adapts(self) -> bool {
        let adaptive = [
            Self::AdaptiveAnticipate,
            Self::AdaptivePid,
            Self::AdaptivePidAnticipate,
        ];
        adaptive.contains(&self)
    }

    pub(super) fn policy(self) -> Policy {
        match self {
            Self::InverseAnticipate
            | Self::AdaptiveAnticipate
            | Self::InversePidAnticipate
            | Self::AdaptivePidAnticipate => Policy::Anticipate,
            _ => Policy::Hold,
        }
    }
}
