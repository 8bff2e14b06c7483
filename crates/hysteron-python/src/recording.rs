//! `Recording`.

use crate::array::{optional, series, times};
use crate::choices::none_left;
use crate::convert::result_of;
use crate::error::Raise;
use crate::integer::Integer;
use crate::pool::detached;
use hysteron::{FitOptions, Origin, Plane, Quantity};
use numpy::PyArray1;
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};
use std::path::PathBuf;
use std::sync::Arc;

/// An input and the output it caused, sample by sample.
///
/// Parameters
/// ----------
/// input, output : array_like, shape (n,)
/// time : array_like, shape (n,), optional
///     Seconds, not decreasing. Dates (datetime64, a pandas DatetimeIndex, datetime objects) become
///     seconds from the first sample, durations (timedelta64, timedelta objects) seconds.
/// load : array_like, shape (n,), optional
///     The load or stress.
/// input_name, output_name, load_name : str
///     Names, with the unit in brackets: ``'temperature [degC]'``.
/// simulated : bool
///     Whether the samples come from a simulation. Models and figures made from them say so.
///
/// Raises
/// ------
/// RecordingError
///     For series of different lengths, no samples, one that is NaN or infinite, or time that goes
///     back.
///
/// Examples
/// --------
/// >>> recording = pyhysteron.Recording([20, 80, 50], [0, 14, 11], input_name='temperature [degC]')
/// >>> recording
/// <Recording, 3 samples: temperature [degC] → output>
/// >>> recording.output
/// array([ 0., 14., 11.])
#[pyclass(frozen, module = "pyhysteron", from_py_object)]
#[derive(Clone)]
pub(crate) struct Recording {
    pub(crate) inner: Arc<hysteron::Recording>,
}

impl From<hysteron::Recording> for Recording {
    fn from(recording: hysteron::Recording) -> Self {
        Self {
            inner: Arc::new(recording),
        }
    }
}

/// An array, or `None` where there is no series.
type Series<'py> = Option<Bound<'py, PyArray1<f64>>>;

impl Recording {
    /// A recording of arrays; `names` are those of input, output and load.
    pub(crate) fn of_arrays(
        input: &Bound<'_, PyAny>,
        output: &Bound<'_, PyAny>,
        time: Option<&Bound<'_, PyAny>>,
        load: Option<&Bound<'_, PyAny>>,
        (input_name, output_name, load_name): (&str, &str, &str),
        simulated: bool,
    ) -> PyResult<Self> {
        let recording = hysteron::Recording {
            time: times(time)?,
            input: series(input, "input")?,
            output: series(output, "output")?,
            input_quantity: Quantity::from_column(input_name),
            output_quantity: Quantity::from_column(output_name),
            load: optional(load, "load")?,
            load_quantity: Quantity::from_column(load_name),
            origin: match simulated {
                true => Origin::Simulated,
                false => Origin::Measured,
            },
            source: None,
            undone: None,
            rest: None,
        };
        recording.check().raise()?;
        Ok(recording.into())
    }
}

