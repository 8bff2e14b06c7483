//! The guards of the estimators: samples that teach nothing, roll-backs, and weights that stay
//! finite and not negative.

use crate::common::{
    INCREMENTS, Learner, METHODS, OPERATORS, build, dense, inputs, options, rng, strokes,
    unit_plane, weights,
};
use hysteron_core::{Adaptation, Method, Operator, Outcome, operator_count};
use rand::RngExt;

/// A learner after a way over the whole plane, and an input within the plane at which it rests.
fn at_rest(method: Method<f64>, guards: Adaptation<f64>) -> (Learner, Vec<f64>, f64) {
    let k = 8;
    let plane = unit_plane(k);
    let mut rng = rng(5);
    let offline = vec![1.0; operator_count(k)];
    let (plant, mut there) = build(plane, Operator::Mkp, &weights(&mut rng, k));
    let guards = Adaptation { method, ..guards };
    let mut learner = Learner::new(plane, Operator::Mkp, &offline, guards);
    for input in strokes(&mut rng, &plane, 2000, 40) {
        let measured = plant.step(&mut there, input).unwrap().output;
        learner.step(input, measured).unwrap();
    }
    learner.step(50.0, 10.0).unwrap();
    learner.step(50.0, 10.0).unwrap();
    for _ in 0..2 * k {
        learner.step(50.0, 10.0).unwrap();
    }
    let kept = learner.estimator.parameters().to_vec();
    (learner, kept, 50.0)
}

#[test]
fn no_drift_under_noise_without_excitation() {
    for method in METHODS {
        let mut rng = rng(6);
        let (mut learner, kept, rest) = at_rest(method, Adaptation::default());
        let offset = learner.estimator.offset();
        // Noise of half of `movement` to each side, in levels.
        let half = 0.4999 * learner.estimator.options().movement * learner.model.plane().step();
        for n in 0..1_000_000 {
            let noise = if n < 500_000 { 0.0 } else { half };
            let input = rest + noise * rng.random_range(-1.0..=1.0);
            let learning = learner.step(input, rng.random_range(-30.0..30.0)).unwrap();
            assert_ne!(learning.outcome, Outcome::Learned, "{method:?}, {n}");
        }
        assert_eq!(learner.estimator.parameters(), kept, "{method:?}");
        assert_eq!(learner.estimator.offset(), offset);
    }
}

#[test]
fn noise_within_the_dead_zone_teaches_nothing() {
    for method in METHODS {
        let mut rng = rng(7);
        let k = 8;
        let plane = unit_plane(k);
        let offline = weights(&mut rng, k);
        let (plant, mut there) = build(plane, Operator::Mkp, &offline);
        let guards = Adaptation {
            dead_zone: 0.2,
            leakage: 0.1,
            ..options(method)
        };
        let mut learner = Learner::new(plane, Operator::Mkp, &offline, guards);
        for input in strokes(&mut rng, &plane, 100_000, 40) {
            // An increment has the noise of two readings.
            let noise = rng.random_range(-0.0999..0.0999);
            let measured = plant.step(&mut there, input).unwrap().output + noise;
            assert_ne!(
                learner.step(input, measured).unwrap().outcome,
                Outcome::Learned
            );
        }
        assert_eq!(learner.estimator.parameters(), offline, "{method:?}");
        assert_eq!(learner.estimator.offset(), 0.0);
    }
}

#[test]
fn weights_of_zero_are_not_left_to_the_negative_side() {
    for method in METHODS {
        for operator in OPERATORS {
            let mut rng = rng(8);
            let k = 8;
            let plane = unit_plane(k);
            let offline = vec![0.3; operator_count(k)];
            let mut learner = Learner::new(plane, operator, &offline, options(method));
            let mut zeros = 0;
            for input in strokes(&mut rng, &plane, 20_000, 40) {
                learner.step(input, rng.random_range(-1.0..1.0)).unwrap();
                let weights = learner.estimator.parameters();
                assert!(weights.iter().all(|weight| *weight >= 0.0));
                zeros += weights.iter().filter(|weight| **weight == 0.0).count();
                assert!(learner.model.inverse().is_ok());
            }
            assert!(
                zeros > 0,
                "the projection was at work: {method:?}, {operator:?}"
            );
        }
    }
}

#[test]
fn leakage_leads_back_to_the_offline_weights() {
    for method in METHODS {
        let mut rng = rng(9);
        let k = 6;
        let plane = unit_plane(k);
        let offline = weights(&mut rng, k);
        let (plant, mut there) = build(plane, Operator::Mkp, &offline);
        let guards = Adaptation {
            leakage: 0.01,
            trial: u32::MAX,
            ..options(method)
        };
        let mut learner = Learner::new(plane, Operator::Mkp, &offline, guards);
        let mut away = 0.0;
        // An increment moves the weights that it concerns, not all.
        let count = if method == INCREMENTS {
            200_000
        } else {
            20_000
        };
        for (n, input) in strokes(&mut rng, &plane, count, 40).into_iter().enumerate() {
            let factor = if n < 2000 { 3.0 } else { 1.0 };
            let measured = factor * plant.step(&mut there, input).unwrap().output;
            learner.step(input, measured).unwrap();
            let difference = learner.estimator.parameters().iter().zip(&offline);
            let largest = difference.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            if n == 1999 {
                away = largest;
            } else if n == count - 1 {
                assert!(largest < 1e-6 * away, "{method:?}: {largest} after {away}");
            }
        }
        assert!(away > 0.1);
    }
}

