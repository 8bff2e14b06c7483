//! PID gains by one rule for all controllers, from a test on the same plant.
//!
//! - [`relay`]: a relay in place of the controller makes the loop oscillate (Åström & Hägglund
//!   1984); gains by Tyreus & Luyben 1992. The oscillation crosses the hysteresis, which a step
//!   test on one branch does not see.
//! - [`step`]: a small step on the rising branch, gains by SIMC (Skogestad 2003). It also tunes the
//!   loop around a temperature.

mod plant_test;
mod relay;
mod step;

use super::{Scenario, Tuning};
use hysteron::Result;
use hysteron::control::{Gains, InnerLoop, Scheme};

/// Gains of the feedback of the output.
pub(super) fn outer(scenario: &Scenario, scheme: &Scheme) -> Result<Gains> {
    match scenario.shared.tuning {
        Tuning::Relay => relay::gains(scenario, scheme),
        Tuning::Step => step::gains(scenario, scheme),
    }
}

/// Gains of the loop around the temperature.
pub(super) fn inner(scenario: &Scenario, scheme: &Scheme) -> Result<InnerLoop> {
    step::inner(scenario, scheme)
}
