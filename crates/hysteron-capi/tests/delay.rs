//! The dead time of a model: states, lanes and learners delay their inputs as the library delays
//! those of a series, bit for bit.
#![allow(clippy::unwrap_used)]

mod whole;

use hysteron::{Adaptation, Adaptive, Method, Model, Sample, Surroundings};
use hysteron_capi::*;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::ffi::CString;
use std::mem::zeroed;
use std::ptr::{null, null_mut};
use whole::WHOLE;

const NONE: f64 = f64::NAN;
const PLAIN: &str = r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
    "plane": {"min": 0.2, "max": 1.0, "levels": 3}, "weights": [1, 2, 1, 0.5, 0.25, 1]}"#;

fn ok(code: i32) {
    assert_eq!(code, HYSTERON_OK);
}

/// A model file with a dead time.
fn with_delay(text: &str, samples: usize) -> String {
    let mut file: serde_json::Value = serde_json::from_str(text).unwrap();
    file["version"] = 4.into();
    file["delay"] = serde_json::json!({"samples": samples, "interval_s": 0.1});
    file.to_string()
}

fn parsed(text: &str) -> u64 {
    let (text, mut handle) = (CString::new(text).unwrap(), 0);
    // SAFETY: live memory.
    ok(unsafe { hysteron_model_parse(text.as_ptr(), &mut handle) });
    handle
}

struct Series {
    input: Vec<f64>,
    time: Vec<f64>,
    load: Vec<f64>,
}

fn series(seed: u64, dt: f64) -> Series {
    let mut random = StdRng::seed_from_u64(seed);
    let count = 120;
    Series {
        input: (0..count).map(|_| random.random_range(0.0..1.0)).collect(),
        time: (0..count).map(|n| dt * f64::from(n)).collect(),
        load: (0..count)
            .map(|_| random.random_range(50.0..200.0))
            .collect(),
    }
}

/// What the library says of the whole series.
fn expected(model: &Model, series: &Series) -> Vec<f64> {
    let around = Surroundings {
        time: model.is_timed().then_some(&series.time),
        load: model.load.as_ref().map(|_| &series.load[..]),
        rest: None,
    };
    // The interval is told to a model without time as well.
    let input = model
        .delay()
        .acting(&series.input, Some(&series.time))
        .into_owned();
    let mut output = vec![0.0; input.len()];
    model
        .run_in(&mut model.start(), &input, around, &mut output)
        .unwrap();
    output
}

/// Calls `check` with models, their handles and series on the clock of the recording, on a faster
/// and on a slower one.
fn for_all(mut check: impl FnMut(&Model, u64, &Series)) {
    for text in [PLAIN, WHOLE] {
        for samples in [0, 1, 2, 7, 300] {
            let text = with_delay(text, samples);
            let (model, handle) = (Model::from_json(&text).unwrap(), parsed(&text));
            for (seed, dt) in [(1, 0.1), (2, 0.05), (3, 0.3)] {
                let mut late = 0;
                // SAFETY: live memory.
                ok(unsafe { hysteron_model_delay(handle, dt, &mut late) });
                assert_eq!(late, model.delay().at(Some(dt)));
                check(&model, handle, &series(seed, dt));
            }
            ok(hysteron_model_free(handle));
        }
    }
}

fn state(model: u64, memory: &mut Vec<u64>) -> u64 {
    let mut state = 0;
    let bytes = hysteron_state_size(model);
    memory.resize(bytes / 8, 0);
    // SAFETY: live memory of the size given.
    ok(unsafe { hysteron_state_place(model, memory.as_mut_ptr().cast(), bytes, &mut state) });
    state
}

fn load_of(model: &Model, series: &Series, n: usize) -> f64 {
    model.load.as_ref().map_or(NONE, |_| series.load[n])
}

#[test]
fn steps_are_those_of_a_whole_series() {
    for_all(|model, handle, series| {
        let (mut memory, mut states) = (Vec::new(), [0; 2]);
        // SAFETY: live memory.
        ok(unsafe { hysteron_state_new(handle, &mut states[0]) });
        states[1] = state(handle, &mut memory);
        let dt = series.time[1];
        for (n, expected) in expected(model, series).into_iter().enumerate() {
            let dt = if n == 0 { NONE } else { dt };
            let load = load_of(model, series, n);
            for state in states {
                let mut output = 0.0;
                // SAFETY: live memory.
                unsafe {
                    // A step that is refused delays nothing.
                    let code = hysteron_step_in(state, NONE, dt, load, &mut output, null_mut());
                    assert_eq!(code, HYSTERON_INPUT_NOT_FINITE);
                    let input = series.input[n];
                    ok(hysteron_step_in(
                        state,
                        input,
                        dt,
                        load,
                        &mut output,
                        null_mut(),
                    ));
                }
                // Sums of time steps have no effect on operators, and rounding on stages.
                assert!((output - expected).abs() < 1e-9, "{n}: {output} {expected}");
                assert!(
                    model.is_timed() || output == expected,
                    "{n}: {output} {expected}"
                );
            }
            if n % 7 == 3 {
                states[0] = saved_and_restored(states[0], handle);
            }
        }
        ok(hysteron_state_free(states[0]));
        ok(hysteron_state_free(states[1]));
    });
}

