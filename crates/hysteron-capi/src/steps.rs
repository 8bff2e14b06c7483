//! Steps of states: forward and inverse, one sample or a series.

use crate::codes::HYSTERON_VALUE;
use crate::fault::{Fault, Result, guard};
use crate::limits::HysteronLimits;
use crate::objects::{Moves, STATES};
use crate::pointer::Arguments;
use crate::types::{
    self, HYSTERON_HOLD, clipped as clipped_constant, given, heading as heading_constant,
    status as status_constant,
};
use hysteron::{Model, Sample, Wanted, headings};
use std::ptr::null;

/// The series beside the inputs of a run, each as long as they are.
struct Around<'a> {
    time: Option<&'a [f64]>,
    last_time: f64,
    load: Option<&'a [f64]>,
}

impl<'a> Around<'a> {
    /// A model that does not read the time takes no notice of it. An array without elements is
    /// none.
    fn new(model: &Model, time: &'a [f64], last_time: f64, load: &'a [f64]) -> Self {
        let series = |values: &'a [f64]| (!values.is_empty()).then_some(values);
        Self {
            time: series(time).filter(|_| model.reads_time()),
            last_time,
            load: series(load),
        }
    }

    /// The time step and the load of a sample.
    fn at(&self, n: usize) -> (Option<f64>, Option<f64>) {
        let before = |time: &[f64]| match n {
            0 => given(self.last_time),
            n => Some(time[n - 1]),
        };
        let dt = |time: &[f64]| before(time).map(|before| time[n] - before);
        (self.time.and_then(dt), self.load.map(|load| load[n]))
    }
}

/// Moves by `work`. After an error the state is as it was.
fn moved(state: &mut dyn Moves, work: impl FnOnce(&mut dyn Moves) -> Result<()>) -> Result<()> {
    state.keep();
    let done = work(state);
    if done.is_err() {
        state.undo();
    }
    done
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
    // SAFETY: the contract of the crate.
    unsafe { hysteron_step_in(state, input, f64::NAN, f64::NAN, output, clipped) }
}

/// As `hysteron_step`, for any model.
///
/// `input` is the one held since the sample before. `dt` is the time since that sample in seconds,
/// from 0; a model that depends on time needs it from its second sample on. `load` is the load,
/// which a model that depends on one needs within its range. `NAN` for a `dt` or a `load` that is
/// not given. `hysteron_model_needs` says what a model needs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_step_in(
    state: u64,
    input: f64,
    dt: f64,
    load: f64,
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
        let (dt, load) = (given(dt), given(load));
        STATES.with(state, "state", &mut arguments, |state| {
            let step = state.step(Sample { input, dt, load })?;
            output.set(step.output);
            if let Some(clipped) = clipped {
                clipped.set(clipped_constant(step.clipped));
            }
            Ok(())
        })
    })
}

/// Moves through `count` inputs and writes as many outputs. The arrays must not overlap. After an
/// error the state stays as it is, and of an input that is not finite the outputs, too.
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
        STATES.with(state, "state", &mut arguments, |state| {
            finite(input)?;
            moved(state, |state| state.run(input, output.zeros()))
        })
    })
}

