//! Models by handle.

use crate::codes::HYSTERON_VALUE;
use crate::fault::{Fault, guard};
use crate::handles::Table;
use crate::pointer::Arguments;
use crate::types::{HysteronModelInfo, operator, operator_kind as kind_of, sign as sign_of};
use hysteron::{Model, Plane};
use std::ffi::c_char;
use std::path::Path;

pub(crate) static MODELS: Table<Model> = Table::new(1);

/// Reads a model file. The handle is to be freed with `hysteron_model_free`.
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

/// Takes the text of a model file.
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

/// Writes the model file, whole or not at all; one that is there already is replaced.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_write(model: u64, path: *const c_char) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let path = unsafe { Arguments::default().text(path, "path")? };
        Ok(MODELS.get(model, "model")?.write(Path::new(path))?)
    })
}

/// A model of `count = K(K + 1)/2` weights, row by row: `j = 1…K`, within a row `i = 1…j`; `K` levels from `min` to `max`.
/// Its output is `offset + sign · Σ μ γ`, the sign 1 or −1.
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

/// The model at one load, of a model that depends on a load: a model of its own.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_at_load(model: u64, load: f64, at_load: *mut u64) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let at_load = unsafe { Arguments::default().out(at_load, "at_load")? };
        at_load.set(MODELS.insert(MODELS.get(model, "model")?.at_load(load)?)?);
        Ok(())
    })
}

/// Frees a model. States made of it stay as they are.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_model_free(model: u64) -> i32 {
    guard(|| MODELS.remove(model, "model"))
}

/// What the model is.
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

/// Copies the weights. `count` becomes their number, also where `capacity` is too small for them.
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

/// Copies what the input (`quantity` 0) or the output (1) is: its name, and its unit in brackets where it has one, as in
/// `"temperature [degC]"`. As much as fits into `text`, of `size` bytes, with a zero byte at the end; `needed` becomes the bytes that
/// the whole takes with that zero, and `text` may be null with size 0.
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
        let quantity = match quantity {
            0 => &model.input,
            1 => &model.output,
            _ => return Err(Fault::Call(HYSTERON_VALUE, "quantity")),
        };
        needed.set(text.write_text(&quantity.to_column()));
        Ok(())
    })
}
