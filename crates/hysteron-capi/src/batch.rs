//! Batches by handle: many models with a state each, which move together.

use crate::codes::HYSTERON_VALUE;
use crate::fault::{Fault, Result, guard};
use crate::handles::Table;
use crate::model::MODELS;
use crate::objects::STATES;
use crate::pointer::Arguments;
use crate::state::Running;
use crate::steps::given;
use hysteron::{BatchModel, Surroundings};
use std::sync::{Mutex, PoisonError};

static BATCHES: Table<Mutex<BatchModel>> = Table::new(5);

fn with<T>(batch: u64, work: impl FnOnce(&mut BatchModel) -> Result<T>) -> Result<T> {
    let batch = BATCHES.get(batch, "batch")?;
    work(&mut batch.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Makes a batch of `lanes` models with a state each, which move together. A lane is one of them
/// with its state, as `hysteron_state_new` makes it. The same model may come more than once. The
/// models may be freed before the batch. Free the handle with `hysteron_batch_free`.
///
/// Each lane gives the same outputs as a state alone, to the last bit. Many samples are divided
/// among all processors.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_batch_new(
    models: *const u64,
    lanes: usize,
    batch: *mut u64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (models, batch) = unsafe {
            (
                arguments.array(models, lanes, "models")?,
                arguments.out(batch, "batch")?,
            )
        };
        let models = models.iter().map(|model| MODELS.get(*model, "models"));
        let models = models.collect::<Result<Vec<_>>>()?;
        batch.set(BATCHES.insert(Mutex::new(models.into_iter().collect()))?);
        Ok(())
    })
}

/// As `hysteron_batch_new`, with `lanes` states of one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_batch_of(model: u64, lanes: usize, batch: *mut u64) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let batch = unsafe { Arguments::default().out(batch, "batch")? };
        let made = BatchModel::new(MODELS.get(model, "model")?, lanes)?;
        batch.set(BATCHES.insert(Mutex::new(made))?);
        Ok(())
    })
}

/// Frees a batch. States of its lanes stay valid.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_batch_free(batch: u64) -> i32 {
    guard(|| BATCHES.remove(batch, "batch"))
}

/// Brings all lanes back to their start, as that of a new batch.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_batch_reset(batch: u64) -> i32 {
    guard(|| {
        with(batch, |batch| {
            batch.reset();
            Ok(())
        })
    })
}

/// Moves every lane by one sample: `lanes` inputs, and as many outputs. The arrays must not
/// overlap. After an error, whose text names the lane, all lanes stay as they are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_batch_step(
    batch: u64,
    input: *const f64,
    output: *mut f64,
    lanes: usize,
) -> i32 {
    let (dt, load) = (f64::NAN, std::ptr::null());
    // SAFETY: the contract of the crate.
    unsafe { hysteron_batch_step_in(batch, input, dt, load, output, lanes) }
}

/// As `hysteron_batch_step`, for any models. `dt` is the time since the sample before in seconds,
/// 0 for the first one, or `NAN` for models that do not depend on time. `load` has the load of each
/// lane, or is null. A lane that does not depend on one of them takes no notice of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_batch_step_in(
    batch: u64,
    input: *const f64,
    dt: f64,
    load: *const f64,
    output: *mut f64,
    lanes: usize,
) -> i32 {
    guard(|| {
        let loads = if load.is_null() { 0 } else { lanes };
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (input, load, mut output) = unsafe {
            (
                arguments.array(input, lanes, "input")?,
                arguments.array(load, loads, "load")?,
                arguments.array_out(output, lanes, "output")?,
            )
        };
        with(batch, |batch| {
            let load = (!load.is_empty()).then_some(load);
            batch.step_in(input, given(dt), load, output.zeros())?;
            Ok(())
        })
    })
}

/// Moves every lane through its inputs: `count` inputs, and as many outputs. They come row by row:
/// first all samples of lane 0, then all of lane 1. `count` is a multiple of the number of lanes.
/// The arrays must not overlap. After an error, whose text names the lane, all lanes stay as they
/// are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_batch_run(
    batch: u64,
    input: *const f64,
    output: *mut f64,
    count: usize,
) -> i32 {
    let (time, last_time, load) = (std::ptr::null(), f64::NAN, std::ptr::null());
    // SAFETY: the contract of the crate.
    unsafe { hysteron_batch_run_in(batch, input, time, 0, last_time, load, output, count) }
}

/// As `hysteron_batch_run`, for any models. `time` has the time of each of the `samples` of a lane
/// in seconds, or is null; it is the same for all lanes. `last_time` is the time of the sample
/// before the first one, `NAN` for a new batch. `load` has `count` loads in the order of the
/// inputs, or is null. A lane that does not depend on one of them takes no notice of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_batch_run_in(
    batch: u64,
    input: *const f64,
    time: *const f64,
    samples: usize,
    last_time: f64,
    load: *const f64,
    output: *mut f64,
    count: usize,
) -> i32 {
    guard(|| {
        let times = if time.is_null() { 0 } else { samples };
        let loads = if load.is_null() { 0 } else { count };
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (input, time, load, mut output) = unsafe {
            (
                arguments.array(input, count, "input")?,
                arguments.array(time, times, "time")?,
                arguments.array(load, loads, "load")?,
                arguments.array_out(output, count, "output")?,
            )
        };
        let time: Option<Vec<f64>> = (!time.is_empty()).then(|| {
            given(last_time)
                .into_iter()
                .chain(time.iter().copied())
                .collect()
        });
        with(batch, |batch| {
            let around = Surroundings {
                time: time.as_deref(),
                load: (!load.is_empty()).then_some(load),
            };
            batch.run_in(input, around, output.zeros())?;
            Ok(())
        })
    })
}

/// Makes a state of its own from that of a lane, counted from 0: a copy, for all functions of a
/// state. Free it with `hysteron_state_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_batch_state(batch: u64, lane: usize, state: *mut u64) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let state = unsafe { Arguments::default().out(state, "state")? };
        let found = with(batch, |batch| {
            let model = batch.models().nth(lane).cloned();
            let found = model.zip(batch.states().nth(lane).cloned());
            found.ok_or(Fault::Call(HYSTERON_VALUE, "lane"))
        });
        let (model, copy) = found?;
        state.set(STATES.insert(Running::object(model, copy))?);
        Ok(())
    })
}
