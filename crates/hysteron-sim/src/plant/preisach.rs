//! A piezo-like actuator: a cloud of relays behind an amplifier with a lag.

use super::cloud::{NOMINAL_LOAD_N, cloud, relative};
use super::divided;
use super::drift::DriftOptions;
use super::relays::Relays;
use super::sensor::{SensorChain, SensorOptions, step_for_lag};
use crate::rig::{RigError, check};
use hysteron::control::{Device, Disturbance, Reading, SimulatedPlant};
use serde::Deserialize;

/// Highest drive, V; the lowest is 0.
const LIMIT_V: f64 = 150.0;
/// Stroke at the nominal load, µm.
const STROKE_UM: f64 = 100.0;

/// The simulated actuator and its sensors.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PreisachPlantOptions {
    /// Load, N, from 0 to 12. Default 6.
    pub load_n: f64,
    /// Time constant of the amplifier, s, from 0 (none) to 5. Default 0.02.
    pub lag_s: f64,
    /// Highest drive, V, from 1 to 150; the lowest is 0. Default 150.
    pub limit_v: f64,
    /// Centres, and half-widths for each centre, from 4 to 1000. Default 240: 57 600 relays.
    pub levels: usize,
    /// Drift with time. Default none.
    pub drift: DriftOptions,
    /// Whether the amplifier's voltage (the hysteresis' input) is measured. Default no: the drive
    /// is all that is known.
    pub measure_input: bool,
    /// Sensor of the displacement, µm. Default ±0.3 (a standard deviation of 0.1 % of the stroke),
    /// −50 to 150 µm in 16 bits.
    pub output_sensor: SensorOptions,
    /// Sensor of the amplifier's voltage, V. Default ±0.3, −10 to 190 V in 16 bits.
    pub input_sensor: SensorOptions,
    /// Seed of both sensors' noise. Default 1.
    pub seed: u64,
}

impl Default for PreisachPlantOptions {
    fn default() -> Self {
        let sensor = |low: f64| SensorOptions {
            accuracy: 0.3,
            resolution: 200.0 / 65536.0,
            range: Some((low, low + 200.0)),
            ..SensorOptions::default()
        };
        Self {
            load_n: NOMINAL_LOAD_N,
            lag_s: 0.02,
            limit_v: LIMIT_V,
            levels: 240,
            drift: DriftOptions::default(),
            measure_input: false,
            output_sensor: sensor(-50.0),
            input_sensor: sensor(-10.0),
            seed: 1,
        }
    }
}

/// A **simulated** actuator with a hidden fine Preisach density, driven by a voltage from 0 to
/// [`PreisachPlantOptions::limit_v`].
///
/// Output is the displacement in µm, input of the hysteresis the amplifier's voltage. It knows
/// [`Disturbance::Load`], which shifts and spreads the thresholds, lowers the gain and moves the
/// offset, and the sensor's faults; it has no room and no pre-deformation.
///
/// ```
/// use hysteron::control::{Device, SimulatedPlant};
/// use hysteron_sim::plant::{PreisachPlant, PreisachPlantOptions};
///
/// let mut plant = PreisachPlant::new(&PreisachPlantOptions::default())?;
/// let mut at_75_v = |from_v: f64| {
///     for drive in [from_v, 75.0] {
///         plant.write(drive);
///         plant.advance(1.0);
///     }
///     plant.truth().output
/// };
/// assert!(at_75_v(150.0) > at_75_v(0.0) + 10.0);
/// # Ok::<(), hysteron_sim::rig::RigError>(())
/// ```
#[derive(Debug, Clone)]
pub struct PreisachPlant {
    options: PreisachPlantOptions,
    relays: Relays,
    drive_v: f64,
    amplifier_v: f64,
    /// Share of the drift that is still to come, `exp(−t/T)`.
    to_come: f64,
    output: SensorChain,
    input: SensorChain,
}

impl PreisachPlant {
    /// An actuator that has never been driven.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] names the first number that does not fit.
    pub fn new(options: &PreisachPlantOptions) -> Result<Self, RigError> {
        check_load(options.load_n)?;
        check(
            "time constant of the amplifier (s)",
            options.lag_s,
            0.0,
            5.0,
        )?;
        check("limit of the drive (V)", options.limit_v, 1.0, LIMIT_V)?;
        check("levels of the cloud", options.levels as f64, 4.0, 1000.0)?;
        options.drift.check()?;
        let sensor = |sensor, stream| SensorChain::new(sensor, 0.0, options.seed, stream);
        let mut plant = Self {
            options: *options,
            relays: Relays::new(&cloud(options.levels, options.load_n), 0.0),
            drive_v: 0.0,
            amplifier_v: 0.0,
            to_come: 1.0,
            output: sensor(options.output_sensor, 0)?,
            input: sensor(options.input_sensor, 1)?,
        };
        plant.output.settle(plant.output_um());
        Ok(plant)
    }

