//! `Model.export_c` and `Model.export_fmu`.

use crate::choices::choice;
use crate::convert::result;
use crate::error::Raise;
use crate::integer::Integer;
use crate::model::Model;
use crate::pid::Pid;
use crate::pool::detached;
use hysteron::Destination;
use hysteron_export::{COptions, CReal, CSampling, Fmi, FmuOptions};
use hysteron_sim::joint::TargetLoop;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

/// Drive range, gains, gate and filter, as one gives them.
type Settings<'a> = (
    Option<(f64, f64)>,
    Option<&'a Pid>,
    Option<f64>,
    Option<f64>,
);

/// The loop that is exported with a controller; `None` without one.
fn target_loop(
    controller: bool,
    dt: Option<f64>,
    (drives, gains, gate, filter_s): Settings<'_>,
) -> PyResult<Option<TargetLoop>> {
    match (controller, dt) {
        (true, Some(dt)) => Ok(Some(TargetLoop {
            dt,
            drives,
            gains: gains.map(|pid| pid.gains),
            gate,
            filter_s,
        })),
        (true, None) => Err(PyValueError::new_err("a controller needs `dt`")),
        (false, _) if gains.is_some() || gate.is_some() || filter_s.is_some() => Err(
            PyValueError::new_err("`gains`, `gate` and `filter_s` need `controller`"),
        ),
        (false, _) => Ok(None),
    }
}

