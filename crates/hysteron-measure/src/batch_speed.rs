//! What a sample of `BatchModel::run` takes beside the same models one after the other, each by
//! `Model::run`: `cargo run --release -p hysteron-measure -- batch-speed`
//!
//! Both run in turn on the same inputs, and the shortest time of each counts. The first lines are
//! of one model with many inputs, the last ones of a model of its own for each lane.

use crate::result::Result;
use hysteron::{BatchModel, Model, Operator, Plane, Sign};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::hint::black_box;
use std::time::Instant;

/// Samples of all lanes together.
const SAMPLES: usize = 1 << 20;
const LEVELS: usize = 20;
const TURNS: usize = 15;

pub(crate) fn run(_: &[String]) -> Result<()> {
    let threads = std::thread::available_parallelism()?;
    println!("K = {LEVELS}, {SAMPLES} samples in all lanes together, {threads} threads\n");
    println!(
        "| models | lanes | input | `BatchModel::run` | one after the other | ratio |\n\
         | --- | ---: | --- | ---: | ---: | ---: |"
    );
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for (models, shared) in [("one", true), ("each its own", false)] {
        for lanes in [1, 16, 1024, 65_536] {
            let count = if shared { 1 } else { lanes };
            let own: Vec<Model> = (0..count).map(|_| model(&mut rng)).collect::<Result<_>>()?;
            for (input, is_smooth) in [("smooth", true), ("random walk", false)] {
                let inputs: Vec<f64> = (0..lanes)
                    .flat_map(|_| series(&mut rng, SAMPLES / lanes, is_smooth))
                    .collect();
                let [ours, alone] = measured(&own, lanes, &inputs)?;
                println!(
                    "| {models} | {lanes} | {input} | {ours:.2} ns | {alone:.2} ns | {:.2} |",
                    ours / alone
                );
            }
        }
    }
    Ok(())
}

fn model(rng: &mut ChaCha8Rng) -> Result<Model> {
    let low = rng.random_range(15.0..25.0);
    let plane = Plane::new(low, low + 60.0, LEVELS)?;
    let weights = (0..plane.operators()).map(|_| rng.random()).collect();
    Ok(Model::new(
        Operator::Mkp,
        plane,
        weights,
        0.0,
        Sign::Positive,
    )?)
}

fn series(rng: &mut ChaCha8Rng, samples: usize, is_smooth: bool) -> Vec<f64> {
    let phase: f64 = rng.random_range(0.0..6.0);
    let mut at: f64 = 50.0;
    let next = |n: usize| match is_smooth {
        true => 50.0 + 28.0 * (phase + n as f64 * 0.0126).sin(),
        false => {
            at = (at + rng.random_range(-3.0..3.0)).clamp(15.0, 85.0);
            at
        }
    };
    (0..samples).map(next).collect()
}

/// Nanoseconds for a sample, in the batch and one after the other.
fn measured(models: &[Model], lanes: usize, inputs: &[f64]) -> Result<[f64; 2]> {
    let mut batch = match models {
        [model] => BatchModel::new(model.clone(), lanes)?,
        models => models.iter().cloned().collect(),
    };
    let of = |lane: usize| &models[lane % models.len()];
    let mut states: Vec<_> = (0..lanes).map(|lane| of(lane).start()).collect();
    let mut outputs = [vec![0.0; inputs.len()], vec![0.0; inputs.len()]];
    let samples = inputs.len() / lanes;
    let mut best = [f64::INFINITY; 2];
    for _ in 0..TURNS {
        let begin = Instant::now();
        batch.run(black_box(inputs), &mut outputs[0])?;
        best[0] = best[0].min(begin.elapsed().as_secs_f64());

        let begin = Instant::now();
        let rows = inputs
            .chunks_exact(samples)
            .zip(outputs[1].chunks_exact_mut(samples));
        for (lane, (input, output)) in rows.enumerate() {
            of(lane).run(&mut states[lane], black_box(input), output)?;
        }
        best[1] = best[1].min(begin.elapsed().as_secs_f64());
        if outputs[0] != outputs[1] {
            return Err("the batch has other outputs than the models alone".into());
        }
    }
    Ok(best.map(|seconds| 1e9 * seconds / inputs.len() as f64))
}
