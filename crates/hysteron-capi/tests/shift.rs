//! A load that nobody measures: by handle and over the caller's memory, bit for bit what the library
//! says.
#![allow(clippy::unwrap_used)]

mod own;
mod whole;

use hysteron::{AdaptiveLoad, Model, Sample, Target, Wanted};
use hysteron_capi::*;
use own::{NONE, Own, ok, parsed};
use std::mem::zeroed;
use std::ptr::{null, null_mut};
use whole::{BY_LOAD, WHOLE};

const PLAIN: &str = r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
    "plane": {"min": 30.0, "max": 60.0, "levels": 3}, "weights": [1, 2, 1, 0.5, 0.25, 1]}"#;

/// Weights of three parts, and a shift that tells the load.
fn telling() -> String {
    let mut file: serde_json::Value = serde_json::from_str(WHOLE).unwrap();
    let part = |offset: f64, factor: f64| {
        let weights: Vec<f64> = [1.0, 0.5, 1.0, 0.25, 0.5, 1.0].map(|mu| factor * mu).into();
        serde_json::json!({"offset": offset, "weights": weights})
    };
    let middle = part(2.3125, 1.25);
    file["weights"] = middle["weights"].clone();
    file["output"]["offset"] = middle["offset"].clone();
    file["load"]["parts"] = [part(2.0, 1.0), part(2.5, 1.25), part(2.25, 1.5)].into();
    file.to_string()
}

fn shift_of(handle: u64) -> HysteronShift {
    // SAFETY: all fields are numbers.
    let mut shift: HysteronShift = unsafe { zeroed() };
    // SAFETY: live memory.
    ok(unsafe { hysteron_adaptive_load_shift(handle, &mut shift) });
    shift
}

/// Two states of one model: of what is measured, and of the inverse.
struct Twin {
    room: Vec<u64>,
    state: *mut HysteronCoreState,
    past: HysteronStageState,
}

/// The plant: the model itself, shifted. Its load jumps in the middle.
fn compare(text: &str) {
    let model = Model::from_json(text).unwrap();
    let mut library = AdaptiveLoad::new(&model, None, None).unwrap();
    let handle = parsed(text);
    let mut follower = 0;
    // SAFETY: live memory of the sizes given.
    ok(unsafe { hysteron_adaptive_load_new(handle, NONE, null(), &mut follower) });

    let mut own = Own::new(handle);
    let bytes = hysteron_core_state_size(3);
    let mut twin = Twin {
        room: vec![0; bytes / 8],
        state: null_mut(),
        past: HysteronStageState::default(),
    };
    let mut place = vec![0_u64; hysteron_core_shift_size() / 8];
    let (mut shift, mut limits) = (null_mut(), unsafe { zeroed::<HysteronLimits>() });
    let (mut usual, mut of_core) = unsafe { zeroed::<[HysteronShiftOptions; 2]>() }.into();
    // SAFETY: live memory of the sizes given.
    unsafe {
        let room = twin.room.as_mut_ptr().cast();
        ok(hysteron_core_state_init(
            own.model,
            room,
            bytes,
            &mut twin.state,
        ));
        let (room, bytes) = (place.as_mut_ptr().cast(), hysteron_core_shift_size());
        ok(hysteron_core_shift_init(
            own.model,
            own.stages,
            null(),
            room,
            bytes,
            &mut shift,
        ));
        ok(hysteron_model_limits(handle, &mut limits));
        ok(hysteron_shift_usual(handle, &mut usual));
        ok(hysteron_core_shift_usual(
            own.model,
            own.stages,
            &mut of_core,
        ));
    }
    assert_eq!(
        (usual.noise, usual.reach, usual.burst),
        (of_core.noise, of_core.reach, of_core.burst)
    );

    let told = library.told();
    let load = told.unwrap_or(NONE);
    let body = model.thermal.is_some();
    let mut plant = model.start();
    let mut learned = 0;
    for n in 0..600 {
        let swing = 0.5 - 0.5 * (0.11 * f64::from(n)).cos();
        let input = if body {
            0.7 * swing
        } else {
            20.0 + 60.0 * swing
        };
        let dt = if model.is_timed() { 0.8 } else { NONE };
        let given = (!dt.is_nan()).then_some(dt);
        // What the plant's load is: the model's own, or a shift of the input where it has none.
        let (sample, shifted) = match &model.load {
            Some(_) => {
                let load = if n < 300 { 60.0 } else { 170.0 };
                (
                    Sample {
                        input,
                        dt: given,
                        load: Some(load),
                    },
                    0.0,
                )
            }
            None => (
                Sample {
                    input,
                    dt: given,
                    load: None,
                },
                if n < 300 { 3.0 } else { 7.0 },
            ),
        };
        let moved = Sample {
            input: sample.input - shifted,
            ..sample
        };
        let measured = model.step(&mut plant, moved).unwrap().output;

        let sample = Sample {
            load: None,
            ..sample
        };
        let expected = library.step(sample, measured).unwrap();
        // SAFETY: all fields are numbers.
        let mut found: [HysteronLearning; 2] = unsafe { zeroed() };
        // SAFETY: live memory.
        unsafe {
            ok(hysteron_adaptive_load_step(
                follower,
                input,
                dt,
                measured,
                &mut found[0],
            ));
            ok(hysteron_core_shift_step(
                shift,
                own.stages,
                own.model,
                own.state,
                &mut own.past,
                input,
                dt,
                load,
                measured,
                &mut found[1],
            ));
        }
        for found in found {
            let bits = (found.output.to_bits(), found.error.to_bits());
            assert_eq!(
                bits,
                (expected.output.to_bits(), expected.error.to_bits()),
                "{n}"
            );
            learned += i32::from(found.outcome == HYSTERON_LEARNED);
        }
        // SAFETY: all fields are numbers.
        let mut read: HysteronShift = unsafe { zeroed() };
        // SAFETY: live memory.
        ok(unsafe { hysteron_core_shift_read(shift, own.stages, load, &mut read) });
        for found in [shift_of(follower), read] {
            assert_eq!(found.shift.to_bits(), library.shift().to_bits(), "{n}");
            assert_eq!(found.deviation.to_bits(), library.deviation().to_bits());
            assert_eq!((!found.load.is_nan()).then_some(found.load), library.load());
        }

        let target = 1.0 + 1.5 * swing;
        let wanted = Wanted {
            dt: given,
            ..Target::new(target).into()
        };
        let solution = library.solve(wanted).unwrap();
        let (mut input, mut status) = ([7.0; 2], [7; 2]);
        // SAFETY: live memory.
        unsafe {
            ok(hysteron_adaptive_load_inverse_step(
                follower,
                target,
                HYSTERON_HOLD,
                0.0,
                dt,
                &mut input[0],
                &mut status[0],
            ));
            ok(hysteron_core_shift_inverse_step(
                shift,
                own.stages,
                own.model,
                twin.state,
                &mut twin.past,
                target,
                HYSTERON_HOLD,
                0.0,
                dt,
                load,
                &limits,
                &mut input[1],
                &mut status[1],
            ));
        }
        for (input, status) in input.into_iter().zip(status) {
            assert_eq!(input.to_bits(), solution.input.to_bits(), "{n}");
            assert_eq!(status, i32::from(solution.status.number()));
        }
    }
    assert!(learned > 40, "{learned} of 1200 taught something");
    let mut at = 0;
    // SAFETY: live memory.
    ok(unsafe { hysteron_adaptive_load_model(follower, &mut at) });
    ok(hysteron_model_free(at));
    ok(hysteron_adaptive_load_free(follower));
}

