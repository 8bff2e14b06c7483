//! The rivals of a choice see the inputs as measured, on the same samples whatever the model is.

use hysteron::{Fit, Recording, RivalScore, Spacing};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A steep loop around a random place: levels close together there are better.
fn steep(seed: u64, branches: usize) -> Recording {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (place, width) = (rng.random_range(0.3..0.6), rng.random_range(0.02..0.05));
    let mut input = vec![0.0_f64];
    for branch in 0..branches {
        let from = *input.last().unwrap();
        let to = match branch % 2 {
            0 => rng.random_range(place + 0.1..1.0),
            _ => rng.random_range(0.0..place - 0.1),
        };
        input.extend((1..=40).map(|n| from + (to - from) * f64::from(n) / 40.0));
    }
    let mut played = 0.0_f64;
    let output = input.iter().map(|x| {
        played = played.clamp(x - 0.04, x + 0.04);
        ((played - place) / width).tanh() + 1e-3 * rng.random_range(-1.0..1.0)
    });
    let output = output.collect();
    Recording::new(input, output).unwrap()
}

fn rivals(recordings: &[Recording], spacing: Spacing) -> (bool, Vec<RivalScore>) {
    let fit = Fit::new().levels(10).bootstrap(0).spacing(spacing);
    let model = fit.run(recordings).unwrap();
    let bent = !model.spacing().is_empty();
    (bent, model.fit.unwrap().validation.unwrap().rivals)
}

/// With few branches and with many, so with parts of branches and with whole ones left out.
#[test]
fn their_errors_do_not_depend_on_the_spacing() {
    let mut bent = 0;
    for seed in 0..6 {
        for branches in [3, 9] {
            let both = [steep(seed, branches), steep(seed + 100, branches)];
            for recordings in [&both[..1], &both[..]] {
                let (_, even) = rivals(recordings, Spacing::Uniform);
                let (is_bent, auto) = rivals(recordings, Spacing::Auto);
                assert!(!even.is_empty());
                assert_eq!(even, auto, "seed {seed}, {branches} branches");
                bent += usize::from(is_bent);
            }
        }
    }
    // Otherwise this test compares a fit with itself.
    assert!(bent >= 12, "{bent} of 24 with other spacings");
}
