//! The estimator of the shift in memory of the caller.

use crate::adaptive_load::HysteronShift;
use crate::chain::{HysteronCoreStages, check_levels, invertible, placed, weights_range};
use crate::fault::guard_plain;
use crate::limits::HysteronLimits;
use crate::memory::{HysteronCoreModel, HysteronCoreState};
use crate::pointer::Arguments;
use crate::room::{Kind, Object, size};
use crate::shift_options::HysteronShiftOptions;
use crate::stage_state::HysteronStageState;
use crate::surroundings::given;
use crate::types::{self, HysteronLearning, status as status_constant};
use hysteron_core::{Sample, ShiftEstimator, ShiftOptions, Wanted};
use std::ffi::c_void;

/// An estimator of the shift, in the caller's memory.
pub struct HysteronCoreShift(());

impl Kind for HysteronCoreShift {
    const MARK: u64 = 0x6879_7374_7368_6966;
    type Content = Follower;
}

/// The estimator, and the load that the weights are those of.
pub(crate) struct Follower {
    estimator: ShiftEstimator<f64>,
    placed: Option<f64>,
}

impl Follower {
    /// The load for the weights of `stages`, for a model that was told the load `told`.
    fn load(&self, stages: &Object<HysteronCoreStages>, told: Option<f64>) -> Option<f64> {
        match (weights_range(stages.get()), self.placed, told) {
            (Some(_), Some(placed), _) => Some(placed),
            (Some((low, high)), None, Some(told)) => Some(told.clamp(low, high)),
            _ => told,
        }
    }
}

/// Writes the usual options for `model` between `stages`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_shift_usual(
    model: *const HysteronCoreModel,
    stages: *const HysteronCoreStages,
    options: *mut HysteronShiftOptions,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (model, stages, options) = unsafe {
            (
                arguments.object_ref(model, "model")?,
                arguments.object_ref(stages, "stages")?,
                arguments.out(options, "options")?,
            )
        };
        check_levels(stages, model)?;
        options.set(ShiftOptions::usual(model, &stages.stages).into());
        Ok(())
    })
}

/// Size in bytes of an estimator of the shift. The memory has to be aligned like a `uint64_t`.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_core_shift_size() -> usize {
    size::<HysteronCoreShift, f64>(0).unwrap_or(0)
}

/// Makes an estimator of the shift for `model` between `stages`, in `memory`. `options` may be null
/// for the usual ones. A model without stages takes stages of zeros with the sign 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_shift_init(
    model: *const HysteronCoreModel,
    stages: *const HysteronCoreStages,
    options: *const HysteronShiftOptions,
    memory: *mut c_void,
    bytes: usize,
    shift: *mut *mut HysteronCoreShift,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (model, stages, options, room, out) = unsafe {
            (
                arguments.object_ref(model, "model")?,
                arguments.object_ref(stages, "stages")?,
                arguments.shift_options(options)?,
                arguments.room(memory, bytes)?,
                arguments.out(shift, "shift")?,
            )
        };
        check_levels(stages, model)?;
        let options = options.unwrap_or_else(|| ShiftOptions::usual(model, &stages.stages));
        let estimator = ShiftEstimator::new(options, model, &stages.stages)?;
        room.fill::<_, f64>(0, &out, |_| {
            Ok(Follower {
                estimator,
                placed: None,
            })
        })
    })
}

