//! Models that follow a load that nobody measures, by handle.

use crate::fault::{Result, guard};
use crate::handles::Table;
use crate::model::MODELS;
use crate::pointer::Arguments;
use crate::shift_options::HysteronShiftOptions;
use crate::surroundings::given;
use crate::types::{self, HysteronLearning, status as status_constant};
use hysteron::{AdaptiveLoad, Sample, Wanted};
use std::sync::{Mutex, PoisonError};

static FOLLOWERS: Table<Mutex<AdaptiveLoad>> = Table::new(4);

fn with(adaptive: u64, work: impl FnOnce(&mut AdaptiveLoad) -> Result<()>) -> Result<()> {
    let follower = FOLLOWERS.get(adaptive, "adaptive_load")?;
    let mut follower = follower.lock().unwrap_or_else(PoisonError::into_inner);
    work(&mut follower)
}

/// What the estimator of the shift found.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronShift {
    /// The shift of the axis from the load that it departs from, in the unit of the temperature.
    pub shift: f64,
    /// Standard deviation of the shift, as the filter believes it.
    pub deviation: f64,
    /// The load that the shift tells. `NAN` for a model whose shift says nothing of the load.
    /// Beyond the model's loads it is the outermost one.
    pub load: f64,
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
    adaptive_load: *mut u64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (out, options) = unsafe {
            (
                arguments.out(adaptive_load, "adaptive_load")?,
                arguments.shift_options(options)?,
            )
        };
        let model = MODELS.get(model, "model")?;
        let follower = AdaptiveLoad::new(&model, given(load), options)?;
        out.set(FOLLOWERS.insert(Mutex::new(follower))?);
        Ok(())
    })
}

/// Frees the handle.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_load_free(adaptive_load: u64) -> i32 {
    guard(|| FOLLOWERS.remove(adaptive_load, "adaptive_load"))
}

/// Moves to `input`, predicts the output there, and learns from the output `measured`. `dt` is as
/// for `hysteron_step_in`. After an error nothing has changed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_load_step(
    adaptive_load: u64,
    input: f64,
    dt: f64,
    measured: f64,
    learning: *mut HysteronLearning,
) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let learning = unsafe { Arguments::default().out(learning, "learning")? };
        with(adaptive_load, |follower| {
            learning.set(follower.step(sample(input, dt), measured)?.into());
            Ok(())
        })
    })
}

/// Moves to `input` and writes the output predicted there, without learning.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_load_simulate(
    adaptive_load: u64,
    input: f64,
    dt: f64,
    output: *mut f64,
) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let output = unsafe { Arguments::default().out(output, "output")? };
        with(adaptive_load, |follower| {
            output.set(follower.simulate(sample(input, dt))?);
            Ok(())
        })
    })
}

/// As `hysteron_inverse_step_in`, at the present shift. The inverse has a state of its own, separate
/// from the state that follows the plant.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_load_inverse_step(
    adaptive_load: u64,
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
        with(adaptive_load, |follower| {
            let solution = follower.solve(wanted)?;
            input.set(solution.input);
            status.set(status_constant(solution.status));
            Ok(())
        })
    })
}

/// Writes the shift, and the load that it tells.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_load_shift(
    adaptive_load: u64,
    shift: *mut HysteronShift,
) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let shift = unsafe { Arguments::default().out(shift, "shift")? };
        with(adaptive_load, |follower| {
            shift.set(HysteronShift {
                shift: follower.shift(),
                deviation: follower.deviation(),
                load: follower.load().unwrap_or(f64::NAN),
            });
            Ok(())
        })
    })
}

/// Makes a model with the present shift, which depends on no load. Free it with
/// `hysteron_model_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_load_model(adaptive_load: u64, model: *mut u64) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let model = unsafe { Arguments::default().out(model, "model")? };
        with(adaptive_load, |follower| {
            model.set(MODELS.insert(follower.model()?)?);
            Ok(())
        })
    })
}

/// Switches all operators off, those of the inverse too. The shift stays.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_load_reset(adaptive_load: u64) -> i32 {
    guard(|| {
        with(adaptive_load, |follower| {
            follower.reset();
            Ok(())
        })
    })
}

/// Sets the state of the inverse to that of the measured input.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_load_align(adaptive_load: u64) -> i32 {
    guard(|| {
        with(adaptive_load, |follower| {
            follower.align();
            Ok(())
        })
    })
}

/// Stops learning (`frozen` not 0), or resumes it (0).
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_load_freeze(adaptive_load: u64, frozen: i32) -> i32 {
    guard(|| {
        with(adaptive_load, |follower| {
            follower.freeze(frozen != 0);
            Ok(())
        })
    })
}

fn sample(input: f64, dt: f64) -> Sample {
    Sample {
        dt: given(dt),
        ..input.into()
    }
}
