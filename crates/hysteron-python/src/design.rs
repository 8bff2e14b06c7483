//! `design` and `Design`.

use crate::error::Raise;
use crate::evaluate::classes;
use crate::inputs::inputs_of;
use crate::integer::Integer;
use crate::model::Model;
use crate::pool::detached;
use hysteron::{DesignOptions, Plane, Rates};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// An input profile, and what its recording will determine. Made by `design`.
#[pyclass(frozen, module = "pyhysteron")]
pub(crate) struct Design {
    inner: hysteron::Design,
}

#[pymethods]
impl Design {
    /// Time of each sample in seconds, shape (n,); empty where nothing is left to measure.
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.inner.time)
    }

    /// Input at each sample, shape (n,); it starts at the bottom of the plane, with every operator
    /// off.
    #[getter]
    fn input<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.inner.input)
    }

    /// The branches in order: input at the start, input at the end, and how many corners of the
    /// plane none before it shows.
    #[getter]
    fn legs(&self) -> Vec<(f64, f64, usize)> {
        let legs = self.inner.legs.iter();
        legs.map(|leg| (leg.from, leg.to, leg.new_corners))
            .collect()
    }

    /// What recordings and profile say together, shape (K, K), as `excitation` has it.
    #[getter]
    fn excitation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        classes(py, &self.inner.excitation)
    }

    /// What the recordings alone say, shape (K, K); None without recordings.
    #[getter]
    fn recorded<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let recorded = self.inner.recorded.as_ref();
        recorded.map(|found| classes(py, found)).transpose()
    }

    /// Corners of the plane known then, of ``K (K + 1) / 2``: with all of them every operator is
    /// determined.
    #[getter]
    fn corners(&self) -> usize {
        self.inner.corners
    }

    /// Duration in seconds.
    #[getter]
    fn duration(&self) -> f64 {
        self.inner.duration_s()
    }

    /// Duration in seconds without a budget.
    #[getter]
    fn full_duration(&self) -> f64 {
        self.inner.full_duration_s
    }

    /// Write the profile as CSV with the columns ``time [s]`` and ``input``.
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
    /// >>> path = os.path.join(tempfile.mkdtemp(), 'profile.csv')
    /// >>> pyhysteron.design((20, 80), 20, heating_rate=2, cooling_rate=0.5).to_csv(path)
    /// >>> open(path).readline()
    /// 'time [s],input\n'
    fn to_csv(&self, path: PathBuf) -> PyResult<()> {
        self.inner.write_csv(&path).raise()
    }

    fn __len__(&self) -> usize {
        self.inner.time.len()
    }

    fn __repr__(&self) -> String {
        let (samples, legs) = (self.inner.time.len(), self.inner.legs.len());
        format!(
            "<Design, {legs} branches, {samples} samples, {:.1} s>",
            self.duration()
        )
    }
}

/// The shortest input profile that determines every operator of a plane.
///
/// With `recorded`, only what these recordings do not determine.
///
/// Parameters
/// ----------
/// range : tuple of float
///     Lowest and highest level of the plane, in the input's unit; the profile starts one level
///     below the lowest.
/// levels : int
/// heating_rate, cooling_rate : float
///     How fast the input can rise and fall, in its unit per second.
/// budget : float, optional
///     Longest duration, s: as many rings as fit, evenly spread. By default all that it takes.
/// recorded : array_like of shape (n,), Recording, or list of these, optional
///     Inputs that exist: what they determine is left out.
/// step : float, optional
///     Longest time between samples, s; by default ten samples a level.
/// operator : {'mkp', 'kp', 'relay'}
///
/// Returns
/// -------
/// Design
///
/// Raises
/// ------
/// DesignError
///     For an invalid rate, budget or step, or recordings outside the plane.
/// CoreError
///     For an invalid plane.
///
/// Examples
/// --------
/// >>> profile = pyhysteron.design((20, 80), 20, heating_rate=2, cooling_rate=0.5)
/// >>> profile
/// <Design, 20 branches, 5101 samples, 805.3 s>
/// >>> bool(np.nanmin(profile.excitation) == 3)  # every operator is determined
/// True
/// >>> len(pyhysteron.design((20, 80), 20, heating_rate=2, cooling_rate=0.5, recorded=profile.input))
/// 0
#[pyfunction]
#[pyo3(signature = (range, levels, *, heating_rate, cooling_rate, budget=None, recorded=None, step=None, operator="mkp", **unknown),
    text_signature = "(range, levels, *, heating_rate, cooling_rate, budget=None, recorded=None, step=None, operator='mkp')")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn design(
    py: Python<'_>,
    range: (f64, f64),
    levels: Integer,
    heating_rate: f64,
    cooling_rate: f64,
    budget: Option<f64>,
    recorded: Option<&Bound<'_, PyAny>>,
    step: Option<f64>,
    operator: &str,
    unknown: Option<&Bound<'_, PyDict>>,
) -> PyResult<Design> {
    let names = [
        "heating_rate",
        "cooling_rate",
        "budget",
        "recorded",
        "step",
        "operator",
    ];
    crate::choices::none_left("design", unknown, &names)?;
    let rates = Rates {
        heating: heating_rate,
        cooling: cooling_rate,
    };
    let plane = Plane::new(range.0, range.1, levels.convert("levels")?).raise()?;
    let options = DesignOptions {
        operator: crate::choices::operator(operator)?,
        budget_s: budget,
        step_s: step,
        ..DesignOptions::new(plane, rates)
    };
    let recorded = match recorded {
        Some(recorded) => inputs_of(recorded, "recorded")?,
        None => Vec::new(),
    };
    let inputs: Vec<&[f64]> = recorded.iter().map(Vec::as_slice).collect();
    let inner = detached(py, || hysteron::design(&options, &inputs)).raise()?;
    Ok(Design { inner })
}

