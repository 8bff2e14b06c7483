//! Slow drift of the Preisach plant with time, towards an end.

use crate::rig::{RigError, check};
use serde::Deserialize;

/// How far and how fast the plant drifts: `X = X_∞ (1 − exp(−t/T))`. The default drifts nowhere.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DriftOptions {
    /// Where the shift of all thresholds ends, V, from −20 to 20. Default 0.
    pub threshold_v: f64,
    /// Where the relative change of the gain ends, from −0.5 to 0.5. Default 0.
    pub gain: f64,
    /// Time constant `T`, s, from 10 to 10⁷. Default 600.
    pub time_s: f64,
}

impl Default for DriftOptions {
    fn default() -> Self {
        Self {
            threshold_v: 0.0,
            gain: 0.0,
            time_s: 600.0,
        }
    }
}

impl DriftOptions {
    pub(super) fn check(&self) -> Result<(), RigError> {
        check(
            "final drift of the thresholds (V)",
            self.threshold_v,
            -20.0,
            20.0,
        )?;
        check("final drift of the gain", self.gain, -0.5, 0.5)?;
        check("time constant of the drift (s)", self.time_s, 10.0, 1e7)
    }
}
