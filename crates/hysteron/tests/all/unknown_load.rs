//! The method `load` on models with stages: the shift is found, and the model written has it.

use hysteron::{
    AdaptOptions, Adapted, AdaptiveLoad, CreepTerm, EstimatorOptions, FirstOrder, Learner, Model,
    Operator, Outcome, Plane, Progress, Recording, Sample, Sign, Start, Surroundings, Target,
    adapt,
};

const DT: f64 = 0.1;

fn plain(low: f64, sign: Sign) -> Model {
    let plane = Plane::new(low, low + 60.0, 20).unwrap();
    Model::new(Operator::Mkp, plane, vec![0.02; 210], 1.0, sign).unwrap()
}

/// A model with every stage but a load, and the same actuator whose axis is shifted by `shift`.
fn staged(shift: f64, spaced: bool, sign: Sign) -> Model {
    let low = if spaced { 20.0 } else { 20.0 + shift };
    let mut model = plain(low, sign);
    if spaced {
        let corner = |k: usize| 10.0 + shift + 0.1 * (k * k) as f64 + 1.5 * k as f64;
        model = model.with_spacing((0..=20).map(corner).collect()).unwrap();
    }
    model.thermal = Some(FirstOrder {
        gain: 80.0,
        tau_heating: 2.0,
        tau_cooling: 3.0,
        ..FirstOrder::default()
    });
    let creep = [CreepTerm {
        coefficient: 0.05,
        tau: 3.0,
    }];
    model.with_after(&creep, 0.2).unwrap()
}

/// Slow triangles of the drive, as a plant answers them.
fn recording(plant: &Model, count: usize) -> Recording {
    let drive = (0..count).map(|n| 1.1 * (1.0 - (2.0 * (n as f64 / 1500.0).fract() - 1.0).abs()));
    let drive: Vec<f64> = drive.collect();
    let time: Vec<f64> = (0..count).map(|n| n as f64 * DT).collect();
    let around = Surroundings {
        time: plant.is_timed().then_some(&time),
        load: None,
        rest: None,
    };
    let output = plant.simulate_in(&drive, around).unwrap();
    let mut recording = Recording::new(drive, output).unwrap();
    recording.time = Some(time);
    recording
}

fn by_load() -> AdaptOptions {
    AdaptOptions {
        learner: Learner::Load,
        ..AdaptOptions::default()
    }
}

fn adapted(model: &Model, recording: &Recording) -> Adapted {
    adapt(model, recording, &by_load(), Progress::NONE).unwrap()
}

#[test]
fn a_shift_is_found_through_body_spacing_creep_and_lag() {
    for sign in [Sign::Positive, Sign::Negative] {
        for spaced in [false, true] {
            let model = staged(0.0, spaced, sign);
            for shift in [-9.0, 6.0, 12.0] {
                let plant = staged(shift, spaced, sign);
                let told = recording(&plant, 6000);
                let adapted = adapted(&model, &told);
                let found = adapted.shift.as_ref().unwrap();
                // A twentieth of a level of 3 K, as in the core.
                assert!(
                    (found.shift - shift).abs() < 0.2,
                    "{spaced} {shift}: {}",
                    found.shift
                );
                assert_eq!(found.shifts.len(), told.len());
                assert!(found.loads.is_none() && found.load.is_none());
                assert!(matches!(adapted.options, EstimatorOptions::Shift(_)));
                let last = adapted.thirds[2];
                assert!(
                    last.adapting.rmse < 0.05 * last.fixed.rmse,
                    "{spaced} {shift}: {last:?}"
                );
                assert!(!adapted.worse);
                // Of the temperatures, and not of the drives.
                assert!(adapted.covered > 0.5, "{}", adapted.covered);
                // What is written is the plant: its levels moved, its stages as they were.
                let range = 0.02 * 210.0;
                assert!(adapted.again.rmse < 0.005 * range, "{:?}", adapted.again);
                assert_eq!(adapted.model.thermal, model.thermal);
                assert_eq!(adapted.model.weights(), model.weights());
            }
        }
    }
}

#[test]
fn a_model_that_fits_stays_as_it_is() {
    let model = staged(0.0, false, Sign::Positive);
    let adapted = adapted(&model, &recording(&model, 3000));
    // No error, no correction: rounding alone is left.
    assert!(adapted.shift.unwrap().shift.abs() < 1e-6);
    assert!(adapted.whole.adapting.rmse < 1e-9);
}

#[test]
fn the_inverse_follows_the_shift() {
    let model = plain(20.0, Sign::Positive);
    let plant = plain(27.0, Sign::Positive);
    let mut adaptive = AdaptiveLoad::new(&model, None, None).unwrap();
    let mut state = plant.start();
    for n in 0..4000 {
        let input = 55.0 - 45.0 * (0.02 * f64::from(n)).cos();
        let measured = plant.step(&mut state, input).unwrap().output;
        adaptive.step(input, measured).unwrap();
    }
    adaptive.align();
    let mut there = plant.start();
    let found = adaptive.solve(Target::new(3.0)).unwrap();
    // From where the plant is.
    there.clone_from(&state);
    let reached = plant.step(&mut there, found.input).unwrap().output;
    // Of a stroke of 4.2: a shift that is off by a tenth of a degree.
    assert!((reached - 3.0).abs() < 0.02, "{reached}");
}

#[test]
fn what_it_cannot_have_is_refused_and_nothing_changes() {
    let model = plain(20.0, Sign::Positive);
    assert!(AdaptiveLoad::new(&model, Some(3.0), None).is_err());
    let zero = Model::new(
        Operator::Mkp,
        *model.plane(),
        vec![0.0; 210],
        0.0,
        Sign::Positive,
    );
    assert!(AdaptiveLoad::new(&zero.unwrap(), None, None).is_err());
    assert!(by_load().adaptive(&model).is_err());
    assert!(AdaptOptions::default().adaptive_load(&model).is_err());
    let gain = AdaptOptions {
        gain: Some(0.3),
        ..by_load()
    };
    assert!(gain.adaptive_load(&model).is_err());

    let rest = AdaptOptions {
        start: Start::Rest,
        ..by_load()
    };
    let told = recording(&staged(0.0, false, Sign::Positive), 200);
    let refused = adapt(&plain(20.0, Sign::Positive), &told, &rest, Progress::NONE);
    assert!(refused.unwrap_err().to_string().contains("no rest"));

    let mut timed = by_load()
        .adaptive_load(&staged(0.0, false, Sign::Positive))
        .unwrap();
    let sample = |dt| Sample { dt, ..0.5.into() };
    let first = timed.step(sample(Some(DT)), 1.0).unwrap();
    assert_eq!(first.outcome, Outcome::AtRest);
    let before = timed.state().clone();
    assert!(timed.step(sample(None), 1.0).is_err());
    assert!(timed.step(sample(Some(DT)), f64::NAN).is_err());
    assert!(timed.step(sample(Some(-1.0)), 1.0).is_err());
    let loaded = Sample {
        load: Some(1.0),
        ..sample(Some(DT))
    };
    assert!(timed.step(loaded, 1.0).is_err());
    assert_eq!(*timed.state(), before);
}