    fn output_um(&self) -> f64 {
        let load = relative(self.options.load_n);
        let gain = (1.0 - 0.1 * load) * (1.0 + self.options.drift.gain * (1.0 - self.to_come));
        STROKE_UM * (gain * self.relays.share() - 0.18 * load)
    }

    /// Lets `dt_s` pass. What the relays feel is the amplifier's voltage less the drift of their
    /// thresholds. Both are exponentials, so it turns round at most once, at a time that is known:
    /// the relays get every turning point, and the step is exact.
    fn step(&mut self, dt_s: f64) {
        if let Some(turn_s) = self.turn_s().filter(|turn_s| *turn_s < dt_s) {
            let (amplifier_v, to_come) = self.after(turn_s);
            self.relays.travel(self.felt_v(amplifier_v, to_come));
        }
        (self.amplifier_v, self.to_come) = self.after(dt_s);
        self.relays
            .travel(self.felt_v(self.amplifier_v, self.to_come));
    }

    /// The amplifier's voltage and the drift that is still to come after `dt_s` with the drive
    /// held.
    fn after(&self, dt_s: f64) -> (f64, f64) {
        let decay = if self.options.lag_s > 0.0 {
            (-dt_s / self.options.lag_s).exp()
        } else {
            0.0
        };
        let amplifier_v = self.drive_v + (self.amplifier_v - self.drive_v) * decay;
        let to_come = self.to_come * (-dt_s / self.options.drift.time_s).exp();
        (amplifier_v, to_come)
    }

    fn felt_v(&self, amplifier_v: f64, to_come: f64) -> f64 {
        amplifier_v - self.options.drift.threshold_v * (1.0 - to_come)
    }

    /// When, s from now, what the relays feel turns round; `None` if it does not.
    fn turn_s(&self) -> Option<f64> {
        let (lag, slow) = (self.options.lag_s, self.options.drift.time_s);
        if lag == 0.0 {
            // The amplifier jumps, then the drift goes on.
            return Some(0.0);
        }
        // Where (u − v)/τ exp(−t/τ) = S c/T exp(−t/T), with c still to come.
        let fast_rate = (self.drive_v - self.amplifier_v) / lag;
        let slow_rate = self.options.drift.threshold_v * self.to_come / slow;
        let turn_s = (fast_rate / slow_rate).ln() / (1.0 / lag - 1.0 / slow);
        (turn_s.is_finite() && turn_s > 0.0).then_some(turn_s)
    }

    /// Shows the sensors what `dt_s` has brought.
    fn follow(&mut self, dt_s: f64) {
        self.output.follow(self.output_um(), dt_s);
        self.input.follow(self.amplifier_v, dt_s);
    }
}

impl Device for PreisachPlant {
    fn read(&mut self) -> Reading {
        Reading {
            output: self.output.read(),
            input: self.options.measure_input.then(|| self.input.read()),
        }
    }

    /// Sets the drive, V, held within its limits. NaN leaves it as it is.
    fn write(&mut self, drive: f64) {
        if !drive.is_nan() {
            self.drive_v = drive.clamp(0.0, self.options.limit_v);
        }
    }
}

impl SimulatedPlant for PreisachPlant {
    /// Exact up to rounding, in one step; only a sensor with a lag divides it, to follow the
    /// output's path.
    fn advance(&mut self, dt_s: f64) {
        let longest = self
            .output
            .longest_step_s()
            .min(self.input.longest_step_s());
        let longest = if longest.is_finite() {
            longest.min(step_for_lag(self.options.lag_s))
        } else {
            longest
        };
        let (steps, h) = divided(dt_s, longest);
        for _ in 0..steps {
            self.step(h);
            self.follow(h);
        }
    }

    fn truth(&self) -> Reading {
        Reading {
            output: self.output_um(),
            input: Some(self.amplifier_v),
        }
    }

    fn disturb(&mut self, disturbance: Disturbance) -> hysteron::Result<()> {
        match disturbance {
            Disturbance::Load(load_n) => {
                check_load(load_n)?;
                self.options.load_n = load_n;
                self.relays.replace(&cloud(self.options.levels, load_n));
                self.follow(0.0);
            }
            Disturbance::Gain(_) => return Err(RigError::NoSuchDisturbance("gain").into()),
            Disturbance::Stuck(stuck) => self.output.set_stuck(stuck),
            Disturbance::Lost(lost) => self.output.set_lost(lost),
            Disturbance::Room(_) => return Err(RigError::NoSuchDisturbance("room").into()),
            Disturbance::Predeformation(_) => {
                return Err(RigError::NoSuchDisturbance("pre-deformation").into());
            }
        }
        Ok(())
    }
}

fn check_load(load_n: f64) -> Result<(), RigError> {
    check("load (N)", load_n, 0.0, 12.0)
}
