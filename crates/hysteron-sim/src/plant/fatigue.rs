//! Functional fatigue: what cycling does to a shape-memory alloy.
//!
//! On each transformation dislocations stay behind. They shift the transformation temperatures
//! (Miyazaki, Igo & Otsuka 1986, thermal cycles of NiTi) and leave strain that does not come back,
//! more slowly from cycle to cycle until the alloy is trained (Bo & Lagoudas 1999). The measure of
//! cycling is the transformed fraction that has accumulated, `ζ = ∫ |dξ|`. A complete cycle adds 2.
//! What changes follows `X = X_∞ (1 − exp(−ζ/ζ₀))`, the law of Lagoudas & Entchev 2004. So partial
//! cycles count in part, rest does not count, and how time is divided does not matter.

use crate::rig::{RigError, check};
use serde::Deserialize;

/// How far and how fast the spring drifts as it is cycled. The sizes are chosen, not measured on
/// the chapter's spring.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FatigueOptions {
    /// Where the shift of all four transformation temperatures ends, K, from −20 to 20. Default −5.
    pub shift_k: f64,
    /// Where the irrecoverable lengthening of the spring ends, mm, from 0 to 10: the load hangs
    /// lower by it. Default 1.
    pub irrecoverable_mm: f64,
    /// Complete cycles until 63 % of both have come, from 0.1 to 10⁶. Default 20.
    pub cycles: f64,
}

impl Default for FatigueOptions {
    fn default() -> Self {
        Self {
            shift_k: -5.0,
            irrecoverable_mm: 1.0,
            cycles: 20.0,
        }
    }
}

impl FatigueOptions {
    pub(super) fn check(&self) -> Result<(), RigError> {
        check(
            "final shift of the transformation temperatures (K)",
            self.shift_k,
            -20.0,
            20.0,
        )?;
        check(
            "final irrecoverable displacement (mm)",
            self.irrecoverable_mm,
            0.0,
            10.0,
        )?;
        check("cycles of the fatigue", self.cycles, 0.1, 1e6)
    }

    /// Share of the drift that has come when `transformed` has accumulated.
    pub(super) fn share(&self, transformed: f64) -> f64 {
        -(-transformed / (2.0 * self.cycles)).exp_m1()
    }
}
