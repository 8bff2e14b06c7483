//! Feedback beside an inverse: a reading that is late by its filter does not pull the drive away,
//! and without readings the integral stays alone.

use hysteron::control::{Compensator, Controller, Gains, Reading, Reference, Scheme};
use hysteron::{Model, Operator, Plane, Sign};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::iter::zip;

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
        let alone = Scheme {
            compensator: Some(Compensator::fixed(&plant).unwrap()),
            ..Scheme::new(0.01, (0.0, 100.0))
        };
        let with_feedback = Scheme {
            // Where the branch is steep, more would not be stable with a sample of delay.
            pid: Some(Gains {
                gain: 60.0 / range * rng.random_range(0.02..0.2),
                integral_s: 0.0,
                derivative_s: 0.0,
            }),
            filter_s: rng.random_range(0.05..0.2),
            ..alone.clone()
        };
        let (from, rise) = (rng.random_range(0.05..0.2), rng.random_range(0.2..0.8));
        let share = |n: usize| n as f64 / 1500.0;
        let reference = |n: usize| low + range * (from + rise * share(n));
        let drives = |scheme: Scheme| {
            let mut controller = Controller::new(scheme).unwrap();
            let mut state = plant.start();
            let mut output = plant.step(&mut state, 0.0).unwrap().output;
            let mut drive = |n: usize| {
                let target = Reference {
                    output: reference(n),
                    heading: None,
                };
                let reading = Reading {
                    output,
                    input: None,
                };
                let next = [reference(n + 1)];
                let drive = controller.step_ahead(target, &next, reading).unwrap().drive;
                output = plant.step(&mut state, drive).unwrap().output;
                drive
            };
            (0..1500).map(&mut drive).collect::<Vec<f64>>()
        };
        // What is left of the beginning has faded. Compared with the target of now, the feedback
        // would move the drive by its gain times what the target moves in the filter's time, 0.0008
        // at least.
        for (n, (one, other)) in zip(drives(alone), drives(with_feedback)).enumerate() {
            let difference = (one - other).abs();
            assert!(
                n < 1000 || difference < 1e-6,
                "seed {seed}, {n}: {difference}"
            );
        }
    }
}

/// The reading is off by a constant until the sensor ends.
#[test]
fn without_readings_an_inverse_goes_on_with_the_integral_alone() {
    let plane = Plane::new(0.0, 10.0, 5).unwrap();
    let model = Model::new(Operator::Mkp, plane, vec![1.0; 15], 0.0, Sign::Positive).unwrap();
    let gains = Gains {
        gain: 0.1,
        integral_s: 2.0,
        derivative_s: 0.0,
    };
    let alone = Scheme {
        pid: Some(gains),
        ..Scheme::new(0.01, (0.0, 10.0))
    };
    let beside = Scheme {
        compensator: Some(Compensator::fixed(&model).unwrap()),
        ..alone.clone()
    };
    let [alone, beside] = [alone, beside].map(|scheme| {
        let mut controller = Controller::new(scheme).unwrap();
        let target = Reference {
            output: 6.0,
            heading: None,
        };
        let mut drive = |output: f64| {
            let reading = Reading {
                output,
                input: None,
            };
            controller.step(target, reading).unwrap().drive
        };
        let last = (0..100).map(|_| drive(4.0)).last().unwrap();
        let later = (0..2000).map(|_| drive(f64::NAN)).last().unwrap();
        later - last
    });
    assert_eq!(alone, 0.0);
    // The proportional term, 0.1 of an error of 2, but for what e^-10 leaves of it.
    assert!((beside + 0.2).abs() < 1e-4, "{beside}");
}