#[pymethods]
impl Recording {
    #[new]
    #[pyo3(signature = (input, output, *, time=None, load=None, input_name="input", output_name="output", load_name="load", simulated=false, **unknown),
        text_signature = "(input, output, *, time=None, load=None, input_name='input', output_name='output', load_name='load', simulated=False)")]
    #[allow(clippy::too_many_arguments)]
    fn new(
        input: &Bound<'_, PyAny>,
        output: &Bound<'_, PyAny>,
        time: Option<&Bound<'_, PyAny>>,
        load: Option<&Bound<'_, PyAny>>,
        input_name: &str,
        output_name: &str,
        load_name: &str,
        simulated: bool,
        unknown: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let names = [
            "time",
            "load",
            "input_name",
            "output_name",
            "load_name",
            "simulated",
        ];
        none_left("Recording", unknown, &names)?;
        let names = (input_name, output_name, load_name);
        Self::of_arrays(input, output, time, load, names, simulated)
    }

    /// A recording from columns of a pandas frame, or of any object indexed by column names.
    ///
    /// Parameters
    /// ----------
    /// frame : pandas.DataFrame
    /// input, output : hashable
    ///     The columns, by name.
    /// time : hashable, optional
    ///     The column of time: seconds, dates or durations.
    /// load : hashable, optional
    ///     The column of the load or stress.
    /// input_name, output_name, load_name : str, optional
    ///     Names, with the unit in brackets. By default the names of the columns.
    ///
    /// Returns
    /// -------
    /// Recording
    ///
    /// Raises
    /// ------
    /// KeyError
    ///     For a missing column.
    /// RecordingError
    ///     As `Recording`.
    ///
    /// Examples
    /// --------
    /// >>> frame = {'T [degC]': [20, 80], 'lift': [0, 14]}
    /// >>> pyhysteron.Recording.from_frame(frame, input='T [degC]', output='lift')
    /// <Recording, 2 samples: T [degC] → lift>
    #[classmethod]
    #[pyo3(signature = (frame, *, input, output, time=None, load=None, input_name=None, output_name=None, load_name=None))]
    #[allow(clippy::too_many_arguments)]
    fn from_frame<'py>(
        _class: &Bound<'_, PyType>,
        frame: &Bound<'py, PyAny>,
        input: &Bound<'py, PyAny>,
        output: &Bound<'py, PyAny>,
        time: Option<&Bound<'py, PyAny>>,
        load: Option<&Bound<'py, PyAny>>,
        input_name: Option<&str>,
        output_name: Option<&str>,
        load_name: Option<&str>,
    ) -> PyResult<Self> {
        let column = |name: &Bound<'py, PyAny>| {
            let py = name.py();
            frame.get_item(name).map_err(|error| {
                if error.is_instance_of::<PyKeyError>(py) {
                    return error;
                }
                let of = frame.get_type();
                let text = format!("`frame` of {of} is not indexed by names of columns: {error}");
                PyTypeError::new_err(text)
            })
        };
        let name_of = |name: Option<&str>, column: Option<&Bound<'py, PyAny>>| {
            let column = column.map_or("load".into(), |column| column.to_string());
            name.map_or(column, str::to_owned)
        };
        Self::of_arrays(
            &column(input)?,
            &column(output)?,
            time.map(column).transpose()?.as_ref(),
            load.map(column).transpose()?.as_ref(),
            (
                &name_of(input_name, Some(input)),
                &name_of(output_name, Some(output)),
                &name_of(load_name, load),
            ),
            false,
        )
    }

    /// The input samples, shape (n,): a copy.
    #[getter]
    fn input<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.inner.input)
    }

    /// The output samples, shape (n,): a copy.
    #[getter]
    fn output<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.inner.output)
    }

    /// Time in seconds, shape (n,), or None: a copy.
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Series<'py> {
        let time = self.inner.time.as_ref();
        time.map(|time| PyArray1::from_slice(py, time))
    }

    /// The load, shape (n,), or None: a copy.
    #[getter]
    fn load<'py>(&self, py: Python<'py>) -> Series<'py> {
        let load = self.inner.load.as_ref();
        load.map(|load| PyArray1::from_slice(py, load))
    }

    /// Name and unit of the input.
    #[getter]
    fn input_name(&self) -> String {
        self.inner.input_quantity.to_column()
    }

    /// Name and unit of the output.
    #[getter]
    fn output_name(&self) -> String {
        self.inner.output_quantity.to_column()
    }

    /// Name and unit of the load.
    #[getter]
    fn load_name(&self) -> String {
        self.inner.load_quantity.to_column()
    }

    /// Whether it comes from a simulated plant.
    #[getter]
    fn simulated(&self) -> bool {
        self.inner.origin == Origin::Simulated
    }

    /// The file that was read, or None.
    #[getter]
    fn path(&self) -> Option<PathBuf> {
        self.inner.source.as_ref().map(|source| source.path.clone())
    }

    /// Write a CSV file with a header row. An existing file is replaced, in one step.
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
    /// >>> pyhysteron.Recording([20, 80], [0, 14], input_name='T [degC]').to_csv(path)
    /// >>> open(path).read()
    /// 'T [degC],output\n20,0\n80,14\n'
    fn to_csv(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.inner.write_csv(&path).raise())
    }

    /// Ranges, reversals, sampling, gaps, and the number of operators that the input moves.
    ///
    /// Parameters
    /// ----------
    /// levels : int
    ///     Levels of the plane that operators are counted on.
    /// range : tuple of float, optional
    ///     Its lowest and highest level. By default those of a fit.
    ///
    /// Returns
    /// -------
    /// results.RecordingSummary
    ///
    /// Examples
    /// --------
    /// >>> summary = pyhysteron.Recording([20, 80, 50], [0, 14, 11]).summary(levels=5)
    /// >>> summary.samples, summary.operators, summary.excited
    /// (3, 15, 15)
    #[pyo3(signature = (*, levels=None, range=None), text_signature = "($self, *, levels=20, range=None)")]
    fn summary<'py>(
        &self,
        py: Python<'py>,
        levels: Option<Integer>,
        range: Option<(f64, f64)>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let levels = levels.map_or(Ok(FitOptions::plain().levels), |n| n.convert("levels"))?;
        let plane = match range {
            Some((min, max)) => Plane::new(min, max, levels).raise()?,
            None => hysteron::plane_of(&*self.inner, levels).raise()?,
        };
        let summary = detached(py, || hysteron::inspect_recording(&*self.inner, plane)).raise()?;
        result_of(py, "RecordingSummary", &summary)
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let half = slf.py().import("pyhysteron._html")?;
        half.call_method1("recording", (slf,))
    }

    fn __len__(&self) -> usize {
        self.inner.len()
    }

    /// Whether samples, names and origin are the same, wherever they were read from.
    fn __eq__(&self, other: &Self) -> bool {
        let unread = |recording: &hysteron::Recording| hysteron::Recording {
            source: None,
            ..recording.clone()
        };
        unread(&self.inner) == unread(&other.inner)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, this) = (slf.py(), slf.get());
        let named = PyDict::new(py);
        named.set_item("time", this.time(py))?;
        named.set_item("load", this.load(py))?;
        named.set_item("input_name", this.input_name())?;
        named.set_item("output_name", this.output_name())?;
        named.set_item("load_name", this.load_name())?;
        named.set_item("simulated", this.simulated())?;
        let series = (this.input(py), this.output(py));
        let partial = py.import("functools")?.getattr("partial")?;
        let make = partial.call((slf.get_type(),), Some(&named))?;
        (make, series).into_pyobject(py)
    }

    fn __repr__(&self) -> String {
        let simulated = if self.simulated() { ", simulated" } else { "" };
        let (input, output) = (self.input_name(), self.output_name());
        let samples = self.inner.len();
        format!("<Recording, {samples} samples{simulated}: {input} → {output}>")
    }
}
