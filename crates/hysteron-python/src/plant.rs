//! Simulated plants.

use crate::convert::{arguments, options};
use crate::error::{Raise, number};
use crate::shared::Shared;
use hysteron_sim::plant::{self, PreisachPlantOptions, SpringPlantOptions};
use hysteron_sim::track::{Event, PlantOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Longest time that a plant goes on without hearing of signals, s: a fraction of a second here.
const HEARD_S: f64 = 3600.0;

type Boxed = Box<dyn hysteron::control::SimulatedPlant + Send>;

/// A simulated device: `SpringPlant` or `PreisachPlant`.
///
/// Once a sample: `read`, `write`, `advance`. Several threads may share one. It cannot be pickled:
/// one made with the same options and seed does the same.
#[pyclass(frozen, subclass, module = "pyhysteron")]
pub(crate) struct SimulatedPlant {
    pub(crate) inner: Shared<Boxed>,
    options: PlantOptions,
}

#[pymethods]
impl SimulatedPlant {
    /// Always True: nothing was measured.
    #[getter]
    fn simulated(&self) -> bool {
        true
    }

    /// Lowest and highest drive.
    #[getter]
    fn drives(&self) -> (f64, f64) {
        self.options.drives()
    }

    /// Drive, input of the hysteresis and output, with their units.
    #[getter]
    fn quantities(&self) -> [String; 3] {
        self.options
            .quantities()
            .map(|quantity| quantity.to_column())
    }

    /// Read the sensors.
    ///
    /// Returns
    /// -------
    /// output : float
    ///     NaN where the sensor gave nothing.
    /// input : float or None
    ///     The input of the hysteresis; None where no sensor measures it.
    ///
    /// Examples
    /// --------
    /// >>> output, temperature = pyhysteron.SpringPlant().read()
    /// >>> 21 < temperature < 23  # the room's
    /// True
    fn read(&self, py: Python<'_>) -> (f64, Option<f64>) {
        let reading = self.inner.with(py, |plant| plant.read());
        (reading.output, reading.input)
    }

    /// Set the drive, held within its limits until the next call.
    ///
    /// Parameters
    /// ----------
    /// drive : float
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For a drive that is NaN or infinite; the one before stays.
    ///
    /// Examples
    /// --------
    /// >>> plant = pyhysteron.PreisachPlant()
    /// >>> plant.write(1000)
    /// >>> plant.advance(1.0)
    /// >>> round(plant.truth()[1])  # its limit
    /// 150
    fn write(&self, py: Python<'_>, drive: f64) -> PyResult<()> {
        let drive = number("drive", drive)?;
        self.inner.with(py, |plant| plant.write(drive));
        Ok(())
    }

    /// Let time pass. Ctrl-C ends it, between two hours of the plant's time.
    ///
    /// Parameters
    /// ----------
    /// dt_s : float
    ///     s, from 0 on.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For a time that cannot pass.
    ///
    /// Examples
    /// --------
    /// >>> plant = pyhysteron.PreisachPlant()
    /// >>> plant.write(150)
    /// >>> plant.advance(1.0)
    /// >>> plant.truth()[1] > 149  # the amplifier has followed
    /// True
    fn advance(&self, py: Python<'_>, dt_s: f64) -> PyResult<()> {
        if !(dt_s >= 0.0 && dt_s.is_finite()) {
            let text = format!("`dt_s` is {dt_s}: a time from 0 on is needed, in seconds");
            return Err(PyValueError::new_err(text));
        }
        let mut left = dt_s;
        while left > 0.0 {
            let now = left.min(HEARD_S);
            py.detach(|| self.inner.with_detached(|plant| plant.advance(now)));
            left -= now;
            py.check_signals()?;
        }
        Ok(())
    }

    /// The true output and input, without sensors.
    ///
    /// Returns
    /// -------
    /// output, input : float
    ///
    /// Examples
    /// --------
    /// >>> pyhysteron.PreisachPlant().truth()
    /// (0.0, 0.0)
    fn truth(&self, py: Python<'_>) -> (f64, Option<f64>) {
        let truth = self.inner.with(py, |plant| plant.truth());
        (truth.output, truth.input)
    }

    /// Change what acts on the plant.
    ///
    /// Parameters
    /// ----------
    /// load_n : float, optional
    ///     Load, N.
    /// room_degc : float, optional
    ///     Room temperature, °C.
    /// predeformation_mm : float, optional
    ///     Pre-deformation, mm.
    /// stuck, lost : bool, optional
    ///     Whether the output's sensor stands still, or reads nothing.
    ///
    /// Raises
    /// ------
    /// RigError
    ///     For values outside the plant's physics, and for what the plant does not know.
    ///
    /// Examples
    /// --------
    /// >>> plant = pyhysteron.PreisachPlant()
    /// >>> plant.disturb(lost=True)
    /// >>> plant.read()[0]
    /// nan
    #[pyo3(signature = (**what), text_signature = "($self, *, load_n=None, room_degc=None, predeformation_mm=None, stuck=None, lost=None)")]
    fn disturb(&self, py: Python<'_>, what: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let event = arguments(py, what, &[])?;
        event.set_item("at_s", 0.0)?;
        let event: Event = options("disturb", event.as_any())?;
        let what = event.disturbances();
        let disturb = |plant: &mut Boxed| what.into_iter().try_for_each(|what| plant.disturb(what));
        self.inner.with(py, disturb).raise()
    }
}

/// A simulated NiTi spring, heated by a current and read through a thermocouple and an LVDT: the
/// rig of the chapter.
///
/// Drive: current, A. Input of the hysteresis: temperature, °C. Output: displacement, mm.
///
/// Parameters
/// ----------
/// load_n : float
///     Load, N, from 0 to 11.
/// room_degc : float
///     Room temperature, °C, from -50 to 200.
/// predeformation_mm : float
///     From 0 to 20.
/// limit_a : float
///     Largest current, A, from 0.1 to 3.
/// fatigue : dict, optional
///     Drift with the thermal cycles: 'shift_k' (-20 to 20), 'irrecoverable_mm' (0 to 10), 'cycles'
///     (0.1 to 1e6). By default none.
/// thermocouple, lvdt : dict, optional
///     The sensors: 'lag_s', 'accuracy' (three standard deviations), 'resolution', 'range' (a
///     pair), 'dropout' (0 to 1); what is left out is perfect. By default those of the chapter.
/// seed : int
///     Of the sensors' noise.
///
/// Raises
/// ------
/// RigError
///     Names the first number that does not fit.
/// TypeError, ValueError
///     For unknown options, and values that are no numbers.
///
/// Examples
/// --------
/// >>> plant = pyhysteron.SpringPlant(load_n=6, seed=3)
/// >>> plant.write(2.0)
/// >>> plant.advance(30.0)
/// >>> lifted, temperature = plant.truth()
/// >>> plant.disturb(load_n=10.0)
/// >>> plant.truth()[0] < lifted - 1
/// True
#[pyclass(frozen, extends = SimulatedPlant, module = "pyhysteron")]
pub(crate) struct SpringPlant;

#[pymethods]
impl SpringPlant {
    #[new]
    #[pyo3(signature = (**options), text_signature = "(*, load_n=6.0, room_degc=22.0, predeformation_mm=0.0, limit_a=2.0, fatigue=None, thermocouple=..., lvdt=..., seed=1)")]
    fn new(
        py: Python<'_>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let options = arguments(py, options, &["fatigue", "thermocouple", "lvdt"])?;
        let options: SpringPlantOptions = self::options("SpringPlant", options.as_any())?;
        let plant: Boxed = Box::new(plant::SpringPlant::new(&options).raise()?);
        let (inner, options) = (Shared::new(plant), PlantOptions::Spring(options));
        Ok(PyClassInitializer::from(SimulatedPlant { inner, options }).add_subclass(Self))
    }

    fn __repr__(&self) -> &'static str {
        "<SpringPlant, simulated: current [A] → temperature [degC] → displacement [mm]>"
    }
}

