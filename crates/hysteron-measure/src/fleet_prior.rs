//! What a fleet tells about the next actuator, on **simulated** actuators. Prints
//! `docs/measured/fleet-prior.md`: `cargo run --release -p hysteron-measure -- fleet-prior`

use crate::material::{FINE, RANGE, bell};
use crate::median::median;
use crate::result::Result;
use hysteron::{Fit, Model, Operator, Plane, Recording, Sign, Spacing, WeightPrior};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::sync::Arc;

/// Sizes of the fleets.
const FLEETS: [usize; 3] = [12, 40, 200];
/// Actuators that are not of the fleet.
const TESTED: usize = 24;
/// Levels of the fits.
const LEVELS: usize = 20;
/// Samples of a recording.
const SAMPLES: usize = 500;
/// Shares of the recording that are known of the next actuator.
const KNOWN: [f64; 4] = [0.05, 0.1, 0.2, 0.5];
/// Standard deviation of the noise, as a share of the mean stroke.
const NOISE: f64 = 0.002;

pub(crate) fn run(_: &[String]) -> Result<()> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let most = FLEETS[FLEETS.len() - 1];
    let mut recorded = (0..most + TESTED).map(|_| record(&mut rng));
    let fleet: Vec<Recording> = recorded.by_ref().take(most).collect::<Result<_, _>>()?;
    let tested: Vec<Recording> = recorded.collect::<Result<_, _>>()?;
    let fit = Fit::new()
        .range(RANGE.0, RANGE.1)
        .levels(LEVELS)
        .spacing(Spacing::Uniform)
        .bootstrap(0);
    eprintln!("the fleet");
    let models: Vec<Model> = fleet
        .iter()
        .map(|recording| fit.run(recording))
        .collect::<Result<_, _>>()?;
    let priors = FLEETS.map(|count| WeightPrior::from_models(&models[..count]).map(Arc::new));
    let priors = priors.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mean = mean_of(&models)?;
    print!("{}", include_str!("text/fleet-prior.md"));
    println!(
        "| known | alone | mean model | mean, moved and scaled | 12 others | 40 others | 200 others | all known, alone |"
    );
    println!("| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for share in KNOWN {
        let known = (share * SAMPLES as f64).round() as usize;
        let mut columns: Vec<Vec<f64>> = vec![Vec::new(); 7];
        for recording in &tested {
            let part = recording.only(|n| n < known).ok_or("no sample")?;
            let rest = |model: &Model| -> Result<f64> {
                let found = model.simulate(&recording.input)?;
                let errors = found.iter().zip(&recording.output).skip(known);
                let squares: f64 = errors.map(|(h, y)| (h - y).powi(2)).sum();
                Ok(100.0 * (squares / (SAMPLES - known) as f64).sqrt() / stroke(recording))
            };
            columns[0].push(rest(&fit.run(&part)?)?);
            columns[1].push(rest(&mean)?);
            columns[2].push(rest(&fitted_mean(&mean, &part)?)?);
            for column in 0..FLEETS.len() {
                let fit = fit.clone().prior(priors[column].clone());
                columns[3 + column].push(rest(&fit.run(&part)?)?);
            }
            columns[6].push(rest(&fit.run(recording)?)?);
        }
        let medians = columns
            .into_iter()
            .map(|column| format!(" {:.2} |", median(column)));
        println!("| {:.0} % |{}", 100.0 * share, medians.collect::<String>());
    }
    Ok(())
}

/// A material of random constants, recorded.
fn record(rng: &mut ChaCha8Rng) -> Result<Recording> {
    let mut near = |mean: f64, deviation: f64| -> f64 {
        let normal: f64 = StandardNormal.sample(&mut *rng);
        mean + deviation * normal
    };
    let (middle, half) = (near(55.0, 3.0), near(8.0, 1.5).max(2.0));
    let (spread, width) = (near(5.0, 0.6).max(2.0), near(2.5, 0.4).max(1.0));
    let (stroke, offset) = (near(10.0, 0.8), near(2.0, 0.3));
    let plane = Plane::new(RANGE.0, RANGE.1, FINE)?;
    let weights = bell((middle, spread), (half, width), stroke);
    let offset = offset + 0.5 * stroke;
    let material = Model::new(Operator::Relay, plane, weights, offset, Sign::Positive)?;
    let input: Vec<f64> = (0..SAMPLES)
        .map(|n| path(n as f64 / SAMPLES as f64))
        .collect();
    let noise = NOISE * 10.0;
    let mut output = material.simulate(&input)?;
    for y in &mut output {
        let normal: f64 = StandardNormal.sample(&mut *rng);
        *y += noise * normal;
    }
    Ok(Recording::new(input, output)?)
}

/// Ten swings between the ends of the range, each a little smaller, from below.
fn path(part: f64) -> f64 {
    let swing = 10.0 * part;
    let shrunk = 1.0 - 0.08 * swing.floor();
    let triangle = 1.0 - (2.0 * (swing - swing.floor()) - 1.0).abs();
    RANGE.0 + 2.0 + (RANGE.1 - RANGE.0 - 4.0) * (triangle * shrunk + 0.4 * (1.0 - shrunk))
}

fn stroke(recording: &Recording) -> f64 {
    let (low, high) = recording.ranges().1;
    high - low
}

/// The model of the mean weights.
fn mean_of(models: &[Model]) -> Result<Model> {
    let count = models.len() as f64;
    let mut weights = vec![0.0; models[0].weights().len()];
    for model in models {
        weights
            .iter_mut()
            .zip(model.weights())
            .for_each(|(sum, w)| *sum += w / count);
    }
    let offset = models.iter().map(Model::offset).sum::<f64>() / count;
    Ok(Model::new(
        models[0].operator(),
        *models[0].plane(),
        weights,
        offset,
        models[0].sign(),
    )?)
}

/// The mean model with its axis moved and its output scaled and moved, as fits the part best.
fn fitted_mean(mean: &Model, part: &Recording) -> Result<Model> {
    let mut best: Option<(f64, Model)> = None;
    for step in -40..=40 {
        let shift = 0.25 * f64::from(step);
        let (low, high) = (mean.plane().min() + shift, mean.plane().max() + shift);
        let plane = Plane::new(low, high, mean.plane().levels())?;
        let made = |scale: f64, offset: f64| {
            let weights = mean.weights().iter().map(|w| scale * w).collect();
            Model::new(mean.operator(), plane, weights, offset, mean.sign())
        };
        let output = made(1.0, 0.0)?.simulate(&part.input)?;
        let count = part.len() as f64;
        let middle = |y: &[f64]| y.iter().sum::<f64>() / count;
        let (x0, y0) = (middle(&output), middle(&part.output));
        let pairs = output.iter().zip(&part.output);
        let (mut xx, mut xy) = (0.0, 0.0);
        for (x, y) in pairs.clone() {
            xx += (x - x0).powi(2);
            xy += (x - x0) * (y - y0);
        }
        let scale = if xx > 0.0 { (xy / xx).max(0.0) } else { 1.0 };
        let offset = y0 - scale * x0;
        let error = pairs
            .map(|(x, y)| (offset + scale * x - y).powi(2))
            .sum::<f64>();
        if best.as_ref().is_none_or(|(least, _)| error < *least) {
            best = Some((error, made(scale, offset)?));
        }
    }
    best.map(|(_, model)| model)
        .ok_or_else(|| "no shift".into())
}
