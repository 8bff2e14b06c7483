//! States by handle: forward, inverse, save and restore.

use crate::codes::HYSTERON_VALUE;
use crate::fault::{Fault, Result, guard};
use crate::handles::Table;
use crate::model::MODELS;
use crate::pointer::Arguments;
use crate::types::{
    self, HYSTERON_HOLD, HYSTERON_START_FITTED, HYSTERON_START_OFF, HYSTERON_START_ON,
    clipped as clipped_constant, heading as heading_constant, status as status_constant,
};
use hysteron::{Model, State, headings};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A state, together with its model.
pub(crate) struct Running {
    pub(crate) model: Arc<Model>,
    state: Mutex<State>,
}

impl Running {
    pub(crate) fn new(model: Arc<Model>, state: State) -> Self {
        let state = Mutex::new(state);
        Self { model, state }
    }

    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Moves the state by `work`. After an error it is as it was.
    pub(crate) fn moved<T>(&self, work: impl FnOnce(&Model, &mut State) -> Result<T>) -> Result<T> {
        let mut state = self.state();
        let mut moved = state.clone();
        let done = work(&self.model, &mut moved)?;
        *state = moved;
        Ok(done)
    }
}

pub(crate) static STATES: Table<Running> = Table::new(2);

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
        out.set(STATES.insert(Running::new(model, state))?);
        Ok(())
    })
}

/// Frees a state.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_state_free(state: u64) -> i32 {
    guard(|| STATES.remove(state, "state"))
}

/// Switches all operators off, as at the bottom of the plane. The stages are at rest with the
/// next sample.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_state_reset(state: u64) -> i32 {
    guard(|| {
        let running = STATES.get(state, "state")?;
        *running.state() = running.model.off();
        Ok(())
    })
}

/// Starts a state again: as a new one (`HYSTERON_START_FITTED`), with all operators off
/// (`HYSTERON_START_OFF`) or on (`HYSTERON_START_ON`). The stages are at rest with the
/// next sample.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_state_start(state: u64, start: i32) -> i32 {
    guard(|| {
        let running = STATES.get(state, "state")?;
        *running.state() = match start {
            HYSTERON_START_FITTED => running.model.start(),
            HYSTERON_START_OFF => running.model.off(),
            HYSTERON_START_ON => running.model.saturated(),
            _ => return Err(Fault::Call(HYSTERON_VALUE, "start")),
        };
        Ok(())
    })
}

/// Switches all operators on, as at the top of the plane. The stages are at rest with the
/// next sample.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_state_saturate(state: u64) -> i32 {
    guard(|| {
        let running = STATES.get(state, "state")?;
        *running.state() = running.model.saturated();
        Ok(())
    })
}

/// Moves to `input` and writes the output. `clipped` becomes `HYSTERON_INSIDE`, or `HYSTERON_LOW`
/// or `HYSTERON_HIGH` for an input of the operators outside the plane. It may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_step(
    state: u64,
    input: f64,
    output: *mut f64,
    clipped: *mut i32,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (output, clipped) = unsafe {
            (
                arguments.out(output, "output")?,
                arguments.optional(clipped, "clipped")?,
            )
        };
        let running = STATES.get(state, "state")?;
        let step = running.model.step(&mut running.state(), input)?;
        output.set(step.output);
        if let Some(clipped) = clipped {
            clipped.set(clipped_constant(step.clipped));
        }
        Ok(())
    })
}

/// Moves through `count` inputs and writes as many outputs. The arrays must not overlap. After an
/// error, as of an input that is not finite, the state stays as it is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_run(
    state: u64,
    input: *const f64,
    output: *mut f64,
    count: usize,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (input, mut output) = unsafe {
            (
                arguments.array(input, count, "input")?,
                arguments.array_out(output, count, "output")?,
            )
        };
        let running = STATES.get(state, "state")?;
        let output = output.zeros();
        running.moved(|model, state| Ok(model.run(state, input, output).map(|_| ())?))
    })
}

