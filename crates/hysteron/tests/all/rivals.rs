//! Simple predictors: what each of them can follow exactly, and what it refuses.

use hysteron::{Recording, Result, Rival, RivalKind};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const SEEDS: u64 = 40;

/// A random input between reversals that lie apart, `steps` samples a branch.
fn zigzag(rng: &mut impl Rng, reversals: usize, steps: i32) -> Vec<f64> {
    let mut input = vec![rng.random_range(-1.0..1.0)];
    let mut up = rng.random_bool(0.5);
    for _ in 0..reversals {
        let from = *input.last().unwrap();
        let to = match up {
            true => from + rng.random_range(0.3..2.0),
            false => from - rng.random_range(0.3..2.0),
        };
        input.extend((1..=steps).map(|n| from + (to - from) * f64::from(n) / f64::from(steps)));
        up = !up;
    }
    input
}

/// Direction of travel and last reversal at each sample of [`zigzag`].
fn path(input: &[f64], steps: usize) -> Vec<(bool, f64)> {
    let leg = |n: usize| n.saturating_sub(1) / steps;
    let at = |n: usize| {
        let begin = leg(n) * steps;
        (input[begin + 1] > input[begin], input[begin])
    };
    (0..input.len()).map(at).collect()
}

fn largest_error(kind: RivalKind, training: &[Recording], test: &Recording) -> Result<f64> {
    let predicted = Rival::fit(kind, training)?.predict(test)?;
    let pairs = predicted.iter().zip(&test.output);
    Ok(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
}

/// Rounding of sums over a few hundred outputs of about ten.
const ROUNDING: f64 = 1e-9;

#[test]
fn a_straight_line_is_predicted_exactly_by_every_curve() {
    for seed in 0..SEEDS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let (a, b) = (rng.random_range(-5.0..5.0), rng.random_range(-5.0..5.0));
        let line = |input: Vec<f64>| {
            let output = input.iter().map(|x| a + b * x).collect();
            Recording::new(input, output).unwrap()
        };
        let training = line(zigzag(&mut rng, 8, 20));
        let ((low, high), _) = training.ranges();
        // The other predictors know nothing beyond the inputs fitted.
        let test = zigzag(&mut rng, 8, 20);
        let test = line(test.iter().map(|x| x.clamp(low, high)).collect());
        let other = line(zigzag(&mut rng, 8, 20));
        let all = [training];
        let error = |kind, test| largest_error(kind, &all, test).unwrap();
        assert!(error(RivalKind::Line, &other) < ROUNDING, "seed {seed}");
        assert!(error(RivalKind::MeanCurve, &test) < ROUNDING, "seed {seed}");
    }
}

#[test]
fn a_polynomial_for_each_direction_is_found_up_to_degree_five() {
    for seed in 0..SEEDS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let degree = rng.random_range(0..=5);
        let mut coefficients =
            || -> Vec<f64> { (0..=degree).map(|_| rng.random_range(-1.0..1.0)).collect() };
        let (up, down) = (coefficients(), coefficients());
        let input = zigzag(&mut rng, 9, 30);
        let value = |(x, (rises, _)): (&f64, (bool, f64))| {
            let own = if rises { &up } else { &down };
            own.iter().rev().fold(0.0, |sum, c| sum * x + c)
        };
        let output = input.iter().zip(path(&input, 30)).map(value).collect();
        let recording = Recording::new(input, output).unwrap();
        let (_, (low, high)) = recording.ranges();
        let all = [recording.clone()];
        let error = largest_error(RivalKind::BranchPolynomial, &all, &recording).unwrap();
        // Gram-Schmidt loses a few digits: the basis is not orthogonal over the samples.
        assert!(error < 1e-7 * (high - low).max(1.0), "seed {seed}: {error}");
    }
}

#[test]
fn interpolation_is_exact_where_the_output_is_linear_in_input_and_reversal() {
    for seed in 0..SEEDS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let k: [f64; 6] = std::array::from_fn(|_| rng.random_range(-2.0..2.0));
        let output = |x: f64, rises: bool, reversal: f64| match rises {
            true => k[0] + k[1] * x + k[2] * reversal,
            false => k[3] + k[4] * x + k[5] * reversal,
        };
        // Falling curves from different heights, each down to zero.
        let curve = |heights: &[f64]| {
            let (mut input, mut measured) = (vec![0.0], vec![output(0.0, true, 0.0)]);
            for &height in heights {
                for n in 1..=25 {
                    let x = height * f64::from(n) / 25.0;
                    input.push(x);
                    measured.push(output(x, true, 0.0));
                }
                for n in 1..=25 {
                    let x = height * (1.0 - f64::from(n) / 25.0);
                    input.push(x);
                    measured.push(output(x, false, height));
                }
            }
            Recording::new(input, measured).unwrap()
        };
        let heights: Vec<f64> = (1..=10).map(|n| 0.1 * f64::from(n)).collect();
        let training = curve(&heights);
        let between: Vec<f64> = (0..5).map(|_| rng.random_range(0.2..1.0)).collect();
        let test = curve(&between);
        let rival = Rival::fit(RivalKind::Interpolation, &training).unwrap();
        let predicted = rival.predict(&test).unwrap();
        let mut compared = 0;
        for (n, x) in test.input.iter().enumerate() {
            // A curve from further up reaches this input only below its own reversal, where the
            // curve began a step later; a curve from below it does not reach the top.
            let height = between[n.saturating_sub(1) / 50];
            let lower = heights.iter().rev().find(|h| **h <= height).unwrap();
            if n.saturating_sub(1) % 50 >= 25 && *x < lower - 0.05 {
                let error = (predicted[n] - test.output[n]).abs();
                assert!(error < ROUNDING, "seed {seed}, sample {n}: {error}");
                compared += 1;
            }
        }
        assert!(compared > 20);
    }
}