#[test]
fn readings_of_any_size_leave_weights_that_are_numbers() {
    for seed in 0..60 {
        let mut rng = rng(40 + seed);
        let method = METHODS[seed as usize % METHODS.len()];
        let k = 2 + seed as usize % 5;
        let offline = weights(&mut rng, k);
        let guards = Adaptation {
            offset_share: [0.0, 1.0, 1e3][seed as usize / 2 % 3],
            ..options(method)
        };
        let mut learner = Learner::new(
            unit_plane(k),
            OPERATORS[seed as usize / 6 % 3],
            &offline,
            guards,
        );
        for input in inputs(&mut rng, &unit_plane(k), 4000) {
            let measured = [f64::MAX, -f64::MAX, 1e300, -1e300, 1e150, 1.0, -1e-300];
            let measured = measured[rng.random_range(0..measured.len())];
            learner.step(input, measured).unwrap();
            let weights = learner.estimator.parameters();
            assert!(
                weights
                    .iter()
                    .all(|weight| *weight >= 0.0 && weight.is_finite())
            );
            assert!(learner.estimator.offset().is_finite());
            assert!(
                learner.model.output(&learner.state).is_finite(),
                "{method:?}"
            );
            assert!(learner.model.output_range().1.is_finite());
        }
    }
}

#[test]
fn a_few_huge_readings_are_rolled_back() {
    for method in METHODS {
        let mut rng = rng(50);
        let k = 6;
        let (plant, mut there) = build(unit_plane(k), Operator::Mkp, &dense(&mut rng, k));
        let offline = vec![0.5; operator_count(k)];
        let mut learner = Learner::new(unit_plane(k), Operator::Mkp, &offline, options(method));
        let mut last = 0.0_f64;
        for (n, input) in strokes(&mut rng, &unit_plane(k), 60_000, 40)
            .into_iter()
            .enumerate()
        {
            let output = plant.step(&mut there, input).unwrap().output;
            let huge = (20_000..20_100).contains(&n);
            let measured = if huge { 1e300 } else { output };
            let learning = learner.step(input, measured).unwrap();
            if n >= 50_000 {
                last = last.max((learning.output - output).abs());
            }
        }
        let range = plant.output_range().1;
        assert!(last < 0.05 * range, "{method:?}: {last} of {range}");
    }
}

#[test]
fn frozen_it_predicts_and_does_not_learn() {
    for method in METHODS {
        let mut rng = rng(60);
        let k = 6;
        let (plant, mut there) = build(unit_plane(k), Operator::Mkp, &dense(&mut rng, k));
        let offline = vec![0.5; operator_count(k)];
        let mut learner = Learner::new(unit_plane(k), Operator::Mkp, &offline, options(method));
        assert!(!learner.estimator.is_frozen());
        learner.estimator.freeze(true);
        assert!(learner.estimator.is_frozen());
        for (n, input) in strokes(&mut rng, &unit_plane(k), 40_000, 40)
            .into_iter()
            .enumerate()
        {
            let measured = plant.step(&mut there, input).unwrap().output;
            if n == 10_000 {
                assert_eq!(learner.estimator.parameters(), offline);
                assert_eq!(learner.estimator.offset(), 0.0);
                learner.estimator.freeze(false);
            }
            let learning = learner.step(input, measured).unwrap();
            assert_eq!(learning.outcome == Outcome::Frozen, n < 10_000);
            if n > 30_000 {
                let range = plant.output_range().1;
                assert!(
                    learning.error.abs() < 0.05 * range,
                    "{method:?}: {}",
                    learning.error
                );
            }
        }
        // Weights are kept by a call, damaged, and taken back.
        let kept = learner.estimator.parameters().to_vec();
        learner.estimator.keep();
        for input in strokes(&mut rng, &unit_plane(k), 200, 40) {
            learner.step(input, 100.0).unwrap();
        }
        assert_ne!(learner.estimator.parameters(), kept);
        learner.estimator.roll_back(&mut learner.model);
        assert_eq!(learner.estimator.parameters(), kept);
        learner.model.rebase(&mut learner.state).unwrap();
        assert!((learner.model.output_range().1 - kept.iter().sum::<f64>()).abs() < 1e-12);
    }
}

