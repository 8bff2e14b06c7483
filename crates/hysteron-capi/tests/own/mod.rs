//! Operators and stages in memory of a program, from a model by handle.
#![allow(dead_code, reason = "not every test takes them all")]

use hysteron_capi::*;
use std::ffi::{CString, c_void};
use std::mem::zeroed;
use std::ptr::null_mut;

pub const NONE: f64 = f64::NAN;

pub fn ok(code: i32) {
    assert_eq!(code, HYSTERON_OK);
}

/// Operators and stages of a model by handle, in memory of this program.
pub struct Own {
    pub handle: u64,
    pub memory: [Vec<u64>; 3],
    pub model: *mut HysteronCoreModel,
    pub state: *mut HysteronCoreState,
    pub stages: *mut HysteronCoreStages,
    pub past: HysteronStageState,
}

pub fn constants(handle: u64) -> HysteronStages {
    // SAFETY: all fields are numbers, or pointers that may be null.
    let mut constants: HysteronStages = unsafe { zeroed() };
    // SAFETY: live memory.
    ok(unsafe { hysteron_model_stages(handle, &mut constants) });
    constants
}

pub fn parsed(text: &str) -> u64 {
    let (text, mut handle) = (CString::new(text).unwrap(), 0);
    // SAFETY: live memory.
    ok(unsafe { hysteron_model_parse(text.as_ptr(), &mut handle) });
    handle
}

impl Own {
    pub fn new(handle: u64) -> Self {
        let mut own = Self {
            handle,
            memory: [const { Vec::new() }; 3],
            model: null_mut(),
            state: null_mut(),
            stages: null_mut(),
            past: HysteronStageState::default(),
        };
        let constants = constants(handle);
        // SAFETY: live memory of the sizes given.
        unsafe {
            let mut info: HysteronModelInfo = zeroed();
            ok(hysteron_model_info(handle, &mut info));
            let mut weights = vec![0.0; info.weights];
            let (mut count, at) = (0, weights.as_mut_ptr());
            ok(hysteron_model_weights(handle, at, info.weights, &mut count));
            let sizes = [
                hysteron_core_model_size(info.levels, 1),
                hysteron_core_state_size(info.levels),
                hysteron_core_stages_size(&constants),
            ];
            own.memory = sizes.map(|bytes| vec![0; bytes / 8]);
            let [model, state, stages] = own.places();
            ok(hysteron_core_model_init(
                model,
                sizes[0],
                info.operator_kind,
                info.min,
                info.max,
                info.levels,
                weights.as_ptr(),
                count,
                &mut own.model,
            ));
            ok(hysteron_core_state_init(
                own.model,
                state,
                sizes[1],
                &mut own.state,
            ));
            ok(hysteron_core_stages_init(
                own.model,
                &constants,
                stages,
                sizes[2],
                &mut own.stages,
            ));
        }
        own
    }

    pub fn places(&mut self) -> [*mut c_void; 3] {
        self.memory
            .each_mut()
            .map(|memory| memory.as_mut_ptr().cast())
    }

    pub fn step(&mut self, input: f64, dt: f64, load: f64) -> (i32, f64) {
        let mut output = 7.0;
        // SAFETY: live memory.
        let code = unsafe {
            hysteron_core_stages_step(
                self.stages,
                self.model,
                self.state,
                &mut self.past,
                input,
                dt,
                load,
                &mut output,
                null_mut(),
            )
        };
        (code, output)
    }

    pub fn invert(
        &mut self,
        target: f64,
        dt: f64,
        load: f64,
        limits: *const HysteronLimits,
    ) -> (i32, f64, i32) {
        let (mut input, mut status) = (7.0, 7);
        // SAFETY: live memory.
        let code = unsafe {
            hysteron_core_stages_inverse_step(
                self.stages,
                self.model,
                self.state,
                &mut self.past,
                target,
                HYSTERON_HOLD,
                0.0,
                dt,
                load,
                limits,
                &mut input,
                &mut status,
            )
        };
        (code, input, status)
    }
}
