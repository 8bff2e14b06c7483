//! What the inverse of the chain says of a target that it misses, and the drives that it takes.

use crate::common::stages::Constants;
use crate::common::{OPERATORS, build, inputs, levels, plane, rng, weights};
use hysteron_core::{
    Body, Direction, Error, Operator, Plane, Sample, StageState, Stages, Status, Target, Wanted,
};
use rand::RngExt;

const BODY: Body<f64> = Body {
    ambient: 20.0,
    gain: 2.0,
    tau_heating: 0.5,
    tau_cooling: 3.0,
};

/// High and low are told from limited by the outputs at rest, with the target's tolerance.
#[test]
fn a_missed_target_is_beyond_the_outputs_at_rest_or_limited() {
    let mut seen = [0; 3];
    for seed in 0..400 {
        let mut rng = rng(6000 + seed);
        let operator = OPERATORS[seed as usize % 2];
        let k = levels(&mut rng, 12);
        let plane = plane(&mut rng, k);
        let (model, state) = build(plane, operator, &weights(&mut rng, k));
        let owned = Constants::random(&mut rng, &plane).map(|v| v);
        let (stages, inverse) = (owned.stages(), model.inverse().unwrap());
        let (off, on) = model.output_range();
        // At an end of the plane, and held there.
        let load = Some(rng.random_range(-4.0..8.0));
        let loaded = stages.axis.load.at(load).unwrap();
        let (end, held) = match rng.random() {
            true => (plane.max() + plane.step(), on),
            false => (plane.bottom() - plane.step(), off),
        };
        let end = stages.axis.backward(&plane, loaded, Direction::Rising, end);
        let input = owned.body().map_or(end, |body| body.hold(end));
        let (mut state, mut memory) = (state, StageState::default());
        let sample = Sample {
            input,
            dt: Some(1.0),
            load,
        };
        stages
            .step(&model, &mut state, &mut memory, sample)
            .unwrap();
        let settled = |sum: f64| stages.behind.settled(loaded.gain * sum);
        let (low, high) = (settled(off), settled(on));
        for _ in 0..20 {
            let tolerance = 0.01 * (high - low) * rng.random::<f64>();
            // Within the tolerance beyond an end, beyond that too, or anywhere within.
            let past = [0.5, 1.5, 40.0][rng.random_range(0..3)] * tolerance;
            let (sum, expected) = match rng.random_range(0..3) {
                0 => (high + past, if past > tolerance { 1 } else { 0 }),
                1 => (low - past, if past > tolerance { -1 } else { 0 }),
                _ => (low + rng.random_range(0.3..0.7) * (high - low), 0),
            };
            let sign = if owned.falling { -1.0 } else { 1.0 };
            let output = owned.offset + loaded.offset + sign * sum;
            let wanted = Wanted {
                dt: Some(0.1),
                load,
                drive: (input, input),
                ..Target::new(output).tolerance(tolerance).into()
            };
            let found = stages
                .invert(&inverse, &mut state.clone(), &mut memory.clone(), wanted)
                .unwrap();
            // The sum at that end is met.
            if found.status == Status::Ok {
                assert!(
                    (sum - settled(held)).abs() <= 2.0 * tolerance + 1e-9,
                    "{seed}"
                );
                continue;
            }
            let expected = match expected * sign as i32 {
                1 => Status::High,
                -1 => Status::Low,
                _ => Status::Limited,
            };
            // Rounding of the ends decides where there is no tolerance.
            if tolerance > 1e-9 * high.abs() {
                assert_eq!(found.status, expected, "{seed}: {sum} of {off} to {on}");
                seen[usize::from(expected == Status::High)
                    + 2 * usize::from(expected == Status::Low)] += 1;
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 100), "{seen:?}");
}

/// Without stages the chain is the operators' inverse, to the last bit and with its status.
#[test]
fn without_stages_it_is_the_inverse_of_the_operators() {
    let mut passed = 0;
    for seed in 0..200 {
        let mut rng = rng(6500 + seed);
        let operator = OPERATORS[seed as usize % 3];
        let k = levels(&mut rng, 12);
        let plane = plane(&mut rng, k);
        let (model, mut state) = build(plane, operator, &weights(&mut rng, k));
        let (inverse, mut memory) = (model.inverse().unwrap(), StageState::default());
        let (off, on) = model.output_range();
        for input in inputs(&mut rng, &plane, 40) {
            let target = Target::new(rng.random_range(off..=on + 1e-9));
            let expected = inverse.solve(&state, target).unwrap();
            let found = Stages::NONE
                .invert(&inverse, &mut state, &mut memory, target.into())
                .unwrap();
            assert_eq!(found.input, expected.input, "{seed}");
            if expected.status == Status::Passed {
                assert_eq!(found.status, Status::Passed, "{seed}");
                passed += 1;
            }
            if rng.random() {
                model.step(&mut state, input).unwrap();
            }
        }
    }
    assert!(passed > 500, "{passed}");
}

#[test]
fn a_horizon_is_the_time_in_which_the_temperature_is_reached() {
    let plane = Plane::new(30.0, 90.0, 6).unwrap();
    let (model, state) = build(plane, Operator::Mkp, &[1.0; 21]);
    let (inverse, mut rng) = (model.inverse().unwrap(), rng(1));
    let stages = Stages {
        body: Some(BODY),
        ..Stages::NONE
    };
    let (mut start, mut memory) = (state, StageState::default());
    let sample = Sample {
        input: 10.0,
        dt: Some(1.0),
        load: None,
    };
    stages
        .step(&model, &mut start, &mut memory, sample)
        .unwrap();
    for _ in 0..200 {
        let (dt, horizon) = (rng.random_range(0.01..1.0), rng.random_range(0.01..3.0));
        let target = Target::new(rng.random_range(0.0..21.0));
        let drive = |dt: f64, horizon: f64| {
            let wanted = Wanted {
                dt: Some(dt),
                horizon,
                ..target.into()
            };
            let found = stages.invert(&inverse, &mut start.clone(), &mut memory.clone(), wanted);
            found.unwrap().input
        };
        assert_eq!(drive(dt, horizon), drive(dt.max(horizon), 0.0));
    }
}

/// A drive that is a number, but whose temperature is none.
#[test]
fn a_drive_beyond_all_temperatures_is_refused() {
    let plane = Plane::new(30.0, 90.0, 2).unwrap();
    let (model, mut state) = build(plane, Operator::Mkp, &[1.0; 3]);
    let stages = Stages {
        body: Some(BODY),
        ..Stages::NONE
    };
    let mut memory = StageState::default();
    let sample = Sample {
        input: 1.5e308,
        dt: Some(1.0),
        load: None,
    };
    for _ in 0..2 {
        let before = (state.clone(), memory);
        let refused = stages.step(&model, &mut state, &mut memory, sample);
        assert_eq!(refused, Err(Error::InputNotFinite { index: 0 }));
        assert_eq!((&state, memory), (&before.0, before.1));
        let fine = Sample {
            input: 10.0,
            ..sample
        };
        stages.step(&model, &mut state, &mut memory, fine).unwrap();
    }
}