/// As `hysteron_run`, for any model. After any error the state stays as it is.
///
/// `time` has the time of each sample in seconds, and `load` its load; each has `count` elements or
/// is null. `last_time` is the time of the sample before the first one. It is `NAN` for a new
/// state, whose first sample has none before it. `clipped` has `count` elements as in
/// `hysteron_step`, or is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_run_in(
    state: u64,
    input: *const f64,
    time: *const f64,
    last_time: f64,
    load: *const f64,
    output: *mut f64,
    clipped: *mut i32,
    count: usize,
) -> i32 {
    guard(|| {
        let wanted = |is_null| if is_null { 0 } else { count };
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (input, time, load, mut output, mut clipped) = unsafe {
            (
                arguments.array(input, count, "input")?,
                arguments.array(time, wanted(time.is_null()), "time")?,
                arguments.array(load, wanted(load.is_null()), "load")?,
                arguments.array_out(output, count, "output")?,
                arguments.array_out(clipped, wanted(clipped.is_null()), "clipped")?,
            )
        };
        STATES.with(state, "state", &mut arguments, |state| {
            finite(input)?;
            let mut done = 0;
            moved(state, |state| {
                for (n, &input) in input.iter().enumerate() {
                    let (dt, load) = Around::new(state.model(), time, last_time, load).at(n);
                    let step = state.step(Sample { input, dt, load })?;
                    output.set(n, step.output);
                    clipped.set(n, clipped_constant(step.clipped));
                    done = n + 1;
                }
                Ok(())
            })
            .inspect_err(|_| {
                if done > 0 {
                    output.zeros();
                    clipped.zeros();
                }
            })
        })
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
    let (dt, load, limits) = (f64::NAN, f64::NAN, null());
    // SAFETY: the contract of the crate.
    unsafe {
        hysteron_inverse_step_in(
            state, target, heading, tolerance, dt, load, limits, input, status,
        )
    }
}

/// As `hysteron_inverse_step`, for any model. `dt` and `load` are as for `hysteron_step_in`.
///
/// With a thermal body `input` becomes the drive to hold since the sample before. `limits` may be
/// null for those of the model itself (`hysteron_model_limits`). `status` is `HYSTERON_LIMITED`
/// where the model can give the target, but not in this sample. The state goes where the drive
/// takes it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_inverse_step_in(
    state: u64,
    target: f64,
    heading: i32,
    tolerance: f64,
    dt: f64,
    load: f64,
    limits: *const HysteronLimits,
    input: *mut f64,
    status: *mut i32,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (input, status, limits) = unsafe {
            (
                arguments.out(input, "input")?,
                arguments.out(status, "status")?,
                arguments.limits(limits)?,
            )
        };
        let wanted = Wanted {
            target: types::target(target, heading, tolerance)?,
            dt: given(dt),
            load: given(load),
            temperature: limits.unwrap_or(HysteronLimits::NONE).temperature(),
        };
        STATES.with(state, "state", &mut arguments, |state| {
            let solution = state.solve(wanted, limits)?;
            input.set(solution.input);
            status.set(status_constant(solution.status));
            Ok(())
        })
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
    let (time, last_time, load, limits) = (null(), f64::NAN, null(), null());
    // SAFETY: the contract of the crate.
    unsafe {
        hysteron_inverse_run_in(
            state, target, heading, tolerance, time, last_time, load, limits, input, status, count,
        )
    }
}

/// As `hysteron_inverse_run`, for any model. `time`, `last_time` and `load` are as for
/// `hysteron_run_in`, `limits` as for `hysteron_inverse_step_in`. After any error the state stays
/// as it is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_inverse_run_in(
    state: u64,
    target: *const f64,
    heading: *const i32,
    tolerance: f64,
    time: *const f64,
    last_time: f64,
    load: *const f64,
    limits: *const HysteronLimits,
    input: *mut f64,
    status: *mut i32,
    count: usize,
) -> i32 {
    guard(|| {
        let wanted = |is_null| if is_null { 0 } else { count };
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (target, heading, time, load, mut input, mut status, limits) = unsafe {
            (
                arguments.array(target, count, "target")?,
                arguments.array(heading, wanted(heading.is_null()), "heading")?,
                arguments.array(time, wanted(time.is_null()), "time")?,
                arguments.array(load, wanted(load.is_null()), "load")?,
                arguments.array_out(input, count, "input")?,
                arguments.array_out(status, wanted(status.is_null()), "status")?,
                arguments.limits(limits)?,
            )
        };
        let temperature = limits.unwrap_or(HysteronLimits::NONE).temperature();
        let of_target = |n: usize| {
            let heading = heading.get(n).copied().unwrap_or(HYSTERON_HOLD);
            types::target(target[n], heading, tolerance)
        };
        STATES.with(state, "state", &mut arguments, |state| {
            finite(target)?;
            (0..count).try_for_each(|n| of_target(n).map(|_| ()))?;
            let mut done = 0;
            moved(state, |state| {
                for n in 0..count {
                    let (dt, load) = Around::new(state.model(), time, last_time, load).at(n);
                    let wanted = Wanted {
                        target: of_target(n)?,
                        dt,
                        load,
                        temperature,
                    };
                    let solution = state.solve(wanted, limits)?;
                    input.set(n, solution.input);
                    status.set(n, status_constant(solution.status));
                    done = n + 1;
                }
                Ok(())
            })
            .inspect_err(|_| {
                // A model without an inverse has written nothing.
                if done > 0 {
                    input.zeros();
                    status.zeros();
                }
            })
        })
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
        finite(target)?;
        if tolerance.is_nan() || tolerance < 0.0 {
            return Err(Fault::Call(HYSTERON_VALUE, "tolerance"));
        }
        let constant = |heading: Option<_>| heading.map_or(HYSTERON_HOLD, heading_constant);
        heading.write(headings(target, tolerance).into_iter().map(constant));
        Ok(())
    })
}

/// Refuses a series with a number that is not finite, and names it.
fn finite(series: &[f64]) -> Result<()> {
    match series.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => Err(hysteron_core::Error::InputNotFinite { index }.into()),
    }
}
