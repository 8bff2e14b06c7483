//! Pictures of models and recordings in a notebook.

use crate::model::Model;
use crate::recording::Recording;
use pyo3::prelude::*;

#[pymethods]
impl Model {
    /// Draw the loop between the ends of the plane and the weights; with a recording, both over its
    /// input and over time. A notebook shows it at its own width. Needs matplotlib.
    ///
    /// Parameters
    /// ----------
    /// recording : Recording, optional
    ///
    /// Returns
    /// -------
    /// plot.Picture
    ///     Its `figure` is matplotlib's.
    ///
    /// Examples
    /// --------
    /// >>> picture = pyhysteron.Model([1.0, 2.0, 4.0], (20, 80)).plot()
    /// >>> len(picture.figure.axes) >= 2
    /// True
    #[pyo3(signature = (recording=None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        recording: Option<&Bound<'py, Recording>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let plot = slf.py().import("pyhysteron.plot")?;
        plot.getattr("_notebook")?
            .call_method1("_model", (slf, recording))
    }
}

#[pymethods]
impl Recording {
    /// Draw output over input, and both over time; with a model, its output as well. A notebook
    /// shows it at its own width. Needs matplotlib.
    ///
    /// Parameters
    /// ----------
    /// model : Model, optional
    ///
    /// Returns
    /// -------
    /// plot.Picture
    ///     Its `figure` is matplotlib's.
    ///
    /// Examples
    /// --------
    /// >>> picture = pyhysteron.Recording([0.5, 1.0, 0.5], [4.0, 7.0, 5.5]).plot()
    /// >>> len(picture.figure.axes)
    /// 3
    #[pyo3(signature = (model=None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        model: Option<&Bound<'py, Model>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let plot = slf.py().import("pyhysteron.plot")?;
        plot.getattr("_notebook")?
            .call_method1("_recording", (slf, model))
    }
}
