//! Models that learn, by handle.

use crate::fault::{Result, guard};
use crate::handles::Table;
use crate::model::MODELS;
use crate::pointer::Arguments;
use crate::types::{self, HysteronAdaptation, HysteronLearning, status as status_constant};
use hysteron::{Adaptation, Adaptive};
use std::sync::{Mutex, PoisonError};

static LEARNERS: Table<Mutex<Adaptive>> = Table::new(3);

fn with(adaptive: u64, work: impl FnOnce(&mut Adaptive) -> Result<()>) -> Result<()> {
    let learner = LEARNERS.get(adaptive, "adaptive")?;
    let mut learner = learner.lock().unwrap_or_else(PoisonError::into_inner);
    work(&mut learner)
}

/// Makes a model that adapts all weights of `model` and its offset. `options` may be null for the
/// defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_new(
    model: u64,
    options: *const HysteronAdaptation,
    adaptive: *mut u64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let out = unsafe { arguments.out(adaptive, "adaptive")? };
        let options = if options.is_null() {
            Adaptation::default()
        } else {
            // SAFETY: the contract of the crate; every bit pattern is a value of each field.
            unsafe { arguments.value(options, "options")? }.adaptation()?
        };
        let model = MODELS.get(model, "model")?;
        // A step here has no time.
        if model.is_timed() {
            model.plain()?;
        }
        let adaptive = Adaptive::new(&model, options)?;
        out.set(LEARNERS.insert(Mutex::new(adaptive))?);
        Ok(())
    })
}

/// Frees the handle.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_free(adaptive: u64) -> i32 {
    guard(|| LEARNERS.remove(adaptive, "adaptive"))
}

/// Moves to `input`, predicts the output there, and learns from the output `measured`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_step(
    adaptive: u64,
    input: f64,
    measured: f64,
    learning: *mut HysteronLearning,
) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let learning = unsafe { Arguments::default().out(learning, "learning")? };
        with(adaptive, |learner| {
            learning.set(learner.step(input, measured)?.into());
            Ok(())
        })
    })
}

/// Moves to `input` and writes the output predicted there, without learning.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_simulate(
    adaptive: u64,
    input: f64,
    output: *mut f64,
) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let output = unsafe { Arguments::default().out(output, "output")? };
        with(adaptive, |learner| {
            output.set(learner.simulate(input)?);
            Ok(())
        })
    })
}

/// As `hysteron_inverse_step`, with the present weights. The inverse has a state of its own,
/// separate from the state that follows the plant. It starts with all operators off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_inverse_step(
    adaptive: u64,
    target: f64,
    heading: i32,
    tolerance: f64,
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
        let target = types::target(target, heading, tolerance)?;
        with(adaptive, |learner| {
            let solution = learner.solve(target)?;
            input.set(solution.input);
            status.set(status_constant(solution.status));
            Ok(())
        })
    })
}

/// Makes a model with the present weights and offset. Free it with `hysteron_model_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptive_model(adaptive: u64, model: *mut u64) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let model = unsafe { Arguments::default().out(model, "model")? };
        with(adaptive, |learner| {
            model.set(MODELS.insert(learner.model()?)?);
            Ok(())
        })
    })
}

/// Switches all operators off, those of the inverse too. The weights stay.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_reset(adaptive: u64) -> i32 {
    guard(|| with(adaptive, |learner| Ok(learner.reset()?)))
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

/// Takes the present weights as the last good ones.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_keep(adaptive: u64) -> i32 {
    guard(|| {
        with(adaptive, |learner| {
            learner.keep();
            Ok(())
        })
    })
}

/// Returns to the last good weights.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_adaptive_roll_back(adaptive: u64) -> i32 {
    guard(|| with(adaptive, |learner| Ok(learner.roll_back()?)))
}
