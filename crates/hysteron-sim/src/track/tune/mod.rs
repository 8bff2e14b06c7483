//! PID gains by one rule for all controllers, from a test on the same plant.
//!
//! - [`relay`]: a relay in place of the controller makes the loop oscillate (Åström & Hägglund
//!   1984); gains by Tyreus & Luyben 1992. The oscillation crosses the hysteresis, which a step
//!   test on one branch does not see.
//! - [`step`]: a small step on the rising branch, gains by SIMC (Skogestad 2003). It also tunes the
//!   loop around a temperature.
//!
//! Or from the model of a run, for each controller ([`crate::joint`]).

mod plant_test;
mod relay;
mod step;

use super::{Kind, Scenario, Tuning};
use crate::joint::{self, Tuned};
use hysteron::control::{Gains, InnerLoop, Scheme};
use hysteron::{Model, Result};

/// Gains of the feedback of the output by a test on the plant. None where they come from the model.
pub(super) fn outer(scenario: &Scenario, scheme: &Scheme) -> Result<Option<Gains>> {
    match scenario.shared.tuning {
        Tuning::Relay => relay::gains(scenario, scheme).map(Some),
        Tuning::Step => step::gains(scenario, scheme).map(Some),
        Tuning::Model => Ok(None),
    }
}

/// Gains for this controller by simulation of the loop around the model.
pub(super) fn by_model(scheme: &Scheme, model: &Model, kind: Kind) -> Result<Tuned> {
    let scheme = Scheme {
        policy: kind.policy(),
        ..scheme.clone()
    };
    joint::tune(model, &scheme, kind.has_model()).map_err(|error| {
        let what = format!("no gains come from the model ({error}): use \"relay\" or \"step\"");
        plant_test::refused("loop.tuning", what)
    })
}

/// Gains of the loop around the temperature.
pub(super) fn inner(scenario: &Scenario, scheme: &Scheme) -> Result<InnerLoop> {
    step::inner(scenario, scheme)
}
