//! Identification of known models, and the optimality of what is found.

use hysteron::{Error, Fit, FitOptions, Model, Operator, Plane, Recording, Sign, Smooth, Solver};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const OPERATORS: [Operator; 3] = [Operator::Mkp, Operator::Kp, Operator::Relay];

fn plane(levels: usize) -> Plane {
    Plane::new(20.0, 80.0, levels).unwrap()
}

/// First-order reversal curves over the whole plane: they excite every operator.
fn reversal_curves(plane: &Plane) -> Vec<f64> {
    let mut input = Vec::new();
    let walk = |input: &mut Vec<f64>, to: f64| {
        let from = input.last().copied().unwrap_or(plane.bottom());
        input.extend((1..=40).map(|n| from + (to - from) * f64::from(n) / 40.0));
    };
    for level in 1..=plane.levels() {
        walk(&mut input, plane.level(level));
        walk(&mut input, plane.bottom());
    }
    input
}

fn options(operator: Operator, levels: usize, solver: Solver) -> FitOptions {
    FitOptions {
        operator,
        levels,
        range: Some((20.0, 80.0)),
        solver,
        ridge: 0.0,
        ..FitOptions::plain()
    }
}

#[test]
fn a_known_model_is_recovered() {
    for (seed, operator) in OPERATORS.into_iter().enumerate() {
        for sign in [Sign::Positive, Sign::Negative] {
            for solver in [Solver::Nnls, Solver::Ols] {
                let mut rng = ChaCha8Rng::seed_from_u64(seed as u64);
                let plane = plane(8);
                let weights: Vec<f64> = (0..36).map(|_| rng.random_range(0.0..2.0)).collect();
                let known = Model::new(operator, plane, weights, 3.5, sign).unwrap();
                let input = reversal_curves(&plane);
                let recording =
                    Recording::new(input.clone(), known.simulate(&input).unwrap()).unwrap();
                let found = Fit::from(&options(operator, 8, solver))
                    .run(&recording)
                    .unwrap();
                assert_eq!(found.sign(), sign);
                assert!(
                    (found.offset() - 3.5).abs() < 1e-6,
                    "{operator:?}: {}",
                    found.offset()
                );
                for (a, b) in found.weights().iter().zip(known.weights()) {
                    // The smallest singular value of these curves amplifies rounding by about 1e4.
                    assert!(
                        (a - b).abs() < 1e-6,
                        "{operator:?} {sign:?} {solver:?}: {a} for {b}"
                    );
                }
            }
        }
    }
}

/// Karush-Kuhn-Tucker: no weight below zero, and no direction in which the error falls. The
/// gradient is taken numerically, from simulations alone.
#[test]
fn non_negative_least_squares_is_optimal() {
    for seed in 0..20 {
        let mut rng = ChaCha8Rng::seed_from_u64(100 + seed);
        let levels = rng.random_range(2..=9);
        let operator = OPERATORS[rng.random_range(0..3)];
        let plane = plane(levels);
        let input: Vec<f64> = (0..400).map(|_| rng.random_range(10.0..85.0)).collect();
        // Nothing that a monotone model could fit: many weights end at zero.
        let output: Vec<f64> = input
            .iter()
            .map(|t| (t / 9.0).sin() + rng.random_range(-0.5..0.5))
            .collect();
        let recording = Recording::new(input, output.clone()).unwrap();
        let model = Fit::from(&options(operator, levels, Solver::Nnls))
            .run(&recording)
            .unwrap();
        let rmse = model.fit.as_ref().unwrap().rmse;
        let squares = |model: &Model| -> f64 {
            let modelled = model.simulate(&recording.input).unwrap();
            let residuals: Vec<f64> = output.iter().zip(&modelled).map(|(y, h)| y - h).collect();
            let mean = residuals.iter().sum::<f64>() / residuals.len() as f64;
            residuals.iter().map(|r| (r - mean).powi(2)).sum()
        };
        let best = squares(&model);
        assert!(
            (best - 400.0 * rmse * rmse).abs() < 1e-9 * best,
            "the offset is the best one"
        );
        for n in 0..plane.operators() {
            let mu = model.weights()[n];
            assert!(mu >= 0.0);
            for step in [1e-4, -1e-4] {
                if mu + step < 0.0 {
                    continue;
                }
                let mut weights = model.weights().to_vec();
                weights[n] += step;
                let other =
                    Model::new(operator, plane, weights, model.offset(), model.sign()).unwrap();
                assert!(
                    squares(&other) >= best * (1.0 - 1e-12),
                    "seed {seed}, weight {n}"
                );
            }
        }
    }
}