/// Finds the input that gives `target` and moves the state there. `status` becomes
/// `HYSTERON_INSIDE` if the input gives the target, otherwise `HYSTERON_LOW`, `HYSTERON_HIGH`,
/// `HYSTERON_PASSED` or `HYSTERON_LIMITED`.
///
/// `heading` is `HYSTERON_HOLD` to hold the target, or the direction in which the target goes next,
/// `HYSTERON_RISING` or `HYSTERON_FALLING`, to anticipate it. A target that goes back by up to
/// `tolerance`, in the output's unit, is held.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_inverse_step(
    state: u64,
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
        let running = STATES.get(state, "state")?;
        let target = types::target(target, heading, tolerance)?;
        let inverse = running.model.inverse()?;
        let solution = inverse.step(&mut running.state(), target)?;
        input.set(solution.input);
        status.set(status_constant(solution.status));
        Ok(())
    })
}

/// Finds the inputs for `count` targets, one after the other, and moves the state through them.
/// `heading` has `count` elements as in `hysteron_inverse_step`, or is null for `HYSTERON_HOLD`.
/// `status` has `count` elements, or is null. Arrays must not overlap. If a target or a heading is
/// not valid, the state stays as it is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_inverse_run(
    state: u64,
    target: *const f64,
    heading: *const i32,
    tolerance: f64,
    input: *mut f64,
    status: *mut i32,
    count: usize,
) -> i32 {
    guard(|| {
        let wanted = |is_null| if is_null { 0 } else { count };
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (target, heading, input, status) = unsafe {
            (
                arguments.array(target, count, "target")?,
                arguments.array(heading, wanted(heading.is_null()), "heading")?,
                arguments.array_out(input, count, "input")?,
                arguments.array_out(status, wanted(status.is_null()), "status")?,
            )
        };
        let running = STATES.get(state, "state")?;
        let headings = heading
            .iter()
            .copied()
            .chain(std::iter::repeat(HYSTERON_HOLD));
        let targets = target.iter().zip(headings);
        let targets = targets
            .map(|(&target, heading)| types::target(target, heading, tolerance))
            .collect::<Result<Vec<_>>>()?;
        let solutions =
            running.moved(|model, state| Ok(model.inverse()?.through(state, &targets)?))?;
        input.write(solutions.iter().map(|solution| solution.input));
        status.write(solutions.iter().map(|s| status_constant(s.status)));
        Ok(())
    })
}

/// Writes where each of `count` targets goes next, for `hysteron_inverse_run`: `HYSTERON_RISING` or
/// `HYSTERON_FALLING`, or `HYSTERON_HOLD` if the series never moves. Reversals of up to `tolerance`
/// are noise.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_headings(
    target: *const f64,
    count: usize,
    tolerance: f64,
    heading: *mut i32,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (target, heading) = unsafe {
            (
                arguments.array(target, count, "target")?,
                arguments.array_out(heading, count, "heading")?,
            )
        };
        if let Some(index) = target.iter().position(|target| !target.is_finite()) {
            return Err(hysteron_core::Error::InputNotFinite { index }.into());
        }
        if tolerance.is_nan() || tolerance < 0.0 {
            return Err(Fault::Call(HYSTERON_VALUE, "tolerance"));
        }
        let constant = |heading: Option<_>| heading.map_or(HYSTERON_HOLD, heading_constant);
        heading.write(headings(target, tolerance).into_iter().map(constant));
        Ok(())
    })
}

/// Saves the state: its turning points as normalised positions, at most `capacity`, and the last
/// input of the operators. A model with stages also needs `hysteron_state_save_stages`. `count`
/// becomes the number of turning points, also if `capacity` is too small.
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
        let running = STATES.get(state, "state")?;
        let state = running.state();
        let needed = state.turning_points().count();
        points.write_all(state.turning_points(), needed, &count)?;
        input.set(state.input());
        Ok(())
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
        // SAFETY: the contract of the crate.
        let points = unsafe { Arguments::default().array(points, count, "points")? };
        let running = STATES.get(state, "state")?;
        *running.state() = running.model.restore(points, input)?;
        Ok(())
    })
}

/// Writes how far the output may really be from the modelled one where the state is, in the
/// output's unit: half the width of the model's 95 % band, or 1.96 times its error on what was held
/// out of its fit, whichever is wider. `NAN` for a model that has neither. After an inverse step it
/// says how far the target may be missed that the status reports as reached.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_half_width(state: u64, half_width: *mut f64) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let half_width = unsafe { Arguments::default().out(half_width, "half_width")? };
        let running = STATES.get(state, "state")?;
        let bounds = running.model.bounds()?;
        let half = bounds
            .map(|bounds| bounds.at(&running.state()))
            .transpose()?;
        half_width.set(half.unwrap_or(f64::NAN));
        Ok(())
    })
}
