//! The experiment that a plant's model is identified from: the designed profile, run through the
//! same loop and sensors.

use super::{Reference, Scenario};
use hysteron::control::{Controller, Scheme};
use hysteron::{DesignOptions, Rates, design};
use hysteron::{Fit, FitOptions, Model, Plane, Recording, Result};

/// A model of the scenario's plant: from its file, or fitted to an experiment with the noise of
/// `seed`.
///
/// # Errors
/// As [`design`], [`Fit::run`] and [`Model::read`].
pub(super) fn identify(scenario: &Scenario, scheme: &Scheme, seed: u64) -> Result<Model> {
    let options = &scenario.model;
    if let Some(file) = &options.file {
        return Model::read(file);
    }
    let recording = record(
        scenario,
        scheme,
        &profile(scenario, options.plane()?)?,
        seed,
    )?;
    let mut model = Fit::from(&FitOptions {
        levels: options.levels,
        range: Some(options.range),
        smooth: (0.0, options.smooth).into(),
        ..FitOptions::default()
    })
    .run(&recording)?;
    let [_, input, output] = scenario.plant.quantities();
    (model.input, model.output) = (input, output);
    Ok(model)
}

/// The profile that determines every operator, at each sample.
fn profile(scenario: &Scenario, plane: Plane) -> Result<Vec<f64>> {
    let (heating, cooling) = scenario.model.rates;
    let planned = design(
        &DesignOptions {
            step_s: Some(scenario.interval_s),
            ..DesignOptions::new(plane, Rates { heating, cooling })
        },
        &[],
    )?;
    let last = planned.time.last().copied().unwrap_or(0.0);
    let count = (last / scenario.interval_s).ceil() as usize;
    let points = planned.time.into_iter().zip(planned.input).collect();
    let profile = Reference::Ramps { points };
    Ok((0..=count)
        .map(|n| profile.at(n as f64 * scenario.interval_s))
        .collect())
}

fn record(scenario: &Scenario, scheme: &Scheme, profile: &[f64], seed: u64) -> Result<Recording> {
    let mut plant = scenario.plant.build(seed)?;
    let mut controller = Controller::new(scheme.clone())?;
    let (mut input, mut output) = (Vec::new(), Vec::new());
    for &command in profile {
        let reading = plant.read();
        let action = controller.step_command(command, reading)?;
        plant.write(action.drive);
        plant.advance(scenario.interval_s);
        if let (Some(x), y) = (action.filtered.input, action.filtered.output)
            && x.is_finite()
            && y.is_finite()
        {
            input.push(x);
            output.push(y);
        }
    }
    Recording::new(input, output)
}
