//! What the benchmarks share: ratios within one run.
//!
//! Machines are shared and noisy, so nothing here is a time to quote: both sides of a ratio run in
//! turn, several times, and the median of the ratios is printed with its smallest and largest
//! value.
#![allow(clippy::unwrap_used, dead_code)]

use crate::common::rng;
use hysteron_core::{Definition, Operator, Plane, operator_count};
use rand::RngExt;
use std::hint::black_box;
use std::time::Instant;

const ROUNDS: usize = 9;
/// Seconds per unit of one call that does `units` of work.
pub fn seconds(units: usize, mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64() / units as f64
}

/// Prints the names of the columns.
pub fn title() {
    println!(
        "{:<58} {:>10} {:>10} {:>22} {:>10} {:>10}",
        "ratio A / B, medians of 9 pairs", "A / B", "aim", "smallest – largest", "A ns", "B ns"
    );
}

/// Times `slow` and `fast` in turn; prints `slow / fast` beside `aim` and the median time of each.
pub fn ratio(name: &str, aim: &str, mut slow: impl FnMut() -> f64, mut fast: impl FnMut() -> f64) {
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

pub fn unit_plane(levels: usize) -> Plane<f64> {
    Plane::new(20.0, 80.0, levels).unwrap()
}

pub fn random_weights(levels: usize) -> Vec<f64> {
    let mut rng = rng(1);
    (0..operator_count(levels)).map(|_| rng.random()).collect()
}

/// A decaying sum of two sines over the plane, 500 samples a cycle.
pub fn smooth(count: usize) -> Vec<f64> {
    (0..count)
        .map(|n| {
            let phase = n as f64 * std::f64::consts::TAU / 500.0;
            let envelope = 1.0 - 0.8 * (n % 50_000) as f64 / 50_000.0;
            50.0 + 28.0 * envelope * (phase.sin() + 0.3 * (phase * 3.7).sin()) / 1.3
        })
        .collect()
}

/// Seconds per sample of the definition.
pub fn definition(levels: usize, input: &[f64]) -> impl FnMut() -> f64 {
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