#[test]
fn interpolation_gives_back_what_it_was_fitted_to() {
    for seed in 0..SEEDS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let input = zigzag(&mut rng, 6, 25);
        let output: Vec<f64> = input.iter().map(|_| rng.random_range(-1.0..1.0)).collect();
        let recording = Recording::new(input.clone(), output).unwrap();
        let ((low, high), _) = recording.ranges();
        let path = path(&input, 25);
        let mut reversals: Vec<(bool, f64)> = path.clone();
        reversals.dedup();
        let alone = |(rises, reversal): (bool, f64)| {
            let near =
                |r: &&(bool, f64)| r.0 == rises && (r.1 - reversal).abs() <= 0.011 * (high - low);
            reversals.iter().filter(near).count() == 1
        };
        let rival = Rival::fit(RivalKind::Interpolation, &recording).unwrap();
        let predicted = rival.predict(&recording).unwrap();
        for n in 1..input.len() {
            // At its reversal two branches meet, and the output of neither is more right.
            if alone(path[n]) {
                let error = (predicted[n] - recording.output[n]).abs();
                assert!(error < ROUNDING, "seed {seed}, sample {n}");
            }
        }
    }
}

#[test]
fn a_cycle_that_repeats_is_predicted_by_the_last_one() {
    for seed in 0..SEEDS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let one: Vec<f64> = (0..60).map(|_| rng.random_range(-1.0..1.0)).collect();
        let cycles = |count: usize| {
            let sample = |n: usize| {
                let at = n % 60;
                let x = if at < 30 { at } else { 60 - at } as f64;
                // From 0 to 30 and back, the output anything at all.
                (x, one[at])
            };
            let (input, output) = (0..60 * count + 1).map(sample).unzip();
            Recording::new(input, output).unwrap()
        };
        let all = [cycles(2)];
        let error = largest_error(RivalKind::Persistence, &all, &cycles(3)).unwrap();
        assert!(error < ROUNDING, "seed {seed}: {error}");
        // A smaller loop is not the cycle.
        let mut smaller = cycles(3);
        let before = smaller.clone();
        smaller.input.iter_mut().for_each(|x| *x = 0.7 * *x + 3.0);
        let refused = largest_error(RivalKind::Persistence, &all, &smaller).unwrap_err();
        assert!(refused.to_string().contains("does not repeat"), "{refused}");
        assert!(Rival::fit(RivalKind::Persistence, &before.only(|n| n < 25).unwrap()).is_err());
    }
}

#[test]
fn only_input_and_load_are_used() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for kind in RivalKind::ALL {
        let triangle = |n: i32| f64::from(10 - (n % 20 - 10).abs());
        let input: Vec<f64> = (0..81).map(triangle).collect();
        let output: Vec<f64> = input
            .iter()
            .map(|x| x * x + rng.random_range(0.0..1.0))
            .collect();
        let recording = Recording::new(input, output).unwrap();
        let rival = Rival::fit(kind, &recording).unwrap();
        assert_eq!(rival.kind(), kind);
        let mut other = recording.clone();
        other.output.iter_mut().for_each(|y| *y *= -1e3);
        let predicted = rival.predict(&recording).unwrap();
        assert_eq!(predicted.len(), recording.len());
        assert!(predicted.iter().all(|y| y.is_finite()));
        assert_eq!(predicted, rival.predict(&other).unwrap(), "{}", kind.name());
    }
}

#[test]
fn between_two_loads_the_output_is_interpolated() {
    let at = |load: f64| {
        let triangle = |n: i32| f64::from(10 - (n % 20 - 10).abs());
        let input: Vec<f64> = (0..61).map(triangle).collect();
        let output = input
            .iter()
            .map(|x| (1.0 + load) * x + 2.0 * load)
            .collect();
        Recording {
            load: Some(vec![load; input.len()]),
            ..Recording::new(input, output).unwrap()
        }
    };
    let training = [at(4.0), at(1.0), at(2.0), at(2.0)];
    for kind in RivalKind::ALL {
        for load in [1.0, 1.7, 2.0, 3.9, 4.0] {
            let error = largest_error(kind, &training, &at(load)).unwrap();
            // A polynomial is found to fewer digits than a line.
            assert!(error < 1e-8, "{} at {load}: {error}", kind.name());
        }
        let mut without = at(2.0);
        without.load = None;
        assert!(
            Rival::fit(kind, &training)
                .unwrap()
                .predict(&without)
                .is_err()
        );
    }
}

#[test]
fn hostile_recordings_are_refused_or_predicted() {
    for kind in RivalKind::ALL {
        assert!(Rival::fit(kind, &[]).is_err());
        let mut broken = Recording::new(vec![0.0, 1.0], vec![0.0, 1.0]).unwrap();
        broken.output[1] = f64::NAN;
        assert!(Rival::fit(kind, &broken).is_err());
        for input in [vec![1.0], vec![1.0; 5], vec![0.0, 1.0, 0.0, 1.0]] {
            let output = input.iter().map(|x| 3.0 * x).collect();
            let recording = Recording::new(input, output).unwrap();
            match Rival::fit(kind, &recording) {
                Ok(rival) => {
                    let predicted = rival.predict(&recording).unwrap();
                    assert!(predicted.iter().all(|y| y.is_finite()), "{}", kind.name());
                }
                Err(error) => assert_eq!(kind, RivalKind::Persistence, "{error}"),
            }
        }
    }
}
