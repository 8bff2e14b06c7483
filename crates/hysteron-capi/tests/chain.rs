//! The whole signal path over the caller's memory: bit for bit what a state by handle gives, and
//! without an allocation.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod own;
mod whole;

use hysteron_capi::*;
use hysteron_core::Stages;
use own::{NONE, Own, constants, ok, parsed};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use serde_json::{Value, json};
use std::ffi::CStr;
use std::mem::zeroed;
use std::ptr::{null, null_mut};
use whole::{BY_LOAD, Series, WHOLE, series};

#[test]
fn the_path_is_that_of_a_state_by_handle() {
    let handle = parsed(WHOLE);
    let mut own = Own::new(handle);
    let (mut state, mut limits) = (0, unsafe { zeroed::<HysteronLimits>() });
    // SAFETY: live memory.
    unsafe {
        ok(hysteron_state_new(handle, &mut state));
        ok(hysteron_model_limits(handle, &mut limits));
    }
    ok(hysteron_state_start(state, HYSTERON_START_OFF));
    let Series {
        input,
        target,
        load,
        step,
        ..
    } = series(5, 600);
    for n in 0..input.len() {
        let (mut expected, mut status) = (0.0, 0);
        // Forward and inverse in turns, over one state.
        if n % 5 < 3 {
            // SAFETY: live memory.
            ok(unsafe {
                hysteron_step_in(state, input[n], step[n], load[n], &mut expected, null_mut())
            });
            let (code, found) = own.step(input[n], step[n], load[n]);
            assert_eq!((code, found.to_bits()), (HYSTERON_OK, expected.to_bits()));
            continue;
        }
        // SAFETY: live memory.
        ok(unsafe {
            hysteron_inverse_step_in(
                state,
                target[n],
                HYSTERON_HOLD,
                0.0,
                step[n],
                load[n],
                null(),
                &mut expected,
                &mut status,
            )
        });
        let found = own.invert(target[n], step[n], load[n], &limits);
        assert_eq!(found, (HYSTERON_OK, expected, status));
    }
    // The model's arrays were copied: they are not needed any more.
    ok(hysteron_state_free(state));
    ok(hysteron_model_free(own.handle));
    assert_eq!(own.step(0.5, 0.1, 100.0).0, HYSTERON_OK);
}

#[test]
fn a_copy_of_the_numbers_is_a_saved_state() {
    let mut own = Own::new(parsed(WHOLE));
    let Series {
        input, load, step, ..
    } = series(6, 50);
    for n in 0..40 {
        ok(own.step(input[n], step[n], load[n]).0);
    }
    let (mut points, mut count, mut last, past) = ([0.0; 64], 0, 0.0, own.past);
    // SAFETY: live memory of the sizes given.
    ok(unsafe {
        hysteron_core_state_save(own.state, points.as_mut_ptr(), 64, &mut count, &mut last)
    });
    let rest = |own: &mut Own| -> Vec<u64> {
        let steps = (40..50).map(|n| own.step(input[n], step[n], load[n]).1.to_bits());
        steps.collect()
    };
    let first = rest(&mut own);
    // SAFETY: live memory of the sizes given.
    ok(unsafe { hysteron_core_state_restore(own.model, own.state, points.as_ptr(), count, last) });
    own.past = past;
    assert_eq!(rest(&mut own), first);
}

#[test]
fn what_is_missing_or_wrong_is_refused_and_nothing_moves() {
    let handle = parsed(WHOLE);
    let (mut own, mut twin) = (Own::new(handle), Own::new(handle));
    assert_eq!(own.step(0.5, -1.0, 100.0).0, HYSTERON_TIME_STEP);
    ok(own.step(0.5, NONE, 100.0).0);
    ok(twin.step(0.5, NONE, 100.0).0);
    for (input, dt, load, code) in [
        (NONE, 0.1, 100.0, HYSTERON_INPUT_NOT_FINITE),
        (f64::INFINITY, 0.1, 100.0, HYSTERON_INPUT_NOT_FINITE),
        (0.5, NONE, 100.0, HYSTERON_TIME_STEP),
        (0.5, -0.1, 100.0, HYSTERON_TIME_STEP),
        (0.5, f64::INFINITY, 100.0, HYSTERON_TIME_STEP),
        (0.5, 0.1, NONE, HYSTERON_LOAD),
        (0.5, 0.1, f64::INFINITY, HYSTERON_LOAD),
    ] {
        assert_eq!(own.step(input, dt, load), (code, 7.0));
        assert_eq!(own.invert(input, dt, load, null()), (code, 7.0, 7));
    }
    // SAFETY: all fields are numbers.
    let mut limits: HysteronLimits = unsafe { zeroed() };
    limits.drive_min = NONE;
    assert_eq!(own.invert(1.0, 0.1, 100.0, &limits).0, HYSTERON_VALUE);
    let past = own.past;
    own.past.behind[2] = NONE;
    assert_eq!(own.step(0.5, 0.1, 100.0).0, HYSTERON_INPUT_NOT_FINITE);
    own.past = past;
    let mark = own.memory[2][0];
    own.memory[2][0] = 0;
    assert_eq!(own.step(0.5, 0.1, 100.0).0, HYSTERON_HANDLE);
    own.memory[2][0] = mark;
    assert_eq!(own.step(0.6, 0.1, 90.0), twin.step(0.6, 0.1, 90.0));

    let other = r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
        "plane": {"min": 0, "max": 1, "levels": 2}, "weights": [1, 2, 1]}"#;
    let other = Own::new(parsed(other));
    (own.model, own.state) = (other.model, other.state);
    assert_eq!(own.step(0.5, 0.1, 100.0).0, HYSTERON_STATE_MISMATCH);
}

