//! Models that learn.

use crate::fault::{Result, guard};
use crate::late;
use crate::learners::{LoadOfCaller, WeightsOfCaller};
use crate::memory::Size;
use crate::model::MODELS;
use crate::objects::{LEARNERS, Learns};
use crate::pointer::Arguments;
use crate::shift_options::{HysteronShift, HysteronShiftOptions};
use crate::types::given;
use crate::types::{self, HysteronAdaptation, HysteronLearning, status as status_constant};
use hysteron::{Adaptation, Adaptive, AdaptiveLoad, Model, Sample, Wanted};
use std::ffi::c_void;

/// Calls `work` with a learner, in a function without pointers.
fn with(adaptive: u64, work: impl FnOnce(&mut (dyn Learns + 'static)) -> Result<()>) -> Result<()> {
    LEARNERS.with(adaptive, "adaptive", &mut Arguments::default(), work)
}

/// Memory of a learner of weights, and of one of a load.
fn weights_size(model: &Model, options: Adaptation<f64>) -> Result<Size> {
    Ok(WeightsOfCaller::size(model, options.method)?.and(late::size(model)))
}

fn load_size(model: &Model) -> Size {
    LoadOfCaller::size(model).and(late::size(model))
}

impl Arguments {
    /// Options that may be null for the defaults.
    ///
    /// # Safety
    /// `options` is null or valid for a read.
    unsafe fn adaptation(&mut self, options: *const HysteronAdaptation) -> Result<Adaptation<f64>> {
        if options.is_null() {
            return Ok(Adaptation::default());
        }
        // SAFETY: the caller's promise; every bit pattern is a value of each field.
        unsafe { self.value(options, "options")? }.adaptation()
    }
}

/// Makes a model that adapts all weights of `model` and its offset. `options` may be null for the
/// defaults. All operators are off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_new(
    model: u64,
    options: *const HysteronAdaptation,
    adaptive: *mut u64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (out, options) = unsafe {
            (
                arguments.out(adaptive, "adaptive")?,
                arguments.adaptation(options)?,
            )
        };
        let model = MODELS.get(model, "model")?;
        let learner = Box::new(Adaptive::new(&model, options)?);
        out.set(LEARNERS.insert(late::learns(&model, learner).into())?);
        Ok(())
    })
}

/// Size in bytes of the memory of such a model, for `hysteron_adaptive_place`. 0 if there is none
/// for this model and these options.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_size(
    model: u64,
    options: *const HysteronAdaptation,
) -> usize {
    // SAFETY: the contract of the crate.
    let options = unsafe { Arguments::default().adaptation(options) };
    let size = |options: Adaptation<f64>| {
        let model = MODELS.get(model, "model")?;
        Ok(weights_size(&model, options)?.bytes())
    };
    options.and_then(size).unwrap_or(0)
}

/// As `hysteron_adaptive_new`, with all numbers in `memory` of the caller, as in
/// `hysteron_state_place`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_place(
    model: u64,
    options: *const HysteronAdaptation,
    memory: *mut c_void,
    bytes: usize,
    adaptive: *mut u64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (room, out, options) = unsafe {
            (
                arguments.room(memory, bytes)?,
                arguments.out(adaptive, "adaptive")?,
                arguments.adaptation(options)?,
            )
        };
        let model = MODELS.get(model, "model")?;
        let make = |lent: &mut _| -> Result<Box<dyn Learns>> {
            let learner = Box::new(WeightsOfCaller::new(&model, options, lent)?);
            Ok(late::learns_of_caller(&model, learner, lent))
        };
        let size = weights_size(&model, options)?;
        out.set(LEARNERS.place(room, size, make)?);
        Ok(())
    })
}

/// Makes a model that follows a load that nobody measures. It follows the shift of the axis alone;
/// the weights stay, or are those of the load that the shift tells.
///
/// `load` is the load to start at, `NAN` for the middle of the model's range. `options` may be null
/// for the usual ones (`hysteron_shift_usual`). All operators are off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_load_new(
    model: u64,
    load: f64,
    options: *const HysteronShiftOptions,
    adaptive: *mut u64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (out, options) = unsafe {
            (
                arguments.out(adaptive, "adaptive")?,
                arguments.shift_options(options)?,
            )
        };
        let model = MODELS.get(model, "model")?;
        let learner = Box::new(AdaptiveLoad::new(&model, given(load), options)?);
        out.set(LEARNERS.insert(late::learns(&model, learner).into())?);
        Ok(())
    })
}

/// Size in bytes of the memory of such a model, for `hysteron_adaptive_load_place`. 0 if there is
/// no such model.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_load_size(model: u64) -> usize {
    let model = MODELS.get(model, "model");
    model.map_or(0, |model| load_size(&model).bytes())
}

