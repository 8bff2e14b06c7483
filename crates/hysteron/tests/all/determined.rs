//! How many combinations of the weights a recording determines.

use hysteron::{Fit, FitOptions, Recording, RecordingSummary, Start, inspect_recording, plane_of};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// A random zigzag from the lowest input; the output is a play with `noise`.
fn zigzag(seed: u64, branches: usize, noise: f64) -> Recording {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut input = vec![0.0_f64];
    for branch in 0..branches {
        let from = *input.last().unwrap();
        let to = match branch {
            0 => 1.0,
            _ if branch % 2 == 0 => rng.random_range(from..1.0),
            _ => rng.random_range(0.0..from),
        };
        input.extend((1..=25).map(|n| from + (to - from) * f64::from(n) / 25.0));
    }
    let mut played = 0.0_f64;
    let output = input.iter().map(|x| {
        played = played.clamp(x - 0.1, x + 0.1);
        let deviation: f64 = StandardNormal.sample(&mut rng);
        played + noise * deviation
    });
    let output = output.collect();
    Recording::new(input, output).unwrap()
}

fn inspected(recording: &Recording, levels: usize) -> RecordingSummary {
    inspect_recording(recording, plane_of(recording, levels).unwrap()).unwrap()
}

/// The rank is that of a fit with these levels, and never more than what is excited.
#[test]
fn the_rank_is_that_of_a_fit() {
    for seed in 0..8 {
        for levels in [2, 5, 12] {
            let recording = zigzag(seed, 2 + seed as usize * 2, 0.002);
            let summary = inspected(&recording, levels);
            let options = FitOptions {
                levels,
                start: Start::Off,
                bootstrap: 5,
                ..FitOptions::plain()
            };
            let model = Fit::from(options).run(&recording).unwrap();
            let fitted = model.fit.unwrap().confidence.unwrap();
            let (rank, determined) = (summary.rank.unwrap(), summary.determined.unwrap());
            assert_eq!(rank, fitted.rank, "seed {seed}, {levels} levels");
            assert!(determined <= rank && rank <= summary.excited);
        }
    }
}

/// A single loop excites every operator and determines few combinations; more branches determine
/// more, and more noise leaves fewer.
#[test]
fn excited_is_not_determined() {
    for seed in 0..6 {
        let one_loop = inspected(&zigzag(seed, 2, 0.0), 20);
        assert_eq!(one_loop.excited, one_loop.operators);
        assert!(3 * one_loop.rank.unwrap() < one_loop.operators);
        let mut before = 0;
        for branches in [2, 8, 40] {
            let rank = inspected(&zigzag(seed, branches, 0.0), 20).rank.unwrap();
            assert!(rank > before, "seed {seed}, {branches} branches");
            before = rank;
        }
        let mut before = usize::MAX;
        for noise in [1e-5, 1e-3, 1e-1] {
            let found = inspected(&zigzag(seed, 40, noise), 20).determined.unwrap();
            assert!(found < before, "seed {seed}, noise {noise}");
            before = found;
        }
    }
}

/// The unit of the output does not matter, and a large plane is not counted.
#[test]
fn units_do_not_matter() {
    let recording = zigzag(1, 20, 0.003);
    let scaled = Recording {
        // By a power of two, so that nothing is rounded.
        output: recording.output.iter().map(|y| y * 1024.0).collect(),
        ..recording.clone()
    };
    assert_eq!(
        inspected(&recording, 15).determined,
        inspected(&scaled, 15).determined
    );
    let large = inspected(&recording, 51);
    assert_eq!((large.rank, large.determined), (None, None));
}
