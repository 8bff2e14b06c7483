//! What is good: parameters that predicted well, and an estimator that returns to them.

use crate::common::{
    Learner, METHODS, OPERATORS, build, dense, inputs, options, plane, rng, strokes, unit_plane,
    weights,
};
use hysteron_core::{Adaptation, Method, Operator, Outcome, operator_count};
use rand::RngExt;

/// Errors, trials and scales of before are forgotten, and so is an increment under way. The state
/// comes to the same position on the same branch by another way.
#[test]
fn rolled_back_and_realigned_it_goes_on_as_a_new_one() {
    for seed in 0..90 {
        let mut rng = rng(3000 + seed);
        let method = METHODS[seed as usize % METHODS.len()];
        let operator = OPERATORS[seed as usize / 2 % 3];
        let k = rng.random_range(4..9);
        let plane = plane(&mut rng, k);
        let offline = weights(&mut rng, k);
        let guards = Adaptation {
            trial: u32::MAX,
            gate: 0.0,
            ..options(method)
        };
        let new = || Learner::new(plane, operator, &offline, guards);
        let (mut learner, mut fresh) = (new(), new());
        let range = learner.model.output_range().1 + 1.0;
        let steep = |rng: &mut rand::rngs::StdRng| range * rng.random_range(-100.0..100.0);
        for input in inputs(&mut rng, &plane, 300) {
            let measured = steep(&mut rng);
            learner.step(input, measured).unwrap();
        }
        // The ends of these branches differ only where the third branch from the last one began.
        let at = |share: f64| plane.bottom() + share * (plane.max() - plane.bottom());
        for share in [1.0, 0.1, 0.7, 0.3, 0.5] {
            learner.step(at(share), steep(&mut rng)).unwrap();
        }
        for share in [0.8, 0.1, 0.7, 0.3, 0.5] {
            fresh.model.step(&mut fresh.state, at(share)).unwrap();
        }
        learner.estimator.roll_back(&mut learner.model);
        learner.state = fresh.state.clone();
        learner.model.rebase(&mut learner.state).unwrap();
        learner.estimator.realign();
        for input in inputs(&mut rng, &plane, 300) {
            let measured = range * 10f64.powf(rng.random_range(-3.0..1.0));
            let expected = fresh.step(input, measured).unwrap();
            assert_eq!(learner.step(input, measured).unwrap(), expected, "{seed}");
        }
        let found = learner.estimator.parameters();
        assert_eq!(found, fresh.estimator.parameters());
        assert!(learner.estimator.offset() != 0.0 && found != offline);
    }
}

#[test]
fn parameters_that_predict_better_become_the_good_ones() {
    let k = 5;
    for method in METHODS {
        let mut rng = rng(3100);
        let (plant, mut there) = build(unit_plane(k), Operator::Mkp, &dense(&mut rng, k));
        let offline = vec![0.5; operator_count(k)];
        let guards = Adaptation {
            trial: 64,
            ..options(method)
        };
        let mut learner = Learner::new(unit_plane(k), Operator::Mkp, &offline, guards);
        let mut error = |learner: &mut Learner| {
            let mut squares = 0.0;
            for input in strokes(&mut rng, &unit_plane(k), 20_000, 40) {
                let measured = plant.step(&mut there, input).unwrap().output;
                squares += learner.step(input, measured).unwrap().error.powi(2);
            }
            squares
        };
        learner.estimator.freeze(true);
        let at_first = error(&mut learner);
        learner.estimator.freeze(false);
        error(&mut learner);
        learner.estimator.roll_back(&mut learner.model);
        learner.estimator.freeze(true);
        let good = error(&mut learner);
        assert!(good < 0.1 * at_first, "{method:?}: {good} {at_first}");
    }
}

#[test]
fn at_rest_is_where_the_input_did_not_move() {
    for seed in 0..90 {
        let mut rng = rng(3200 + seed);
        let method = METHODS[seed as usize % METHODS.len()];
        let k = 2 + seed as usize % 7;
        let plane = unit_plane(k);
        let guards = Adaptation {
            movement: [0.0, 0.05, 0.4][seed as usize / 2 % 3],
            trial: u32::MAX,
            gate: 0.0,
            ..options(method)
        };
        let mut learner = Learner::new(plane, Operator::Kp, &weights(&mut rng, k), guards);
        // An estimator begins where the state is.
        let (mut learned, mut waited, mut rested) = (plane.bottom(), 0, 0);
        let start = [plane.bottom(); 2];
        for input in start.into_iter().chain(inputs(&mut rng, &plane, 1000)) {
            let seen = input.clamp(plane.bottom(), plane.max());
            let moved = (seen - learned).abs() > guards.movement * plane.step();
            learned = if moved { seen } else { learned };
            match learner.step(input, rng.random()).unwrap().outcome {
                Outcome::AtRest => {
                    assert!(!moved, "{seed}");
                    rested += 1;
                }
                Outcome::Waiting => {
                    assert!(moved, "{seed}");
                    waited += 1;
                }
                // An increment may end where the input crept there.
                outcome => {
                    assert_eq!(outcome, Outcome::Learned);
                    assert!(
                        moved || matches!(method, Method::Increments { .. }),
                        "{seed}"
                    );
                }
            }
        }
        assert!(rested > 50, "{seed}: {rested}");
        let waits = matches!(method, Method::Increments { .. });
        assert_eq!(waited > 50, waits, "{seed}: {waited}");
    }
}