/// As `hysteron_adaptive_load_new`, with all numbers in `memory` of the caller, as in
/// `hysteron_state_place`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_load_place(
    model: u64,
    load: f64,
    options: *const HysteronShiftOptions,
    memory: *mut c_void,
    bytes: usize,
    adaptive: *mut u64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (room, out, options) = unsafe {
            (
                arguments.room(memory, bytes)?,
                arguments.out(adaptive, "adaptive")?,
                arguments.shift_options(options)?,
            )
        };
        let model = MODELS.get(model, "model")?;
        let make = |lent: &mut _| -> Result<Box<dyn Learns>> {
            let learner = Box::new(LoadOfCaller::new(&model, given(load), options, lent)?);
            Ok(late::learns_of_caller(&model, learner, lent))
        };
        out.set(LEARNERS.place(room, load_size(&model), make)?);
        Ok(())
    })
}

/// Frees a learner of either kind. Memory of the caller stays the caller's.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_free(adaptive: u64) -> i32 {
    guard(|| LEARNERS.remove(adaptive, "adaptive"))
}

/// Moves to `input`, predicts the output there, and learns from the output `measured`. `dt` is as
/// for `hysteron_step_in`; without stages it has no effect. After an error nothing has changed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_step(
    adaptive: u64,
    input: f64,
    dt: f64,
    measured: f64,
    learning: *mut HysteronLearning,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let learning = unsafe { arguments.out(learning, "learning")? };
        LEARNERS.with(adaptive, "adaptive", &mut arguments, |learner| {
            learning.set(learner.step(sample(input, dt), measured)?.into());
            Ok(())
        })
    })
}

/// Moves to `input` and writes the output predicted there, without learning.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_simulate(
    adaptive: u64,
    input: f64,
    dt: f64,
    output: *mut f64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let output = unsafe { arguments.out(output, "output")? };
        LEARNERS.with(adaptive, "adaptive", &mut arguments, |learner| {
            output.set(learner.simulate(sample(input, dt))?);
            Ok(())
        })
    })
}

/// As `hysteron_inverse_step_in`, with what was learned. The inverse has a state of its own,
/// separate from the state that follows the plant. It starts with all operators off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_inverse_step(
    adaptive: u64,
    target: f64,
    heading: i32,
    tolerance: f64,
    dt: f64,
    input: *mut f64,
    status: *mut i32,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (input, status) = unsafe {
            (
                arguments.out(input, "input")?,
                arguments.out(status, "status")?,
            )
        };
        let wanted = Wanted {
            dt: given(dt),
            ..types::target(target, heading, tolerance)?.into()
        };
        LEARNERS.with(adaptive, "adaptive", &mut arguments, |learner| {
            let solution = learner.solve(wanted)?;
            input.set(solution.input);
            status.set(status_constant(solution.status));
            Ok(())
        })
    })
}

/// Makes a model with what was learned: with the present weights and offset, or with the present
/// shift, which depends on no load. Free it with `hysteron_model_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_model(adaptive: u64, model: *mut u64) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let model = unsafe { arguments.out(model, "model")? };
        LEARNERS.with(adaptive, "adaptive", &mut arguments, |learner| {
            model.set(MODELS.insert(learner.model()?)?);
            Ok(())
        })
    })
}

/// Writes the shift of a learner of `hysteron_adaptive_load_new`, and the load that it tells.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_shift(adaptive: u64, shift: *mut HysteronShift) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let shift = unsafe { arguments.out(shift, "shift")? };
        LEARNERS.with(adaptive, "adaptive", &mut arguments, |learner| {
            shift.set(learner.shift()?);
            Ok(())
        })
    })
}

/// Switches all operators off, those of the inverse too. What was learned stays.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_reset(adaptive: u64) -> i32 {
    guard(|| with(adaptive, |learner| learner.reset()))
}

/// Sets the state of the inverse to that of the measured input.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_align(adaptive: u64) -> i32 {
    guard(|| with(adaptive, |learner| learner.align()))
}

/// Stops learning (`frozen` not 0), or resumes it (0).
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_freeze(adaptive: u64, frozen: i32) -> i32 {
    guard(|| {
        with(adaptive, |learner| {
            learner.freeze(frozen != 0);
            Ok(())
        })
    })
}

/// Takes the present weights of a learner of `hysteron_adaptive_new` as the last good ones.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_keep(adaptive: u64) -> i32 {
    guard(|| with(adaptive, |learner| learner.keep()))
}

/// Returns to the last good weights, of a learner of `hysteron_adaptive_new`.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_roll_back(adaptive: u64) -> i32 {
    guard(|| with(adaptive, |learner| learner.roll_back()))
}

fn sample(input: f64, dt: f64) -> Sample {
    Sample {
        dt: given(dt),
        ..input.into()
    }
}
