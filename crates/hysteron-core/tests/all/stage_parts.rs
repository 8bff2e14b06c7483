//! Parts of the chain of stages that callers use alone, and what is saved of them.

use crate::common::stages::Constants;
use crate::common::{build, plane, rng, weights};
use hysteron_core::{
    Behind, Body, Creep, Error, Lag, Operator, RATE_NUMBERS, Ring, STATE_NUMBERS, Sample,
    StageState, Stages,
};
use rand::RngExt;

const BODY: Body<f64> = Body {
    ambient: 20.0,
    gain: 2.0,
    tau_heating: 0.5,
    tau_cooling: 3.0,
};

#[test]
fn stages_behind_alone_are_those_of_the_chain() {
    for seed in 0..200 {
        let mut rng = rng(seed);
        let k = rng.random_range(2..9);
        let plane = plane(&mut rng, k);
        let (model, mut state) = build(plane, Operator::Kp, &weights(&mut rng, k));
        let mut constants = Constants::random(&mut rng, &plane);
        constants.loads.clear();
        let owned = constants.map(|v| v);
        let stages = owned.stages();
        let (mut memory, mut past, mut undone) = (StageState::default(), None, None);
        let size = model.total() + constants.offset.abs();
        for _ in 0..100 {
            let dt = rng.random_range(0.01..3.0);
            let input = rng.random_range(-1.0..2.0);
            let sample = Sample {
                input,
                dt: Some(dt),
                load: None,
            };
            let y = stages
                .step(&model, &mut state, &mut memory, sample)
                .unwrap()
                .output;
            let sum = model.output(&state);
            let h = constants.offset + if constants.falling { -sum } else { sum };
            let (after, next) = stages.after(past, dt, h);
            past = Some(next);
            // Sums of a few terms.
            assert!((after - y).abs() < 1e-13 * size, "{seed}: {after} {y}");
            let lags = next
                .to_numbers()
                .into_iter()
                .zip(memory.to_numbers())
                .skip(2);
            for (alone, chain) in lags {
                assert!(
                    (alone - chain).abs() < 1e-13 * size,
                    "{seed}: {alone} {chain}"
                );
            }
            let (back, next) = stages.undo_after(undone, dt, y);
            undone = Some(next);
            // A lag lets a hundredth of the change through, or more. A ring may let far less
            // through.
            let fine = constants.ring.is_some();
            assert!(
                fine || (back - h).abs() < 1e-10 * size,
                "{seed}: {back} {h}"
            );
        }
    }
}

#[test]
fn rates_are_exponentials() {
    let stages = Stages {
        body: Some(BODY),
        behind: Behind {
            creep: Creep {
                coefficients: &[0.1, 0.2],
                taus: &[0.7, 5.0],
            },
            lag: Lag { tau: 0.3 },
            ..Behind::NONE
        },
        ..Stages::NONE
    };
    let dt = 0.4_f64;
    let of = |tau: f64| (-dt / tau).exp();
    let numbers = stages.rates(dt).to_numbers();
    assert_eq!(
        numbers,
        [
            of(0.5),
            of(3.0),
            of(0.7),
            of(5.0),
            0.0,
            0.0,
            of(0.3),
            0.0,
            0.0,
            0.0
        ]
    );
    assert_eq!(
        Stages::<f64>::NONE.rates(dt).to_numbers(),
        [0.0; RATE_NUMBERS]
    );
}

#[test]
fn states_are_saved_as_numbers() {
    let stages = Stages {
        body: Some(BODY),
        behind: Behind {
            creep: Creep {
                coefficients: &[0.1; 4],
                taus: &[0.7, 5.0, 9.0, 20.0],
            },
            lag: Lag { tau: 0.3 },
            ring: Ring {
                frequency: 0.4,
                damping: 0.1,
            },
            ..Behind::NONE
        },
        ..Stages::NONE
    };
    let mut rng = rng(1);
    let plane = plane(&mut rng, 4);
    let (model, mut state) = build(plane, Operator::Kp, &[1.0; 10]);
    let mut memory = StageState::default();
    assert_eq!(memory.to_numbers(), [0.0; STATE_NUMBERS]);
    assert_eq!((memory.is_started(), memory.temperature()), (false, 0.0));
    assert_eq!(StageState::from_numbers(&memory.to_numbers()), Ok(memory));
    for _ in 0..5 {
        let input = BODY.hold(plane.bottom() + rng.random::<f64>() * 4.0 * plane.step());
        let sample = Sample {
            input,
            dt: Some(0.2),
            load: None,
        };
        stages
            .step(&model, &mut state, &mut memory, sample)
            .unwrap();
    }
    let numbers = memory.to_numbers();
    assert_eq!(numbers[..2], [1.0, memory.temperature()]);
    assert!(memory.is_started() && memory.temperature() != 0.0);
    // Lags of different lengths are at different outputs.
    for pair in numbers[2..STATE_NUMBERS - 1].windows(2) {
        assert_ne!(pair[0], pair[1]);
    }
    // Forward, a ring wants the output that it has.
    assert_eq!(numbers[STATE_NUMBERS - 1], numbers[STATE_NUMBERS - 3]);
    assert_eq!(StageState::from_numbers(&numbers), Ok(memory));
    for index in 0..numbers.len() {
        for bad in [f64::NAN, f64::INFINITY] {
            let mut numbers = numbers;
            numbers[index] = bad;
            let refused = StageState::from_numbers(&numbers);
            assert_eq!(refused, Err(Error::InputNotFinite { index }));
        }
    }
}

#[test]
fn each_stage_with_a_time_constant_needs_time() {
    let plain: Stages<'_, f64> = Stages::NONE;
    let behind = |name: &str| {
        let stages = Stages::<f64>::declared();
        let stage = stages.into_iter().find(|stage| stage.name == name).unwrap();
        assert!(
            stage
                .constants
                .iter()
                .any(|constant| constant.range.is_timed())
        );
        Stages::with_constants(|constant| match stage.constants.contains(constant) {
            true => &[0.1],
            false => &[],
        })
    };
    assert!(!plain.is_timed());
    assert!(
        Stages {
            body: Some(BODY),
            ..plain
        }
        .is_timed()
    );
    assert!(behind("creep").unwrap().is_timed());
    assert!(behind("lag").unwrap().is_timed());
    assert!(behind("ring").unwrap().is_timed());
}

#[test]
fn a_body_is_driven_where_it_is_wanted() {
    let mut rng = rng(2);
    for _ in 0..1000 {
        let now = rng.random_range(-50.0..100.0);
        let wanted = rng.random_range(-50.0..100.0);
        let decay = BODY.decay(rng.random_range(0.1..2.0));
        let drive = BODY.drive(now, wanted, decay);
        // A drive of some thousand degrees is cut down to the step.
        assert!((BODY.step(now, drive, decay) - wanted).abs() < 1e-10);
        assert!((BODY.rest(BODY.hold(wanted)) - wanted).abs() < 1e-12);
    }
}
