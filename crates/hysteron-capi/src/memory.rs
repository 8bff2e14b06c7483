//! Model and state over memory that the caller owns: nothing is allocated.
//!
//! An object lies at the beginning of its memory, with its numbers behind it. It must not be moved, and ends with the
//! memory. Outputs are `Σ μ γ` of the operators, without offset and sign. One thread at a time for each object
//! that is written to (a state; model and estimator while weights are learned).

use crate::fault::guard_plain;
use crate::pointer::{Out, apart, array, array_out, optional};
use crate::room::{Marked, Room, marked, object, object_ref, size};
use crate::types::{clipped as clipped_constant, operator, policy, status as status_constant};
use hysteron_core::{Error, MAX_LEVELS, Model, Plane, State, Turn, table_len, turn_capacity};
use std::ffi::c_void;

/// A model in the caller's memory.
pub struct HysteronCoreModel {
    mark: u64,
    pub(crate) model: Model<f64, &'static mut [f64]>,
}

/// A state in the caller's memory.
pub struct HysteronCoreState {
    mark: u64,
    pub(crate) state: State<f64, &'static mut [Turn<f64>]>,
}

marked!(HysteronCoreModel, 0x6879_7374_6d6f_646c);
marked!(HysteronCoreState, 0x6879_7374_7374_6174);

/// Bytes for a model of `levels` levels with 1 table, or with the 2 that adaptation by increments needs; 0 where there is no
/// such model. The memory has to be aligned as a `uint64_t` is.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_core_model_size(levels: usize, tables: usize) -> usize {
    if !(2..=MAX_LEVELS).contains(&levels) || !(1..=2).contains(&tables) {
        return 0;
    }
    size::<HysteronCoreModel, f64>(tables * table_len(levels)).unwrap_or(0)
}

/// Makes a model in `memory`; the weights as for `hysteron_model_new`, and not needed afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_model_init(
    memory: *mut c_void,
    bytes: usize,
    operator_kind: i32,
    min: f64,
    max: f64,
    levels: usize,
    weights: *const f64,
    count: usize,
    model: *mut *mut HysteronCoreModel,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (weights, out) =
            unsafe { (array(weights, count, "weights")?, Out::new(model, "model")?) };
        let (plane, operator) = (Plane::new(min, max, levels)?, operator(operator_kind)?);
        let two = hysteron_core_model_size(levels, 2);
        let tables = if two != 0 && bytes >= two { 2 } else { 1 };
        // SAFETY: the contract of the crate.
        let (room, table) = unsafe { Room::cut(memory, bytes, tables * table_len(levels))? };
        let model = Model::new(plane, operator, weights, table)?;
        let mark = HysteronCoreModel::MARK;
        room.finish(HysteronCoreModel { mark, model }, &out);
        Ok(())
    })
}

/// Bytes for a state of a model of `levels` levels; 0 where there is no such model. Aligned as a `uint64_t` is.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_core_state_size(levels: usize) -> usize {
    if !(2..=MAX_LEVELS).contains(&levels) {
        return 0;
    }
    size::<HysteronCoreState, Turn<f64>>(turn_capacity(levels)).unwrap_or(0)
}

/// Makes a state of `model` in `memory`, all operators off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_init(
    model: *const HysteronCoreModel,
    memory: *mut c_void,
    bytes: usize,
    state: *mut *mut HysteronCoreState,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, out) = unsafe {
            (
                &object_ref(model, "model")?.model,
                Out::new(state, "state")?,
            )
        };
        // SAFETY: the contract of the crate.
        let (room, turns) =
            unsafe { Room::cut(memory, bytes, turn_capacity(model.plane().levels()))? };
        let state = model.state(turns)?;
        let mark = HysteronCoreState::MARK;
        room.finish(HysteronCoreState { mark, state }, &out);
        Ok(())
    })
}

/// All operators off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_reset(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe { (object_ref(model, "model")?, object(state, "state")?) };
        Ok(model.model.reset_off(&mut state.state)?)
    })
}

/// Moves to `input` and gives `Σ μ γ`; `clipped` may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_step(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    input: f64,
    output: *mut f64,
    clipped: *mut i32,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe { (object_ref(model, "model")?, object(state, "state")?) };
        // SAFETY: the contract of the crate.
        let (output, clipped) =
            unsafe { (Out::new(output, "output")?, optional(clipped, "clipped")?) };
        let step = model.model.step(&mut state.state, input)?;
        output.set(step.output);
        if let Some(clipped) = clipped {
            clipped.set(clipped_constant(step.clipped));
        }
        Ok(())
    })
}

/// As `hysteron_run`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_run(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    input: *const f64,
    output: *mut f64,
    count: usize,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe { (object_ref(model, "model")?, object(state, "state")?) };
        if count > 0 {
            apart(input, output, count, "output")?;
        }
        // SAFETY: the contract of the crate, and apart as checked.
        let (input, output) = unsafe {
            (
                array(input, count, "input")?,
                array_out(output, count, "output")?,
            )
        };
        model.model.run(&mut state.state, input, output)?;
        Ok(())
    })
}

/// As `hysteron_inverse_step`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_inverse_step(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    target: f64,
    heading: i32,
    tolerance: f64,
    input: *mut f64,
    status: *mut i32,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe { (object_ref(model, "model")?, object(state, "state")?) };
        // SAFETY: the contract of the crate.
        let (input, status) = unsafe { (Out::new(input, "input")?, Out::new(status, "status")?) };
        let policy = policy(heading, tolerance)?;
        let solution = model
            .model
            .inverse()?
            .step(&mut state.state, target, policy)?;
        input.set(solution.input);
        status.set(status_constant(solution.status));
        Ok(())
    })
}

/// As `hysteron_state_save`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_save(
    state: *const HysteronCoreState,
    points: *mut f64,
    capacity: usize,
    count: *mut usize,
    input: *mut f64,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (count, input) = unsafe { (Out::new(count, "count")?, Out::new(input, "input")?) };
        // SAFETY: the contract of the crate.
        let state = unsafe { &object_ref(state, "state")?.state };
        let needed = state.held() + 1;
        count.set(needed);
        if capacity < needed {
            return Err(Error::MemoryTooSmall {
                needed,
                found: capacity,
            }
            .into());
        }
        // SAFETY: the contract of the crate, and no more than the capacity.
        let points = unsafe { array_out(points, needed, "points")? };
        points
            .iter_mut()
            .zip(state.turning_points())
            .for_each(|(to, x)| *to = x);
        input.set(state.input());
        Ok(())
    })
}

/// As `hysteron_state_restore`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_restore(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    points: *const f64,
    count: usize,
    input: f64,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe { (object_ref(model, "model")?, object(state, "state")?) };
        // SAFETY: the contract of the crate.
        let points = unsafe { array(points, count, "points")? };
        Ok(model.model.restore(&mut state.state, points, input)?)
    })
}
