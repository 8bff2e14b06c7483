//! The whole signal path in memory of the caller: the stages around the operators.

use crate::fault::{Result, guard_plain};
use crate::limits::HysteronLimits;
use crate::memory::{HysteronCoreModel, HysteronCoreState};
use crate::pointer::Arguments;
use crate::room::{Kind, size};
use crate::stage_state::HysteronStageState;
use crate::stages::{HysteronStages, copied, numbers};
use crate::surroundings::given;
use crate::types::{self, clipped as clipped_constant, status as status_constant};
use hysteron_core::{Error, Model, Sample, Stages, Wanted};
use std::ffi::c_void;

/// The stages around the operators, in the caller's memory.
pub struct HysteronCoreStages(());

impl Kind for HysteronCoreStages {
    const MARK: u64 = 0x6879_7374_7374_6167;
    type Content = Chain;
}

/// Stages that were checked for a plane of so many levels.
pub(crate) struct Chain {
    stages: Stages<'static, f64>,
    levels: usize,
}

impl Chain {
    fn of<C: AsRef<[f64]>>(&self, model: &Model<f64, C>) -> Result<&Stages<'static, f64>> {
        match model.plane().levels() == self.levels {
            true => Ok(&self.stages),
            false => Err(Error::StateMismatch.into()),
        }
    }
}

/// Size in bytes of stages with these constants. 0 if there are no such stages. The memory has to
/// be aligned like a `uint64_t`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_stages_size(stages: *const HysteronStages) -> usize {
    // SAFETY: the contract of the crate.
    let constants = unsafe { Arguments::default().stages(stages) };
    constants.map_or(0, |constants| {
        size::<HysteronCoreStages, f64>(numbers(&constants)).unwrap_or(0)
    })
}

/// Makes stages around the operators of `model` in `memory`. The constants are copied, with their
/// arrays. `HYSTERON_STAGE` for a constant out of its range. The stages may be used with every
/// model of as many levels.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_stages_init(
    model: *const HysteronCoreModel,
    constants: *const HysteronStages,
    memory: *mut c_void,
    bytes: usize,
    stages: *mut *mut HysteronCoreStages,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (model, room, out, constants) = unsafe {
            (
                arguments.object_ref(model, "model")?,
                arguments.room(memory, bytes)?,
                arguments.out(stages, "stages")?,
                arguments.stages(constants)?,
            )
        };
        constants.check(model)?;
        room.fill(numbers(&constants), &out, |place| {
            Ok(Chain {
                stages: copied(&constants, place),
                levels: model.plane().levels(),
            })
        })
    })
}

/// Moves by one sample and writes the output `y`, with offset and sign. `input`, `dt` and `load`
/// are as for `hysteron_step_in`; a load beyond the curves has their outermost values. `memory` is
/// what the stages remember, zeros before the first sample. `clipped` may be null. After an error
/// nothing has moved.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_stages_step(
    stages: *const HysteronCoreStages,
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    memory: *mut HysteronStageState,
    input: f64,
    dt: f64,
    load: f64,
    output: *mut f64,
    clipped: *mut i32,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate; every bit pattern is a value of each field.
        let (chain, model, state, (memory, after), output, clipped) = unsafe {
            (
                arguments.object_ref(stages, "stages")?,
                arguments.object_ref(model, "model")?,
                arguments.object(state, "state")?,
                arguments.replaced(memory, "memory")?,
                arguments.out(output, "output")?,
                arguments.optional(clipped, "clipped")?,
            )
        };
        let mut memory = memory.core()?;
        let (dt, load) = (given(dt), given(load));
        let sample = Sample { input, dt, load };
        let step = chain.of(model)?.step(model, state, &mut memory, sample)?;
        after.set(memory.to_numbers().into());
        output.set(step.output);
        if let Some(clipped) = clipped {
            clipped.set(clipped_constant(step.clipped));
        }
        Ok(())
    })
}

/// Finds the input for the output `target` and moves there. Arguments are as for
/// `hysteron_inverse_step_in`; `limits` may be null for none. After an error nothing has moved.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_stages_inverse_step(
    stages: *const HysteronCoreStages,
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    memory: *mut HysteronStageState,
    target: f64,
    heading: i32,
    tolerance: f64,
    dt: f64,
    load: f64,
    limits: *const HysteronLimits,
    input: *mut f64,
    status: *mut i32,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate; every bit pattern is a value of each field.
        let (chain, model, state, (memory, after), input, status, limits) = unsafe {
            (
                arguments.object_ref(stages, "stages")?,
                arguments.object_ref(model, "model")?,
                arguments.object(state, "state")?,
                arguments.replaced(memory, "memory")?,
                arguments.out(input, "input")?,
                arguments.out(status, "status")?,
                arguments.limits(limits)?,
            )
        };
        let mut memory = memory.core()?;
        let limits = limits.unwrap_or(HysteronLimits::NONE);
        let wanted = Wanted {
            target: types::target(target, heading, tolerance)?,
            dt: given(dt),
            load: given(load),
            drive: limits.drive(),
            horizon: limits.horizon,
            temperature: limits.temperature(),
        };
        let (stages, inverse) = (chain.of(model)?, model.inverse()?);
        let solution = stages.invert(&inverse, state, &mut memory, wanted)?;
        after.set(memory.to_numbers().into());
        input.set(solution.input);
        status.set(status_constant(solution.status));
        Ok(())
    })
}
