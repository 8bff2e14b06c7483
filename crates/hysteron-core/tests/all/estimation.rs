//! Estimators find known plants and known solutions, and recover from wrong readings.

use crate::common;

use common::{
    INCREMENTS, LEAST_SQUARES, Learner, build, dense, options, rng, start_covariance, strokes,
    unit_plane, weights,
};
use hysteron_core::{
    Adaptation, Estimator, Method, Operator, Outcome, estimator_len_of_basis, operator_count,
    operators,
};
use rand::{Rng, RngExt};

/// Solves `A x = b` by elimination with pivots.
fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let best = (k..n).max_by(|&p, &q| a[p][k].abs().total_cmp(&a[q][k].abs()));
        a.swap(k, best.unwrap());
        b.swap(k, best.unwrap());
        let (pivot, pivot_b) = (a[k].clone(), b[k]);
        for (row, b) in a.iter_mut().zip(&mut b).skip(k + 1) {
            let share = row[k] / pivot[k];
            row.iter_mut()
                .zip(&pivot)
                .for_each(|(x, p)| *x -= share * p);
            *b -= share * pivot_b;
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|c| a[k][c] * b[c]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}

#[test]
fn least_squares_without_forgetting_is_the_batch_solution() {
    const K: usize = 4;
    let (n, noise, spread) = (operator_count(K), 0.1, 0.7);
    for correlation in [0.0, 1.5] {
        let mut rng = rng(11);
        // Weights are far from zero, so that the projection has no effect.
        let offline: Vec<f64> = (0..n).map(|_| rng.random_range(4.0..6.0)).collect();
        let plant: Vec<f64> = (0..n).map(|_| rng.random_range(4.0..6.0)).collect();
        let (plant, mut there) = build(unit_plane(K), Operator::Mkp, &plant);
        let method = Method::LeastSquares {
            forgetting: 1.0,
            noise,
            spread,
            correlation,
        };
        let guards = Adaptation {
            trial: u32::MAX,
            ..options(method)
        };
        let mut learner = Learner::new(unit_plane(K), Operator::Mkp, &offline, guards);
        // (Σ φφᵀ/r + P₀⁻¹) (θ − θ₀) = Σ φ (y − φᵀθ₀)/r
        let places: Vec<_> = operators(K).collect();
        let start = start_covariance(K, spread, correlation);
        let unit = |k: usize| (0..=n).map(|a| f64::from(a == k)).collect();
        let mut normal: Vec<Vec<f64>> = (0..=n).map(|k| solved(start.clone(), unit(k))).collect();
        let mut right = vec![0.0; n + 1];
        let mut learned = 0;
        for input in strokes(&mut rng, &unit_plane(K), 3000, 25) {
            let clean = plant.step(&mut there, input).unwrap().output;
            let measured = clean + rng.random_range(-0.2..0.2);
            if learner.step(input, measured).unwrap().outcome != Outcome::Learned {
                continue;
            }
            learned += 1;
            let mut phi: Vec<f64> = places
                .iter()
                .map(|&(i, j)| learner.state.gamma(i, j).unwrap())
                .collect();
            phi.push(1.0);
            let known: f64 = phi.iter().zip(&offline).map(|(phi, mu)| phi * mu).sum();
            for a in 0..=n {
                for b in 0..=n {
                    normal[a][b] += phi[a] * phi[b] / (noise * noise);
                }
                right[a] += phi[a] * (measured - known) / (noise * noise);
            }
        }
        assert!(learned > 1000);
        let batch = solved(normal, right);
        for (k, found) in learner.estimator.parameters().iter().enumerate() {
            // Rounding error times the condition number of the normal equations, about 1e4.
            assert!((found - offline[k] - batch[k]).abs() < 1e-9, "weight {k}");
        }
        assert!((learner.estimator.offset() - batch[n]).abs() < 1e-9);
    }
}