/// A new state where the old one was.
fn saved_and_restored(old: u64, model: u64) -> u64 {
    let (mut points, mut inputs) = ([0.0; 32], vec![0.0; 1000]);
    let (mut count, mut under_way, mut input, mut new) = (0, 0, 0.0, 0);
    let mut stages = HysteronStageState::default();
    // SAFETY: live memory of the sizes given.
    unsafe {
        let to = points.as_mut_ptr();
        ok(hysteron_state_save(old, to, 32, &mut count, &mut input));
        ok(hysteron_state_save_stages(old, &mut stages));
        ok(hysteron_state_save_inputs(
            old,
            inputs.as_mut_ptr(),
            1000,
            &mut under_way,
        ));
        if under_way > 0 {
            let code = hysteron_state_save_inputs(old, null_mut(), 0, &mut under_way);
            assert_eq!(code, HYSTERON_MEMORY_TOO_SMALL);
        }
        ok(hysteron_state_new(model, &mut new));
        ok(hysteron_state_restore(new, points.as_ptr(), count, input));
        ok(hysteron_state_restore_stages(new, &stages));
        ok(hysteron_state_restore_inputs(
            new,
            inputs.as_ptr(),
            under_way,
        ));
    }
    ok(hysteron_state_free(old));
    new
}

#[test]
fn runs_are_those_of_a_whole_series() {
    for_all(|model, handle, series| {
        let expected = expected(model, series);
        let (mut memory, mut states) = (Vec::new(), [0; 2]);
        // SAFETY: live memory.
        ok(unsafe { hysteron_state_new(handle, &mut states[0]) });
        states[1] = state(handle, &mut memory);
        for state in states {
            let (mut begin, mut output) = (0, vec![0.0; expected.len()]);
            for count in [1, 2, 40, 60, 17] {
                let last = if begin == 0 {
                    NONE
                } else {
                    series.time[begin - 1]
                };
                let (input, time) = (&series.input[begin..], &series.time[begin..]);
                let load = match model.load {
                    Some(_) => series.load[begin..].as_ptr(),
                    None => null(),
                };
                let to = output[begin..].as_mut_ptr();
                let run = |input: *const f64| {
                    // SAFETY: live memory of the sizes given.
                    unsafe {
                        hysteron_run_in(
                            state,
                            input,
                            time.as_ptr(),
                            last,
                            load,
                            to,
                            null_mut(),
                            count,
                        )
                    }
                };
                // A run that fails in its middle moves nothing.
                if model.load.is_some() && count > 2 {
                    let mut loads = series.load[begin..].to_vec();
                    loads[count - 1] = 1e9;
                    let mut rest = vec![0.0; count];
                    // SAFETY: live memory of the sizes given.
                    let code = unsafe {
                        hysteron_run_in(
                            state,
                            input.as_ptr(),
                            time.as_ptr(),
                            last,
                            loads.as_ptr(),
                            rest.as_mut_ptr(),
                            null_mut(),
                            count,
                        )
                    };
                    assert!(code != HYSTERON_OK);
                }
                ok(run(input.as_ptr()));
                begin += count;
            }
            assert_eq!(output, expected);
            ok(hysteron_state_free(state));
        }
    });
}

#[test]
fn lanes_are_states() {
    for_all(|model, handle, series| {
        let expected = expected(model, series);
        let (mut batch, count) = (0, expected.len());
        // SAFETY: live memory.
        ok(unsafe { hysteron_batch_of(handle, 2, &mut batch) });
        let twice = |values: &[f64], part: std::ops::Range<usize>| {
            [&values[part.clone()], &values[part]].concat()
        };
        let (middle, mut output) = (count / 3, vec![0.0; 2 * count]);
        for part in [0..middle, middle..count] {
            let last = if part.start == 0 {
                NONE
            } else {
                series.time[part.start - 1]
            };
            let (input, load) = (
                twice(&series.input, part.clone()),
                twice(&series.load, part.clone()),
            );
            let load = if model.load.is_some() {
                load.as_ptr()
            } else {
                null()
            };
            let mut rows = vec![0.0; input.len()];
            // SAFETY: live memory of the sizes given.
            ok(unsafe {
                hysteron_batch_run_in(
                    batch,
                    input.as_ptr(),
                    series.time[part.clone()].as_ptr(),
                    part.len(),
                    last,
                    load,
                    rows.as_mut_ptr(),
                    rows.len(),
                )
            });
            output[part.clone()].copy_from_slice(&rows[..part.len()]);
            let second = count + part.start..count + part.end;
            output[second].copy_from_slice(&rows[part.len()..]);
        }
        assert_eq!(output, [&expected[..], &expected].concat());
        // A state of a lane goes on where the lane is, as the lane itself.
        let (mut state, mut alone, mut both) = (0, 0.0, [0.0; 2]);
        // SAFETY: live memory of the sizes given.
        unsafe {
            ok(hysteron_batch_state(batch, 1, &mut state));
            for n in 0..20 {
                let (dt, load) = (series.time[1], load_of(model, series, n));
                let inputs = [series.input[n]; 2];
                let loads = [load; 2];
                let loads = if load.is_nan() {
                    null()
                } else {
                    loads.as_ptr()
                };
                let to = both.as_mut_ptr();
                ok(hysteron_batch_step_in(
                    batch,
                    inputs.as_ptr(),
                    dt,
                    loads,
                    to,
                    2,
                ));
                ok(hysteron_step_in(
                    state,
                    inputs[0],
                    dt,
                    load,
                    &mut alone,
                    null_mut(),
                ));
                assert_eq!(both, [alone; 2]);
            }
        }
        ok(hysteron_state_free(state));
        ok(hysteron_batch_free(batch));
    });
}

