//! The experiment that a plant's model is identified from: the designed profile, run through the
//! same loop and sensors.

use super::{Reference, Scenario};
use hysteron::control::{Controller, Scheme};
use hysteron::{Auto, Choice, DesignOptions, Rates, design};
use hysteron::{Fit, FitOptions, Model, Plane, Recording, Result};

/// How many triangles the experiment of a wire has, and its steps as shares of the drive's range.
/// Both begin at the lowest drive, where the wire is at rest.
const TRIANGLES: usize = 5;
const STEPS: [f64; 9] = [0.0, 1.0, 0.0, 0.65, 0.2, 0.8, 0.4, 0.55, 0.0];

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
    if scenario.plant.has_body() {
        return with_body(scenario, scheme, seed);
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
        delay: Choice::Auto,
        ..FitOptions::plain()
    })
    .run(&recording)?;
    let [_, input, output] = scenario.plant.quantities();
    (model.input, model.output) = (input, output);
    Ok(model)
}

/// A model with a thermal body, from triangles of the drive that shrink and from steps.
fn with_body(scenario: &Scenario, scheme: &Scheme, seed: u64) -> Result<Model> {
    let options = &scenario.model;
    let ((low, high), (up, down)) = (options.range, options.rates);
    let drive = |share: f64| low + share * (high - low);
    let ((mut time, mut at), mut triangles) = ((0.0, low), vec![(0.0, low)]);
    for n in 0..TRIANGLES {
        for to in [drive(1.0 - n as f64 / TRIANGLES as f64), low] {
            let rate = if to > at { up } else { down };
            time += (to - at).abs() / rate;
            at = to;
            triangles.push((time, to));
        }
    }
    // Each step lasts as long as the first leg of the triangles takes for half of its way.
    let rest = 0.5 * (high - low) / up;
    let steps = (0..STEPS.len()).map(|n| (n as f64 * rest, drive(STEPS[n])));
    let steps: Vec<(f64, f64)> = steps.collect();
    let ends = [time, STEPS.len() as f64 * rest];
    let profiles = [
        Reference::Ramps { points: triangles },
        Reference::Steps { points: steps },
    ];
    let recordings = profiles
        .iter()
        .zip(ends)
        .zip(0..)
        .map(|((profile, end), n)| {
            let count = (end / scenario.interval_s) as usize;
            let profile = (0..count).map(|n| profile.at(n as f64 * scenario.interval_s));
            record(
                scenario,
                scheme,
                &profile.collect::<Vec<_>>(),
                seed + n * 500_000,
            )
        });
    let recordings = recordings.collect::<Result<Vec<_>>>()?;
    let mut model = Fit::from(&FitOptions {
        levels: options.levels,
        smooth: options.smooth.into(),
        delay: Choice::Auto,
        ..FitOptions::plain()
    })
    .thermal(Auto)
    .run(&recordings)?;
    let [drive, _, output] = scenario.plant.quantities();
    (model.input, model.output) = (drive, output);
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
    let (mut time, mut input, mut output) = (Vec::new(), Vec::new(), Vec::new());
    for (n, &command) in profile.iter().enumerate() {
        let reading = plant.read();
        let action = controller.step_command(command, reading)?;
        plant.write(action.drive);
        plant.advance(scenario.interval_s);
        if let (Some(x), y) = (action.filtered.input, action.filtered.output)
            && x.is_finite()
            && y.is_finite()
        {
            time.push(n as f64 * scenario.interval_s);
            input.push(x);
            output.push(y);
        }
    }
    let mut recording = Recording::new(input, output)?;
    recording.time = Some(time);
    Ok(recording)
}