/// The profile of drives of which a model with a thermal body can be identified anew.
///
/// It is planned in temperatures, within the model's range and 5 % inside of what the drives can
/// hold, and given as the drives that make the body follow it. The first drive holds the first
/// temperature: begin at rest there. `Design.legs` are in temperatures. Heat that the operators bind
/// is left out of the plan.
///
/// Parameters
/// ----------
/// model : Model
///     It has a thermal body.
/// range : tuple of float, optional
///     Lowest and highest drive; by default those of the recording that was fitted.
/// levels : int
///     Of the plane that is planned for, 2 or more; by default 20.
/// heating_rate, cooling_rate : float, optional
///     How fast the temperature rises and falls, in its unit per second; by default as fast as the
///     drives can everywhere. Give both or none.
/// budget : float, optional
///     Longest duration, s, above zero. By default all that it takes.
/// step : float, optional
///     Longest time between samples, s, above zero; by default ten samples a level.
///
/// Returns
/// -------
/// Design
///
/// Raises
/// ------
/// DesignError
///     For a model without a body, a range in which nothing moves, and rates that its drives cannot
///     give; one rate alone, an invalid budget or step.
///
/// Examples
/// --------
/// >>> time = np.arange(3000) * 0.1
/// >>> drive = 50 - 50 * np.cos(0.05 * time)
/// >>> temperature = np.zeros(3000)
/// >>> for n in range(1, 3000):
/// ...     temperature[n] = temperature[n - 1] + 0.1 / 4 * (drive[n] - temperature[n - 1])
/// >>> wire = pyhysteron.fit(drive, temperature, time=time, levels=5, thermal='first-order')
/// >>> profile = pyhysteron.design_heated(wire, range=(0, 80), levels=10)
/// >>> bool(profile.input.min() >= 0 and profile.input.max() <= 80)
/// True
#[pyfunction]
#[pyo3(signature = (model, *, range=None, levels=None, heating_rate=None, cooling_rate=None, budget=None, step=None, **unknown),
    text_signature = "(model, *, range=None, levels=20, heating_rate=None, cooling_rate=None, budget=None, step=None)")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn design_heated(
    py: Python<'_>,
    model: &Model,
    range: Option<(f64, f64)>,
    levels: Option<Integer>,
    heating_rate: Option<f64>,
    cooling_rate: Option<f64>,
    budget: Option<f64>,
    step: Option<f64>,
    unknown: Option<&Bound<'_, PyDict>>,
) -> PyResult<Design> {
    let names = [
        "range",
        "levels",
        "heating_rate",
        "cooling_rate",
        "budget",
        "step",
    ];
    crate::choices::none_left("design_heated", unknown, &names)?;
    let rates = match (heating_rate, cooling_rate) {
        (None, None) => None,
        (Some(heating), Some(cooling)) => Some(Rates { heating, cooling }),
        _ => {
            let what = "give both `heating_rate` and `cooling_rate`, or neither";
            return Err(hysteron::Error::Design(what.into())).raise();
        }
    };
    let levels = levels.map_or(Ok(20), |levels| levels.convert("levels"))?;
    let model = &model.inner;
    let find = || hysteron::design_heated(model, range, levels, rates, (budget, step));
    let inner = detached(py, find).raise()?;
    Ok(Design { inner })
}
