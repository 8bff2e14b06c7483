//! Batches by handle: many models with a state each, which move together.

use crate::codes::HYSTERON_VALUE;
use crate::delay::UnderWay;
use crate::fault::{Fault, Result, guard};
use crate::handles::Table;
use crate::late;
use crate::model::MODELS;
use crate::objects::STATES;
use crate::pointer::Arguments;
use crate::state::Running;
use crate::types::given;
use hysteron::{BatchModel, Surroundings};
use std::sync::{Mutex, PoisonError};

/// Lanes, and the inputs that are under way in each; none where no lane has a dead time.
struct Batch {
    lanes: BatchModel,
    under_way: Vec<UnderWay<Vec<f64>>>,
}

impl From<BatchModel> for Batch {
    fn from(lanes: BatchModel) -> Self {
        let under_way = match lanes.models().all(|model| model.delay().is_none()) {
            true => Vec::new(),
            false => lanes.models().map(|model| late::under_way(model)).collect(),
        };
        Self { lanes, under_way }
    }
}

impl Batch {
    /// Moves the lanes by `work`, which takes the inputs that act. `input` has those of the lanes row
    /// by row, and `dt` tells the time step of a sample. After an error nothing has moved.
    fn pass(
        &mut self,
        input: &[f64],
        dt: impl Fn(usize) -> Option<f64>,
        work: impl FnOnce(&mut BatchModel, &[f64]) -> Result<()>,
    ) -> Result<()> {
        let lanes = self.under_way.len();
        let whole = lanes > 0 && input.len().is_multiple_of(lanes);
        if !whole || input.iter().any(|input| !input.is_finite()) {
            // Without a dead time, or to be refused.
            return work(&mut self.lanes, input);
        }
        let mut under_way = self.under_way.clone();
        let mut acting = input.to_vec();
        let rows = acting.chunks_mut((input.len() / lanes).max(1));
        for (row, under_way) in rows.zip(&mut under_way) {
            for (n, place) in row.iter_mut().enumerate() {
                let (given, dt) = (*place, dt(n));
                *place = under_way.acting(given, dt);
                under_way.push(given, dt);
            }
        }
        work(&mut self.lanes, &acting)?;
        self.under_way = under_way;
        Ok(())
    }
}

static BATCHES: Table<Mutex<Batch>> = Table::new(5);

fn with<T>(batch: u64, work: impl FnOnce(&mut Batch) -> Result<T>) -> Result<T> {
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
        let lanes: BatchModel = models.into_iter().collect();
        batch.set(BATCHES.insert(Mutex::new(lanes.into()))?);
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
        batch.set(BATCHES.insert(Mutex::new(made.into()))?);
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
            batch.lanes.reset();
            batch.under_way.iter_mut().for_each(UnderWay::clear);
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
            let dt = given(dt);
            batch.pass(
                input,
                |_| dt,
                |lanes, acting| {
                    lanes.step_in(acting, dt, load, output.zeros())?;
                    Ok(())
                },
            )
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
                rest: None,
            };
            let before = usize::from(given(last_time).is_some());
            let dt = |n: usize| {
                let at = (n + before).checked_sub(1)?;
                let time = around.time?;
                Some(time.get(at + 1)? - time.get(at)?)
            };
            batch.pass(input, dt, |lanes, acting| {
                lanes.run_in(acting, around, output.zeros())?;
                Ok(())
            })
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
            let model = batch.lanes.models().nth(lane).cloned();
            let found = model.zip(batch.lanes.states().nth(lane).cloned());
            let (model, copy) = found.ok_or(Fault::Call(HYSTERON_VALUE, "lane"))?;
            let inputs = batch.under_way.get(lane).map(UnderWay::inputs);
            Ok((
                model,
                copy,
                inputs.into_iter().flatten().collect::<Vec<f64>>(),
            ))
        });
        let (model, copy, inputs) = found?;
        let mut running = Running::boxed(model, copy);
        running.restore_under_way(&inputs)?;
        state.set(STATES.insert(running.into())?);
        Ok(())
    })
}
