//! Over memory of the caller nothing is allocated after an object was made, with success and with
//! errors.
#![allow(clippy::unwrap_used)]

mod whole;

use hysteron_capi::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ffi::CString;
use std::ptr::{null, null_mut};
use whole::{BY_LOAD, WHOLE};

struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: the system's allocator, with a counter beside it that does not allocate.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const PLAIN: &str = r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
    "plane": {"min": 30.0, "max": 60.0, "levels": 3}, "weights": [1, 2, 1, 0.5, 0.25, 1]}"#;
const HOLD: i32 = HYSTERON_HOLD;

fn ok(code: i32) {
    assert_eq!(code, HYSTERON_OK);
}

fn counted(work: impl FnOnce()) {
    let before = COUNT.get();
    work();
    assert_eq!(COUNT.get(), before);
}

fn parsed(text: &str) -> u64 {
    let (text, mut model) = (CString::new(text).unwrap(), 0);
    // SAFETY: live memory.
    ok(unsafe { hysteron_model_parse(text.as_ptr(), &mut model) });
    model
}

/// All functions of a state.
fn state(model: u64) {
    let mut memory = vec![0_u64; hysteron_state_size(model) / 8];
    let (at, bytes, mut state) = (memory.as_mut_ptr().cast(), 8 * memory.len(), 0);
    // SAFETY: live memory of the size given.
    ok(unsafe { hysteron_state_place(model, at, bytes, &mut state) });
    let (mut output, mut input, mut status, mut count) = (0.0, 0.0, 0, 0);
    let (mut points, mut outputs, mut statuses) = ([0.0; 64], [0.0; 2], [0; 2]);
    let mut stages = HysteronStageState::default();
    // SAFETY: live memory of the sizes given.
    counted(|| unsafe {
        for n in 0..200 {
            let x = 50.0 + 40.0 * (0.1 * f64::from(n)).sin();
            // Some loads are those of the model, some are missing, some beyond its range.
            let load = [100.0, 60.0, f64::NAN, 500.0][n as usize % 4];
            hysteron_step_in(state, x, 0.1, load, &mut output, null_mut());
            let (input, status) = (&mut input, &mut status);
            hysteron_inverse_step_in(state, 5.0, HOLD, 0.0, 0.1, load, null(), input, status);
            hysteron_step(state, x, &mut output, null_mut());
            hysteron_inverse_step(state, 5.0, HOLD, 0.0, input, status);
        }
        let (inputs, time, load) = ([0.3, 0.4], [1.0, 2.0], [100.0, 700.0]);
        let (from, to) = (inputs.as_ptr(), outputs.as_mut_ptr());
        hysteron_run(state, from, to, 2);
        let (time, load) = (time.as_ptr(), load.as_ptr());
        hysteron_run_in(state, from, time, 0.0, load, to, null_mut(), 2);
        let flags = statuses.as_mut_ptr();
        hysteron_inverse_run(state, from, null(), 0.0, to, flags, 2);
        hysteron_inverse_run_in(
            state,
            from,
            null(),
            0.0,
            time,
            0.0,
            load,
            null(),
            to,
            flags,
            2,
        );
        ok(hysteron_state_save(
            state,
            points.as_mut_ptr(),
            64,
            &mut count,
            &mut input,
        ));
        ok(hysteron_state_save_stages(state, &mut stages));
        ok(hysteron_state_restore(state, points.as_ptr(), count, input));
        ok(hysteron_state_restore_stages(state, &stages));
        ok(hysteron_state_saturate(state));
        ok(hysteron_state_reset(state));
        let code = hysteron_step(state, f64::NAN, &mut output, null_mut());
        assert!(code != HYSTERON_OK);
        assert_eq!(
            hysteron_step(0, 0.0, &mut output, null_mut()),
            HYSTERON_HANDLE
        );
        let code = hysteron_state_save(state, null_mut(), 0, &mut count, &mut input);
        assert_eq!(code, HYSTERON_MEMORY_TOO_SMALL);
    });
    ok(hysteron_state_free(state));
}

/// All functions of a learner.
fn learner(adaptive: u64) {
    let (mut output, mut input, mut status) = (0.0, 0.0, 0);
    // SAFETY: all fields are numbers.
    let mut learning: HysteronLearning = unsafe { std::mem::zeroed() };
    // SAFETY: live memory.
    counted(|| unsafe {
        for n in 0..200 {
            let x = 50.0 + 40.0 * (0.1 * f64::from(n)).sin();
            ok(hysteron_adaptive_step(
                adaptive,
                x,
                0.1,
                0.1 * x,
                &mut learning,
            ));
            ok(hysteron_adaptive_simulate(adaptive, x, 0.1, &mut output));
            let (input, status) = (&mut input, &mut status);
            ok(hysteron_adaptive_inverse_step(
                adaptive, 5.0, HOLD, 0.0, 0.1, input, status,
            ));
        }
        let code = hysteron_adaptive_step(adaptive, 1.0, 0.1, f64::NAN, &mut learning);
        assert_eq!(code, HYSTERON_INPUT_NOT_FINITE);
        hysteron_adaptive_keep(adaptive);
        hysteron_adaptive_roll_back(adaptive);
        ok(hysteron_adaptive_align(adaptive));
        ok(hysteron_adaptive_freeze(adaptive, 1));
        ok(hysteron_adaptive_reset(adaptive));
    });
    ok(hysteron_adaptive_free(adaptive));
}

#[test]
fn nothing_is_allocated_over_the_callers_memory() {
    let late = PLAIN.replace(
        "\"version\": 1",
        "\"version\": 4, \"delay\": {\"samples\": 3, \"interval_s\": 0.1}",
    );
    for text in [PLAIN, WHOLE, BY_LOAD, &late] {
        let (model, mut adaptive) = (parsed(text), 0);
        state(model);
        let mut memory = vec![0_u64; hysteron_adaptive_load_size(model) / 8];
        let (at, bytes) = (memory.as_mut_ptr().cast(), 8 * memory.len());
        // SAFETY: live memory of the size given.
        ok(unsafe {
            hysteron_adaptive_load_place(model, f64::NAN, null(), at, bytes, &mut adaptive)
        });
        learner(adaptive);
    }
    let model = parsed(PLAIN);
    for method in [HYSTERON_INCREMENTS, HYSTERON_LEAST_SQUARES] {
        // SAFETY: all fields are numbers.
        let (mut options, mut adaptive) = (unsafe { std::mem::zeroed() }, 0);
        // SAFETY: live memory of the sizes given.
        unsafe {
            ok(hysteron_adaptation_default(method, &mut options));
            let mut memory = vec![0_u64; hysteron_adaptive_size(model, &options) / 8];
            let (at, bytes) = (memory.as_mut_ptr().cast(), 8 * memory.len());
            ok(hysteron_adaptive_place(
                model,
                &options,
                at,
                bytes,
                &mut adaptive,
            ));
            learner(adaptive);
        }
    }
    let before = COUNT.get();
    parsed(PLAIN);
    assert!(COUNT.get() > before, "the counter counts");
}
