//! PID gains by one rule for all controllers, from a test on the same plant.
//!
//! - [`relay`]: a relay in place of the controller makes the loop oscillate (Åström & Hägglund
//!   1984); gains by Tyreus & Luyben 1992. The oscillation crosses the hysteresis, which a step
//!   test on one branch does not see.
//! - [`step`]: a small step on the rising branch, gains by SIMC (Skogestad 2003). It also tunes the
//!   loop around a temperature.

mod relay;
mod step;

use super::{Scenario, Tuning};
use hysteron::control::{Gains, InnerLoop, Scheme};
use hysteron::{Error, Result};

/// Tests whose results are averaged, so that noise does not decide.
const TESTS: u64 = 20;

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

/// Middle of what the reference asks for.
fn middle(scenario: &Scenario) -> f64 {
    let (low, high) = hysteron::range(&scenario.references());
    0.5 * (low + high)
}

fn no_answer(what: &str, samples: usize, scenario: &Scenario) -> Error {
    let time = samples as f64 * scenario.interval_s;
    refused(
        "plant",
        format!(
            "its {what} does not answer a step within {time} s ({samples} samples), or less than \
             its noise, so that no PID can be tuned: a longer interval_s, a stronger drive or a \
             better sensor is needed"
        ),
    )
}

fn refused(field: &str, problem: String) -> Error {
    Error::Scenario {
        path: None,
        line: None,
        field: field.into(),
        problem,
    }
}