#[pymethods]
impl Model {
    /// Write the model as C99 for a microcontroller, with the algorithm beside it.
    ///
    /// Files of an earlier export are replaced. A file that was edited since, or that was not
    /// exported, is kept and FileError is raised.
    ///
    /// Parameters
    /// ----------
    /// folder : str or path-like
    /// real : {'float', 'double'}
    ///     The number type that the C computes in.
    /// name : str, optional
    ///     The model's name in C, and of its files. By default 'model'.
    /// adaptation : bool
    ///     Also write the code that learns there: by increments, drift or least squares.
    /// dt : float, optional
    ///     The sample time in seconds, above 0. Needed by a model that depends on time and by a
    ///     controller, and only by these.
    /// drive_range : tuple of float, optional
    ///     The lowest and the highest drive that the inverse may give, for a model with stages;
    ///     with a controller, those of the loop. By default the model's own.
    /// controller : bool
    ///     Also write a control loop around the model: its inverse and a PID. It needs `dt`.
    /// gains : Pid, optional
    ///     The gains of the controller. By default from the model, by simulation.
    /// gate : float, optional
    ///     A gate against spikes in the controller's readings: what deviates by less than this is
    ///     never one, in the unit of the output.
    /// filter_s : float, optional
    ///     The time constant of a low-pass filter on the controller's readings, s.
    /// measured_dt : bool
    ///     Also write what takes the measured time of each sample of the controller.
    ///
    /// Returns
    /// -------
    /// results.CExport
    ///
    /// Raises
    /// ------
    /// ExportError
    ///     For a sample time that is missing or not needed, for an invalid C name, and where no
    ///     gains come from the model.
    /// ValueError
    ///     For a controller without `dt`, and for options of a controller without one.
    /// FileError
    ///
    /// Examples
    /// --------
    /// >>> import os, tempfile
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> with tempfile.TemporaryDirectory() as folder:
    /// ...     export = model.export_c(folder, name='wire')
    /// ...     sorted(os.path.basename(file) for file in export.files)
    /// ['hysteron_mcu.c', 'hysteron_mcu.h', 'hysteron_mcu_internal.h', 'hysteron_mcu_inverse.c', 'wire.c', 'wire.cmake', 'wire.h', 'wire.mk']
    #[pyo3(signature = (
        folder, *, real="float", name=None, adaptation=false, dt=None, drive_range=None,
        controller=false, gains=None, gate=None, filter_s=None, measured_dt=false,
    ))]
    #[allow(clippy::too_many_arguments)]
    fn export_c<'py>(
        &self,
        py: Python<'py>,
        folder: PathBuf,
        real: &str,
        name: Option<&str>,
        adaptation: bool,
        dt: Option<f64>,
        drive_range: Option<(f64, f64)>,
        controller: bool,
        gains: Option<&Pid>,
        gate: Option<f64>,
        filter_s: Option<f64>,
        measured_dt: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
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
        let settings = (drive_range, gains, gate, filter_s);
        let chosen = target_loop(controller, dt, settings)?;
        if measured_dt && !controller {
            return Err(PyValueError::new_err("`measured_dt` needs `controller`"));
        }
        let target = Destination::keeping_foreign(&folder, false);
        let export = match chosen {
            None => {
                let sampling = CSampling {
                    dt,
                    drive: drive_range,
                    ..CSampling::default()
                };
                hysteron_export::c_sampled(&self.inner, target, &options, &sampling)
            }
            Some(chosen) => detached(py, || {
                let sampling = CSampling {
                    measured: measured_dt,
                    ..CSampling::of_loop(&self.inner, dt)
                };
                let scheme = chosen.scheme(&self.inner)?;
                hysteron_export::c_controlled(&self.inner, target, &options, &sampling, &scheme)
            }),
        }
        .raise()?;
        let dict = PyDict::new(py);
        dict.set_item("files", export.files)?;
        dict.set_item("name", export.name)?;
        dict.set_item("inverse", export.inverse)?;
        dict.set_item("rounding", export.rounding)?;
        dict.set_item("flash_bytes", export.memory.constants)?;
        dict.set_item("ram_bytes", export.memory.state + export.memory.turns)?;
        dict.set_item("step_loop", export.worst_case.step)?;
        dict.set_item("inverse_halvings", export.worst_case.halvings)?;
        dict.set_item("controller_bytes", export.memory.controller)?;
        result(py, "CExport", dict)
    }

    /// Write the model, its inverse or a controller as a functional mock-up unit for Simulink and
    /// other tools.
    ///
    /// An existing file is replaced.
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
    ///     The block's name. By default 'sf_MKP', 'sf_Inverse_MKP' or 'sf_Controller_MKP'.
    /// controller : bool
    ///     A controller instead of the model: from the wanted and the measured output to the
    ///     drive. It needs `dt`.
    /// gains : Pid, optional
    ///     The gains of the controller. By default from the model, by simulation.
    /// gate : float, optional
    ///     A gate against spikes in the controller's readings: what deviates by less than this is
    ///     never one, in the unit of the output.
    /// filter_s : float, optional
    ///     The time constant of a low-pass filter on the controller's readings, s.
    /// dt : float, optional
    ///     The sample time of the controller in seconds, above 0. The communication step has to be
    ///     the same.
    /// drive_range : tuple of float, optional
    ///     The lowest and the highest drive of the controller. By default the model's own.
    ///
    /// Returns
    /// -------
    /// results.FmuExport
    ///
    /// Raises
    /// ------
    /// ExportError
    ///     For an invalid name or path, for weights of more than the seventh order in a load, for a
    ///     controller of a model with a load, and where no gains come from the model.
    /// ValueError
    ///     For a controller without `dt`, or of an inverse, and for options of a controller without
    ///     one.
    /// CoreError
    ///     For the inverse of a model with weights below zero.
    /// FileError
    ///
    /// Examples
    /// --------
    /// >>> import os, tempfile
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> fmu = model.export_fmu(os.path.join(tempfile.mkdtemp(), 'inverse.fmu'), inverse=True)
    /// >>> fmu.name, fmu.inputs, fmu.outputs
    /// ('sf_Inverse_MKP', ('target', 'heading'), ('input', 'status'))
    #[pyo3(
        signature = (
            path, *, inverse=false, fmi=None, name=None, controller=false, gains=None, gate=None,
            filter_s=None, dt=None, drive_range=None,
        ),
        text_signature = "($self, path, *, inverse=False, fmi=2, name=None, controller=False, \
            gains=None, gate=None, filter_s=None, dt=None, drive_range=None)",
    )]
    #[allow(clippy::too_many_arguments)]
    fn export_fmu<'py>(
        &self,
        py: Python<'py>,
        path: PathBuf,
        inverse: bool,
        fmi: Option<Integer>,
        name: Option<String>,
        controller: bool,
        gains: Option<&Pid>,
        gate: Option<f64>,
        filter_s: Option<f64>,
        dt: Option<f64>,
        drive_range: Option<(f64, f64)>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let versions = [(2, Fmi::V2), (3, Fmi::V3)];
        let fmi = fmi.map_or(Ok(Fmi::V2), |fmi| fmi.one_of("fmi", "2 or 3", &versions))?;
        let settings = (drive_range, gains, gate, filter_s);
        let chosen = target_loop(controller, dt, settings)?;
        let problem = match () {
            () if controller && inverse => Some("a block is a controller or an inverse, not both"),
            () if controller => None,
            () => (dt.is_some() || drive_range.is_some())
                .then_some("`dt` and `drive_range` need `controller`"),
        };
        if let Some(problem) = problem {
            return Err(PyValueError::new_err(problem));
        }
        let options = FmuOptions { inverse, fmi, name };
        let fmu = match chosen {
            None => py.detach(|| hysteron_export::fmu(&self.inner, &options, &path)),
            Some(chosen) => detached(py, || {
                let scheme = chosen.scheme(&self.inner)?;
                hysteron_export::fmu_controlled(&self.inner, &scheme, &options, &path)
            }),
        }
        .raise()?;
        let dict = PyDict::new(py);
        dict.set_item("name", fmu.name)?;
        dict.set_item("token", fmu.token)?;
        dict.set_item("bytes", fmu.bytes)?;
        dict.set_item("inputs", fmu.inputs)?;
        dict.set_item("outputs", fmu.outputs)?;
        dict.set_item("parameters", fmu.parameters)?;
        result(py, "FmuExport", dict)
    }
}
