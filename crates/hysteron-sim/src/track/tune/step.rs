//! Step tests, and SIMC (Skogestad 2003).
//!
//! For the loop around the temperature the drive steps to its limit, and the temperature is taken
//! as an integrator with a slope and a delay. For the feedback of the output the
//! command steps by a little on the rising branch at the middle of the reference
//! ([`Gains::from_step`]).

use super::plant_test::{TESTS, middle, no_answer};
use crate::track::scenario::Scenario;
use hysteron::Result;
use hysteron::control::{Controller, Gains, InnerLoop, Scheme};
use hysteron::mean_and_deviation;

/// Samples of a test before and after the step.
const SAMPLES: usize = 200;
/// Samples before the step over which the level is taken.
const LEVEL: usize = 50;
/// Size of the outer step in levels of the plane.
const LEVELS: f64 = 2.0;
/// Samples within which the output has to come to the middle of the reference.
const PATIENCE: usize = 100_000;

/// Gains of the loop around the temperature.
pub(super) fn inner(scenario: &Scenario, scheme: &Scheme) -> Result<InnerLoop> {
    let drive = scheme.drives.1;
    let open = Scheme {
        inner: None,
        bias: scheme.drives.0,
        ..scheme.clone()
    };
    let mean = average(scenario, &open, |_, n, _| {
        (true, if n < LEVEL { open.bias } else { drive })
    })?;
    let temperature: Vec<f64> = mean.iter().map(|(input, _)| *input).collect();
    // The steepest stretch of a tenth of the test, and where its line leaves the level before.
    let wide = SAMPLES / 10;
    let rise = |n: usize| temperature[n + wide] - temperature[n];
    let steepest = (LEVEL..temperature.len() - wide).max_by(|a, b| rise(*a).total_cmp(&rise(*b)));
    let steepest = steepest.ok_or_else(|| no_answer("temperature", SAMPLES, scenario))?;
    let slope = rise(steepest) / (wide as f64 * scenario.interval_s);
    let (level, _) = mean_and_deviation(&temperature[..LEVEL]);
    // Less than a level in the whole test is noise, or a heater that cannot do what the model is
    // asked for.
    let one = scenario.model.plane()?.step();
    if mean_and_deviation(&temperature[temperature.len() - LEVEL..]).0 < level + one || slope <= 0.0
    {
        return Err(no_answer("temperature", SAMPLES, scenario));
    }
    let passed = (steepest - LEVEL) as f64 * scenario.interval_s;
    let delay = (passed - (temperature[steepest] - level) / slope).max(scenario.interval_s);
    Ok(InnerLoop {
        gains: Gains {
            // SIMC for an integrating plant with τ_c = θ.
            gain: drive * drive / (slope * 2.0 * delay),
            integral_s: 8.0 * delay,
            derivative_s: 0.0,
        },
        square_root: true,
    })
}

/// Gains of the feedback of the output.
pub(super) fn gains(scenario: &Scenario, scheme: &Scheme) -> Result<Gains> {
    let middle = middle(scenario);
    let step = LEVELS * scenario.model.plane()?.step();
    let rate = scenario.model.rates.0 * scenario.interval_s;
    let mean = average(scenario, scheme, |command, n, output| {
        // Up to the middle, wait there, step.
        if n == 0 && output < middle && command < scheme.commands.1 {
            return (false, command + rate);
        }
        let stepped = n == LEVEL + SAMPLES;
        (true, command + if stepped { step } else { 0.0 })
    })?;
    let output: Vec<f64> = mean.iter().map(|(_, output)| *output).collect();
    let begin = LEVEL + SAMPLES;
    Gains::from_step(&output, begin, step, scenario.interval_s)
        .ok_or_else(|| no_answer("output", SAMPLES, scenario))
}

/// Mean of filtered input and output over the tests, from where `next` says that the test begins.
/// `next(command, n, output)` gives whether the test is on, and the next command; `n` counts its
/// samples.
fn average(
    scenario: &Scenario,
    scheme: &Scheme,
    next: impl Fn(f64, usize, f64) -> (bool, f64),
) -> Result<Vec<(f64, f64)>> {
    let mut sums = vec![(0.0, 0.0); LEVEL + 2 * SAMPLES];
    for seed in 1..=TESTS {
        let mut plant = scenario.plant.build(seed)?;
        let mut controller = Controller::new(scheme.clone())?;
        let (mut command, mut n, mut waited) = (scheme.bias, 0, 0);
        // A lost sample is replaced by the last reading.
        let (mut input, mut output) = (f64::NAN, f64::NAN);
        while n < sums.len() {
            let action = controller.step_command(command, plant.read())?;
            plant.write(action.drive);
            plant.advance(scenario.interval_s);
            let heard = |new: f64, last: f64| if new.is_nan() { last } else { new };
            input = heard(action.filtered.input.unwrap_or(f64::NAN), input);
            output = heard(action.filtered.output, output);
            // No test before the first reading.
            let deaf = output.is_nan() || (action.filtered.input.is_some() && input.is_nan());
            let mut on = false;
            if !deaf {
                (on, command) = next(command, n, output);
            }
            if on {
                sums[n].0 += input;
                sums[n].1 += output;
                n += 1;
            } else {
                waited += 1;
                if waited > PATIENCE {
                    return Err(no_answer("output", SAMPLES, scenario));
                }
            }
        }
    }
    let each = 1.0 / TESTS as f64;
    Ok(sums.iter().map(|(x, y)| (x * each, y * each)).collect())
}
