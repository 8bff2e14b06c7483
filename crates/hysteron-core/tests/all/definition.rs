//! The fast forward model against the definition, on random and adversarial input.

use crate::common;

use common::{OPERATORS, build, inputs, levels, nested, plane, rng, weights};
use hysteron_core::{Definition, Operator, Plane, Region, operator_index};
use rand::RngExt;

/// Largest difference between fast and plain outputs, relative to the sum of the weights.
fn worst(plane: Plane<f64>, operator: Operator, weights: &[f64], inputs: &[f64]) -> f64 {
    let (model, mut state) = build(plane, operator, weights);
    let mut states = vec![0.0; plane.operators()];
    let mut plain = Definition::new(plane, operator, weights, &mut states).unwrap();
    let scale: f64 = weights.iter().sum();
    let mut worst = 0.0_f64;
    for &input in inputs {
        let fast = model.step(&mut state, input).unwrap().output;
        worst = worst.max((fast - plain.step(input).unwrap()).abs() / scale);
        assert!(
            state.corners() <= 2 * plane.levels(),
            "memory above its bound"
        );
    }
    // Compares the state and the region of every operator too.
    let k = plane.levels();
    for j in 1..=k {
        for i in 1..=j {
            let expected = plain.states()[operator_index(i, j)];
            let found = state.gamma(i, j).unwrap();
            assert!(
                (found - expected).abs() <= 1e-12 * k as f64,
                "operator ({i}, {j})"
            );
            if found == expected {
                let region = match expected {
                    0.0 => Region::Min,
                    1.0 => Region::Max,
                    _ => Region::Boundary,
                };
                assert_eq!(state.region(i, j).unwrap(), region);
            }
        }
    }
    worst
}

#[test]
fn a_thousand_random_models_and_sequences() {
    let mut overall = 0.0_f64;
    for seed in 0..1000 {
        let mut rng = rng(seed);
        let k = levels(&mut rng, 200);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        // About the same work for every K, but enough samples to fill the memory.
        let count = (2_000_000 / (k * k)).clamp(4 * k, 4000);
        let inputs = inputs(&mut rng, &plane, count);
        let operator = OPERATORS[rng.random_range(0..3)];
        let worst = worst(plane, operator, &weights, &inputs);
        // Rounding errors of sums of up to 20 100 terms stay below 1e-13. An error of the method
        // does not.
        assert!(
            worst <= 1e-12,
            "seed {seed}, K = {k}, {operator:?}: {worst:e}"
        );
        overall = overall.max(worst);
    }
    println!(
        "fast against definition, 1000 models, K = 2 to 200: largest relative difference {overall:.1e}"
    );
}

#[test]
fn ten_thousand_oscillations_nested_in_one_cell() {
    let mut overall = 0.0_f64;
    for (seed, k) in [2, 3, 5, 10, 20, 40].into_iter().enumerate() {
        let mut rng = rng(77 + seed as u64);
        let plane = Plane::new(0.0, (k - 1) as f64, k).unwrap();
        let weights = weights(&mut rng, k);
        let mut inputs = inputs(&mut rng, &plane, 50);
        let mut deep = Vec::new();
        nested(&mut rng, k, 10_000, &mut deep);
        inputs.extend(deep.iter().map(|x| x - 1.0));
        // Out of the cell again, slowly, over every remaining turning point.
        let last = inputs.last().copied().unwrap_or(0.0);
        inputs.extend((0..500).map(|n| last + (k as f64 - last) * f64::from(n) / 500.0));
        overall = overall.max(worst(plane, Operator::Mkp, &weights, &inputs));
    }
    assert!(overall <= 1e-12, "{overall:e}");
    println!("10,000 oscillations nested in one cell: largest relative difference {overall:.1e}");
}

#[test]
fn single_precision() {
    let mut overall = 0.0_f64;
    for seed in 0..300 {
        let mut rng = rng(5000 + seed);
        let k = levels(&mut rng, 200);
        // A plane whose levels are exact in both precisions, so that both see the same input.
        let plane = Plane::new(0.0, (k - 1) as f64, k).unwrap();
        let weights: Vec<f64> = weights(&mut rng, k)
            .iter()
            .map(|&w| f64::from(w as f32))
            .collect();
        let inputs: Vec<f32> = inputs(&mut rng, &plane, 2000)
            .iter()
            .map(|&t| t as f32)
            .collect();
        let (model, mut state) = common::build_f32(&plane, Operator::Mkp, &weights);
        let (exact, mut exact_state) = build(plane, Operator::Mkp, &weights);
        let scale: f64 = weights.iter().sum();
        for &input in &inputs {
            let single = f64::from(model.step(&mut state, input).unwrap().output);
            let double = exact
                .step(&mut exact_state, f64::from(input))
                .unwrap()
                .output;
            overall = overall.max((single - double).abs() / scale);
        }
    }
    assert!(overall <= 1e-5, "{overall:e}");
    println!("f32 against f64, 300 models: largest relative difference {overall:.1e}");
}

#[test]
fn arrays_equal_steps() {
    let mut rng = rng(9);
    for operator in OPERATORS {
        let k = levels(&mut rng, 60);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let inputs = inputs(&mut rng, &plane, 3000);
        let (model, mut state) = build(plane, operator, &weights);
        let mut outputs = vec![0.0; inputs.len()];
        let clipped = model.run(&mut state, &inputs, &mut outputs).unwrap();
        let (_, mut one) = build(plane, operator, &weights);
        let mut count = 0;
        for (input, output) in inputs.iter().zip(&outputs) {
            let step = model.step(&mut one, *input).unwrap();
            assert_eq!(step.output.to_bits(), output.to_bits());
            count += usize::from(step.clipped.is_some());
        }
        assert_eq!(count, clipped.low + clipped.high);
        assert_eq!(state, one);
    }
}

#[test]
fn saved_and_restored_states_go_on_bit_for_bit() {
    for seed in 0..200 {
        let mut rng = rng(300 + seed);
        let k = levels(&mut rng, 60);
        let plane = plane(&mut rng, k);
        let operator = OPERATORS[rng.random_range(0..3)];
        let weights = weights(&mut rng, k);
        let inputs = inputs(&mut rng, &plane, 600);
        let (model, mut state) = build(plane, operator, &weights);
        if seed % 2 == 0 {
            model.reset_on(&mut state).unwrap();
        }
        let (before, after) = inputs.split_at(rng.random_range(0..600));
        for &input in before {
            model.step(&mut state, input).unwrap();
        }
        let saved: Vec<f64> = state.turning_points().collect();
        // The last point is the present position. Two points make a corner.
        let held = saved.len() - 1;
        assert_eq!((state.held(), state.corners()), (held, held / 2));
        let (_, mut restored) = build(plane, operator, &weights);
        model.restore(&mut restored, &saved, state.input()).unwrap();
        for &input in after {
            let one = model.step(&mut state, input).unwrap().output;
            let other = model.step(&mut restored, input).unwrap().output;
            assert_eq!(one.to_bits(), other.to_bits(), "seed {seed}");
        }
    }
}
