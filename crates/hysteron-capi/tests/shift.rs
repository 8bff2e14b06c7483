//! A load that nobody measures: in memory of the library and of the caller, bit for bit what the
//! library says.
#![allow(clippy::unwrap_used)]

mod whole;

use hysteron::{AdaptiveLoad, Model, Sample, Target, Wanted};
use hysteron_capi::*;
use std::ffi::CString;
use std::mem::zeroed;
use std::ptr::{null, null_mut};
use whole::{BY_LOAD, WHOLE};

const NONE: f64 = f64::NAN;

fn ok(code: i32) {
    assert_eq!(code, HYSTERON_OK);
}

fn parsed(text: &str) -> u64 {
    let (text, mut handle) = (CString::new(text).unwrap(), 0);
    // SAFETY: live memory.
    ok(unsafe { hysteron_model_parse(text.as_ptr(), &mut handle) });
    handle
}

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
    ok(unsafe { hysteron_adaptive_shift(handle, &mut shift) });
    shift
}

/// The plant: the model itself, shifted. Its load jumps in the middle.
fn compare(text: &str) {
    let model = Model::from_json(text).unwrap();
    let mut library = AdaptiveLoad::new(&model, None, None).unwrap();
    let handle = parsed(text);
    let bytes = hysteron_adaptive_load_size(handle);
    let (mut memory, mut followers) = (vec![0_u64; bytes / 8], [0; 2]);
    // SAFETY: live memory of the sizes given.
    unsafe {
        ok(hysteron_adaptive_load_new(
            handle,
            NONE,
            null(),
            &mut followers[0],
        ));
        let (memory, out) = (memory.as_mut_ptr().cast(), &mut followers[1]);
        ok(hysteron_adaptive_load_place(
            handle,
            NONE,
            null(),
            memory,
            bytes,
            out,
        ));
    }
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
        for (follower, found) in followers.iter().zip(&mut found) {
            // SAFETY: live memory.
            ok(unsafe { hysteron_adaptive_step(*follower, input, dt, measured, found) });
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
        for found in followers.map(shift_of) {
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
        for (n, follower) in followers.into_iter().enumerate() {
            let (input, status) = (&mut input[n], &mut status[n]);
            // SAFETY: live memory.
            ok(unsafe {
                hysteron_adaptive_inverse_step(
                    follower,
                    target,
                    HYSTERON_HOLD,
                    0.0,
                    dt,
                    input,
                    status,
                )
            });
        }
        for (input, status) in input.into_iter().zip(status) {
            assert_eq!(input.to_bits(), solution.input.to_bits(), "{n}");
            assert_eq!(status, i32::from(solution.status.number()));
        }
        if n % 97 == 50 {
            library.align();
            followers
                .iter()
                .for_each(|follower| ok(hysteron_adaptive_align(*follower)));
        }
    }
    assert!(learned > 40, "{learned} of 1200 taught something");
    let expected = library.model().unwrap();
    for follower in followers {
        // SAFETY: all fields are numbers.
        let (mut at, mut info) = (0, unsafe { zeroed::<HysteronModelInfo>() });
        // SAFETY: live memory.
        unsafe {
            ok(hysteron_adaptive_model(follower, &mut at));
            ok(hysteron_model_info(at, &mut info));
        }
        assert_eq!(
            (info.min, info.max),
            (expected.plane().min(), expected.plane().max())
        );
        assert_eq!((info.output_off, info.output_on), expected.output_range());
        assert_eq!(hysteron_adaptive_keep(follower), HYSTERON_HANDLE);
        ok(hysteron_model_free(at));
        ok(hysteron_adaptive_free(follower));
    }
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
        let mut step = |input, dt, y| hysteron_adaptive_step(follower, input, dt, y, &mut learning);
        ok(step(0.5, NONE, 1.0));
        assert_eq!(step(0.5, -1.0, 1.0), HYSTERON_THERMAL);
        assert_eq!(step(NONE, 0.1, 1.0), HYSTERON_INPUT_NOT_FINITE);
        assert_eq!(step(0.5, 0.1, NONE), HYSTERON_INPUT_NOT_FINITE);
        assert_eq!(shift_of(follower).shift, before.shift);
        ok(hysteron_adaptive_freeze(follower, 1));
        ok(hysteron_adaptive_step(
            follower,
            0.2,
            9.0,
            1.0,
            &mut learning,
        ));
        assert_eq!(learning.outcome, HYSTERON_FROZEN);
        ok(hysteron_adaptive_align(follower));
        ok(hysteron_adaptive_reset(follower));
        let mut output = 0.0;
        ok(hysteron_adaptive_simulate(follower, 0.4, NONE, &mut output));
        ok(hysteron_adaptive_free(follower));
        assert_eq!(hysteron_adaptive_free(follower), HYSTERON_HANDLE);
        assert_eq!(
            hysteron_adaptive_model(follower, &mut model),
            HYSTERON_HANDLE
        );
    }
    let bytes = hysteron_adaptive_load_size(handle);
    let (mut room, mut made) = (vec![0_u64; bytes / 8], 0);
    let memory = room.as_mut_ptr().cast();
    // SAFETY: live memory of the sizes given.
    unsafe {
        let mut place = |load, bytes| {
            hysteron_adaptive_load_place(handle, load, null(), memory, bytes, &mut made)
        };
        assert_eq!(place(NONE, bytes - 1), HYSTERON_MEMORY_TOO_SMALL);
        assert_eq!(place(1e6, bytes), HYSTERON_FIT);
        ok(place(NONE, bytes));
    }
    ok(hysteron_adaptive_free(made));
    assert_eq!(hysteron_adaptive_load_size(0), 0);
}
