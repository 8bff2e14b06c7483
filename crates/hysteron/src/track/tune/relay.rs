//! The relay test (Åström & Hägglund 1984), and gains by Tyreus & Luyben 1992.

use super::{TESTS, middle, refused};
use crate::Result;
use crate::control::{Controller, Gains, Scheme};
use crate::track::Scenario;
use crate::track::score::median;

/// Where the relay's two commands lie between the lowest and the highest level.
const COMMANDS: [f64; 2] = [0.25, 0.75];
/// Periods that are left out, and those that count.
const SETTLED: usize = 3;
const COUNTED: usize = 5;
/// Samples within which they have to come.
const PATIENCE: usize = 100_000;

/// Proportional and integral gain. The rule for three terms is not used: with a sensor as noisy as these, the derivative
/// throws the drive from limit to limit.
pub(super) fn gains(scenario: &Scenario, scheme: &Scheme) -> Result<Gains> {
    let tests = (1..=TESTS).map(|seed| oscillation(scenario, scheme, seed));
    let tests = tests.collect::<Result<Vec<_>>>()?;
    let middle_of = |values: Vec<f64>| median(&mut { values });
    let ultimate_gain = middle_of(tests.iter().map(|(gain, _)| *gain).collect());
    let period = middle_of(tests.iter().map(|(_, period)| *period).collect());
    Ok(Gains {
        gain: ultimate_gain / 3.2,
        integral_s: 2.2 * period,
        derivative_s: 0.0,
    })
}

/// Ultimate gain and period of one test.
fn oscillation(scenario: &Scenario, scheme: &Scheme, seed: u64) -> Result<(f64, f64)> {
    let middle = middle(scenario);
    let band = scenario.shared.tolerance;
    let (bottom, top) = scenario.model.range;
    let commands = COMMANDS.map(|share| bottom + share * (top - bottom));
    let mut plant = scenario.plant.build(seed)?;
    let mut controller = Controller::new(scheme.clone())?;
    let mut high = true;
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut range, mut all) = (none, none);
    // Sample at which each period ended, and half the output's way in it.
    let mut periods: Vec<(usize, f64)> = Vec::new();
    for n in 0..PATIENCE {
        let action = controller.step_command(commands[usize::from(high)], plant.read())?;
        plant.write(action.drive);
        plant.advance(scenario.interval_s);
        let output = action.filtered.output;
        range = (range.0.min(output), range.1.max(output));
        all = (all.0.min(output), all.1.max(output));
        if high && output > middle + band {
            high = false;
        } else if !high && output < middle - band {
            high = true;
            periods.push((n, 0.5 * (range.1 - range.0)));
            range = none;
        }
        if periods.len() == SETTLED + COUNTED + 1 {
            break;
        }
    }
    let Some([first, rest @ ..]) = periods.get(SETTLED..).filter(|rest| rest.len() > COUNTED)
    else {
        return Err(match all.0 <= all.1 {
            true => refused(
                "reference",
                format!(
                    "between the inputs {} and {} (model.range) the output goes from {:.4} to {:.4}, and does not cross {middle:.4}, the middle of the reference, \
                     again and again, so that no PID can be tuned there",
                    commands[0], commands[1], all.0, all.1
                ),
            ),
            false => refused("plant", "the sensor of its output gives no readings".into()),
        });
    };
    let count = rest.len() as f64;
    let last = rest.last().map_or(first.0, |(n, _)| *n);
    let period = (last - first.0) as f64 / count * scenario.interval_s;
    let amplitude = rest.iter().map(|(_, half)| half).sum::<f64>() / count;
    let swing = 0.5 * (commands[1] - commands[0]);
    // The describing function of a relay.
    Ok((4.0 * swing / (std::f64::consts::PI * amplitude), period))
}