#[test]
fn learners_learn_from_what_acts() {
    for samples in [0, 1, 5] {
        let text = with_delay(PLAIN, samples);
        let (model, handle) = (Model::from_json(&text).unwrap(), parsed(&text));
        let series = series(9, 0.1);
        let method = Method::Increments {
            gain: 0.3,
            span: 1.0,
        };
        let options = Adaptation {
            method,
            ..Adaptation::default()
        };
        let mut library = Adaptive::new(&model, options).unwrap();
        let mut learners = [0; 2];
        // SAFETY: all fields are numbers; live memory of the sizes given.
        let mut memory = unsafe {
            let mut options: HysteronAdaptation = zeroed();
            ok(hysteron_adaptation_default(
                HYSTERON_INCREMENTS,
                &mut options,
            ));
            ok(hysteron_adaptive_new(handle, &options, &mut learners[0]));
            let bytes = hysteron_adaptive_size(handle, &options);
            let mut memory = vec![0_u64; bytes / 8];
            let (at, out) = (memory.as_mut_ptr().cast(), &mut learners[1]);
            ok(hysteron_adaptive_place(handle, &options, at, bytes, out));
            memory
        };
        let acting = model.delay().acting(&series.input, None).into_owned();
        for (n, input) in acting.into_iter().enumerate() {
            let measured = 1.3 * input;
            let sample = Sample {
                input,
                dt: None,
                load: None,
            };
            let expected = library.step(sample, measured).unwrap();
            for learner in learners {
                // SAFETY: all fields are numbers; live memory.
                unsafe {
                    let mut found: HysteronLearning = zeroed();
                    let given = series.input[n];
                    ok(hysteron_adaptive_step(
                        learner, given, NONE, measured, &mut found,
                    ));
                    assert_eq!(
                        (found.output, found.error),
                        (expected.output, expected.error)
                    );
                }
            }
        }
        for learner in learners {
            let (mut learned, mut late) = (0, 0);
            // SAFETY: live memory.
            unsafe {
                ok(hysteron_adaptive_model(learner, &mut learned));
                ok(hysteron_model_delay(learned, NONE, &mut late));
            }
            assert_eq!(late, samples);
            ok(hysteron_adaptive_free(learner));
        }
        memory.clear();
    }
}

/// The inverse gives at once what arrives later: behind the dead time the target is reached.
#[test]
fn an_inverse_reaches_the_target_when_its_input_arrives() {
    let (samples, text) = (4, with_delay(PLAIN, 4));
    let model = parsed(&text);
    let (mut inverse, mut plant) = (0, 0);
    // SAFETY: live memory.
    unsafe {
        ok(hysteron_state_new(model, &mut inverse));
        ok(hysteron_state_new(model, &mut plant));
    }
    let wanted: Vec<f64> = (0..80)
        .map(|n| 2.0 + 1.5 * (0.2 * f64::from(n)).sin())
        .collect();
    for n in 0..wanted.len() - samples {
        let (mut input, mut status, mut output) = (0.0, 0, 0.0);
        // SAFETY: live memory.
        unsafe {
            let due = wanted[n + samples];
            ok(hysteron_inverse_step(
                inverse,
                due,
                0,
                0.0,
                &mut input,
                &mut status,
            ));
            ok(hysteron_step(plant, input, &mut output, null_mut()));
        }
        assert!(
            n < samples || (output - wanted[n]).abs() < 1e-9,
            "{n}: {output}"
        );
    }
    // Nothing is under way where the inverse went.
    let mut count = 7;
    // SAFETY: live memory; null with room for nothing.
    ok(unsafe { hysteron_state_save_inputs(inverse, null_mut(), 0, &mut count) });
    assert_eq!(count, 0);
    let inputs = [0.0; 1001];
    // SAFETY: live memory of the size given.
    unsafe {
        let code = hysteron_state_restore_inputs(plant, inputs.as_ptr(), 1001);
        assert_eq!(code, HYSTERON_VALUE);
        let code = hysteron_state_restore_inputs(plant, [NONE].as_ptr(), 1);
        assert_eq!(code, HYSTERON_INPUT_NOT_FINITE);
    }
}
