//! `control.Trace`.

use crate::convert::result;
use crate::error::Raise;
use crate::plane::on_plane;
use hysteron::control::{self, LoopStatus};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::PathBuf;

/// A run of a control loop: arrays of shape (n,), a value for each sample.
#[pyclass(frozen, module = "pyhysteron.control", from_py_object)]
#[derive(Clone)]
pub(crate) struct Trace {
    inner: std::sync::Arc<control::Trace>,
}

impl From<control::Trace> for Trace {
    fn from(trace: control::Trace) -> Self {
        let inner = std::sync::Arc::new(trace);
        Self { inner }
    }
}

impl Trace {
    fn flags<'py>(
        &self,
        py: Python<'py>,
        flag: impl Fn(&LoopStatus) -> bool,
    ) -> Bound<'py, PyArray1<bool>> {
        PyArray1::from_iter(py, self.inner.status.iter().map(flag))
    }
}

type Series<'py> = Bound<'py, PyArray1<f64>>;

#[pymethods]
impl Trace {
    /// Time, s.
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Series<'py> {
        PyArray1::from_slice(py, &self.inner.time)
    }

    /// What the output should be.
    #[getter]
    fn reference<'py>(&self, py: Python<'py>) -> Series<'py> {
        PyArray1::from_slice(py, &self.inner.reference)
    }

    /// The output: the true one of a simulated plant, the measured one of a device.
    #[getter]
    fn output<'py>(&self, py: Python<'py>) -> Series<'py> {
        PyArray1::from_slice(py, &self.inner.output)
    }

    /// The output as its sensor read it; NaN where it gave nothing.
    #[getter]
    fn measured<'py>(&self, py: Python<'py>) -> Series<'py> {
        PyArray1::from_slice(py, &self.inner.measured)
    }

    /// The input of the hysteresis, true or measured; where neither is known, the command.
    #[getter]
    fn input<'py>(&self, py: Python<'py>) -> Series<'py> {
        PyArray1::from_slice(py, &self.inner.input)
    }

    /// The input that the controller commanded.
    #[getter]
    fn command<'py>(&self, py: Python<'py>) -> Series<'py> {
        PyArray1::from_slice(py, &self.inner.command)
    }

    /// The drive that was written to the device.
    #[getter]
    fn drive<'py>(&self, py: Python<'py>) -> Series<'py> {
        PyArray1::from_slice(py, &self.inner.drive)
    }

    /// The output that the controller's model expected before it learned from the reading; NaN
    /// without a model.
    #[getter]
    fn prediction<'py>(&self, py: Python<'py>) -> Series<'py> {
        PyArray1::from_slice(py, &self.inner.prediction)
    }

    /// Whether the drive or the command stood at a limit.
    #[getter]
    fn saturated<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        self.flags(py, |status| status.saturated)
    }

    /// Whether the reference lay out of the model's reach.
    #[getter]
    fn out_of_reach<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        self.flags(py, |status| status.out_of_reach)
    }

    /// Whether a reading was missing, or stuck.
    #[getter]
    fn sensor_fault<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        self.flags(py, |status| status.sensor_fault)
    }

    /// Whether the model learned from the sample.
    #[getter]
    fn adapted<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        self.flags(py, |status| status.adapted)
    }

    /// Readings rejected: too far from what was expected to be learned from.
    #[getter]
    fn rejected<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        self.flags(py, |status| status.rejected)
    }

    /// Where a channel stood still while the other one moved: the model did not learn.
    #[getter]
    fn stuck<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        self.flags(py, |status| status.stuck)
    }

    /// The weights over time, of a controller that adapts.
    ///
    /// A list of `results.Snapshot`.
    #[getter]
    fn snapshots<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for snapshot in &self.inner.snapshots {
            let entry = PyDict::new(py);
            entry.set_item("time", snapshot.time)?;
            entry.set_item("offset", snapshot.offset)?;
            entry.set_item("weights", on_plane(py, &snapshot.weights)?)?;
            list.append(result(py, "Snapshot", entry)?)?;
        }
        Ok(list)
    }

    /// All series, by name, as pandas takes them.
    ///
    /// Returns
    /// -------
    /// dict of ndarray
    ///
    /// Examples
    /// --------
    /// >>> controller = pyhysteron.control.Controller(0.01, (0, 150), pid=pyhysteron.control.Pid(0.2))
    /// >>> trace = controller.run(pyhysteron.PreisachPlant(), np.full(100, 20.0))
    /// >>> {name: len(series) for name, series in trace.to_dict().items()}['drive']
    /// 100
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = PyDict::new(py);
        table.set_item("time", self.time(py))?;
        table.set_item("reference", self.reference(py))?;
        table.set_item("output", self.output(py))?;
        table.set_item("measured", self.measured(py))?;
        table.set_item("input", self.input(py))?;
        table.set_item("command", self.command(py))?;
        table.set_item("drive", self.drive(py))?;
        table.set_item("prediction", self.prediction(py))?;
        table.set_item("saturated", self.saturated(py))?;
        table.set_item("out_of_reach", self.out_of_reach(py))?;
        table.set_item("sensor_fault", self.sensor_fault(py))?;
        table.set_item("adapted", self.adapted(py))?;
        table.set_item("rejected", self.rejected(py))?;
        table.set_item("stuck", self.stuck(py))?;
        Ok(table)
    }

    /// Write the run as a table, a row for each sample.
    ///
    /// Parameters
    /// ----------
    /// path : str or path-like
    ///
    /// Raises
    /// ------
    /// FileError
    ///
    /// Examples
    /// --------
    /// >>> import os, tempfile
    /// >>> path = os.path.join(tempfile.mkdtemp(), 'run.csv')
    /// >>> controller = pyhysteron.control.Controller(0.01, (0, 150), pid=pyhysteron.control.Pid(0.2))
    /// >>> trace = controller.run(pyhysteron.PreisachPlant(), np.full(100, 20.0))
    /// >>> trace.to_csv(path)
    /// >>> open(path).readline()[:29]
    /// 'time_s,reference,output,measu'
    fn to_csv(&self, path: PathBuf) -> PyResult<()> {
        self.inner.write_csv(&path).raise()
    }

    fn __len__(&self) -> usize {
        self.inner.time.len()
    }

    fn __repr__(&self) -> String {
        let last = self.inner.time.last().copied().unwrap_or(0.0);
        format!("<Trace, {} samples to {last} s>", self.inner.time.len())
    }
}