/// The constant with this name.
fn list<'c>(constants: &'c mut HysteronStages, name: &str) -> &'c mut HysteronConstant {
    let mut lists = constants.constants.iter_mut();
    // SAFETY: the names are texts of the library.
    let named =
        |list: &&mut HysteronConstant| unsafe { CStr::from_ptr(list.name).to_str() == Ok(name) };
    lists.find(named).expect("a constant")
}

#[test]
fn constants_are_checked() {
    let handle = parsed(WHOLE);
    let mut own = Own::new(handle);
    let place = own.places()[2];
    let bytes = 8 * own.memory[2].len();
    let mut make = |change: &dyn Fn(&mut HysteronStages)| {
        let mut constants = constants(handle);
        change(&mut constants);
        // SAFETY: live memory of the sizes given.
        unsafe { hysteron_core_stages_init(own.model, &constants, place, bytes, &mut own.stages) }
    };
    static BACK: [f64; 4] = [3.0, 2.0, 1.0, 0.0];
    static NAN: [f64; 4] = [1.0, NONE, 2.0, 3.0];
    static MANY: [f64; 9] = [1.0; 9];
    // Each constant out of its range, and with a number too many.
    let declared: Vec<_> = Stages::<f64>::declared().collect();
    let all = declared.iter().flat_map(|stage| stage.constants);
    for constant in all {
        let bad = make(&|c| {
            let list = list(c, constant.name);
            (list.numbers, list.count) = (NAN[1..].as_ptr(), list.count.max(1));
        });
        assert_eq!(bad, HYSTERON_STAGE, "{constant:?}");
        let many = make(&|c| {
            let list = list(c, constant.name);
            (list.numbers, list.count) = (MANY.as_ptr(), MANY.len());
        });
        assert_eq!(many, HYSTERON_STAGE, "{constant:?}");
        let null = make(&|c| list(c, constant.name).numbers = null());
        let there = list(&mut constants(handle), constant.name).count > 0;
        assert_eq!(null, if there { HYSTERON_NULL } else { HYSTERON_OK });
    }
    for (n, change) in [
        (&|c: &mut HysteronStages| c.offset = f64::INFINITY) as &dyn Fn(&mut HysteronStages),
        &|c| list(c, "loads").numbers = BACK.as_ptr(),
        &|c| list(c, "spacing").numbers = BACK.as_ptr(),
        &|c| list(c, "spacing").count = 3,
    ]
    .into_iter()
    .enumerate()
    {
        assert_eq!(make(change), HYSTERON_STAGE, "{n}");
    }
    assert_eq!(make(&|c| c.sign = 0), HYSTERON_VALUE);
    let count = |c: &mut HysteronStages| list(c, "loads").count = usize::MAX;
    assert_eq!(make(&count), HYSTERON_VALUE);
    assert_eq!(
        make(&|c| list(c, "lag").name = c"none".as_ptr()),
        HYSTERON_VALUE
    );
    assert_eq!(
        make(&|c| list(c, "lag").name = c"gain".as_ptr()),
        HYSTERON_VALUE
    );
    let same = |c: &mut HysteronStages| list(c, "shifts").numbers = list(c, "loads").numbers;
    assert_eq!(make(&same), HYSTERON_OVERLAP);
    let beside = |c: &mut HysteronStages| list(c, "spacing").numbers = place.cast::<f64>();
    assert_eq!(make(&beside), HYSTERON_OVERLAP);
    let odd = |array: *const f64| array.cast::<u8>().wrapping_add(1).cast::<f64>();
    let odd = |c: &mut HysteronStages| list(c, "gains").numbers = odd(list(c, "gains").numbers);
    assert_eq!(make(&odd), HYSTERON_ALIGNMENT);
    ok(make(&|_| {}));
    ok(make(&|c| {
        for name in ["shifts", "scales", "gains", "offsets"] {
            list(c, name).count = 0;
        }
    }));
    ok(make(&|c| {
        c.constants.iter_mut().for_each(|list| list.name = null())
    }));

    let (constants, mut stages) = (constants(handle), null_mut());
    // SAFETY: live memory of the sizes given.
    unsafe {
        let too_small = hysteron_core_stages_size(&constants) - 8;
        let code = hysteron_core_stages_init(own.model, &constants, place, too_small, &mut stages);
        assert_eq!(code, HYSTERON_MEMORY_TOO_SMALL);
        assert_eq!(hysteron_core_stages_size(null()), 0);
    }
}