/// A plant whose weights are numbers, but twice their sum is none.
#[test]
fn the_models_sum_stays_below_half_the_largest_number() {
    let k = 3;
    let mut rng = rng(90);
    let offline = vec![f64::MAX / 6.0 * 0.4; operator_count(k)];
    let guards = Adaptation {
        gate: 0.0,
        ..options(INCREMENTS)
    };
    let mut learner = Learner::new(unit_plane(k), Operator::Mkp, &offline, guards);
    let (plant, mut there) = build(unit_plane(k), Operator::Mkp, &[1.0; 6]);
    let mut refused = 0;
    for input in strokes(&mut rng, &unit_plane(k), 2000, 10) {
        let share = plant.step(&mut there, input).unwrap().output / 6.0;
        let learning = learner.step(input, 0.8 * f64::MAX * share).unwrap();
        refused += usize::from(learning.outcome == Outcome::RolledBack);
        assert!((2.0 * learner.model.total()).is_finite());
    }
    assert!(refused > 0);
}

/// A power of two changes no digit.
#[test]
fn a_plant_in_another_unit_is_learned_in_the_same_way() {
    let (k, unit) = (4, 2.0_f64.powi(600));
    let mut rng = rng(91);
    let offline = dense(&mut rng, k);
    let (plant, mut there) = build(unit_plane(k), Operator::Mkp, &dense(&mut rng, k));
    let guards = Adaptation {
        gate: 0.0,
        trial: u32::MAX,
        ..options(INCREMENTS)
    };
    let scaled = |weights: &[f64]| weights.iter().map(|w| unit * w).collect::<Vec<_>>();
    let learner = |weights: &[f64]| Learner::new(unit_plane(k), Operator::Mkp, weights, guards);
    let (mut one, mut other) = (learner(&offline), learner(&scaled(&offline)));
    for input in strokes(&mut rng, &unit_plane(k), 500, 20) {
        let measured = plant.step(&mut there, input).unwrap().output;
        let expected = one.step(input, measured).unwrap();
        let found = other.step(input, unit * measured).unwrap();
        assert_eq!(found.outcome, expected.outcome);
        assert_eq!(found.output, unit * expected.output);
    }
    let learned = scaled(one.estimator.parameters());
    assert_eq!(other.estimator.parameters(), learned);
    assert_ne!(learned, scaled(&offline));
}

/// In units in which squares are numbers, the trials are the same too.
#[test]
fn trials_do_not_depend_on_the_unit() {
    let (k, mut taken_back) = (4, 0);
    // A gain near 2 follows wrong readings, so that trials take weights back.
    let method = Method::Increments {
        gain: 1.9,
        span: 1.0,
    };
    for unit in [2.0_f64.powi(300), 2.0_f64.powi(-300)] {
        let mut rng = rng(92);
        let weights = dense(&mut rng, k);
        let (plant, mut there) = build(unit_plane(k), Operator::Mkp, &weights);
        let guards = Adaptation {
            gate: 0.0,
            trial: 8,
            ..options(method)
        };
        let scaled: Vec<f64> = weights.iter().map(|w| unit * w).collect();
        let learner = |weights: &[f64]| Learner::new(unit_plane(k), Operator::Mkp, weights, guards);
        let (mut one, mut other) = (learner(&weights), learner(&scaled));
        for (n, input) in strokes(&mut rng, &unit_plane(k), 10_000, 20)
            .into_iter()
            .enumerate()
        {
            let size = if n % 1000 < 200 { 50.0 } else { 0.1 };
            let noise = size * rng.random_range(-1.0..1.0);
            let measured = plant.step(&mut there, input).unwrap().output + noise;
            let expected = one.step(input, measured).unwrap();
            let found = other.step(input, unit * measured).unwrap();
            assert_eq!(found.outcome, expected.outcome);
            taken_back += usize::from(found.outcome == Outcome::RolledBack);
        }
    }
    assert!(taken_back > 10, "{taken_back}");
}

/// Errors of the size of rounding are no reason to go back.
#[test]
fn rounding_errors_take_nothing_back() {
    let k = 4;
    for method in METHODS {
        let mut rng = rng(93);
        let weights = dense(&mut rng, k);
        let (plant, mut there) = build(unit_plane(k), Operator::Mkp, &weights);
        let guards = Adaptation {
            trial: 2,
            gate: 0.0,
            ..options(method)
        };
        // Nothing is nothing, exactly.
        let zeros = vec![0.0; operator_count(k)];
        let mut learner = Learner::new(unit_plane(k), Operator::Mkp, &zeros, guards);
        for input in strokes(&mut rng, &unit_plane(k), 100, 20) {
            let outcome = learner.step(input, 0.0).unwrap().outcome;
            assert_ne!(outcome, Outcome::RolledBack, "{method:?}");
        }
        let mut learner = Learner::new(unit_plane(k), Operator::Mkp, &weights, guards);
        for input in strokes(&mut rng, &unit_plane(k), 20_000, 20) {
            let output = plant.step(&mut there, input).unwrap().output;
            let measured = output * (1.0 + f64::EPSILON * rng.random_range(-4.0..4.0));
            let outcome = learner.step(input, measured).unwrap().outcome;
            assert_ne!(outcome, Outcome::RolledBack, "{method:?}");
        }
    }
}
