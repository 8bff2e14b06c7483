//! Models and states in memory of the caller. Nothing is allocated.
//!
//! An object lies at the beginning of its memory, followed by its numbers. It must not be moved,
//! and it is gone when the memory is. Where an initialisation fails in memory that has an object,
//! that object either stays as it is or is refused from then on (`HYSTERON_HANDLE`). Outputs are
//! `Σ μ γ` of the operators, without offset and sign. Only one thread at a time may use an object
//! that is changed: a state, model and estimator while weights are learned, and model and stages
//! whose weights depend on the load.

use crate::fault::guard_plain;
use crate::pointer::Arguments;
use crate::room::{Kind, size};
use crate::types::{self, clipped as clipped_constant, operator, status as status_constant};
use hysteron_core::{MAX_LEVELS, Model, Plane, State, Turn, table_len, turn_capacity};
use std::ffi::c_void;

/// A model in the caller's memory.
pub struct HysteronCoreModel(());

/// A state in the caller's memory.
pub struct HysteronCoreState(());

impl Kind for HysteronCoreModel {
    const MARK: u64 = 0x6879_7374_6d6f_646c;
    type Content = Model<f64, &'static mut [f64]>;
}

impl Kind for HysteronCoreState {
    const MARK: u64 = 0x6879_7374_7374_6174;
    type Content = State<f64, &'static mut [Turn<f64>]>;
}

/// Size in bytes of a model with `levels` levels and `tables` tables: 1, or 2 for adaptation by
/// increments. 0 if there is no such model. The memory has to be aligned like a `uint64_t`.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_core_model_size(levels: usize, tables: usize) -> usize {
    if !(2..=MAX_LEVELS).contains(&levels) || !(1..=2).contains(&tables) {
        return 0;
    }
    size::<HysteronCoreModel, f64>(tables * table_len(levels)).unwrap_or(0)
}

/// Makes a model in `memory`. Weights are as for `hysteron_model_new`; they are copied.
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
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (room, weights, out) = unsafe {
            (
                arguments.room(memory, bytes)?,
                arguments.array(weights, count, "weights")?,
                arguments.out(model, "model")?,
            )
        };
        let (plane, operator) = (Plane::new(min, max, levels)?, operator(operator_kind)?);
        let two = hysteron_core_model_size(levels, 2);
        let tables = if two != 0 && bytes >= two { 2 } else { 1 };
        room.fill(tables * table_len(levels), &out, |table| {
            Ok(Model::new(plane, operator, weights, table)?)
        })
    })
}

/// Size in bytes of a state of a model with `levels` levels. 0 if there is no such model. The
/// memory has to be aligned like a `uint64_t`.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_core_state_size(levels: usize) -> usize {
    if !(2..=MAX_LEVELS).contains(&levels) {
        return 0;
    }
    size::<HysteronCoreState, Turn<f64>>(turn_capacity(levels)).unwrap_or(0)
}

/// Makes a state of `model` in `memory`, with all operators off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_init(
    model: *const HysteronCoreModel,
    memory: *mut c_void,
    bytes: usize,
    state: *mut *mut HysteronCoreState,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (model, room, out) = unsafe {
            (
                arguments.object_ref(model, "model")?,
                arguments.room(memory, bytes)?,
                arguments.out(state, "state")?,
            )
        };
        room.fill(turn_capacity(model.plane().levels()), &out, |turns| {
            Ok(model.state(turns)?)
        })
    })
}

/// Switches all operators off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_reset(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe {
            (
                arguments.object_ref(model, "model")?,
                arguments.object(state, "state")?,
            )
        };
        Ok(model.reset_off(state)?)
    })
}

/// Moves to `input` and writes the output `Σ μ γ`. `clipped` may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_step(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    input: f64,
    output: *mut f64,
    clipped: *mut i32,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (model, state, output, clipped) = unsafe {
            (
                arguments.object_ref(model, "model")?,
                arguments.object(state, "state")?,
                arguments.out(output, "output")?,
                arguments.optional(clipped, "clipped")?,
            )
        };
        let step = model.step(state, input)?;
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
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (model, state, input, mut output) = unsafe {
            (
                arguments.object_ref(model, "model")?,
                arguments.object(state, "state")?,
                arguments.array(input, count, "input")?,
                arguments.array_out(output, count, "output")?,
            )
        };
        model.run(state, input, output.zeros())?;
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
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (model, state, input, status) = unsafe {
            (
                arguments.object_ref(model, "model")?,
                arguments.object(state, "state")?,
                arguments.out(input, "input")?,
                arguments.out(status, "status")?,
            )
        };
        let target = types::target(target, heading, tolerance)?;
        let solution = model.inverse()?.step(state, target)?;
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
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (state, points, count, input) = unsafe {
            (
                arguments.object_ref(state, "state")?,
                arguments.array_out(points, capacity, "points")?,
                arguments.out(count, "count")?,
                arguments.out(input, "input")?,
            )
        };
        points.write_all(state.turning_points(), state.held() + 1, &count)?;
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
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (model, state, points) = unsafe {
            (
                arguments.object_ref(model, "model")?,
                arguments.object(state, "state")?,
                arguments.array(points, count, "points")?,
            )
        };
        Ok(model.restore(state, points, input)?)
    })
}