/// The file of a model with every stage or none, and weights of `parts` parts over the load.
fn by_load(seed: u64, parts: usize, alone: bool) -> String {
    let mut file: Value = serde_json::from_str(WHOLE).unwrap();
    let mut random = StdRng::seed_from_u64(seed);
    let mut numbers =
        |count: usize| -> Vec<f64> { (0..count).map(|_| random.random_range(0.0..2.0)).collect() };
    let part = |_| json!({"offset": numbers(1)[0], "weights": numbers(6)});
    file["load"]["parts"] = (0..parts).map(part).collect();
    at_middle(&mut file);
    if alone {
        for stage in ["thermal", "drive", "spacing", "creep", "lag", "start"] {
            file.as_object_mut().unwrap().remove(stage);
        }
        file["load"].as_object_mut().unwrap().remove("curves");
    }
    file.to_string()
}

/// Two states by handle, and two over one model in own memory, whose weights follow the load of
/// whoever moves.
#[test]
fn weights_follow_the_load() {
    let mut files: Vec<String> = vec![BY_LOAD.into()];
    files.extend((2..=8).map(|parts| by_load(parts as u64, parts, parts % 3 == 0)));
    for file in files {
        let handle = parsed(&file);
        let mut own = Own::new(handle);
        let bytes = hysteron_core_state_size(3);
        let mut room = vec![0_u64; bytes / 8];
        let (mut second, mut past) = (null_mut(), HysteronStageState::default());
        let (mut states, mut limits) = ([0; 2], unsafe { zeroed::<HysteronLimits>() });
        // SAFETY: live memory of the sizes given.
        unsafe {
            let place = room.as_mut_ptr().cast();
            ok(hysteron_core_state_init(
                own.model,
                place,
                bytes,
                &mut second,
            ));
            ok(hysteron_model_limits(handle, &mut limits));
            for state in &mut states {
                ok(hysteron_state_new(handle, state));
                ok(hysteron_state_start(*state, HYSTERON_START_OFF));
            }
        }
        let Series {
            input,
            target,
            mut load,
            step,
            ..
        } = series(9, 400);
        // Temperatures where there is no body.
        let scale = if limits.drive_max.is_finite() {
            1.0
        } else {
            80.0
        };
        let mut now = 0;
        for n in 0..input.len() {
            if n % 4 < 2 {
                load[n] = load[n.saturating_sub(1)];
            }
            if n % 7 > 3 {
                now = 1 - now;
                std::mem::swap(&mut own.state, &mut second);
                std::mem::swap(&mut own.past, &mut past);
            }
            let (mut expected, mut status) = (0.0, 0);
            if n % 5 < 3 {
                let input = scale * input[n];
                let (state, place) = (states[now], &mut expected);
                // SAFETY: live memory.
                ok(unsafe { hysteron_step_in(state, input, step[n], load[n], place, null_mut()) });
                let (code, found) = own.step(input, step[n], load[n]);
                assert_eq!((code, found.to_bits()), (HYSTERON_OK, expected.to_bits()));
                continue;
            }
            // SAFETY: live memory.
            ok(unsafe {
                hysteron_inverse_step_in(
                    states[now],
                    target[n],
                    HYSTERON_HOLD,
                    0.0,
                    step[n],
                    load[n],
                    null(),
                    &mut expected,
                    &mut status,
                )
            });
            let found = own.invert(target[n], step[n], load[n], &limits);
            assert_eq!(found, (HYSTERON_OK, expected, status), "{file}");
        }
    }
}

