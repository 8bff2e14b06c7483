//! The whole signal path in memory of the caller: the stages around the operators.

use crate::fault::{Result, guard_plain};
use crate::limits::HysteronLimits;
use crate::memory::{HysteronCoreModel, HysteronCoreState};
use crate::parts::{ByLoad, GivenParts};
use crate::pointer::Arguments;
use crate::room::{Kind, Object, size};
use crate::stage_state::HysteronStageState;
use crate::stages::{HysteronStages, StageArguments, copied, numbers};
use crate::surroundings::given;
use crate::types::{self, clipped as clipped_constant, status as status_constant};
use hysteron_core::{Error, Sample, Stages, Wanted, operator_count};
use std::ffi::c_void;

/// The stages around the operators, in the caller's memory.
pub struct HysteronCoreStages(());

impl Kind for HysteronCoreStages {
    const MARK: u64 = 0x6879_7374_7374_6167;
    type Content = Chain;
}

/// Stages that were checked for a plane of so many levels.
pub(crate) struct Chain {
    pub(crate) stages: Stages<'static, f64>,
    levels: usize,
    by_load: Option<ByLoad>,
}

/// Brings the operators to a load, where their weights depend on it. Returns the stages with the
/// offset at that load.
///
/// A model whose weights do not depend on the load is only read, so others may read it too.
pub(crate) fn placed(
    chain: &mut Object<HysteronCoreStages>,
    model: &mut Object<HysteronCoreModel>,
    state: &mut <HysteronCoreState as Kind>::Content,
    load: Option<f64>,
) -> Result<Stages<'static, f64>> {
    let stages = chain.get().stages;
    if chain.get().by_load.is_none() {
        return Ok(stages);
    }
    let offset = match &mut chain.get_mut().by_load {
        Some(by_load) => by_load.place(model.get_mut(), state, load)?,
        None => stages.offset,
    };
    Ok(Stages { offset, ..stages })
}

/// The range of the loads, where the weights depend on the load.
pub(crate) fn weights_range(chain: &Chain) -> Option<(f64, f64)> {
    chain.by_load.as_ref().map(ByLoad::range)
}

/// Refuses the inverse of operators of another plane, and of weights below zero.
pub(crate) fn invertible(
    chain: &Object<HysteronCoreStages>,
    model: &Object<HysteronCoreModel>,
) -> Result<()> {
    check_levels(chain.get(), model.get())?;
    model.get().inverse()?;
    let by_load = chain.get().by_load.as_ref();
    by_load.map_or(Ok(()), ByLoad::check_inverse)
}

pub(crate) fn check_levels(
    chain: &Chain,
    model: &<HysteronCoreModel as Kind>::Content,
) -> Result<()> {
    match model.plane().levels() == chain.levels {
        true => Ok(()),
        false => Err(Error::StateMismatch.into()),
    }
}

/// How many numbers the constants take in memory.
fn all_numbers(stages: &Stages<'_, f64>, parts: Option<&GivenParts<'_>>) -> Option<usize> {
    let parts = parts.map_or(Some(0), GivenParts::numbers)?;
    numbers(stages).checked_add(parts)
}

/// Size in bytes of stages with these constants. 0 if there are no such stages. The memory has to
/// be aligned like a `uint64_t`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_stages_size(stages: *const HysteronStages) -> usize {
    // SAFETY: the contract of the crate.
    let constants = unsafe { StageArguments::default().stages(stages) };
    let size = |(stages, parts): (Stages<'_, f64>, Option<GivenParts<'_>>)| {
        let count = all_numbers(&stages, parts.as_ref())?;
        size::<HysteronCoreStages, f64>(count)
    };
    constants.ok().and_then(size).unwrap_or(0)
}

/// Makes stages around the operators of `model` in `memory`. The constants are copied, with their
/// arrays. `HYSTERON_STAGE` for a constant out of its range. The stages may be used with every
/// model of as many levels.
///
/// Where the weights depend on the load, the operators are those of `model`, and its weights have
/// no effect.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_stages_init(
    model: *const HysteronCoreModel,
    constants: *const HysteronStages,
    memory: *mut c_void,
    bytes: usize,
    stages: *mut *mut HysteronCoreStages,
) -> i32 {
    guard_plain(|| {
        let mut arguments = StageArguments::default();
        // SAFETY: the contract of the crate.
        let (model, room, out, (constants, parts)) = unsafe {
            (
                arguments.object_ref(model, "model")?,
                arguments.room(memory, bytes)?,
                arguments.out(stages, "stages")?,
                arguments.stages(constants)?,
            )
        };
        constants.check(model)?;
        let levels = model.plane().levels();
        if let Some(found) = parts.as_ref().map(|parts| parts.each) {
            let expected = operator_count(levels);
            if found != expected {
                return Err(Error::WeightCount { expected, found }.into());
            }
        }
        let count = all_numbers(&constants, parts.as_ref());
        let count = count.ok_or(Error::Stage { stage: "parts" })?;
        room.fill(count, &out, |place| {
            let (place, rest) = place.split_at_mut(numbers(&constants));
            let by_load = parts.map(|parts| parts.built(model, rest)).transpose()?;
            Ok(Chain {
                stages: copied(&constants, place)?,
                levels,
                by_load,
            })
        })
    })
}

/// Moves by one sample and writes the output `y`, with offset and sign. `input`, `dt` and `load`
/// are as for `hysteron_step_in`; a load beyond the curves has their outermost values. `memory` is
/// what the stages remember, zeros before the first sample. `clipped` may be null. After an error
/// nothing has moved.
///
/// Where the weights depend on the load, the call first gives `model` those of this load, in
/// `O(K²)` if the load has changed. Stages and model are then changed, so only one thread at a time
/// may use them. Otherwise they are only read. Several states may take turns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_stages_step(
    stages: *mut HysteronCoreStages,
    model: *mut HysteronCoreModel,
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
        let (mut chain, mut model, state, (memory, after), output, clipped) = unsafe {
            (
                arguments.object_at(stages, "stages")?,
                arguments.object_at(model, "model")?,
                arguments.object(state, "state")?,
                arguments.replaced(memory, "memory")?,
                arguments.out(output, "output")?,
                arguments.optional(clipped, "clipped")?,
            )
        };
        let mut memory = memory.core()?;
        let (dt, load) = (given(dt), given(load));
        let sample = Sample { input, dt, load };
        check_levels(chain.get(), model.get())?;
        chain.get().stages.accepts(&memory, sample)?;
        let stages = placed(&mut chain, &mut model, state, load)?;
        let step = stages.step(model.get(), state, &mut memory, sample)?;
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
    stages: *mut HysteronCoreStages,
    model: *mut HysteronCoreModel,
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
        let (mut chain, mut model, state, (memory, after), input, status, limits) = unsafe {
            (
                arguments.object_at(stages, "stages")?,
                arguments.object_at(model, "model")?,
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
        invertible(&chain, &model)?;
        let sample = Sample {
            input: target,
            dt: wanted.dt,
            load: wanted.load,
        };
        chain.get().stages.accepts(&memory, sample)?;
        let stages = placed(&mut chain, &mut model, state, wanted.load)?;
        let inverse = model.get().inverse()?;
        let solution = stages.invert(&inverse, state, &mut memory, wanted)?;
        after.set(memory.to_numbers().into());
        input.set(solution.input);
        status.set(status_constant(solution.status));
        Ok(())
    })
}
