//! Speed as ratios within one run: `cargo bench -p hysteron-core`.
#![allow(clippy::unwrap_used)]

#[allow(dead_code, reason = "the tests take the rest")]
#[path = "../tests/common/mod.rs"]
mod common;

mod measure;

use common::{build, rng};
use hysteron_core::{Operator, Target};
use measure::{definition, random_weights, ratio, seconds, smooth, title, unit_plane};
use rand::RngExt;
use std::hint::black_box;

const MILLION: usize = 1_000_000;

/// A walk with steps up to 1/20 of the plane (a grid cell at K = 20), reflected at its ends.
fn walk(count: usize) -> Vec<f64> {
    let mut rng = rng(2);
    let mut t: f64 = 50.0;
    (0..count)
        .map(|_| {
            t += rng.random_range(-3.0..3.0);
            if !(20.0..=80.0).contains(&t) {
                t = if t < 20.0 { 40.0 - t } else { 160.0 - t };
            }
            t
        })
        .collect()
}

/// Seconds per sample of the fast model over an array.
fn forward(levels: usize, input: &[f64]) -> impl FnMut() -> f64 {
    let (model, mut state) = build(unit_plane(levels), Operator::Mkp, &random_weights(levels));
    let mut output = vec![0.0; input.len()];
    move || {
        seconds(input.len(), || {
            model
                .run(&mut state, black_box(input), &mut output)
                .unwrap();
            black_box(&output);
        })
    }
}

/// Seconds per element of `y = a x + b` over the same memory.
fn plain_pass(input: &[f64]) -> impl FnMut() -> f64 {
    let mut output = vec![0.0; input.len()];
    move || {
        seconds(input.len(), || {
            let (a, b) = black_box((1.7, 0.3));
            for (y, x) in output.iter_mut().zip(black_box(input)) {
                *y = a * x + b;
            }
            black_box(&output);
        })
    }
}

/// Seconds per target of the inverse, which moves its state along.
fn inverse(levels: usize, targets: &[f64]) -> impl FnMut() -> f64 {
    let (model, mut state) = build(unit_plane(levels), Operator::Mkp, &random_weights(levels));
    move || {
        let inverse = model.inverse().unwrap();
        seconds(targets.len(), || {
            for &y in targets {
                black_box(inverse.step(&mut state, Target::new(black_box(y))).unwrap());
            }
        })
    }
}

/// Seconds per sample of the forward model called sample by sample.
fn stepping(levels: usize, input: &[f64]) -> impl FnMut() -> f64 {
    let (model, mut state) = build(unit_plane(levels), Operator::Mkp, &random_weights(levels));
    move || {
        seconds(input.len(), || {
            for &t in input {
                black_box(model.step(&mut state, black_box(t)).unwrap());
            }
        })
    }
}

fn outputs(levels: usize, input: &[f64]) -> Vec<f64> {
    let (model, mut state) = build(unit_plane(levels), Operator::Mkp, &random_weights(levels));
    let mut output = vec![0.0; input.len()];
    model.run(&mut state, input, &mut output).unwrap();
    output
}

fn main() {
    let (smooth, walk) = (smooth(MILLION), walk(MILLION));
    title();
    let sizes = [
        (20, "≥ 40", 50_000),
        (100, "≥ 900", 2_000),
        (1000, "≥ 60000", 20),
    ];
    for (kind, input) in [("smooth", &smooth), ("random walk", &walk)] {
        for (levels, aim, samples) in sizes {
            let name = format!("definition / fast, {kind}, K = {levels}");
            let plain = definition(levels, &input[..samples]);
            ratio(&name, aim, plain, forward(levels, input));
        }
    }
    for (kind, input) in [("smooth", &smooth), ("random walk", &walk)] {
        let name = format!("fast K = 1000 / fast K = 20, {kind}");
        ratio(&name, "≤ 1.5", forward(1000, input), forward(20, input));
    }
    for levels in [20, 100] {
        for (kind, aim, input) in [("smooth", "≤ 10", &smooth), ("random walk", "≤ 30", &walk)]
        {
            let name = format!("fast / pass y = a·x + b, 1e6 samples, {kind}, K = {levels}");
            ratio(&name, aim, forward(levels, input), plain_pass(input));
        }
    }
    for levels in [20, 100] {
        for (kind, input) in [("smooth", &smooth), ("random walk", &walk)] {
            let targets = outputs(levels, input);
            let name = format!("inverse / forward step, {kind}, K = {levels}");
            ratio(
                &name,
                "≤ 4",
                inverse(levels, &targets),
                stepping(levels, input),
            );
        }
    }
}
