//! Models by handle.

use crate::codes::HYSTERON_VALUE;
use crate::fault::{Fault, guard};
use crate::handles::Table;
use crate::pointer::Arguments;
use crate::types::given;
use crate::types::{
    HysteronModelInfo, HysteronModelNeeds, operator, operator_kind as kind_of, sign as sign_of,
};
use hysteron::{LoadDependence, Model, Plane};
use std::ffi::c_char;
use std::path::Path;

pub(crate) static MODELS: Table<Model> = Table::new(1);

/// Reads the model file at `path`. Free the handle with `hysteron_model_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_read(path: *const c_char, model: *mut u64) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (path, model) = unsafe {
            (
                arguments.text(path, "path")?,
                arguments.out(model, "model")?,
            )
        };
        model.set(MODELS.insert(Model::read(Path::new(path))?)?);
        Ok(())
    })
}

/// Makes a model from the text of a model file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_parse(json: *const c_char, model: *mut u64) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (json, model) = unsafe {
            (
                arguments.text(json, "json")?,
                arguments.out(model, "model")?,
            )
        };
        model.set(MODELS.insert(Model::from_json(json)?)?);
        Ok(())
    })
}

/// Writes the model file to `path` and replaces a file of that name. After an error there is no
/// incomplete file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_write(model: u64, path: *const c_char) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let path = unsafe { Arguments::default().text(path, "path")? };
        Ok(MODELS.get(model, "model")?.write(Path::new(path))?)
    })
}

/// Makes a model with `K` levels from `min` to `max`, in the input's unit, and `count = K(K + 1)/2`
/// weights, row by row: `j = 1…K`, within a row `i = 1…j`. Its output is `offset + sign · Σ μ γ`.
/// `sign` is 1 or −1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_new(
    operator_kind: i32,
    min: f64,
    max: f64,
    levels: usize,
    weights: *const f64,
    count: usize,
    offset: f64,
    sign: i32,
    model: *mut u64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (weights, model) = unsafe {
            (
                arguments.array(weights, count, "weights")?,
                arguments.out(model, "model")?,
            )
        };
        let plane = Plane::new(min, max, levels)?;
        let (operator, sign) = (operator(operator_kind)?, sign_of(sign)?);
        model.set(MODELS.insert(Model::new(operator, plane, weights.to_vec(), offset, sign)?)?);
        Ok(())
    })
}

/// Makes the model at one load from a model that depends on a load.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_at_load(model: u64, load: f64, at_load: *mut u64) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let at_load = unsafe { Arguments::default().out(at_load, "at_load")? };
        at_load.set(MODELS.insert(MODELS.get(model, "model")?.at_load(load)?)?);
        Ok(())
    })
}

/// Frees a model. States of it stay valid.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_model_free(model: u64) -> i32 {
    guard(|| MODELS.remove(model, "model"))
}

/// Writes what the model is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_info(model: u64, info: *mut HysteronModelInfo) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let info = unsafe { Arguments::default().out(info, "info")? };
        let model = MODELS.get(model, "model")?;
        let (plane, (output_off, output_on)) = (model.plane(), model.output_range());
        info.set(HysteronModelInfo {
            operator_kind: kind_of(model.operator()),
            sign: model.sign().factor() as i32,
            levels: plane.levels(),
            weights: model.weights().len(),
            min: plane.min(),
            max: plane.max(),
            bottom: plane.bottom(),
            offset: model.offset(),
            output_off,
            output_on,
            usual_tolerance: model.usual_tolerance(),
        });
        Ok(())
    })
}

/// Writes what a model needs beside its input, and in which ranges.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_needs(model: u64, needs: *mut HysteronModelNeeds) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let needs = unsafe { Arguments::default().out(needs, "needs")? };
        let model = MODELS.get(model, "model")?;
        let loads = model.load.as_ref().map(LoadDependence::range);
        let (load_min, load_max) = loads.unwrap_or((f64::NAN, f64::NAN));
        let (active_min, active_max) = model.active_range();
        let (drive_min, drive_max) = model.drive_range();
        needs.set(HysteronModelNeeds {
            time: model.is_timed().into(),
            load: model.load.is_some().into(),
            body: model.thermal.is_some().into(),
            fitted_start: model.fitted().is_some().into(),
            load_min,
            load_max,
            drive_min,
            drive_max,
            active_min,
            active_max,
        });
        Ok(())
    })
}

/// Writes the dead time of a model in samples that are `dt` s apart, `NAN` for those of its
/// recording; 0 without one, at most 1000.
///
/// An input that is given to a state, a lane or a learner acts so many samples later. Before the
/// first sample the input stood where it is first. The time step of the second sample tells how
/// many they are from there on. An inverse step gives the input at once that brings the target when
/// it arrives: its `target` is the one of so many samples later. It leaves nothing under way in its
/// state, so that forward steps need another one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_delay(model: u64, dt: f64, samples: *mut usize) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let samples = unsafe { Arguments::default().out(samples, "samples")? };
        samples.set(MODELS.get(model, "model")?.delay().at(given(dt)));
        Ok(())
    })
}

/// Copies the weights, row by row. Of a model that depends on a load, they are those without its
/// curves, at the middle of the load range. `count` becomes their number, also if `capacity` is too
/// small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_weights(
    model: u64,
    weights: *mut f64,
    capacity: usize,
    count: *mut usize,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (weights, count) = unsafe {
            (
                arguments.array_out(weights, capacity, "weights")?,
                arguments.out(count, "count")?,
            )
        };
        let model = MODELS.get(model, "model")?;
        let values = model.weights();
        weights.write_all(values.iter().copied(), values.len(), &count)
    })
}

/// Copies the name of the input (`quantity` 0), of the output (1) or of the load (2, of a model
/// that depends on one), and its unit in brackets if it has one, as in `"temperature [degC]"`.
/// Copies as much as fits into the `size` bytes of `text`, with a zero byte at the end. `needed`
/// becomes the size of the whole text in bytes, with the zero byte. `text` may be null with size 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_quantity(
    model: u64,
    quantity: i32,
    text: *mut c_char,
    size: usize,
    needed: *mut usize,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (text, needed) = unsafe {
            (
                arguments.array_out(text, size, "text")?,
                arguments.out(needed, "needed")?,
            )
        };
        let model = MODELS.get(model, "model")?;
        let load = model.load.as_ref();
        let quantity = match quantity {
            0 => Some(&model.input),
            1 => Some(&model.output),
            2 => load.map(|load| &load.quantity),
            _ => None,
        };
        let quantity = quantity.ok_or(Fault::Call(HYSTERON_VALUE, "quantity"))?;
        needed.set(text.write_text(&quantity.to_column()));
        Ok(())
    })
}
