//! States: made, started, saved and restored.

use crate::fault::{Result, guard};
use crate::late;
use crate::limits::HysteronLimits;
use crate::memory::Size;
use crate::model::MODELS;
use crate::objects::{Moves, STATES, Start};
use crate::path::Path;
use crate::pointer::Arguments;
use crate::stage_state::HysteronStageState;
use crate::types::{HYSTERON_START_OFF, HYSTERON_START_ON};
use hysteron::{Model, Sample, State, Wanted};
use hysteron_core::{Error, Output, STATE_NUMBERS, Solution};
use std::ffi::c_void;
use std::sync::Arc;

/// A state in memory of the library, together with its model.
pub(crate) struct Running {
    model: Arc<Model>,
    state: State,
    kept: Option<State>,
}

impl Running {
    /// For an object of [`STATES`].
    pub(crate) fn boxed(model: Arc<Model>, state: State) -> Box<dyn Moves> {
        let kept = None;
        let running = Box::new(Self {
            model: model.clone(),
            state,
            kept,
        });
        late::moves(&model, running)
    }
}

impl Moves for Running {
    fn model(&self) -> &Model {
        &self.model
    }

    fn step(&mut self, sample: Sample) -> Result<Output<f64>> {
        Ok(self.model.step(&mut self.state, sample)?)
    }

    fn run(&mut self, input: &[f64], output: &mut [f64]) -> Result<()> {
        self.model.run(&mut self.state, input, output)?;
        Ok(())
    }

    fn solve(&mut self, wanted: Wanted, limits: Option<HysteronLimits>) -> Result<Solution<f64>> {
        let mut inverse = self.model.inverse()?;
        if let Some(limits) = limits {
            let (min, max) = limits.drive();
            inverse = inverse.drive_range(min, max)?.horizon(limits.horizon)?;
        }
        Ok(inverse.step(&mut self.state, wanted)?)
    }

    fn start(&mut self, start: Start) -> Result<()> {
        self.state = match start {
            Start::Fitted => self.model.start(),
            Start::Off => self.model.off(),
            Start::On => self.model.saturated(),
        };
        Ok(())
    }

    fn input(&self) -> f64 {
        self.state.input()
    }

    fn turning_points(&self, each: &mut dyn FnMut(f64)) -> usize {
        self.state.turning_points().map(each).count()
    }

    fn restore(&mut self, turning_points: &[f64], input: f64) -> Result<()> {
        self.state = self.model.restore(turning_points, input)?;
        Ok(())
    }

    fn stage_numbers(&self) -> [f64; STATE_NUMBERS] {
        self.state.stage_numbers()
    }

    fn restore_stages(&mut self, numbers: &[f64; STATE_NUMBERS]) -> Result<()> {
        self.state = self.state.clone().with_stage_numbers(numbers)?;
        Ok(())
    }

    fn half_width(&self) -> Result<Option<f64>> {
        let bounds = self.model.bounds()?;
        Ok(bounds.map(|bounds| bounds.at(&self.state)).transpose()?)
    }

    fn keep(&mut self) {
        self.kept = Some(self.state.clone());
    }

    fn undo(&mut self) {
        if let Some(kept) = self.kept.take() {
            self.state = kept;
        }
    }
}

/// Memory of a state.
fn size(model: &Model) -> Size {
    Path::size(model).and(late::size(model))
}

/// Calls `work` with a state, in a function without pointers.
fn with<T>(state: u64, work: impl FnOnce(&mut (dyn Moves + 'static)) -> Result<T>) -> Result<T> {
    STATES.with(state, "state", &mut Arguments::default(), work)
}

/// Makes a state of `model`, as the fit found it before the first sample, or with all operators off
/// where it found none. The stages are at rest with the first sample. `model` may be freed
/// before the state.
///
/// The model may have stages. Move the state by the functions
/// whose names end with `_in`, which take time and load. The others refuse what they cannot know.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_new(model: u64, state: *mut u64) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let out = unsafe { Arguments::default().out(state, "state")? };
        let model = MODELS.get(model, "model")?;
        let state = model.start();
        out.set(STATES.insert(Running::boxed(model, state).into())?);
        Ok(())
    })
}

/// Size in bytes of the memory of a state of `model`, for `hysteron_state_place`. 0 if there is no
/// such model.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_state_size(model: u64) -> usize {
    MODELS
        .get(model, "model")
        .map_or(0, |model| size(&model).bytes())
}

/// As `hysteron_state_new`, with the numbers of the state in `memory` of the caller, aligned like a
/// `uint64_t`. Steps, runs, saving and restoring then allocate nothing, also with errors. The state
/// has a copy of the weights.
///
/// The memory belongs to the state until it is freed. An older object in it ends. Errors of time
/// and load have the codes `HYSTERON_TIME_STEP` and `HYSTERON_LOAD`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_place(
    model: u64,
    memory: *mut c_void,
    bytes: usize,
    state: *mut u64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (room, out) = unsafe {
            (
                arguments.room(memory, bytes)?,
                arguments.out(state, "state")?,
            )
        };
        let model = MODELS.get(model, "model")?;
        let make = |lent: &mut _| -> Result<Box<dyn Moves>> {
            let path = Box::new(Path::new(&model, lent)?);
            Ok(late::moves_of_caller(&model, path, lent))
        };
        out.set(STATES.place(room, size(&model), make)?);
        Ok(())
    })
}

/// Frees a state. Memory of the caller stays the caller's.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_state_free(state: u64) -> i32 {
    guard(|| STATES.remove(state, "state"))
}