#[test]
fn a_plain_model() {
    compare(PLAIN);
}

#[test]
fn every_stage() {
    compare(WHOLE);
}

#[test]
fn weights_that_follow_the_load_found() {
    compare(&telling());
    // Without a curve of shifts no load is told: the weights stay those of the load at the start.
    compare(BY_LOAD);
}

#[test]
fn what_is_wrong_is_refused_and_nothing_changes() {
    let handle = parsed(WHOLE);
    let (mut follower, mut model) = (0, 0);
    // SAFETY: live memory; null pointers are refused.
    unsafe {
        let new = |load, options| hysteron_adaptive_load_new(handle, load, options, &mut 0);
        assert_eq!(new(1e6, null()), HYSTERON_FIT);
        let mut options = zeroed();
        ok(hysteron_shift_usual(handle, &mut options));
        options.noise = -1.0;
        assert_eq!(new(NONE, &options), HYSTERON_ADAPTATION);
        assert_eq!(
            hysteron_adaptive_load_new(handle, NONE, null(), null_mut()),
            HYSTERON_NULL
        );
        ok(hysteron_adaptive_load_new(
            handle,
            100.0,
            null(),
            &mut follower,
        ));
        let before = shift_of(follower);
        let mut learning = zeroed();
        let mut step =
            |input, dt, y| hysteron_adaptive_load_step(follower, input, dt, y, &mut learning);
        ok(step(0.5, NONE, 1.0));
        assert_eq!(step(0.5, -1.0, 1.0), HYSTERON_THERMAL);
        assert_eq!(step(NONE, 0.1, 1.0), HYSTERON_INPUT_NOT_FINITE);
        assert_eq!(step(0.5, 0.1, NONE), HYSTERON_INPUT_NOT_FINITE);
        assert_eq!(shift_of(follower).shift, before.shift);
        ok(hysteron_adaptive_load_freeze(follower, 1));
        ok(hysteron_adaptive_load_step(
            follower,
            0.2,
            9.0,
            1.0,
            &mut learning,
        ));
        assert_eq!(learning.outcome, HYSTERON_FROZEN);
        ok(hysteron_adaptive_load_align(follower));
        ok(hysteron_adaptive_load_reset(follower));
        let mut output = 0.0;
        ok(hysteron_adaptive_load_simulate(
            follower,
            0.4,
            NONE,
            &mut output,
        ));
        ok(hysteron_adaptive_load_free(follower));
        assert_eq!(hysteron_adaptive_load_free(follower), HYSTERON_HANDLE);
        assert_eq!(
            hysteron_adaptive_load_model(follower, &mut model),
            HYSTERON_HANDLE
        );
    }

    let own = Own::new(handle);
    let mut room = vec![0_u64; hysteron_core_shift_size() / 8];
    let (place, bytes) = (room.as_mut_ptr().cast(), hysteron_core_shift_size());
    let mut shift = null_mut();
    // SAFETY: live memory of the sizes given.
    unsafe {
        let init = |bytes, shift| {
            hysteron_core_shift_init(own.model, own.stages, null(), place, bytes, shift)
        };
        assert_eq!(init(bytes - 1, &mut shift), HYSTERON_MEMORY_TOO_SMALL);
        ok(init(bytes, &mut shift));
        ok(hysteron_core_shift_freeze(shift, 1));
        assert_eq!(
            hysteron_core_shift_reset(shift, NONE),
            HYSTERON_INPUT_NOT_FINITE
        );
        ok(hysteron_core_shift_reset(shift, 4.0));
        let mut found = zeroed();
        ok(hysteron_core_shift_read(
            shift, own.stages, 100.0, &mut found,
        ));
        assert_eq!(found.shift, 4.0);
        assert!(found.load > 100.0);
        let code = hysteron_core_shift_read(shift, own.stages, NONE, &mut found);
        assert_eq!(code, HYSTERON_LOAD);
    }
}
