//! Simulated plants.

use crate::convert::{arguments, options};
use crate::error::{Raise, number};
use crate::shared::Shared;
use hysteron_sim::plant::{
    self, BoucWenPlantOptions, LatentWirePlantOptions, PreisachPlantOptions, SpringPlantOptions,
};
use hysteron_sim::track::{Event, PlantOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Longest time that a plant goes on without hearing of signals, s: a fraction of a second here.
const HEARD_S: f64 = 3600.0;

type Boxed = Box<dyn hysteron::control::SimulatedPlant + Send>;

/// A simulated device: `SpringPlant`, `PreisachPlant`, `LatentWirePlant` or `BoucWenPlant`.
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
    /// gain : float, optional
    ///     Ageing: the share of its first stroke that the actuator still has, from 0.5 to 1.
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
    #[pyo3(signature = (**what), text_signature = "($self, *, load_n=None, room_degc=None, predeformation_mm=None, gain=None, stuck=None, lost=None)")]
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

/// A simulated shape-memory wire whose transformation binds heat, pulled by a spring. Only its
/// displacement is measured.
///
/// Cosine kinetics of Liang & Rogers (1990), latent heat, and natural convection (Churchill & Chu
/// 1975). Drive: duty, from 0 to 1. Input of the hysteresis: temperature, °C. Output: displacement,
/// mm.
///
/// Parameters
/// ----------
/// load_n : float
///     Force on the cold wire, N, from 1 to 4.
/// stiffness_n_per_mm : float
///     Of the spring, N/mm, from 0 (a weight) to 0.2.
/// room_degc : float
///     Room temperature, °C, from -20 to 50.
/// latent_heat_j_per_g : float
///     Of the whole transformation, J/g, from 0 to 40.
/// strain : float
///     Largest recoverable strain, from 0.01 to 0.067.
/// drive : {'duty', 'current'}
///     Whether the power is proportional to the drive or to its square.
/// limit_a : float
///     Current at full drive, A, from 0.1 to 0.6.
/// sensor : dict, optional
///     As those of `SpringPlant`.
/// seed : int
///     Of the sensor's noise.
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
/// >>> wire = pyhysteron.LatentWirePlant()
/// >>> wire.write(1.0)
/// >>> wire.advance(10.0)
/// >>> wire.truth()[0] > 3.9
/// True
#[pyclass(frozen, extends = SimulatedPlant, module = "pyhysteron")]
pub(crate) struct LatentWirePlant;

#[pymethods]
impl LatentWirePlant {
    #[new]
    #[pyo3(signature = (**options), text_signature = "(*, load_n=3.0, stiffness_n_per_mm=0.1, room_degc=20.0, latent_heat_j_per_g=20.0, strain=0.04, drive='duty', limit_a=0.3, sensor=..., seed=1)")]
    fn new(
        py: Python<'_>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let options = arguments(py, options, &["sensor"])?;
        let options: LatentWirePlantOptions = self::options("LatentWirePlant", options.as_any())?;
        let plant: Boxed = Box::new(plant::LatentWirePlant::new(&options).raise()?);
        let (inner, options) = (Shared::new(plant), PlantOptions::LatentWire(options));
        Ok(PyClassInitializer::from(SimulatedPlant { inner, options }).add_subclass(Self))
    }

    fn __repr__(&self) -> &'static str {
        "<LatentWirePlant, simulated: duty → temperature [degC] → displacement [mm]>"
    }
}

/// A simulated piezo stage: Bouc-Wen hysteresis, creep, a resonance, and a drive that comes late.
///
/// `h = d u - z`, `z' = α d u' - β |u'| z - γ u' |z|`. Drive: voltage, V. Input of the hysteresis:
/// the voltage that acts, V. Output: displacement, µm.
///
/// Parameters
/// ----------
/// load_n : float
///     Force against the stage, N, from 0 to 20; 5 N push it back by 1 µm.
/// limit_v : float
///     Highest drive, V, from 1 to 150.
/// alpha : float
///     Share that the hysteresis takes away at first, from 0 to 0.9.
/// beta, gamma : float
///     How fast it saturates, 1/V, from 0.001 to 1, and how unlike its two sides are, from -beta to
///     beta.
/// creep : float
///     Share of the three terms at 0.3, 3 and 30 s together, from 0 to 0.3.
/// resonance_hz, damping : float
///     From 20 to 20000 Hz; damping ratio from 0.001 to 0.9.
/// delay_s : float
///     Time until a drive acts, s, from 0 to 0.1.
/// sensor : dict, optional
///     As those of `SpringPlant`.
/// seed : int
///     Of the sensor's noise.
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
/// >>> stage = pyhysteron.BoucWenPlant()
/// >>> stage.write(100.0)
/// >>> stage.advance(0.0005)
/// >>> stage.truth()  # the voltage acts now, and moves nothing yet
/// (0.0, 100.0)
#[pyclass(frozen, extends = SimulatedPlant, module = "pyhysteron")]
pub(crate) struct BoucWenPlant;

#[pymethods]
impl BoucWenPlant {
    #[new]
    #[pyo3(signature = (**options), text_signature = "(*, load_n=0.0, limit_v=100.0, alpha=0.3, beta=0.02, gamma=0.01, creep=0.03, resonance_hz=400.0, damping=0.03, delay_s=0.0005, sensor=..., seed=1)")]
    fn new(
        py: Python<'_>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let options = arguments(py, options, &["sensor"])?;
        let options: BoucWenPlantOptions = self::options("BoucWenPlant", options.as_any())?;
        let plant: Boxed = Box::new(plant::BoucWenPlant::new(&options).raise()?);
        let (inner, options) = (Shared::new(plant), PlantOptions::BoucWen(options));
        Ok(PyClassInitializer::from(SimulatedPlant { inner, options }).add_subclass(Self))
    }

    fn __repr__(&self) -> &'static str {
        "<BoucWenPlant, simulated: voltage [V] → displacement [um]>"
    }
}
