//! What both tests on a plant need.

use crate::track::scenario::Scenario;
use hysteron::Error;

/// Tests whose results are averaged, so that noise does not decide.
pub(super) const TESTS: u64 = 20;

/// Middle of what the reference asks for.
pub(super) fn middle(scenario: &Scenario) -> f64 {
    let (low, high) = hysteron::range(&scenario.references());
    0.5 * (low + high)
}

pub(super) fn no_answer(what: &str, samples: usize, scenario: &Scenario) -> Error {
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

pub(super) fn refused(field: &str, problem: String) -> Error {
    Error::Scenario {
        path: None,
        line: None,
        field: field.into(),
        problem,
    }
}
