//! The controllers that can be compared.

use hysteron::Policy;
use serde::Deserialize;

/// A controller of the comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// PID alone.
    Pid,
    /// PI whose gains follow a linear model that is estimated while the loop runs
    /// (`self_tuning.rs`). Only where a scenario names it.
    PiRls,
    /// The inverse alone, *hold*.
    Inverse,
    /// The inverse alone, *anticipate*.
    InverseAnticipate,
    /// Inverse and PID, *hold*.
    InversePid,
    /// Inverse and PID, *anticipate*.
    InversePidAnticipate,
    /// Adaptive inverse alone, *hold*. Only where a scenario names it.
    AdaptiveInverse,
    /// Adaptive inverse alone, *anticipate*. Only where a scenario names it.
    AdaptiveAnticipate,
    /// Adaptive inverse and PID, *hold*.
    #[serde(alias = "adaptive-inverse-pid")]
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
            Self::PiRls => "PI/RLS",
            Self::Inverse => "inverse, hold",
            Self::InverseAnticipate => "inverse, anticipate",
            Self::InversePid => "inverse + PID, hold",
            Self::InversePidAnticipate => "inverse + PID, anticipate",
            Self::AdaptiveInverse => "adaptive inverse, hold",
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
            Self::PiRls => "pi-rls",
            Self::Inverse => "inverse",
            Self::InverseAnticipate => "inverse-anticipate",
            Self::InversePid => "inverse-pid",
            Self::InversePidAnticipate => "inverse-pid-anticipate",
            Self::AdaptiveInverse => "adaptive-inverse",
            Self::AdaptiveAnticipate => "adaptive-anticipate",
            Self::AdaptivePid => "adaptive-pid",
            Self::AdaptivePidAnticipate => "adaptive-pid-anticipate",
        }
    }

    /// Whether a PID is in the loop.
    #[must_use]
    pub fn has_pid(self) -> bool {
        let alone = [
            Self::Inverse,
            Self::InverseAnticipate,
            Self::AdaptiveInverse,
            Self::AdaptiveAnticipate,
        ];
        !alone.contains(&self)
    }

    /// Whether it needs a hysteresis model.
    #[must_use]
    pub fn has_model(self) -> bool {
        !matches!(self, Self::Pid | Self::PiRls)
    }

    /// Whether its hysteresis model learns.
    #[must_use]
    pub fn adapts(self) -> bool {
        let adaptive = [
            Self::AdaptiveInverse,
            Self::AdaptiveAnticipate,
            Self::AdaptivePid,
            Self::AdaptivePidAnticipate,
        ];
        adaptive.contains(&self)
    }

    /// What its inverse does where the reference rests.
    #[must_use]
    pub fn policy(self) -> Policy {
        match self {
            Self::InverseAnticipate
            | Self::AdaptiveAnticipate
            | Self::InversePidAnticipate
            | Self::AdaptivePidAnticipate => Policy::Anticipate,
            _ => Policy::Hold,
        }
    }
}