#[test]
fn operators_never_excited_get_no_weight() {
    // Up to 50 only: rows above stay off throughout.
    let input: Vec<f64> = (0..100).map(|n| 20.0 + f64::from(n % 50) * 0.6).collect();
    let output = input.iter().map(|t| t * 0.1).collect();
    let recording = Recording::new(input, output).unwrap();
    for solver in [Solver::Nnls, Solver::Ols] {
        let model = Fit::from(&options(Operator::Mkp, 20, solver))
            .run(&recording)
            .unwrap();
        let above = hysteron_core::operator_count(12);
        assert!(model.weights()[above..].iter().all(|mu| mu.abs() < 1e-9));
    }
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let recording = |input: Vec<f64>| Recording::new(input, vec![1.0, 2.0, 4.0]);
    let constant = recording(vec![5.0; 3]).unwrap();
    let error = Fit::from(FitOptions::plain()).run(&constant).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("column `input`: it is 5 throughout"),
        "{error}"
    );
    assert!(recording(vec![1.0, f64::NAN, 2.0]).is_err());
    assert!(recording(vec![1.0, 2.0]).is_err());
    let good = recording(vec![1.0, 2.0, 3.0]).unwrap();
    let refuse = |options: FitOptions| Fit::from(&options).run(&good).unwrap_err();
    for levels in [0, 1, 1_000_000] {
        let error = refuse(FitOptions {
            levels,
            ..FitOptions::plain()
        });
        assert!(
            matches!(error, Error::Core(hysteron_core::Error::Levels(_))),
            "{error}"
        );
    }
    let error = refuse(FitOptions {
        levels: 1000,
        ..FitOptions::plain()
    });
    assert!(matches!(error, Error::Fit(_)), "{error}");
    let error = refuse(FitOptions {
        range: Some((3.0, 1.0)),
        ..FitOptions::plain()
    });
    assert!(
        matches!(error, Error::Core(hysteron_core::Error::Range)),
        "{error}"
    );
    let error = refuse(FitOptions {
        offset: Some(f64::NAN),
        ..FitOptions::plain()
    });
    assert!(matches!(error, Error::Fit(_)), "{error}");
}

/// The Gram matrix of so many levels has no room with all its elements, and a sparse one has.
#[test]
fn levels_whose_dense_matrix_has_no_room_are_fitted() {
    let input: Vec<f64> = (0..3000)
        .map(|n| 50.0 - 30.0 * (1.0 - f64::from(n) / 4000.0) * (f64::from(n) * 0.02).cos())
        .collect();
    let (mut y, noise) = (20.0, 0.1);
    let output = input.iter().zip(0_u32..).map(|(x, n)| {
        y = f64::clamp(y, x - 6.0, x + 3.0);
        y + noise * f64::from(n * n).sin()
    });
    let recording = Recording::new(input.clone(), output.collect()).unwrap();
    let with = |bootstrap| FitOptions {
        levels: 220,
        smooth: Smooth::from(1e-8),
        bootstrap,
        ..FitOptions::plain()
    };
    let model = Fit::from(&with(0)).run(&recording).unwrap();
    // A play turns between two levels, so it is followed to half their distance.
    let (half, rmse) = (0.5 * model.plane().step(), model.fit.unwrap().rmse);
    assert!(rmse < half + noise, "{rmse} for {half}");
    // What still asks for all elements says so.
    let error = Fit::from(&with(10)).run(&recording).unwrap_err();
    assert!(error.to_string().contains("take fewer levels"), "{error}");
}

/// A long rest leaves a large mean and little around it, which is where centring loses its digits.
#[test]
fn long_rests_do_not_spoil_the_fit() {
    for (samples, levels) in [(20_000, 5), (80_000, 20)] {
        let input: Vec<f64> = (0..samples)
            .map(|n| {
                if n < 100 {
                    f64::from(n)
                } else {
                    99.0 + 0.001 * f64::from(n % 2)
                }
            })
            .collect();
        let output = input.iter().map(|t| 0.2 * t).collect();
        let recording = Recording::new(input, output).unwrap();
        for solver in [Solver::Nnls, Solver::Ols] {
            let options = FitOptions {
                levels,
                solver,
                ridge: 0.0,
                ..FitOptions::plain()
            };
            let model = Fit::from(&options).run(&recording).unwrap();
            assert!(
                model.fit.unwrap().nrmse_percent < 1e-4,
                "{samples}, {levels}, {solver:?}"
            );
        }
    }
}

#[test]
fn an_empty_recording_is_an_error_of_a_robust_fit() {
    let good = Recording::new(vec![0.0, 1.0, 2.0, 1.0, 0.0], vec![0.0, 0.1, 0.9, 0.8, 0.0]);
    let good = good.unwrap();
    let empty = Recording {
        input: Vec::new(),
        output: Vec::new(),
        ..good.clone()
    };
    for recordings in [vec![], vec![empty.clone()], vec![good, empty]] {
        assert!(Fit::new().run(&recordings).is_err());
    }
}
