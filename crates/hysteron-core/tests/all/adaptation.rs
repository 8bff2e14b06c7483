//! Weights that change from sample to sample: the fast paths stay exact.

use crate::common::{
    INCREMENTS, Learner, METHODS, OPERATORS, build, inputs, levels, options, plane, rng, weights,
};
use hysteron_core::{Definition, Method, Operator, Outcome, Status, Target, operator_index};
use rand::{Rng, RngExt};

/// The largest number of levels for a test of this method. Least squares is `O(K⁴)`.
fn most(method: Method<f64>) -> usize {
    match method {
        Method::LeastSquares { .. } => 9,
        _ => 60,
    }
}

fn total(weights: &[f64]) -> f64 {
    weights.iter().sum()
}

/// `Σ μ γ` of the definition's states, with the operators' own outputs.
fn sum(operator: Operator, weights: &[f64], states: &[f64]) -> f64 {
    let each = weights.iter().zip(states);
    each.map(|(mu, gamma)| mu * operator.output(*gamma)).sum()
}

#[test]
fn the_fast_paths_stay_exact_while_weights_change() {
    let (mut forward, mut back) = (0.0_f64, 0.0_f64);
    for seed in 0..120 {
        let mut rng = rng(seed);
        let method = METHODS[seed as usize % METHODS.len()];
        let operator = OPERATORS[seed as usize / 2 % 3];
        let k = levels(&mut rng, most(method));
        let plane = plane(&mut rng, k);
        let offline = weights(&mut rng, k);
        let plant = weights(&mut rng, k);
        let mut learner = Learner::new(plane, operator, &offline, options(method));
        let mut states = vec![0.0; plane.operators()];
        let mut definition = Definition::new(plane, operator, &plant, &mut states).unwrap();
        // For the method on increments: the weights from which each row of the next table was
        // computed.
        let mut making = offline.clone();
        let mut acting = offline.clone();
        let (mut row, mut due) = (1, 0);
        for (n, input) in inputs(&mut rng, &plane, 1500).into_iter().enumerate() {
            let measured = definition.step(input).unwrap() + rng.random_range(-0.1..0.1);
            let offset = learner.estimator.offset();
            let expected = sum(operator, &acting, definition.states()) + offset;
            let size = total(&acting) + offset.abs() + 1e-9;
            let learning = learner.step(input, measured).unwrap();
            // Rounding errors of some thousand terms, as with constant weights.
            let worst = (learning.output - expected).abs() / size;
            assert!(worst <= 1e-12, "seed {seed}, {n}, {method:?}: {worst:e}");
            forward = forward.max(worst);

            let now = learner.estimator.parameters();
            assert!(now.iter().all(|weight| *weight >= 0.0));
            let found = learner.model.output(&learner.state);
            if matches!(method, Method::Increments { .. }) {
                match learning.outcome {
                    Outcome::Learned => due = 2 * k,
                    Outcome::RolledBack | Outcome::OutputStuck | Outcome::InputStuck => {
                        // This method writes the whole table at once.
                        (row, due) = (1, 0);
                        acting.copy_from_slice(now);
                        making.copy_from_slice(now);
                    }
                    _ => {}
                }
                if due > 0 {
                    due -= 1;
                    let j = operator_index(1, row)..operator_index(1, row + 1);
                    making[j.clone()].copy_from_slice(&now[j]);
                    row = row % k + 1;
                    if row == 1 {
                        // The model changes only when the table is complete.
                        acting.copy_from_slice(&making);
                    }
                }
            } else {
                acting.copy_from_slice(now);
            }
            let after = sum(operator, &acting, definition.states());
            assert!((found - after).abs() <= 1e-12 * (total(&acting) + 1e-9));
            if n % 50 == 0 {
                back = back.max(round_trip(&learner, &mut rng));
            }
        }
    }
    println!("adapted model against definition: largest relative difference {forward:.1e}");
    println!("|H(H⁻¹(y)) − y| / range while weights change: largest {back:.1e}");
}

/// `|H(H⁻¹(y)) − y|` for some targets, in ranges of the output.
fn round_trip(learner: &Learner, rng: &mut impl Rng) -> f64 {
    let model = &learner.model;
    let (low, high) = model.output_range();
    if model.operator() == Operator::Relay || high <= low {
        return 0.0; // relays move in jumps
    }
    let mut worst = 0.0_f64;
    for _ in 0..4 {
        let target = rng.random_range(low..=high);
        let mut there = learner.state.clone();
        let inverse = model.inverse().unwrap();
        let solution = inverse.step(&mut there, Target::new(target)).unwrap();
        assert_eq!(solution.status, Status::Ok);
        let mut apart = learner.state.clone();
        let reached = model.step(&mut apart, solution.input).unwrap().output;
        worst = worst.max((reached - target).abs() / (high - low));
    }
    assert!(worst <= 1e-12, "{worst:e}");
    worst
}

#[test]
fn a_lagging_table_comes_to_the_weights() {
    for seed in 0..30 {
        let mut rng = rng(700 + seed);
        let k = levels(&mut rng, 60);
        let plane = plane(&mut rng, k);
        let offline = weights(&mut rng, k);
        let (plant, mut there) = build(plane, Operator::Mkp, &weights(&mut rng, k));
        let mut learner = Learner::new(plane, Operator::Mkp, &offline, options(INCREMENTS));
        let inputs = inputs(&mut rng, &plane, 500);
        for &input in &inputs {
            let measured = plant.step(&mut there, input).unwrap().output;
            learner.step(input, measured).unwrap();
        }
        let last = inputs[499];
        for _ in 0..2 * k {
            learner.step(last, 0.0).unwrap();
        }
        let now = learner.estimator.parameters().to_vec();
        let (fresh, mut state) = build(plane, Operator::Mkp, &now);
        for input in inputs {
            fresh.step(&mut state, input).unwrap();
        }
        let found = learner.model.output(&learner.state);
        assert!((found - fresh.output(&state)).abs() <= 1e-12 * (total(&now) + 1e-9));
        let same = learner.model.clone();
        learner.step(last, 0.0).unwrap();
        assert_eq!(
            learner.model, same,
            "nothing is renewed where nothing was learned"
        );
    }
}

#[test]
fn rebasing_equals_restoring() {
    for seed in 0..200 {
        let mut rng = rng(1300 + seed);
        let k = levels(&mut rng, 60);
        let plane = plane(&mut rng, k);
        let operator = OPERATORS[rng.random_range(0..3)];
        let (mut model, mut state) = build(plane, operator, &weights(&mut rng, k));
        for input in inputs(&mut rng, &plane, 400) {
            model.step(&mut state, input).unwrap();
        }
        model.set_weights(&weights(&mut rng, k)).unwrap();
        assert!(
            model.step(&mut state, 0.0).is_err(),
            "an old state is refused"
        );
        let saved: Vec<f64> = state.turning_points().collect();
        let mut restored = state.clone();
        model.restore(&mut restored, &saved, state.input()).unwrap();
        model.rebase(&mut state).unwrap();
        assert_eq!(state.turning_points().collect::<Vec<_>>(), saved);
        let scale = model.output_range().1.abs() + 1e-9;
        for input in inputs(&mut rng, &plane, 400) {
            let one = model.step(&mut state, input).unwrap().output;
            let other = model.step(&mut restored, input).unwrap().output;
            assert!(
                (one - other).abs() <= 1e-13 * scale,
                "seed {seed}: {one} {other}"
            );
        }
    }
}
