//! The relay test (Åström & Hägglund 1984), and gains by Tyreus & Luyben 1992.

use super::plant_test::{TESTS, middle, refused};
use crate::track::scenario::Scenario;
use crate::track::score::median;
use hysteron::Result;
use hysteron::control::{Controller, Gains, RelayTest, Scheme};

/// Where the relay's two commands lie between the lowest and the highest level.
const COMMANDS: [f64; 2] = [0.25, 0.75];
/// Samples within which the test has to come to its end.
const PATIENCE: usize = 100_000;

pub(super) fn gains(scenario: &Scenario, scheme: &Scheme) -> Result<Gains> {
    let tests = (1..=TESTS).map(|seed| oscillation(scenario, scheme, seed));
    let tests = tests.collect::<Result<Vec<_>>>()?;
    let middle_of = |values: Vec<f64>| median(&mut { values });
    let ultimate_gain = middle_of(tests.iter().map(|(gain, _)| *gain).collect());
    let period = middle_of(tests.iter().map(|(_, period)| *period).collect());
    Ok(Gains::from_oscillation(ultimate_gain, period))
}

/// Ultimate gain and period of one test.
fn oscillation(scenario: &Scenario, scheme: &Scheme, seed: u64) -> Result<(f64, f64)> {
    let middle = middle(scenario);
    let (bottom, top) = scenario.model.range;
    let commands = COMMANDS.map(|share| bottom + share * (top - bottom));
    let mut plant = scenario.plant.build(seed)?;
    let mut controller = Controller::new(scheme.clone())?;
    let mut test = RelayTest::new(commands.into(), middle, scenario.shared.tolerance)?;
    for _ in 0..PATIENCE {
        let action = controller.step_command(test.command(), plant.read())?;
        plant.write(action.drive);
        plant.advance(scenario.interval_s);
        test.push(action.filtered.output);
        if test.is_done() {
            break;
        }
    }
    let Some((gain, period)) = test.oscillation() else {
        return Err(match test.outputs() {
            Some((low, high)) => refused(
                "reference",
                format!(
                    "between the inputs {} and {} (model.range) the output goes from {low:.4} to \
                     {high:.4}, and does not cross {middle:.4}, the middle of the reference, again \
                     and again, so that no PID can be tuned there",
                    commands[0], commands[1]
                ),
            ),
            None => refused("plant", "the sensor of its output gives no readings".into()),
        });
    };
    Ok((gain, period * scenario.interval_s))
}