/// Loads beyond the range act as its ends; what is not a load is refused, and nothing moves.
#[test]
fn loads_beyond_the_weights() {
    let handle = parsed(&by_load(3, 4, true));
    let (mut own, mut twin) = (Own::new(handle), Own::new(handle));
    for (n, (load, end)) in [(-1e9, 50.0), (f64::MAX, 200.0), (49.0, 50.0)]
        .into_iter()
        .enumerate()
    {
        let input = 20.0 + 9.0 * n as f64;
        assert_eq!(own.step(input, NONE, load), twin.step(input, NONE, end));
        for load in [NONE, f64::INFINITY] {
            assert_eq!(own.step(55.0, NONE, load), (HYSTERON_LOAD, 7.0));
            assert_eq!(own.invert(1.0, NONE, load, null()), (HYSTERON_LOAD, 7.0, 7));
        }
    }
}

#[test]
fn parts_are_checked() {
    let handle = parsed(&by_load(3, 4, false));
    let mut own = Own::new(handle);
    let place = own.places()[2];
    let bytes = 8 * own.memory[2].len();
    let mut make = |change: &dyn Fn(&mut HysteronStages)| {
        let mut constants = constants(handle);
        change(&mut constants);
        // SAFETY: live memory of the sizes given.
        unsafe { hysteron_core_stages_init(own.model, &constants, place, bytes, &mut own.stages) }
    };
    static NAN: [f64; 24] = [NONE; 24];
    static FEW: [f64; 24] = [1.0; 24];
    assert_eq!(make(&|c| c.part_weight_count = 5), HYSTERON_WEIGHT_COUNT);
    assert_eq!(make(&|c| c.part_weight_count = usize::MAX), HYSTERON_VALUE);
    assert_eq!(make(&|c| c.part_count = usize::MAX), HYSTERON_VALUE);
    assert_eq!(make(&|c| c.part_weights = null()), HYSTERON_NULL);
    assert_eq!(make(&|c| c.part_offsets = null()), HYSTERON_NULL);
    assert_eq!(make(&|c| c.part_offsets = c.part_weights), HYSTERON_OVERLAP);
    assert_eq!(make(&|c| c.load_max = c.load_min), HYSTERON_STAGE);
    assert_eq!(make(&|c| c.load_min = NONE), HYSTERON_STAGE);
    assert_eq!(make(&|c| c.part_offsets = NAN.as_ptr()), HYSTERON_STAGE);
    assert_eq!(
        make(&|c| c.part_weights = NAN.as_ptr()),
        HYSTERON_WEIGHT_NOT_FINITE
    );
    ok(make(&|c| c.part_weights = FEW.as_ptr()));
    ok(make(&|c| c.part_count = 0));

    let mut constants = constants(handle);
    // SAFETY: live memory, which the constants describe.
    let size = |constants: &HysteronStages| unsafe { hysteron_core_stages_size(constants) };
    assert_eq!(size(&constants), bytes);
    for each in [0, 1, 5] {
        constants.part_weight_count = each;
        assert_eq!(size(&constants), 0, "{each}");
    }
    static MANY: [f64; 54] = [1.0; 54];
    (constants.part_count, constants.part_weight_count) = (9, 6);
    (constants.part_offsets, constants.part_weights) = (FEW.as_ptr(), MANY.as_ptr());
    assert_eq!(size(&constants), 0);

    // One part below zero, where the sum is not.
    let mut weights = FEW;
    weights[7] = -0.1;
    static BELOW: std::sync::OnceLock<[f64; 24]> = std::sync::OnceLock::new();
    let below = BELOW.get_or_init(|| weights);
    ok(make(&|c| c.part_weights = below.as_ptr()));
    assert_eq!(own.step(0.5, NONE, 60.0).0, HYSTERON_OK);
    assert_eq!(
        own.invert(0.5, 0.1, 60.0, null()).0,
        HYSTERON_NEGATIVE_WEIGHTS
    );
}

/// Weights and offset of a file that are those in the middle of its parts.
fn at_middle(file: &mut serde_json::Value) {
    let parts = file["load"]["parts"].as_array().unwrap().clone();
    let mut factors = vec![0.0; parts.len()];
    hysteron_core::bernstein(0.5, &mut factors);
    let sum = |of: &dyn Fn(&serde_json::Value) -> f64| -> f64 {
        let pairs = factors.iter().zip(&parts);
        pairs.map(|(f, part)| f * of(part)).sum()
    };
    let count = parts[0]["weights"].as_array().unwrap().len();
    let weight = |n: usize| sum(&|part| part["weights"][n].as_f64().unwrap());
    file["weights"] = (0..count).map(weight).collect();
    file["output"]["offset"] = sum(&|part| part["offset"].as_f64().unwrap()).into();
}
