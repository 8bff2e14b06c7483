//! Speed as ratios within one run: `cargo bench -p hysteron-core`.
//!
//! Machines are shared and noisy, so nothing here is a time to quote: both sides of a ratio run in
//! turn, several times, and the median of the ratios is printed with its smallest and largest value.
#![allow(clippy::unwrap_used)]

#[path = "../tests/common/mod.rs"]
mod common;

use common::{build, rng};
use hysteron_core::{Definition, Operator, Plane, Policy, operator_count};
use rand::RngExt;
use std::hint::black_box;
use std::time::Instant;

const ROUNDS: usize = 9;
const MILLION: usize = 1_000_000;

/// Seconds per unit of one call that does `units` of work.
fn seconds(units: usize, mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64() / units as f64
}

/// Times `slow` and `fast` in turn; prints `slow / fast` beside `aim` and the median time of each.
fn ratio(name: &str, aim: &str, mut slow: impl FnMut() -> f64, mut fast: impl FnMut() -> f64) {
    let _warm_up = (slow(), fast());
    let mut pairs: Vec<(f64, f64)> = (0..ROUNDS).map(|_| (slow(), fast())).collect();
    let mut median = |key: fn(&(f64, f64)) -> f64| {
        pairs.sort_by(|a, b| key(a).total_cmp(&key(b)));
        let at = |n: usize| key(&pairs[n]);
        (at(0), at(ROUNDS / 2), at(ROUNDS - 1))
    };
    let (low, middle, high) = median(|p| p.0 / p.1);
    let (slow, fast) = (median(|p| p.0).1, median(|p| p.1).1);
    println!(
        "{name:<58} {middle:>10.2} {:>10} {:>22} {:>10.2} {:>10.2}",
        aim,
        format!("{low:.2} – {high:.2}"),
        slow * 1e9,
        fast * 1e9
    );
}

fn unit_plane(levels: usize) -> Plane<f64> {
    Plane::new(20.0, 80.0, levels).unwrap()
}

fn random_weights(levels: usize) -> Vec<f64> {
    let mut rng = rng(1);
    (0..operator_count(levels)).map(|_| rng.random()).collect()
}

/// A decaying sum of two sines over the plane, 500 samples a cycle.
fn smooth(count: usize) -> Vec<f64> {
    (0..count)
        .map(|n| {
            let phase = n as f64 * std::f64::consts::TAU / 500.0;
            let envelope = 1.0 - 0.8 * (n % 50_000) as f64 / 50_000.0;
            50.0 + 28.0 * envelope * (phase.sin() + 0.3 * (phase * 3.7).sin()) / 1.3
        })
        .collect()
}

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

/// Seconds per sample of the definition.
fn definition(levels: usize, input: &[f64]) -> impl FnMut() -> f64 {
    let weights = random_weights(levels);
    let mut states = vec![0.0; weights.len()];
    move || {
        let mut plain =
            Definition::new(unit_plane(levels), Operator::Mkp, &weights, &mut states).unwrap();
        seconds(input.len(), || {
            for &t in input {
                black_box(plain.step(black_box(t)).unwrap());
            }
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

/// Seconds per target of the inverse, its own state following.
fn inverse(levels: usize, targets: &[f64]) -> impl FnMut() -> f64 {
    let (model, mut state) = build(unit_plane(levels), Operator::Mkp, &random_weights(levels));
    move || {
        let inverse = model.inverse().unwrap();
        seconds(targets.len(), || {
            for &y in targets {
                black_box(
                    inverse
                        .step(&mut state, black_box(y), Policy::HOLD)
                        .unwrap(),
                );
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
    println!(
        "{:<58} {:>10} {:>10} {:>22} {:>10} {:>10}",
        "ratio A / B, medians of 9 pairs", "A / B", "aim", "smallest – largest", "A ns", "B ns"
    );
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
        for (kind, aim, input) in [("smooth", "≤ 16", &smooth), ("random walk", "≤ 40", &walk)]
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
                "≤ 6",
                inverse(levels, &targets),
                stepping(levels, input),
            );
        }
    }
}
