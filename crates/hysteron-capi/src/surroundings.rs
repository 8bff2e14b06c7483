//! States by handle, for models that need the time or a load beside the input.

use crate::fault::{Result, guard};
use crate::limits::HysteronLimits;
use crate::pointer::Arguments;
use crate::state::STATES;
use crate::types::{self, HYSTERON_HOLD, clipped as clipped_constant, status as status_constant};
use hysteron::{Inverse, Model, Sample, Wanted};

/// A number that may be missing, which is NaN in C.
pub(crate) fn given(value: f64) -> Option<f64> {
    (!value.is_nan()).then_some(value)
}

/// The series beside the inputs of a run, each as long as they are.
struct Around<'a> {
    time: Option<&'a [f64]>,
    last_time: f64,
    load: Option<&'a [f64]>,
}

impl<'a> Around<'a> {
    /// A model that does not depend on time takes no notice of it. An array without elements is
    /// none.
    fn new(model: &Model, time: &'a [f64], last_time: f64, load: &'a [f64]) -> Self {
        let series = |values: &'a [f64]| (!values.is_empty()).then_some(values);
        Self {
            time: series(time).filter(|_| model.is_timed()),
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

fn inverse(model: &Model, limits: Option<HysteronLimits>) -> Result<Inverse<'_>> {
    let inverse = model.inverse()?;
    Ok(match limits {
        None => inverse,
        Some(limits) => {
            let (min, max) = limits.drive();
            inverse.drive_range(min, max)?.horizon(limits.horizon)?
        }
    })
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
        let running = STATES.get(state, "state")?;
        let (dt, load) = (given(dt), given(load));
        let step = running
            .model
            .step(&mut running.state(), Sample { input, dt, load })?;
        output.set(step.output);
        if let Some(clipped) = clipped {
            clipped.set(clipped_constant(step.clipped));
        }
        Ok(())
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
        let (input, time, load, output, clipped) = unsafe {
            (
                arguments.array(input, count, "input")?,
                arguments.array(time, wanted(time.is_null()), "time")?,
                arguments.array(load, wanted(load.is_null()), "load")?,
                arguments.array_out(output, count, "output")?,
                arguments.array_out(clipped, wanted(clipped.is_null()), "clipped")?,
            )
        };
        let running = STATES.get(state, "state")?;
        let around = Around::new(&running.model, time, last_time, load);
        finite(input)?;
        let steps = running.moved(|model, state| {
            let steps = input.iter().enumerate().map(|(n, &input)| {
                let (dt, load) = around.at(n);
                Ok(model.step(state, Sample { input, dt, load })?)
            });
            steps.collect::<Result<Vec<_>>>()
        })?;
        output.write(steps.iter().map(|step| step.output));
        clipped.write(steps.iter().map(|step| clipped_constant(step.clipped)));
        Ok(())
    })
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
        let running = STATES.get(state, "state")?;
        let wanted = Wanted {
            target: types::target(target, heading, tolerance)?,
            dt: given(dt),
            load: given(load),
            temperature: limits.unwrap_or(HysteronLimits::NONE).temperature(),
        };
        let inverse = inverse(&running.model, limits)?;
        let solution = inverse.step(&mut running.state(), wanted)?;
        input.set(solution.input);
        status.set(status_constant(solution.status));
        Ok(())
    })
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
        let (target, heading, time, load, input, status, limits) = unsafe {
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
        let running = STATES.get(state, "state")?;
        let around = Around::new(&running.model, time, last_time, load);
        let temperature = limits.unwrap_or(HysteronLimits::NONE).temperature();
        let wanted = target.iter().enumerate().map(|(n, &target)| {
            let heading = heading.get(n).copied().unwrap_or(HYSTERON_HOLD);
            let target = types::target(target, heading, tolerance)?;
            let (dt, load) = around.at(n);
            Ok(Wanted {
                target,
                dt,
                load,
                temperature,
            })
        });
        let wanted = wanted.collect::<Result<Vec<_>>>()?;
        let solutions =
            running.moved(|model, state| Ok(inverse(model, limits)?.through(state, &wanted)?))?;
        input.write(solutions.iter().map(|solution| solution.input));
        status.write(solutions.iter().map(|s| status_constant(s.status)));
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