/// Root mean square error of a learner while it learns from a plant, as a fraction of the output's
/// range.
fn error(
    learner: &mut Learner,
    plant: &mut common::Owned<f64>,
    rng: &mut impl Rng,
    (count, noise): (usize, f64),
) -> f64 {
    let plane = *learner.model.plane();
    let mut squares = 0.0;
    for input in strokes(rng, &plane, count, 40) {
        let clean = plant.0.step(&mut plant.1, input).unwrap().output;
        let measured = clean + noise * rng.random_range(-1.0..1.0);
        squares += (learner.step(input, measured).unwrap().output - clean).powi(2);
    }
    let (low, high) = plant.0.output_range();
    (squares / count as f64).sqrt() / (high - low)
}

#[test]
fn known_plants_are_found() {
    let increments = Method::Increments {
        gain: 1.0,
        span: 0.5,
    };
    let cases = [
        (increments, 10, 1e-6),
        (INCREMENTS, 20, 0.001),
        (LEAST_SQUARES, 10, 0.001),
    ];
    for (method, k, bound) in cases {
        for operator in [Operator::Mkp, Operator::Kp] {
            let mut rng = rng(12);
            let offline = vec![0.5; operator_count(k)];
            let plant: Vec<f64> = offline.iter().map(|_| rng.random()).collect();
            let mut there = build(unit_plane(k), operator, &plant);
            let mut learner = Learner::new(unit_plane(k), operator, &offline, options(method));
            learner.estimator.freeze(true);
            let first = error(&mut learner, &mut there, &mut rng, (4000, 0.0));
            learner.estimator.freeze(false);
            error(&mut learner, &mut there, &mut rng, (400_000, 0.0));
            let last = error(&mut learner, &mut there, &mut rng, (4000, 0.0));
            println!("{method:?}, {operator:?}, K = {k}: error {first:.5} at first, {last:.6}");
            assert!(
                last < bound && last < first / 20.0,
                "{method:?}: {first} {last}"
            );
        }
    }
}

#[test]
fn least_squares_finds_the_weights_themselves() {
    const K: usize = 6;
    let mut rng = rng(13);
    let plant = dense(&mut rng, K);
    let mut there = build(unit_plane(K), Operator::Mkp, &plant);
    let method = Method::LeastSquares {
        forgetting: 0.999,
        noise: 0.001,
        spread: 1.0,
        correlation: 0.0,
    };
    let offline = [0.5; operator_count(K)];
    let mut learner = Learner::new(unit_plane(K), Operator::Mkp, &offline, options(method));
    error(&mut learner, &mut there, &mut rng, (60_000, 0.0));
    for (found, known) in learner.estimator.parameters().iter().zip(&plant) {
        assert!((found - known).abs() < 1e-3, "{found} {known}");
    }
    assert!(learner.estimator.offset().abs() < 1e-3);
}

/// Weights at zero, a plant on another plane and no forgetting. Setting negative weights to zero
/// must not act on the estimate: its error grew without bound when it did.
#[test]
fn weights_held_at_zero_do_not_pile_up() {
    for forgetting in [0.9999, 1.0] {
        let mut rng = rng(17);
        // A narrow ridge on a finer plane, away from the ridge that the learner starts from.
        let ridge = |levels: usize, middle: f64, j: usize, i: usize| {
            let at = |n: usize| n as f64 / levels as f64 - middle;
            (-200.0 * (at(j).powi(2) + (at(i) + 0.2).powi(2))).exp()
        };
        let weights = |levels: usize, middle: f64| -> Vec<f64> {
            let ridges = operators(levels).map(|(i, j)| ridge(levels, middle, j, i));
            let mut weights: Vec<f64> = ridges.collect();
            let total: f64 = weights.iter().sum();
            weights.iter_mut().for_each(|weight| *weight /= total);
            weights
        };
        let method = Method::LeastSquares {
            forgetting,
            noise: 0.003,
            spread: 0.01,
            correlation: 3.0,
        };
        let guards = Adaptation {
            trial: u32::MAX,
            ..options(method)
        };
        let mut there = build(unit_plane(37), Operator::Mkp, &weights(37, 0.7));
        let offline = weights(12, 0.5);
        let mut learner = Learner::new(unit_plane(12), Operator::Mkp, &offline, guards);
        learner.estimator.freeze(true);
        let fixed = error(&mut learner, &mut there, &mut rng, (4000, 0.0));
        learner.estimator.freeze(false);
        for _ in 0..10 {
            let adapted = error(&mut learner, &mut there, &mut rng, (4000, 0.003));
            assert!(adapted < 0.3 * fixed, "{forgetting}: {adapted} of {fixed}");
        }
    }
}

