//! Time of a sample of an adaptation, in a loop of 200 samples a cycle; medians:
//! `cargo run --release -p hysteron-measure -- refit-speed`

use crate::median::median;
use crate::result::Result;
use hysteron::{AdaptOptions, Learner, Model, Operator, Outcome, Plane, Sign};
use std::time::Instant;

/// Samples of a cycle, and cycles measured.
const CYCLE: usize = 200;
const CYCLES: usize = 20;

pub(crate) fn run(_: &[String]) -> Result<()> {
    println!(
        "| K | a sample, averaged | without a refit | with a refit | matrix | least squares |"
    );
    println!("| ---: | ---: | ---: | ---: | ---: | ---: |");
    for levels in [10, 20, 40] {
        let [refit, squares] =
            [Learner::Refit, Learner::LeastSquares].map(|learner| times(levels, learner));
        let (refit, squares) = (refit?, squares?);
        println!(
            "| {levels} | {:.0} µs | {:.2} µs | {:.2} ms | {:.2} MB | {:.0} µs |",
            refit.mean,
            refit.between,
            refit.refit / 1e3,
            8e-6 * (levels * (levels + 1) / 2).pow(2) as f64,
            squares.mean,
        );
    }
    Ok(())
}

/// In microseconds.
struct Times {
    mean: f64,
    between: f64,
    refit: f64,
}

fn times(levels: usize, learner: Learner) -> hysteron::Result<Times> {
    let plane = Plane::new(20.0, 80.0, levels)?;
    let operators = plane.operators();
    // Away from the diagonal, as of a loop with some width; the plant has a larger stroke, and
    // weights elsewhere.
    let of = |stroke: f64, shift: f64| {
        let weight = |(i, j): (usize, usize)| {
            let [i, j] = [i, j].map(|n| n as f64 / levels as f64);
            stroke * (-30.0 * ((i - 0.3 - shift).powi(2) + (j - 0.6 - shift).powi(2))).exp()
        };
        let weights = hysteron::operators(levels).map(weight).collect();
        Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive)
    };
    let (model, plant) = (
        of(10.0 / operators as f64, 0.0)?,
        of(14.0 / operators as f64, 0.05)?,
    );
    let mut state = plant.start();
    let options = AdaptOptions {
        learner,
        ..AdaptOptions::default()
    };
    let mut adaptive = options.adaptive(&model)?;
    let (mut cycles, mut between, mut refits) = (vec![0.0; CYCLES + 2], vec![], vec![]);
    for n in 0..(CYCLES + 2) * CYCLE {
        let turn = std::f64::consts::TAU * n as f64 / CYCLE as f64;
        // No cycle is like the one before.
        let input = 50.0 - (26.0 + 4.0 * (0.013 * n as f64).sin()) * turn.cos();
        let noise = 0.02 * (1.7 * n as f64).sin();
        let output = plant.step(&mut state, input)?.output + noise;
        let begin = Instant::now();
        let learning = adaptive.step(input, output)?;
        let time = begin.elapsed().as_secs_f64() * 1e6;
        cycles[n / CYCLE] += time;
        match learning.outcome {
            Outcome::Learned => refits.push(time),
            _ => between.push(time),
        }
    }
    // The first cycles are not those of a loop that has run.
    Ok(Times {
        mean: median(cycles.split_off(2)) / CYCLE as f64,
        between: median(between),
        refit: median(refits),
    })
}
