//! Random models, and the calls that are hardest on a turning-point memory.

use super::reference::Call;
use hysteron::{Model, Operator, Plane, Sign};
use hysteron_core::operator_count;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

pub const OPERATORS: [Operator; 3] = [Operator::Mkp, Operator::Kp, Operator::Relay];

pub fn rng(seed: u64) -> StdRng {
    StdRng::seed_from_u64(seed)
}

/// A model of any kind: weights dense, mostly zero, one only, of very different size, or of either
/// sign.
pub fn model(rng: &mut StdRng, operator: Operator, levels: usize) -> Model {
    let n = operator_count(levels);
    let only = rng.random_range(0..n);
    let kind = rng.random_range(0..6);
    let weights: Vec<f64> = (0..n)
        .map(|k| match kind {
            0 if rng.random_bool(0.9) => 0.0,
            1 => f64::from(u8::from(k == only)),
            2 => 10f64.powf(rng.random_range(-9.0..3.0)),
            3 => rng.random_range(-1.0..1.0),
            // Many outputs that are exactly equal.
            4 => f64::from(rng.random_range(0..3_u8)),
            _ => rng.random(),
        })
        .collect();
    let (min, width) = match rng.random_range(0..3) {
        0 => (20.0, 60.0),
        1 => (0.0, (levels - 1) as f64),
        _ => (
            rng.random_range(-100.0..100.0),
            rng.random_range(0.1..200.0),
        ),
    };
    let plane = Plane::new(min, min + width, levels).unwrap();
    let offset = if rng.random() {
        0.0
    } else {
        rng.random_range(-5.0..5.0)
    };
    let sign = if rng.random() {
        Sign::Positive
    } else {
        Sign::Negative
    };
    Model::new(operator, plane, weights, offset, sign).unwrap()
}

/// About `count` calls, forward and inverse mixed, with saves and restores between.
pub fn calls(rng: &mut StdRng, model: &Model, count: usize) -> Vec<Call> {
    let mut calls = Vec::new();
    let mut x = 0.0;
    while calls.len() < count {
        let burst = rng.random_range(1..=40);
        match rng.random_range(0..10) {
            0..=4 => {
                let inputs = inputs(rng, model, &mut x, burst);
                calls.extend(inputs.into_iter().map(Call::Step));
            }
            5..=7 => calls.extend(targets(rng, model, burst)),
            8 => calls.extend([Call::Save, Call::Restore]),
            _ => calls.extend([odd(rng, model), Call::Save]),
        }
    }
    calls
}

fn inputs(rng: &mut StdRng, model: &Model, x: &mut f64, burst: usize) -> Vec<f64> {
    let plane = model.plane();
    let k = plane.levels();
    let span = k as f64;
    let input = |x: f64| plane.min() + (x - 1.0) * plane.step();
    let mut out = Vec::new();
    match rng.random_range(0..8) {
        0 => (0..burst).for_each(|_| {
            *x = (*x + rng.random_range(-1.0..1.0)).clamp(-1.0, span + 1.0);
            out.push(input(*x));
        }),
        // The levels as the plane computes them, exactly.
        1 => (0..burst).for_each(|_| out.push(plane.level(rng.random_range(0..=k)))),
        2 => out.extend([input(*x); 5]),
        3 => {
            *x = rng.random_range(-0.2..1.2) * span;
            out.push(input(*x));
        }
        4 => {
            // An oscillation that narrows.
            let (a, b) = (rng.random::<f64>() * span, rng.random::<f64>() * span);
            let middle = 0.5 * (a + b);
            for n in 0..2 * burst {
                let way = if n % 2 == 0 { a - middle } else { b - middle };
                out.push(input(middle + way * 0.9f64.powi(n as i32)));
            }
        }
        5 => staircase(k, &mut out, input),
        _ => nested(rng, k, 4 * burst, &mut out, input),
    }
    out
}

/// A corner in each cell that a staircase crosses, then one jump over all of them.
fn staircase(k: usize, out: &mut Vec<f64>, input: impl Fn(f64) -> f64) {
    for n in 0..k {
        for part in [0.9, 0.7] {
            let (high, low) = (k as f64 - n as f64 - 1.0 + part, n as f64 + 1.0 - part);
            if low < high {
                out.extend([input(high), input(low)]);
            }
        }
    }
    out.push(input(k as f64));
}

/// Oscillations with every maximum in one row and every minimum in one column of the grid.
fn nested(rng: &mut StdRng, k: usize, deep: usize, out: &mut Vec<f64>, input: impl Fn(f64) -> f64) {
    let p = rng.random_range(0..k);
    let q = rng.random_range(0..=p);
    let to_high: f64 = rng.random();
    let to_low = if p == q { to_high } else { rng.random() };
    let (mut high, mut low) = (1.0, 0.0);
    for _ in 0..deep {
        if rng.random_bool(0.02) {
            (high, low) = (1.0, 0.0);
        }
        high = to_high + (high - to_high) * rng.random_range(0.9..1.0);
        low += (to_low - low) * rng.random_range(0.0..0.1);
        out.extend([input(p as f64 + high), input(q as f64 + low)]);
    }
}

fn targets(rng: &mut StdRng, model: &Model, burst: usize) -> Vec<Call> {
    let (a, b) = model.output_range();
    let (low, high) = (a.min(b), a.max(b));
    let range = high - low;
    let tolerance = match rng.random_range(0..4) {
        0 => rng.random::<f64>() * 0.1 * range,
        1 => [f64::NAN, f64::INFINITY, -1.0, -0.0][rng.random_range(0..4)],
        _ => 0.0,
    };
    let anticipates: bool = rng.random();
    let mut last = low + rng.random::<f64>() * range;
    let kind = rng.random_range(0..4);
    (0..burst)
        .map(|n| {
            let target = match kind {
                0 => low + rng.random_range(-0.2..1.2) * range,
                1 => last + rng.random_range(-0.05..0.05) * range,
                2 => [low, high, last, 0.5 * (low + high)][n % 4],
                _ => last,
            };
            let heading = if anticipates {
                rng.random_range(-1..=1)
            } else {
                0
            };
            last = target;
            Call::Inverse(target, heading, tolerance)
        })
        .collect()
}

/// What is refused, and resets.
fn odd(rng: &mut StdRng, model: &Model) -> Call {
    let k = model.plane().levels() as f64;
    let not = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][rng.random_range(0..3)];
    match rng.random_range(0..8) {
        0 => Call::Off,
        1 => Call::On,
        2 => Call::Step(not),
        3 => Call::Inverse(not, 0, 0.0),
        4 => Call::Inverse(0.5, 7, 0.0),
        5 => Call::RestoreGiven(1.0, vec![k, 0.25, 0.5, not]),
        6 => Call::RestoreGiven(not, vec![k, 0.25]),
        _ => {
            // Nested points of any depth within the first cells, −0 among them.
            let depth = rng.random_range(0..12);
            let (mut low, mut high) = (0.0, k);
            let points = (0..depth).map(|n| {
                let at = rng.random::<f64>() * 0.5;
                if n % 2 == 0 {
                    high -= at * (high - low);
                    high
                } else {
                    low += at * (high - low) * f64::from(u8::from(n > 1));
                    if low == 0.0 { -0.0 } else { low }
                }
            });
            let points = points.collect();
            Call::RestoreGiven(model.plane().min(), points)
        }
    }
}
