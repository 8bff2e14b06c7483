//! `Model.export_c` and `Model.export_fmu`.

use crate::error::Raise;
use crate::word::choice;
use hysteron::Model;
use hysteron_export::{COptions, CReal, Fmi, FmuOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::Path;

pub(crate) fn c<'py>(
    py: Python<'py>,
    model: &Model,
    folder: &Path,
    real: &str,
    name: Option<&str>,
    adaptation: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let real = choice(
        "real",
        real,
        &[("float", CReal::Float), ("double", CReal::Double)],
    )?;
    let source = Path::new("model");
    let options = COptions {
        real,
        name,
        source,
        adaptation,
    };
    let export = hysteron_export::c(model, folder, &options).raise()?;
    let said = PyDict::new(py);
    said.set_item("files", export.files)?;
    said.set_item("name", export.name)?;
    said.set_item("inverse", export.inverse)?;
    said.set_item("flash_bytes", export.memory.constants)?;
    said.set_item("ram_bytes", export.memory.state + export.memory.turns)?;
    said.set_item("step_loop", export.worst_case.step)?;
    said.set_item("inverse_halvings", export.worst_case.halvings)?;
    Ok(said)
}

pub(crate) fn fmu<'py>(
    py: Python<'py>,
    model: &Model,
    path: &Path,
    inverse: bool,
    fmi: Fmi,
    name: Option<String>,
) -> PyResult<Bound<'py, PyDict>> {
    let options = FmuOptions { inverse, fmi, name };
    let fmu = py
        .detach(|| hysteron_export::fmu(model, &options, path))
        .raise()?;
    let said = PyDict::new(py);
    said.set_item("name", fmu.name)?;
    said.set_item("token", fmu.token)?;
    said.set_item("bytes", fmu.bytes)?;
    said.set_item("inputs", fmu.inputs)?;
    said.set_item("outputs", fmu.outputs)?;
    said.set_item("parameters", fmu.parameters)?;
    Ok(said)
}
