//! The cost of a sample that is learned from: `cargo bench -p hysteron-core --bench adaptation`.
#![allow(clippy::unwrap_used)]

#[allow(dead_code, reason = "the tests take the rest")]
#[path = "../tests/common/mod.rs"]
mod common;
mod measure;

use common::{INCREMENTS, LEAST_SQUARES, Learner, build, options, rng, weights};
use hysteron_core::{
    Adaptation, Estimator, Method, Operator, estimator_len_of_basis, operator_count,
};
use measure::{definition, random_weights, ratio, seconds, smooth, title, unit_plane};
use std::hint::black_box;

const MEMBERS: usize = 6;

/// Options with which every sample is learned from, however little the input moved.
fn always(method: Method<f64>) -> Adaptation<f64> {
    Adaptation {
        movement: 0.0,
        ..options(method)
    }
}

/// Outputs to learn from. No model fits them, so that no error becomes zero.
fn measured(levels: usize, input: &[f64]) -> Vec<f64> {
    let (plant, mut state) = build(unit_plane(levels), Operator::Mkp, &random_weights(levels));
    let outputs = input.iter().enumerate().map(|(n, &t)| {
        let output = plant.step(&mut state, t).unwrap().output;
        output * if n % 2 == 0 { 1.01 } else { 0.99 }
    });
    outputs.collect()
}

/// Seconds per sample of a method over all weights.
fn learning(method: Method<f64>, levels: usize, input: &[f64]) -> impl FnMut() -> f64 {
    let (offline, measured) = (random_weights(levels), measured(levels, input));
    let mut learner = Learner::new(unit_plane(levels), Operator::Mkp, &offline, always(method));
    move || {
        seconds(input.len(), || {
            for (&t, &y) in input.iter().zip(&measured) {
                black_box(learner.step(black_box(t), y).unwrap());
            }
        })
    }
}

/// Seconds per sample of a method over the coefficients of a basis.
fn learning_coefficients(method: Method<f64>, levels: usize, input: &[f64]) -> impl FnMut() -> f64 {
    let (offline, measured) = (random_weights(levels), measured(levels, input));
    let (mut model, mut state) = build(unit_plane(levels), Operator::Mkp, &offline);
    let mut rng = rng(3);
    let basis: Vec<f64> = (0..MEMBERS)
        .flat_map(|_| weights(&mut rng, levels))
        .collect();
    let memory = vec![0.0; estimator_len_of_basis(levels, method, MEMBERS)];
    let coefficients = [1.0 / MEMBERS as f64; MEMBERS];
    let options = always(method);
    let mut estimator =
        Estimator::of_basis(options, &mut model, &basis, &coefficients, 0.0, memory).unwrap();
    move || {
        seconds(input.len(), || {
            for (&t, &y) in input.iter().zip(&measured) {
                let learning = estimator.step(&mut model, &mut state, black_box(t), y);
                black_box(learning.unwrap());
            }
        })
    }
}

fn main() {
    let smooth = smooth(100_000);
    let coefficients = Method::LeastSquares {
        forgetting: 0.99,
        noise: 0.01,
        spread: 1.0,
        correlation: 0.0,
    };
    title();
    for levels in [10, 20, 40, 100] {
        let operators = operator_count(levels);
        let input = &smooth[..10_000_000 / operators / operators.max(100)];
        let against = |name: &str, work: &mut dyn FnMut() -> f64| {
            let name = format!("{name} / definition, K = {levels}");
            ratio(&name, "", work, definition(levels, &smooth[..2000]));
        };
        against(
            "increments",
            &mut learning(INCREMENTS, levels, &smooth[..20_000]),
        );
        if levels <= 40 {
            against("least squares", &mut learning(LEAST_SQUARES, levels, input));
        }
        against(
            "least squares, 6 coefficients",
            &mut learning_coefficients(coefficients, levels, &smooth[..5000]),
        );
    }
}
