//! The functions over memory of the caller allocate nothing, with success and with errors.
#![allow(clippy::unwrap_used)]

use hysteron_capi::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ptr::null_mut;

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

const LEVELS: usize = 5;

/// All functions, for one method. Each pointer is to memory of this function.
fn work(method: i32, memory: &mut [Vec<u64>; 3]) {
    let weights = [1.0; LEVELS * (LEVELS + 1) / 2];
    let [model_memory, state_memory, estimator_memory] = memory
        .each_mut()
        .map(|m| (m.as_mut_ptr().cast(), 8 * m.len()));
    let (mut model, mut state, mut estimator) = (null_mut(), null_mut(), null_mut());
    let (mut output, mut input, mut status, mut count) = (0.0, 0.0, 0, 0);
    let (mut points, mut outputs) = ([0.0; 64], [0.0; 2]);
    let mut learning = HysteronLearning {
        output: 0.0,
        error: 0.0,
        outcome: 0,
        clipped: 0,
    };
    let n = weights.len();
    // SAFETY: all pointers are to live memory of the sizes given.
    unsafe {
        let mut options = std::mem::zeroed();
        assert_eq!(hysteron_adaptation_default(method, &mut options), 0);
        let (at, bytes) = model_memory;
        assert_eq!(
            hysteron_core_model_init(
                at,
                bytes,
                HYSTERON_MKP,
                20.0,
                80.0,
                LEVELS,
                weights.as_ptr(),
                n,
                &mut model
            ),
            0
        );
        let (at, bytes) = estimator_memory;
        assert_eq!(
            hysteron_core_estimator_init(
                model,
                &options,
                weights.as_ptr(),
                n,
                0.0,
                at,
                bytes,
                &mut estimator
            ),
            0
        );
        let (at, bytes) = state_memory;
        assert_eq!(hysteron_core_state_init(model, at, bytes, &mut state), 0);
        for step in 0..200 {
            let x = 50.0 + 40.0 * (0.1 * f64::from(step)).sin();
            assert_eq!(
                hysteron_core_step(model, state, x, &mut output, null_mut()),
                0
            );
            assert_eq!(
                hysteron_core_estimator_step(estimator, model, state, x, 0.1 * x, &mut learning),
                0
            );
            let hold = HYSTERON_HOLD;
            assert_eq!(
                hysteron_core_inverse_step(model, state, 5.0, hold, 0.0, &mut input, &mut status),
                0
            );
        }
        let inputs = [30.0, 40.0];
        assert_eq!(
            hysteron_core_run(model, state, inputs.as_ptr(), outputs.as_mut_ptr(), 2),
            0
        );
        assert_eq!(
            hysteron_core_state_save(state, points.as_mut_ptr(), 64, &mut count, &mut input),
            0
        );
        assert_eq!(
            hysteron_core_state_restore(model, state, points.as_ptr(), count, input),
            0
        );
        assert_eq!(
            hysteron_core_step(model, state, f64::NAN, &mut output, null_mut()),
            HYSTERON_INPUT_NOT_FINITE
        );
        assert_eq!(
            hysteron_core_step(null_mut(), state, 0.0, &mut output, null_mut()),
            HYSTERON_NULL
        );
        assert_eq!(
            hysteron_core_state_save(state, null_mut(), 0, &mut count, &mut input),
            HYSTERON_MEMORY_TOO_SMALL
        );
    }
}

/// The stages around the operators: a lag and a load.
fn stages(memory: &mut [Vec<u64>; 3]) {
    let weights = [1.0; LEVELS * (LEVELS + 1) / 2];
    let loads = [1.0, 2.0];
    let [model_memory, state_memory, stages_memory] = memory
        .each_mut()
        .map(|m| (m.as_mut_ptr().cast(), 8 * m.len()));
    let (mut model, mut state, mut stages) = (null_mut(), null_mut(), null_mut());
    let (mut output, mut input, mut status) = (0.0, 0.0, 0);
    let mut past = HysteronStageState::default();
    let (n, at) = (weights.len(), weights.as_ptr());
    // SAFETY: all pointers are to live memory of the sizes given.
    unsafe {
        let (place, bytes) = model_memory;
        let kind = HYSTERON_MKP;
        let code =
            hysteron_core_model_init(place, bytes, kind, 20.0, 80.0, LEVELS, at, n, &mut model);
        assert_eq!(code, 0);
        let (place, bytes) = state_memory;
        let code = hysteron_core_state_init(model, place, bytes, &mut state);
        assert_eq!(code, 0);
        let mut constants: HysteronStages = std::mem::zeroed();
        constants.sign = 1;
        for (place, (name, numbers)) in constants
            .constants
            .iter_mut()
            .zip([(c"lag", &[0.5][..]), (c"loads", &loads)])
        {
            *place = HysteronConstant {
                name: name.as_ptr(),
                numbers: numbers.as_ptr(),
                count: numbers.len(),
            };
        }
        let (place, bytes) = stages_memory;
        let code = hysteron_core_stages_init(model, &constants, place, bytes, &mut stages);
        assert_eq!(code, 0);
        for (dt, load, expected) in [
            (0.1, 1.5, HYSTERON_OK),
            (-0.1, 1.5, HYSTERON_TIME_STEP),
            (0.1, f64::NAN, HYSTERON_LOAD),
        ] {
            let memory = &mut past;
            let code = hysteron_core_stages_step(
                stages,
                model,
                state,
                memory,
                50.0,
                dt,
                load,
                &mut output,
                null_mut(),
            );
            assert_eq!(code, expected);
            let code = hysteron_core_stages_inverse_step(
                stages,
                model,
                state,
                memory,
                5.0,
                HYSTERON_HOLD,
                0.0,
                dt,
                load,
                std::ptr::null(),
                &mut input,
                &mut status,
            );
            assert_eq!(code, expected);
        }
    }
}

#[test]
fn nothing_is_allocated_over_the_callers_memory() {
    for method in [HYSTERON_INCREMENTS, HYSTERON_LEAST_SQUARES] {
        // SAFETY: all fields are numbers.
        let mut options = unsafe { std::mem::zeroed() };
        // SAFETY: a live structure.
        let sizes = unsafe {
            assert_eq!(hysteron_adaptation_default(method, &mut options), 0);
            [
                hysteron_core_model_size(LEVELS, 2),
                hysteron_core_state_size(LEVELS),
                hysteron_core_estimator_size(LEVELS, &options),
            ]
        };
        let mut memory = sizes.map(|bytes| vec![0_u64; bytes / 8]);
        let before = COUNT.get();
        work(method, &mut memory);
        stages(&mut memory);
        assert_eq!(COUNT.get(), before);
    }
    let before = COUNT.get();
    // SAFETY: no pointer but null.
    let code = unsafe { hysteron_model_parse(c"{}".as_ptr(), null_mut()) };
    assert_eq!(code, HYSTERON_NULL);
    assert!(
        COUNT.get() > before,
        "the counter counts: this form leaves a text"
    );
}
