//! `Model.export_c` and `Model.export_fmu`.

use crate::error::Raise;
use crate::model::Model;
use crate::whole::Whole;
use crate::word::choice;
use hysteron::Destination;
use hysteron_export::{COptions, CReal, Fmi, FmuOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

#[pymethods]
impl Model {
    /// Write the model as C99 for a microcontroller, with the algorithm beside it.
    ///
    /// Files exported before are replaced. One that was edited since, or is another's, is kept and a FileError raised.
    ///
    /// Parameters
    /// ----------
    /// folder : str or path-like
    /// real : {'float', 'double'}
    ///     The number type that the C computes in.
    /// name : str, optional
    ///     The model's name in C, and of its files. By default 'model'.
    /// adaptation : bool
    ///     Also write what lets the weights follow the plant there, by the gradient method.
    ///
    /// Returns
    /// -------
    /// dict
    ///     'files', 'name', 'inverse' (whether there is one), 'flash_bytes', 'ram_bytes' (for each state), 'step_loop' and
    ///     'inverse_halvings' (turns of the loops of one call at most).
    ///
    /// Raises
    /// ------
    /// ExportError
    ///     For a model that depends on a load or has a thermal body, and for a name that cannot be one in C.
    /// FileError
    ///
    /// Examples
    /// --------
    /// >>> import os, tempfile
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> with tempfile.TemporaryDirectory() as folder:
    /// ...     export = model.export_c(folder, name='wire')
    /// ...     sorted(os.path.basename(file) for file in export['files'])
    /// ['hysteron_mcu.c', 'hysteron_mcu.h', 'hysteron_mcu_internal.h', 'hysteron_mcu_inverse.c', 'wire.c', 'wire.h']
    #[pyo3(signature = (folder, *, real="float", name=None, adaptation=false))]
    fn export_c<'py>(
        &self,
        py: Python<'py>,
        folder: PathBuf,
        real: &str,
        name: Option<&str>,
        adaptation: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let real = choice(
            "real",
            real,
            &[("float", CReal::Float), ("double", CReal::Double)],
        )?;
        let source = Path::new(name.unwrap_or("model"));
        let options = COptions {
            real,
            name,
            source,
            adaptation,
        };
        let export = hysteron_export::c(
            &self.inner,
            Destination::keeping_foreign(&folder, false),
            &options,
        )
        .raise()?;
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

    /// Write the model, or its inverse, as a functional mock-up unit for Simulink and other tools. A file that is there
    /// already is replaced.
    ///
    /// Parameters
    /// ----------
    /// path : str or path-like
    ///     Ends with '.fmu'.
    /// inverse : bool
    ///     The inverse, from the wanted output to the input, instead of the model.
    /// fmi : {2, 3}
    ///     The version of the standard.
    /// name : str, optional
    ///     The block's name. By default 'sf_MKP' or 'sf_Inverse_MKP'.
    ///
    /// Returns
    /// -------
    /// dict
    ///     'name', 'token', 'bytes', and the names of the 'inputs', 'outputs' and 'parameters'.
    ///
    /// Raises
    /// ------
    /// ExportError
    ///     For a model that depends on a load or has a thermal body, and for a name or a path that cannot be.
    /// CoreError
    ///     For the inverse of a model with weights below zero.
    /// FileError
    ///
    /// Examples
    /// --------
    /// >>> import os, tempfile
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> fmu = model.export_fmu(os.path.join(tempfile.mkdtemp(), 'inverse.fmu'), inverse=True)
    /// >>> fmu['name'], fmu['inputs'], fmu['outputs']
    /// ('sf_Inverse_MKP', ['target', 'heading'], ['input', 'status'])
    #[pyo3(signature = (path, *, inverse=false, fmi=None, name=None), text_signature = "($self, path, *, inverse=False, fmi=2, name=None)")]
    fn export_fmu<'py>(
        &self,
        py: Python<'py>,
        path: PathBuf,
        inverse: bool,
        fmi: Option<Whole>,
        name: Option<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let versions = [(2, Fmi::V2), (3, Fmi::V3)];
        let fmi = fmi.map_or(Ok(Fmi::V2), |fmi| fmi.one_of("fmi", "2 or 3", &versions))?;
        let options = FmuOptions { inverse, fmi, name };
        let fmu = py
            .detach(|| hysteron_export::fmu(&self.inner, &options, &path))
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
}
