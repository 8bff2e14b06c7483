//! A controller that is told the reference ahead: the drive starts early enough.

use hysteron::control::{Compensator, Controller, Reading, Reference, Scheme};
use hysteron::{AdaptOptions, FirstOrder, Model, Operator, Plane, Sample, Sign};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const DT: f64 = 0.1;

fn uniform(rng: &mut ChaCha8Rng) -> f64 {
    f64::from(rng.next_u32()) / f64::from(u32::MAX)
}

/// A wire between 40 and 80 degrees that cools slowly. Its output rises or falls.
fn wire(rng: &mut ChaCha8Rng) -> Model {
    let weights = (0..55).map(|_| 0.01 + 0.02 * uniform(rng)).collect();
    let plane = Plane::new(40.0, 80.0, 10).unwrap();
    let sign = if uniform(rng) < 0.5 {
        Sign::Positive
    } else {
        Sign::Negative
    };
    let mut model = Model::new(Operator::Mkp, plane, weights, 1.0, sign).unwrap();
    model.thermal = Some(FirstOrder {
        ambient: 20.0,
        gain: 90.0,
        tau_heating: 1.0 + uniform(rng),
        tau_cooling: 2.0 + 2.0 * uniform(rng),
    });
    model
}

fn controller(compensator: Compensator) -> Controller {
    let scheme = Scheme {
        compensator: Some(compensator),
        ..Scheme::new(DT, (0.0, 1.0))
    };
    Controller::new(scheme).unwrap()
}

/// Rests and jumps within the range.
fn reference(rng: &mut ChaCha8Rng, model: &Model) -> Vec<f64> {
    let (off, on) = model.output_range();
    let mut reference = Vec::new();
    while reference.len() < 400 {
        let level = off + (0.1 + 0.8 * uniform(rng)) * (on - off);
        let samples = 20 + (40.0 * uniform(rng)) as usize;
        reference.extend(std::iter::repeat_n(level, samples));
    }
    reference
}

/// RMS error in shares of the range, and the drives. The plant is the model itself.
fn follow(model: &Model, reference: &[f64], ahead: usize) -> (f64, Vec<f64>) {
    follow_by(Compensator::fixed(model).unwrap(), model, reference, ahead)
}

fn follow_by(
    compensator: Compensator,
    model: &Model,
    reference: &[f64],
    ahead: usize,
) -> (f64, Vec<f64>) {
    let (mut controller, mut plant) = (controller(compensator), model.start());
    let (mut output, mut squares, mut drives) = (model.output_range().0, 0.0, Vec::new());
    for (n, &target) in reference.iter().enumerate() {
        let next: Vec<f64> = reference[n + 1..].iter().take(ahead).copied().collect();
        let now = Reference {
            output: target,
            heading: None,
        };
        let reading = Reading {
            output,
            input: None,
        };
        let action = match ahead {
            0 => controller.step(now, reading).unwrap(),
            _ => controller.step_ahead(now, &next, reading).unwrap(),
        };
        let sample = Sample {
            input: action.drive,
            dt: Some(DT),
            load: None,
        };
        output = model.step(&mut plant, sample).unwrap().output;
        squares += (output - target).powi(2);
        drives.push(action.drive);
    }
    let (off, on) = model.output_range();
    let rms = (squares / reference.len() as f64).sqrt() / (on - off).abs();
    (rms, drives)
}

#[test]
fn whoever_sees_ahead_errs_less_and_stays_within_the_drives() {
    let (mut blind, mut seeing) = (0.0, 0.0);
    for seed in 0..20 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let model = wire(&mut rng);
        let reference = reference(&mut rng, &model);
        let without = follow(&model, &reference, 0);
        let with = follow(&model, &reference, 40);
        assert!(
            with.0 < without.0,
            "{seed}: {} against {}",
            with.0,
            without.0
        );
        let inside = |drive: &f64| (0.0..=1.0).contains(drive);
        assert!(without.1.iter().chain(&with.1).all(inside), "{seed}");
        (blind, seeing) = (blind + without.0, seeing + with.0);
    }
    // No more than a tenth of the range is given up before a jump, so not all of the lag is won.
    assert!(seeing < 0.9 * blind, "{seeing} against {blind}");
}

#[test]
fn a_model_that_learns_sees_ahead_too() {
    let (mut blind, mut seeing) = (0.0, 0.0);
    for seed in 0..10 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let model = wire(&mut rng);
        let reference = reference(&mut rng, &model);
        let [without, with] = [0, 40].map(|ahead| {
            let learner = AdaptOptions::default().adaptive(&model).unwrap();
            follow_by(Compensator::adaptive(learner), &model, &reference, ahead).0
        });
        (blind, seeing) = (blind + without, seeing + with);
    }
    assert!(seeing < 0.9 * blind, "{seeing} against {blind}");
}

#[test]
fn a_reference_that_rests_needs_no_preview() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let model = wire(&mut rng);
    let (off, on) = model.output_range();
    let rest = vec![0.4 * off + 0.6 * on; 60];
    assert_eq!(follow(&model, &rest, 0), follow(&model, &rest, 25));
}

#[test]
fn a_target_ahead_that_is_no_number_changes_nothing() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let model = wire(&mut rng);
    let (mut one, mut other) = (
        controller(Compensator::fixed(&model).unwrap()),
        controller(Compensator::fixed(&model).unwrap()),
    );
    let reading = Reading {
        output: 1.0,
        input: None,
    };
    let now = Reference {
        output: 1.2,
        heading: None,
    };
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(one.step_ahead(now, &[1.2, bad], reading).is_err());
    }
    for _ in 0..20 {
        let (a, b) = (
            one.step(now, reading).unwrap(),
            other.step(now, reading).unwrap(),
        );
        assert_eq!(a.drive.to_bits(), b.drive.to_bits());
    }
}
