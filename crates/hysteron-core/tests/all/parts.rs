//! Weights that depend on the load: placed at a load, a model is that of the sum of its parts.

use crate::common::{build, dense, inputs, levels, plane, rng, weights};
use hysteron_core::{Error, MAX_PARTS, Operator, Parts, bernstein};
use rand::RngExt;

/// `n! / (k! (n − k)!) sᵏ (1 − s)ⁿ⁻ᵏ`.
fn polynomial(n: usize, k: usize, s: f64) -> f64 {
    let binomial = (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64);
    binomial * s.powi(k as i32) * (1.0 - s).powi((n - k) as i32)
}

#[test]
fn the_polynomials_are_those_of_the_formula() {
    for seed in 0..200 {
        let mut rng = rng(seed);
        let (count, s) = (rng.random_range(1..=MAX_PARTS), rng.random_range(0.0..1.0));
        let mut values = vec![7.0; count];
        bernstein(s, &mut values);
        for (k, value) in values.iter().enumerate() {
            let expected = polynomial(count - 1, k, s);
            // Some ten roundings each.
            assert!((value - expected).abs() < 1e-14, "{count} {k} {s}");
        }
    }
    bernstein(0.5, &mut [0.0_f64; 0]);
}

/// Two states on one model, placed at loads that rest, jump and leave the range.
#[test]
fn a_placed_model_is_that_of_the_sum_for_every_state() {
    for seed in 0..60 {
        let mut rng = rng(1000 + seed);
        let k = levels(&mut rng, 20);
        let plane = plane(&mut rng, k);
        let operator = [Operator::Mkp, Operator::Kp, Operator::Relay][seed as usize % 3];
        let count = rng.random_range(1..=MAX_PARTS);
        let each: Vec<Vec<f64>> = (0..count).map(|_| weights(&mut rng, k)).collect();
        let tables: Vec<f64> = each
            .iter()
            .flat_map(|part| build(plane, operator, part).0.table().to_vec())
            .collect();
        let offsets: Vec<f64> = (0..count).map(|_| rng.random_range(-2.0..2.0)).collect();
        let parts = Parts {
            range: (-50.0, 150.0),
            offsets: &offsets,
            tables: &tables,
        };
        let (mut model, state, ..) = build(plane, operator, &each[0]);
        parts.check(&model).unwrap();
        let mut states = [state.clone(), state];
        let (mut placed, mut load) = (None, 0.0);
        for input in inputs(&mut rng, &plane, 60) {
            let state = &mut states[rng.random_range(0..2)];
            if rng.random_range(0..3) == 0 {
                load = rng.random_range(-80.0..180.0_f64);
            }
            let offset = parts
                .place(&mut model, state, &mut placed, Some(load))
                .unwrap();
            let output = model.step(state, input).unwrap().output;
            let s = ((load + 50.0) / 200.0).clamp(0.0, 1.0);
            let factor = |part: usize| polynomial(count - 1, part, s);
            let sum: Vec<f64> = (0..each[0].len())
                .map(|n| (0..count).map(|part| factor(part) * each[part][n]).sum())
                .collect();
            let expected: f64 = (0..count).map(|part| factor(part) * offsets[part]).sum();
            assert!((offset - expected).abs() < 1e-13);
            let other = build(plane, operator, &sum);
            let mut copy = other.1.clone();
            let turns: Vec<f64> = state.turning_points().collect();
            other.0.restore(&mut copy, &turns, state.input()).unwrap();
            // Sums of up to K(K + 1)/2 weights, in another order.
            let size = 1.0 + sum.iter().sum::<f64>();
            assert!((output - other.0.output(&copy)).abs() < 1e-12 * size);
        }
    }
}

/// Whoever changes the weights in between is noticed.
#[test]
fn changed_weights_are_mixed_anew() {
    let mut rng = rng(7);
    let plane = plane(&mut rng, 4);
    let (one, two) = (dense(&mut rng, 4), dense(&mut rng, 4));
    let tables = [&one, &two].map(|part| build(plane, Operator::Mkp, part).0.table().to_vec());
    let parts = Parts {
        range: (0.0, 1.0),
        offsets: &[0.0, 1.0],
        tables: &tables.concat(),
    };
    let (mut model, mut state, ..) = build(plane, Operator::Mkp, &one);
    let mut placed = None;
    parts
        .place(&mut model, &mut state, &mut placed, Some(0.3))
        .unwrap();
    let mixed = model.table().to_vec();
    model.set_weights(&one).unwrap();
    assert_ne!(model.table(), mixed);
    parts
        .place(&mut model, &mut state, &mut placed, Some(0.3))
        .unwrap();
    assert_eq!(model.table(), mixed);
    model.step(&mut state, plane.max()).unwrap();
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let mut rng = rng(8);
    let plane = plane(&mut rng, 4);
    let mu = weights(&mut rng, 4);
    let (mut model, mut state, ..) = build(plane, Operator::Mkp, &mu);
    let table = model.table().to_vec();
    let tables = [table.clone(), table.clone()].concat();
    let good = Parts {
        range: (0.0, 1.0),
        offsets: &[0.0, 1.0],
        tables: &tables,
    };
    let mut holed = tables.clone();
    holed[3] = f64::NAN;
    let many = table.repeat(MAX_PARTS + 1);
    let stage = |stage| Err(Error::Stage { stage });
    for (parts, expected) in [
        (
            Parts {
                range: (1.0, 1.0),
                ..good
            },
            stage("load"),
        ),
        (
            Parts {
                range: (0.0, f64::NAN),
                ..good
            },
            stage("load"),
        ),
        (
            Parts {
                range: (f64::MIN, f64::MAX),
                ..good
            },
            stage("load"),
        ),
        (
            Parts {
                offsets: &[],
                tables: &[],
                ..good
            },
            stage("parts"),
        ),
        (
            Parts {
                offsets: &[0.0],
                ..good
            },
            stage("parts"),
        ),
        (
            Parts {
                offsets: &[0.0, f64::NAN],
                ..good
            },
            stage("parts"),
        ),
        (
            Parts {
                tables: &holed,
                ..good
            },
            stage("parts"),
        ),
        (
            Parts {
                offsets: &[0.0; MAX_PARTS + 1],
                tables: &many,
                ..good
            },
            stage("parts"),
        ),
        (good, Ok(())),
    ] {
        assert_eq!(parts.check(&model), expected);
    }
    let mut placed = None;
    for load in [None, Some(f64::NAN), Some(f64::INFINITY)] {
        let refused = good.place(&mut model, &mut state, &mut placed, load);
        assert_eq!(refused, Err(Error::Load));
    }
    let mut other = build(plane, Operator::Kp, &mu).1;
    let refused = good.place(&mut model, &mut other, &mut placed, Some(0.5));
    assert_eq!(refused, Err(Error::StateMismatch));
    assert_eq!((model.table(), placed), (table.as_slice(), None));
    model.step(&mut state, plane.max()).unwrap();
}
