//! Cross-validation over whole branches.

use hysteron::{
    Candidates, Choice, Fit, FitOptions, Model, Operator, Plane, Progress, Recording, Sign,
    Spacing, cross_validate, left_out,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// A material with a smooth density over the plane, on many levels.
fn material() -> Model {
    let plane = Plane::new(0.0, 1.0, 60).unwrap();
    let mut weights = Vec::new();
    for j in 1..=60 {
        for i in 1..=j {
            let (a, b) = (f64::from(i) / 60.0 - 0.35, f64::from(j) / 60.0 - 0.65);
            weights.push((-(a * a + b * b) / 0.03).exp() / 60.0);
        }
    }
    Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive).unwrap()
}

/// Reversal curves to sixteen heights, with noise of `part` of the range.
fn recording(material: &Model, part: f64, seed: u64) -> Recording {
    let mut input = vec![-0.01];
    for k in 1..=16 {
        for to in [f64::from(k) / 16.0, 0.015 * f64::from(k % 4)] {
            let from = *input.last().unwrap();
            input.extend((1..=30).map(|n| from + (to - from) * f64::from(n) / 30.0));
        }
    }
    let clean = material.simulate(&input).unwrap();
    let high = clean.iter().copied().fold(0.0, f64::max);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut noise = || -> f64 { StandardNormal.sample(&mut rng) };
    let output = clean.iter().map(|y| y + part * high * noise()).collect();
    Recording::new(input, output).unwrap()
}

fn error(found: &Model, material: &Model) -> f64 {
    let clean = recording(material, 0.0, 0);
    let modelled = found.simulate(&clean.input).unwrap();
    let squares = modelled
        .iter()
        .zip(&clean.output)
        .map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / modelled.len() as f64).sqrt()
}

#[test]
fn the_choice_beats_the_plain_fit_on_noise() {
    let material = material();
    let (mut plain, mut chosen) = (0.0, 0.0);
    for seed in 0..4 {
        let noisy = recording(&material, 0.03, seed);
        let all = std::slice::from_ref(&noisy);
        let candidates = Candidates::new(None, None);
        let (options, validation) =
            cross_validate(all, &FitOptions::plain(), &candidates, Progress::NONE).unwrap();
        assert!(validation.whole_branches && !options.smooth.is_none());
        // What is left out has noise too: 3 % of the range.
        assert!(
            (2.5..4.5).contains(&validation.nrmse_percent),
            "{validation:?}"
        );
        plain += error(
            &Fit::from(FitOptions::plain()).run(&noisy).unwrap(),
            &material,
        );
        chosen += error(&Fit::from(&options).run(&noisy).unwrap(), &material);
    }
    println!("error against the truth: {plain:.5} plain, {chosen:.5} chosen");
    assert!(chosen < 0.8 * plain, "{chosen} of {plain}");
}

#[test]
fn strength_means_the_same_at_any_number_of_levels() {
    let material = material();
    let noisy = recording(&material, 0.02, 9);
    let outputs: Vec<Vec<f64>> = [20, 40]
        .into_iter()
        .map(|levels| {
            let options = FitOptions {
                levels,
                smooth: (0.0, 1e-5).into(),
                ..FitOptions::plain()
            };
            let model = Fit::from(&options).run(&noisy).unwrap();
            model.simulate(&noisy.input).unwrap()
        })
        .collect();
    let squares: f64 = outputs[0]
        .iter()
        .zip(&outputs[1])
        .map(|(a, b)| (a - b).powi(2))
        .sum();
    let high = material.output_range().1;
    let difference = (squares / noisy.len() as f64).sqrt() / high;
    // Half a level of the coarser plane bends the loops by about this; a strength off by K⁴ = 16
    // moves them by more.
    assert!(difference < 0.004, "{difference}");
}

/// Beyond 40 levels the search begins with fewer levels.
#[test]
fn many_levels_find_a_smoothness_that_is_as_good_as_any() {
    let noisy = [recording(&material(), 0.02, 5)];
    let options = FitOptions::plain();
    let rated = |smooth| {
        let candidates = Candidates::new(Some(45), smooth);
        let found = cross_validate(&noisy, &options, &candidates, Progress::NONE);
        found.unwrap().1
    };
    let found = rated(None);
    assert!(found.scores.iter().all(|score| score.levels == 45));
    assert!(found.scores.len() < 12, "{:?}", found.scores);
    for along in [0.0, 1e-9, 1e-7, 1e-5] {
        for across in [0.0, 1e-8, 1e-6] {
            let rmse = rated(Some((along, across).into())).rmse;
            // Between two decades the error hardly changes.
            assert!(
                found.rmse < 1.01 * rmse,
                "{found:?}, {rmse} at {along}, {across}"
            );
        }
    }
}

#[test]
fn samples_are_left_out_with_their_branch() {
    let material = material();
    let noisy = recording(&material, 0.01, 3);
    let found = left_out(
        std::slice::from_ref(&noisy),
        &FitOptions::plain(),
        None,
        Progress::NONE,
    )
    .unwrap();
    // Thirty samples a branch, which begins after its turning point.
    for (n, fold) in found.fold.iter().enumerate().skip(1) {
        assert_eq!(*fold, (n - 1) / 30 % 5, "sample {n}");
    }
    assert!(found.training_nrmse_percent < found.nrmse_percent);
    // What was left out is predicted without it: changing one branch's output changes no prediction
    // of it.
    let mut other = noisy.clone();
    for n in 91..=120 {
        other.output[n] += 0.1;
    }
    let again = left_out(
        std::slice::from_ref(&other),
        &FitOptions::plain(),
        None,
        Progress::NONE,
    )
    .unwrap();
    for n in 91..=120 {
        // The solver's own accuracy: 1e-6 of an output of about one.
        assert!((again.predicted[n] - found.predicted[n]).abs() < 1e-6);
    }
    assert!(
        left_out(
            &[Recording::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 2.0]).unwrap()],
            &FitOptions::plain(),
            None,
            Progress::NONE
        )
        .is_err()
    );
    // Stages are not left out in silence.
    let plain = FitOptions::plain;
    for options in [
        FitOptions {
            spacing: Spacing::Auto,
            ..plain()
        },
        FitOptions {
            creep: Choice::Auto,
            ..plain()
        },
        FitOptions {
            lag: Choice::Fixed(0.1),
            ..plain()
        },
    ] {
        let noisy = std::slice::from_ref(&noisy);
        assert!(left_out(noisy, &options, None, Progress::NONE).is_err());
    }
}
