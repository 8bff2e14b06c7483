//! The offset. The method on increments learns it apart from the weights.

use crate::common::{
    INCREMENTS, Learner, METHODS, OPERATORS, build, dense, options, rng, strokes, unit_plane,
};
use hysteron_core::{Adaptation, Estimator, Method, Operator, Outcome, estimator_len};
use rand::RngExt;

#[test]
fn a_level_that_learning_made_worse_is_taken_back_and_said() {
    for operator in OPERATORS {
        let mut rng = rng(70);
        // Increments are longer than the plane, so none ends and only the offset is learned. A gain
        // near 2 follows noise so closely that the mean square error is about ten times that of a
        // constant offset.
        let method = Method::Increments {
            gain: 1.9,
            span: 8.0,
        };
        let guards = Adaptation {
            offset_share: 10.0,
            trial: 50,
            ..options(method)
        };
        let mut learner = Learner::new(unit_plane(2), operator, &[1.0, 2.0, 4.0], guards);
        let (mut moved, mut taken_back) = (0, 0);
        for n in 0..1000 {
            let input = if n % 2 == 0 { 10.0 } else { 80.0 };
            let (model, mut there) = (&learner.model, learner.state.clone());
            let output = model.step(&mut there, input).unwrap().output;
            let noise = rng.random_range(-1.0..1.0);
            let learning = learner.step(input, output + noise).unwrap();
            if learning.outcome == Outcome::RolledBack {
                taken_back += 1;
                assert_eq!(learner.estimator.offset(), 0.0, "sample {n}");
            }
            moved += usize::from(learner.estimator.offset() != 0.0);
        }
        // Each trial ends with a roll-back. The first sample only starts the learning.
        assert_eq!(taken_back, (1000 - 1) / 50, "{operator:?}");
        assert!(moved > 900, "{moved}");
    }
}

#[test]
fn weights_that_are_taken_back_leave_the_level() {
    let k = 3;
    let mut rng = rng(71);
    let weights = dense(&mut rng, k);
    // A gain near 2 follows noise, so that the weights get worse. The offset follows slowly.
    let method = Method::Increments {
        gain: 1.9,
        span: 1.0,
    };
    let guards = Adaptation {
        offset_share: 0.01,
        trial: 20,
        gate: 0.0,
        ..options(method)
    };
    let mut learner = Learner::new(unit_plane(k), Operator::Mkp, &weights, guards);
    let (plant, mut there) = build(unit_plane(k), Operator::Mkp, &weights);
    let mut taken_back = 0;
    for input in strokes(&mut rng, &unit_plane(k), 20_000, 10) {
        let noise = rng.random_range(-0.1..0.1);
        let measured = plant.step(&mut there, input).unwrap().output + 50.0 + noise;
        let before = learner.estimator.offset();
        let outcome = learner.step(input, measured).unwrap().outcome;
        taken_back += usize::from(outcome == Outcome::RolledBack);
        let change = learner.estimator.offset() - before;
        // Far from the plant's offset it only grows.
        assert!((0.0..1.0).contains(&change), "{outcome:?}: {change}");
    }
    assert!(taken_back > 3, "{taken_back}");
    assert!(learner.estimator.offset() < 45.0);
}

/// The off-line offset is in all predictions, those of a trial too.
#[test]
fn a_constant_in_readings_and_offset_changes_nothing() {
    let k = 4;
    for method in METHODS {
        let mut rng = rng(72);
        let offline = dense(&mut rng, k);
        let guards = Adaptation {
            trial: 100,
            ..options(method)
        };
        let mut plain = Learner::new(unit_plane(k), Operator::Mkp, &offline, guards);
        let mut raised = Learner::new(unit_plane(k), Operator::Mkp, &offline, guards);
        let memory = vec![0.0; estimator_len(k, method)];
        let raise = 1000.0;
        raised.estimator =
            Estimator::new(guards, &mut raised.model, &offline, raise, memory).unwrap();
        let (plant, mut there) = build(unit_plane(k), Operator::Mkp, &dense(&mut rng, k));
        for input in strokes(&mut rng, &unit_plane(k), 20_000, 40) {
            let noise = rng.random_range(-0.001..0.001);
            let measured = plant.step(&mut there, input).unwrap().output + noise;
            let one = plain.step(input, measured).unwrap();
            let other = raised.step(input, raise + measured).unwrap();
            assert_eq!(one.outcome, other.outcome, "{method:?}");
            // The rounding of a reading of 1000, over the samples that are remembered.
            assert!((one.error - other.error).abs() < 1e-9, "{method:?}");
        }
        plain.estimator.roll_back(&mut plain.model);
        raised.estimator.roll_back(&mut raised.model);
        let good = plain.estimator.parameters();
        for (one, other) in good.iter().zip(raised.estimator.parameters()) {
            assert!((one - other).abs() < 1e-9, "{method:?}");
        }
        assert_ne!(
            good, offline,
            "{method:?}: others have become the good ones"
        );
    }
}

/// Where the next offset would be no number, the present one stays.
#[test]
fn the_level_stays_a_number() {
    let method = Method::Increments {
        gain: 1.9,
        span: 8.0,
    };
    let guards = Adaptation {
        offset_share: 2.0,
        trial: u32::MAX,
        gate: 0.0,
        ..options(method)
    };
    for sign in [1.0, -1.0] {
        let mut learner = Learner::new(unit_plane(2), Operator::Mkp, &[1.0; 3], guards);
        for n in 0..2000_u32 {
            let measured = sign * f64::MAX * (f64::from(n) / 1000.0).min(1.0);
            let input = [30.0, 70.0][n as usize % 2];
            learner.step(input, measured).unwrap();
            assert!(learner.estimator.offset().is_finite(), "{n}");
        }
        assert!(sign * learner.estimator.offset() > 0.9 * f64::MAX);
    }
    // A share that is nearly nothing moves the offset by nearly nothing.
    let guards = Adaptation {
        offset_share: 1e-200,
        ..options(INCREMENTS)
    };
    let mut learner = Learner::new(unit_plane(2), Operator::Mkp, &[1.0; 3], guards);
    learner.step(30.0, 1.0).unwrap();
    assert_eq!(learner.estimator.offset(), 0.0);
}
