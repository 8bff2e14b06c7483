//! Clean recordings, each with a second one of the same actuator.

use hysteron::Recording;
use hysteron_sim::rig::{Experiment, prepared};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::error::Error;

/// The spring of the demo, in two sessions with their own noise.
pub fn spring() -> Result<[Recording; 2], Box<dyn Error>> {
    let experiment = Experiment::default();
    Ok([
        prepared(&experiment.record(1)?)?,
        prepared(&experiment.record(2)?)?,
    ])
}

/// Plays in parallel and a linear part, under two zigzags of their own.
pub fn plays(seed: u64) -> Result<[Recording; 2], Box<dyn Error>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let widths: [f64; 8] = std::array::from_fn(|n| 2.0 + 3.0 * n as f64);
    let shares: [f64; 8] = std::array::from_fn(|_| rng.random_range(0.02..0.2));
    let mut record = || {
        let mut input = vec![20.0_f64];
        // The whole range first, then parts of it.
        let parts: Vec<f64> = (0..24).map(|_| rng.random_range(20.0..80.0)).collect();
        for target in [80.0, 20.0, 80.0, 20.0].into_iter().chain(parts) {
            let start = input[input.len() - 1];
            let count = ((target - start).abs() / 0.6).ceil() as usize;
            input.extend((1..=count).map(|n| start + (target - start) * n as f64 / count as f64));
        }
        let mut plays = [20.0_f64; 8];
        let respond = |x: &f64| {
            let moved = widths.iter().zip(&mut plays).zip(&shares);
            let sum = moved.map(|((width, play), share)| {
                *play = play.clamp(x - width, x + width);
                share * *play
            });
            0.1 * x + sum.sum::<f64>()
        };
        let output = input.iter().map(respond).collect();
        let mut recording = Recording::new(input, output)?;
        recording.time = Some((0..recording.len()).map(|n| 0.5 * n as f64).collect());
        Ok::<Recording, hysteron::Error>(recording)
    };
    Ok([record()?, record()?])
}