#[test]
fn coefficients_of_a_basis_are_found() {
    const K: usize = 20;
    let n = operator_count(K);
    let method = Method::LeastSquares {
        forgetting: 0.99,
        noise: 0.1,
        spread: 1.0,
        correlation: 0.0,
    };
    for operator in common::OPERATORS {
        let mut rng = rng(14);
        let basis: Vec<f64> = (0..3).flat_map(|_| weights(&mut rng, K)).collect();
        let scale = basis.chunks(n).map(|member| member.iter().sum::<f64>());
        // Each member has the total 1, as the members for loads have.
        let totals: Vec<f64> = scale.collect();
        let basis: Vec<f64> = (0..3 * n).map(|k| basis[k] / totals[k / n]).collect();
        let known = [0.5, 2.0, 0.0];
        let plant: Vec<f64> = (0..n)
            .map(|k| (0..3).map(|m| known[m] * basis[m * n + k]).sum())
            .collect();
        let (plant, mut there) = build(unit_plane(K), operator, &plant);
        let start = [1.0, 1.0, 1.0];
        let guards = Adaptation {
            offset_share: 0.1,
            ..options(method)
        };
        let (mut model, mut state) = build(unit_plane(K), operator, &vec![1.0; n]);
        let memory = vec![0.0; estimator_len_of_basis(K, method, 3)];
        let mut estimator =
            Estimator::of_basis(guards, &mut model, &basis, &start, 0.0, memory).unwrap();
        for input in strokes(&mut rng, &unit_plane(K), 200_000, 40) {
            let measured = plant.step(&mut there, input).unwrap().output;
            estimator
                .step(&mut model, &mut state, input, measured)
                .unwrap();
        }
        for (found, known) in estimator.parameters().iter().zip(known) {
            assert!(
                (found - known).abs() < 1e-4,
                "{operator:?}: {found} {known}"
            );
        }
    }
}

/// The effect of a burst of wrong readings on a learner: its error before and after, and the number
/// of roll-backs.
fn burst(method: Method<f64>, trial: u32) -> (f64, f64, u32) {
    const K: usize = 20;
    let mut rng = rng(15);
    let weights = weights(&mut rng, K);
    let mut there = build(unit_plane(K), Operator::Mkp, &weights);
    let guards = Adaptation {
        trial,
        ..options(method)
    };
    let mut learner = Learner::new(unit_plane(K), Operator::Mkp, &weights, guards);
    let before = error(&mut learner, &mut there, &mut rng, (100_000, 0.05));
    // The sensor has the wrong sign for less than half a trial.
    let mut wrong = 0;
    let mut rolled_back = 0;
    let inputs = strokes(&mut rng, &unit_plane(K), 60_000, 40);
    let mut squares = 0.0;
    for (n, &input) in inputs.iter().enumerate() {
        let clean = there.0.step(&mut there.1, input).unwrap().output;
        let sign = if wrong < 100 { -1.0 } else { 1.0 };
        let measured = sign * clean + 0.05 * rng.random_range(-1.0..1.0);
        let learning = learner.step(input, measured).unwrap();
        wrong += u32::from(learning.outcome == Outcome::Learned);
        rolled_back += u32::from(learning.outcome == Outcome::RolledBack);
        if n >= inputs.len() / 2 {
            squares += (learning.output - clean).powi(2);
        }
    }
    let range = there.0.output_range();
    let after = (squares * 2.0 / inputs.len() as f64).sqrt() / (range.1 - range.0);
    (before, after, rolled_back)
}

#[test]
fn a_burst_of_wrong_readings_is_rolled_back() {
    let (before, after, rolled_back) = burst(INCREMENTS, 256);
    assert_eq!(rolled_back, 1);
    assert!(after < 1.2 * before, "{before} {after}");
    // Without a return to the last good weights the damage stays.
    let (_, alone, none) = burst(INCREMENTS, u32::MAX);
    assert_eq!(none, 0);
    assert!(alone > 2.0 * after, "{alone} {after}");
}
