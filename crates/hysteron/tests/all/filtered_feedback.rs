//! Feedback beside an inverse: a reading that is late by its filter does not pull the drive away.

use hysteron::control::{Compensator, Controller, Gains, Reading, Reference, Scheme};
use hysteron::{Model, Operator, Plane, Sign};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The plant is the model, and answers a sample later. Where the inverse is exact, there is nothing
/// for the feedback to do, whatever its filter and gains are.
#[test]
fn what_an_exact_inverse_does_is_left_alone() {
    for seed in 0..60 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let levels: usize = rng.random_range(3..15);
        let weights = (0..levels * (levels + 1) / 2).map(|_| rng.random_range(0.1..1.0));
        let plane = Plane::new(20.0, 80.0, levels).unwrap();
        let plant = Model::new(Operator::Mkp, plane, weights.collect(), 0.0, Sign::Positive);
        let plant = plant.unwrap();
        let (low, high) = plant.output_range();
        let range = high - low;
        let mut controller = Controller::new(Scheme {
            compensator: Some(Compensator::fixed(&plant).unwrap()),
            pid: Some(Gains {
                gain: 60.0 / range * rng.random_range(0.1..1.0),
                integral_s: rng.random_range(0.05..1.0),
                derivative_s: 0.0,
            }),
            filter_s: rng.random_range(0.0..0.2),
            ..Scheme::new(0.01, (0.0, 100.0))
        })
        .unwrap();
        let (swing, turn) = (rng.random_range(0.2..0.45), rng.random_range(0.005..0.05));
        let wanted = |n: usize| low + range * (0.5 - swing * (turn * n as f64).cos());
        // It waits where the reference begins, until filter and plant are there.
        let reference = |n: usize| wanted(n.saturating_sub(100));
        let mut state = plant.start();
        let mut output = plant.step(&mut state, 0.0).unwrap().output;
        for n in 0..1500 {
            let target = Reference {
                output: reference(n),
                heading: None,
            };
            let reading = Reading {
                output,
                input: None,
            };
            let action = controller
                .step_ahead(target, &[reference(n + 1)], reading)
                .unwrap();
            output = plant.step(&mut state, action.drive).unwrap().output;
            let error = (output - reference(n + 1)).abs() / range;
            // What is left of the beginning fades with the slower of filter and integral.
            assert!(n < 1000 || error < 1e-3, "seed {seed}, {n}: {error}");
        }
    }
}