/// Moves by one sample, predicts the output, and learns from the output `measured`. Arguments are
/// as for `hysteron_core_stages_step`, but `load` is the load that the shift departs from: always
/// the same, `NAN` for a model without a load. After an error nothing has changed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_shift_step(
    shift: *mut HysteronCoreShift,
    stages: *mut HysteronCoreStages,
    model: *mut HysteronCoreModel,
    state: *mut HysteronCoreState,
    memory: *mut HysteronStageState,
    input: f64,
    dt: f64,
    load: f64,
    measured: f64,
    learning: *mut HysteronLearning,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate; every bit pattern is a value of each field.
        let (follower, mut chain, mut model, state, (memory, after), learning) = unsafe {
            (
                arguments.object(shift, "shift")?,
                arguments.object_at(stages, "stages")?,
                arguments.object_at(model, "model")?,
                arguments.object(state, "state")?,
                arguments.replaced(memory, "memory")?,
                arguments.out(learning, "learning")?,
            )
        };
        let mut memory = memory.core()?;
        let (dt, load) = (given(dt), given(load));
        let sample = Sample { input, dt, load };
        check_levels(chain.get(), model.get())?;
        chain.get().stages.accepts(&memory, sample)?;
        let at = follower.load(&chain, load);
        let stages = placed(&mut chain, &mut model, state, at)?;
        let estimator = &mut follower.estimator;
        let learned = estimator.step(&stages, model.get(), state, &mut memory, sample, measured)?;
        if let (Some(range), Some(at)) = (weights_range(chain.get()), at) {
            follower.placed = Some(estimator.renewed(&stages.axis.load, load, at, range)?);
        }
        after.set(memory.to_numbers().into());
        learning.set(learned.into());
        Ok(())
    })
}

/// As `hysteron_core_stages_inverse_step`, at the present shift from the load `load`. `state` and
/// `memory` are those of the inverse: the plant is elsewhere.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_shift_inverse_step(
    shift: *const HysteronCoreShift,
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
        let (follower, mut chain, mut model, state, (memory, after), input, status, limits) = unsafe {
            (
                arguments.object_ref(shift, "shift")?,
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
        let at = follower.load(&chain, wanted.load);
        let stages = placed(&mut chain, &mut model, state, at)?;
        let inverse = model.get().inverse()?;
        let estimator = &follower.estimator;
        let solution = estimator.invert(&stages, &inverse, state, &mut memory, wanted)?;
        after.set(memory.to_numbers().into());
        input.set(solution.input);
        status.set(status_constant(solution.status));
        Ok(())
    })
}

/// Writes the shift, and the load that it tells, for a model that was told the load `load`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_shift_read(
    shift: *const HysteronCoreShift,
    stages: *const HysteronCoreStages,
    load: f64,
    found: *mut HysteronShift,
) -> i32 {
    guard_plain(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (follower, stages, found) = unsafe {
            (
                arguments.object_ref(shift, "shift")?,
                arguments.object_ref(stages, "stages")?,
                arguments.out(found, "found")?,
            )
        };
        let estimator = &follower.estimator;
        let told = estimator.load(&stages.stages.axis.load, given(load))?;
        found.set(HysteronShift {
            shift: estimator.shift(),
            deviation: estimator.variance().sqrt(),
            load: told.unwrap_or(f64::NAN),
        });
        Ok(())
    })
}

/// Takes `value` for the shift, as uncertain as at the start. Beyond the reach it is the nearest one
/// within.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_shift_reset(
    shift: *mut HysteronCoreShift,
    value: f64,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let follower = unsafe { Arguments::default().object(shift, "shift")? };
        follower.estimator.reset(value)?;
        Ok(())
    })
}

/// Tells the output that the model left alone expects at the next `hysteron_core_shift_step`, from a
/// state of its own and at the load that the shift departs from. A channel that stands still is found
/// by that, and what was learned from it is undone. Without this call none is found.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_shift_expect(
    shift: *mut HysteronCoreShift,
    output: f64,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let follower = unsafe { Arguments::default().object(shift, "shift")? };
        follower.estimator.expect(output)?;
        Ok(())
    })
}

/// Stops learning (`frozen` not 0), or resumes it (0).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_shift_freeze(
    shift: *mut HysteronCoreShift,
    frozen: i32,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let follower = unsafe { Arguments::default().object(shift, "shift")? };
        follower.estimator.freeze(frozen != 0);
        Ok(())
    })
}