/// A simulated piezo-like actuator behind an amplifier, made of relays that no model here has on
/// its plane.
///
/// Drive: voltage, V. Input of the hysteresis: the amplifier's voltage, V. Output: displacement,
/// µm.
///
/// Parameters
/// ----------
/// load_n : float
///     Load, N, from 0 to 12.
/// lag_s : float
///     Time constant of the amplifier, s, from 0 to 5.
/// limit_v : float
///     Highest drive, V, from 1 to 150.
/// levels : int
///     Centres of relays, and half-widths for each, from 4 to 1000.
/// drift : dict, optional
///     Drift with time: 'threshold_v' (-20 to 20), 'gain' (-0.5 to 0.5), 'time_s' (10 to 1e7). By
///     default none.
/// measure_input : bool
///     Whether the amplifier's voltage is measured.
/// output_sensor, input_sensor : dict, optional
///     As those of `SpringPlant`.
/// seed : int
///     Of the sensors' noise.
///
/// Raises
/// ------
/// RigError
///     Names the first number that does not fit.
/// TypeError, ValueError
///     For unknown options, and values that are no numbers.
///
/// Examples
/// --------
/// >>> plant = pyhysteron.PreisachPlant()
/// >>> reached = []
/// >>> for drive in (0, 75, 150, 75):
/// ...     plant.write(drive)
/// ...     plant.advance(1.0)
/// ...     reached.append(plant.truth()[0])
/// >>> reached[3] > reached[1] + 10
/// True
#[pyclass(frozen, extends = SimulatedPlant, module = "pyhysteron")]
pub(crate) struct PreisachPlant;

#[pymethods]
impl PreisachPlant {
    #[new]
    #[pyo3(signature = (**options), text_signature = "(*, load_n=6.0, lag_s=0.02, limit_v=150.0, levels=240, drift=..., measure_input=False, output_sensor=..., input_sensor=..., seed=1)")]
    fn new(
        py: Python<'_>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let options = arguments(py, options, &["drift", "output_sensor", "input_sensor"])?;
        let options: PreisachPlantOptions = self::options("PreisachPlant", options.as_any())?;
        let plant: Boxed = Box::new(plant::PreisachPlant::new(&options).raise()?);
        let (inner, options) = (Shared::new(plant), PlantOptions::Preisach(options));
        Ok(PyClassInitializer::from(SimulatedPlant { inner, options }).add_subclass(Self))
    }

    fn __repr__(&self) -> &'static str {
        "<PreisachPlant, simulated: voltage [V] → displacement [um]>"
    }
}