/// Switches all operators off, as at the bottom of the plane. The stages are at rest with the
/// next sample.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_state_reset(state: u64) -> i32 {
    hysteron_state_start(state, HYSTERON_START_OFF)
}

/// Switches all operators on, as at the top of the plane. The stages are at rest with the
/// next sample.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_state_saturate(state: u64) -> i32 {
    hysteron_state_start(state, HYSTERON_START_ON)
}

/// Starts a state again: as a new one (`HYSTERON_START_FITTED`), with all operators off
/// (`HYSTERON_START_OFF`) or on (`HYSTERON_START_ON`). The stages are at rest with the
/// next sample.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_state_start(state: u64, start: i32) -> i32 {
    guard(|| with(state, |state| state.start(Start::try_from(start)?)))
}

/// Saves the state: its turning points as normalised positions, at most `capacity`, and the last
/// input of the operators. A model with stages also needs `hysteron_state_save_stages`, one with a
/// dead time `hysteron_state_save_inputs`. `count` becomes the number of turning points, also if
/// `capacity` is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_save(
    state: u64,
    points: *mut f64,
    capacity: usize,
    count: *mut usize,
    input: *mut f64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (points, count, input) = unsafe {
            (
                arguments.array_out(points, capacity, "points")?,
                arguments.out(count, "count")?,
                arguments.out(input, "input")?,
            )
        };
        STATES.with(state, "state", &mut arguments, |state| {
            let needed = state.turning_points(&mut |_| ());
            count.set(needed);
            let found = capacity;
            if found < needed {
                return Err(Error::MemoryTooSmall { needed, found }.into());
            }
            let mut n = 0;
            state.turning_points(&mut |point| {
                points.set(n, point);
                n += 1;
            });
            input.set(state.input());
            Ok(())
        })
    })
}

/// Restores, bit for bit, what `hysteron_state_save` gave for a state of this model or of a model
/// with the same plane. The stages are at rest with the next sample, unless
/// `hysteron_state_restore_stages` comes after it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_restore(
    state: u64,
    points: *const f64,
    count: usize,
    input: f64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let points = unsafe { arguments.array(points, count, "points")? };
        STATES.with(state, "state", &mut arguments, |state| {
            state.restore(points, input)
        })
    })
}

/// Saves what the stages remember. Together with `hysteron_state_save` it is the whole
/// state. A model without stages needs it not.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_save_stages(
    state: u64,
    stages: *mut HysteronStageState,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let stages = unsafe { arguments.out(stages, "stages")? };
        STATES.with(state, "state", &mut arguments, |state| {
            stages.set(state.stage_numbers().into());
            Ok(())
        })
    })
}

/// Restores, bit for bit, what `hysteron_state_save_stages` gave. Call it after
/// `hysteron_state_restore`, which puts the stages at rest with the next sample.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_restore_stages(
    state: u64,
    stages: *const HysteronStageState,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate; every bit pattern is a value of each field.
        let stages = unsafe { arguments.value(stages, "stages")? };
        STATES.with(state, "state", &mut arguments, |state| {
            state.restore_stages(&stages.numbers())
        })
    })
}

/// Saves the inputs that are under way: given, and not acting yet for the dead time of the model; at
/// most `capacity`, from the one that arrives next. A model without a dead time needs it not.
/// `count` becomes their number, also if `capacity` is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_save_inputs(
    state: u64,
    inputs: *mut f64,
    capacity: usize,
    count: *mut usize,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (inputs, count) = unsafe {
            (
                arguments.array_out(inputs, capacity, "inputs")?,
                arguments.out(count, "count")?,
            )
        };
        STATES.with(state, "state", &mut arguments, |state| {
            let needed = state.under_way(&mut |_| ());
            count.set(needed);
            let found = capacity;
            if found < needed {
                return Err(Error::MemoryTooSmall { needed, found }.into());
            }
            let mut n = 0;
            state.under_way(&mut |input| {
                inputs.set(n, input);
                n += 1;
            });
            Ok(())
        })
    })
}

/// Restores, bit for bit, what `hysteron_state_save_inputs` gave. Call it after
/// `hysteron_state_restore`, which leaves nothing under way. More inputs than the dead time has
/// samples are `HYSTERON_VALUE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_restore_inputs(
    state: u64,
    inputs: *const f64,
    count: usize,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let inputs = unsafe { arguments.array(inputs, count, "inputs")? };
        if let Some(index) = inputs.iter().position(|input| !input.is_finite()) {
            return Err(Error::InputNotFinite { index }.into());
        }
        STATES.with(state, "state", &mut arguments, |state| {
            state.restore_under_way(inputs)
        })
    })
}

/// Writes the temperature after the last sample: the input itself for a model without a thermal
/// body, and the bottom of the plane before the first sample.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_temperature(state: u64, temperature: *mut f64) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let temperature = unsafe { arguments.out(temperature, "temperature")? };
        STATES.with(state, "state", &mut arguments, |state| {
            let [started, at, ..] = state.stage_numbers();
            temperature.set(if started == 0.0 { state.input() } else { at });
            Ok(())
        })
    })
}

/// Writes how far the output may really be from the modelled one where the state is, in the
/// output's unit: half the width of the model's 95 % band, or 1.96 times its error on what was held
/// out of its fit, whichever is wider. `NAN` for a model that has neither. After an inverse step it
/// says how far the target may be missed that the status reports as reached.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_half_width(state: u64, half_width: *mut f64) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let half_width = unsafe { arguments.out(half_width, "half_width")? };
        STATES.with(state, "state", &mut arguments, |state| {
            half_width.set(state.half_width()?.unwrap_or(f64::NAN));
            Ok(())
        })
    })
}
