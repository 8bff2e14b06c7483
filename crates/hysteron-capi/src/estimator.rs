//! Adaptation in memory of the caller.

use crate::fault::guard_plain;
use crate::memory::{HysteronCoreModel, HysteronCoreState};
use crate::pointer::Arguments;
use crate::room::{Kind, size};
use crate::types::{HysteronAdaptation, HysteronLearning};
use hysteron_core::{Estimator, MAX_LEVELS, estimator_len};
use std::ffi::c_void;

/// An estimator in the caller's memory.
pub struct HysteronCoreEstimator(());

impl Kind for HysteronCoreEstimator {
    const MARK: u64 = 0x6879_7374_6573_7469;
    type Content = Estimator<f64, &'static mut [f64]>;
}

/// Size in bytes of an estimator for a model with `levels` levels. 0 if there is no such estimator.
/// The memory has to be aligned like a `uint64_t`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_estimator_size(
    levels: usize,
    options: *const HysteronAdaptation,
) -> usize {
    // SAFETY: the contract of the crate; every bit pattern is a value of each field.
    let options = unsafe { Arguments::default().value(options, "options") };
    match options.and_then(|options| options.adaptation()) {
        Ok(options) if (2..=MAX_LEVELS).contains(&levels) => {
            let count = estimator_len(levels, options.method);
            size::<HysteronCoreEstimator, f64>(count).unwrap_or(0)
        }
        _ => 0,
    }
}

/// Makes an estimator of all weights of `model` and of an offset. It starts from the weights and
/// the offset given, and writes these weights to the model. Make states after this call, or bring
/// older ones up to date with `hysteron_core_state_rebase`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_estimator_init(
    model: *mut HysteronCoreModel,
    options: *const HysteronAdaptation,
    weights: *const f64,
    count: usize,
    offset: f64,
    memory: *mut c_void,
    bytes: usize,
    estimator: *mut *mut HysteronCoreEstimator,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate; every bit pattern is a value of each field of the
        // options.
        let (model, options, weights, room, out) = unsafe {
            (
                arguments.object(model, "model")?,
                arguments.value(options, "options")?,
                arguments.array(weights, count, "weights")?,
                arguments.room(memory, bytes)?,
                arguments.out(estimator, "estimator")?,
            )
        };
        let options = options.adaptation()?;
        let numbers = estimator_len(model.plane().levels(), options.method);
        room.fill(numbers, &out, |numbers| {
            Ok(Estimator::new(options, model, weights, offset, numbers)?)
        })
    })
}

/// Moves `state` to `input`, predicts the output with the present weights and offset, and learns
/// from the output `measured`. `state` is brought up to date with the weights. Other states of this
/// model are refused until `hysteron_core_state_rebase` brings them up to date.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_estimator_step(
    estimator: *mut HysteronCoreEstimator,
    model: *mut HysteronCoreModel,
    state: *mut HysteronCoreState,
    input: f64,
    measured: f64,
    learning: *mut HysteronLearning,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (estimator, model, state, learning) = unsafe {
            (
                arguments.object(estimator, "estimator")?,
                arguments.object(model, "model")?,
                arguments.object(state, "state")?,
                arguments.out(learning, "learning")?,
            )
        };
        learning.set(estimator.step(model, state, input, measured)?.into());
        Ok(())
    })
}

/// Writes the present offset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_estimator_offset(
    estimator: *const HysteronCoreEstimator,
    offset: *mut f64,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (estimator, offset) = unsafe {
            (
                arguments.object_ref(estimator, "estimator")?,
                arguments.out(offset, "offset")?,
            )
        };
        offset.set(estimator.offset());
        Ok(())
    })
}

/// Stops learning (`frozen` not 0), or resumes it (0).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_estimator_freeze(
    estimator: *mut HysteronCoreEstimator,
    frozen: i32,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        unsafe { Arguments::default().object(estimator, "estimator")? }.freeze(frozen != 0);
        Ok(())
    })
}

/// Brings a state of `model` up to date after an estimator changed the weights. An inverse that
/// runs beside the estimator needs it for its own state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_rebase(
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
        Ok(model.rebase(state)?)
    })
}
