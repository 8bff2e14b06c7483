//! The virtual rig as a plant for control: current in, temperature and displacement out through
//! sensors.

use super::divided;
use super::fatigue::FatigueOptions;
use super::sensor::{SensorChain, SensorOptions};
use crate::rig::{Plant, Rig, RigError, check};
use hysteron::control::{Device, Disturbance, Reading, SimulatedPlant};
use serde::Deserialize;

/// Largest load, N. Beyond it the law of the outer rings turns over (580 MPa); from 10 N on it is
/// steep.
const MAX_LOAD_N: f64 = 11.0;

/// The simulated spring and its sensors. The default is the chapter's rig.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SpringPlantOptions {
    /// Load, N, from 0 to 11. Default 6.
    pub load_n: f64,
    /// Room temperature, °C, from −50 to 200. Default 22.
    pub room_degc: f64,
    /// Pre-deformation, mm, from 0 to 20; see [`Rig::predeformation_mm`]. Default 0.
    pub predeformation_mm: f64,
    /// Largest current that the source gives, A, from 0.1 to 3. Default 2.
    pub limit_a: f64,
    /// Drift with the thermal cycles. Default none.
    pub fatigue: Option<FatigueOptions>,
    /// Sensor of the temperature (the hysteresis' input), °C. Default
    /// [`SensorOptions::THERMOCOUPLE`].
    pub thermocouple: SensorOptions,
    /// Sensor of the displacement (the output), mm. Default [`SensorOptions::LVDT`].
    pub lvdt: SensorOptions,
    /// Seed of both sensors' noise. Default 1.
    pub seed: u64,
}

impl Default for SpringPlantOptions {
    fn default() -> Self {
        let rig = Rig::default();
        Self {
            load_n: rig.load_n,
            room_degc: rig.room_degc,
            predeformation_mm: rig.predeformation_mm,
            limit_a: 2.0,
            fatigue: None,
            thermocouple: SensorOptions::THERMOCOUPLE,
            lvdt: SensorOptions::LVDT,
            seed: 1,
        }
    }
}

/// The **simulated** NiTi spring of the virtual [`rig`](crate::rig), driven by a current (A), from
/// 0 to [`SpringPlantOptions::limit_a`]; the source itself keeps to these limits.
///
/// Output is the displacement in mm, input of the hysteresis the temperature in °C. It knows every
/// [`Disturbance`]; a change of load acts at constant temperature, and the displacement is still
/// counted from where the first load hung.
///
/// ```
/// use hysteron::control::{Device, Disturbance, SimulatedPlant};
/// use hysteron_sim::plant::{SpringPlant, SpringPlantOptions};
///
/// let mut plant = SpringPlant::new(&SpringPlantOptions::default())?;
/// plant.write(2.0);
/// plant.advance(30.0);
/// let lifted = plant.truth().output;
/// plant.disturb(Disturbance::Load(10.0))?;
/// assert!(plant.truth().output < lifted - 1.0);
/// assert!(plant.read().input.is_some_and(|degc| degc > 60.0));
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SpringPlant {
    plant: Plant,
    limit_a: f64,
    current_a: f64,
    fatigue: Option<FatigueOptions>,
    /// Transformed fraction that has accumulated.
    transformed: f64,
    thermocouple: SensorChain,
    lvdt: SensorChain,
}

impl SpringPlant {
    /// A spring at rest at room temperature, its sensors settled.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] names the first number that does not fit.
    pub fn new(options: &SpringPlantOptions) -> Result<Self, RigError> {
        check_load(options.load_n)?;
        check("limit of the current (A)", options.limit_a, 0.1, 3.0)?;
        options
            .fatigue
            .as_ref()
            .map_or(Ok(()), FatigueOptions::check)?;
        let plant = Plant::new(Rig {
            load_n: options.load_n,
            room_degc: options.room_degc,
            predeformation_mm: options.predeformation_mm,
            ..Rig::default()
        })?;
        let sensor = |sensor, truth, stream| SensorChain::new(sensor, truth, options.seed, stream);
        Ok(Self {
            thermocouple: sensor(options.thermocouple, plant.temperature_degc(), 0)?,
            lvdt: sensor(options.lvdt, plant.displacement_mm(), 1)?,
            plant,
            limit_a: options.limit_a,
            current_a: 0.0,
            fatigue: options.fatigue,
            transformed: 0.0,
        })
    }

    /// Lets `change` happen to the spring and counts what it transforms.
    fn transforming<T>(&mut self, change: impl FnOnce(&mut Plant) -> T) -> T {
        let before = self.plant.martensite_fraction();
        let result = change(&mut self.plant);
        self.transformed += (self.plant.martensite_fraction() - before).abs();
        result
    }

    fn displacement_mm(&self) -> f64 {
        let lost = self.fatigue.map_or(0.0, |fatigue| {
            fatigue.irrecoverable_mm * fatigue.share(self.transformed)
        });
        self.plant.displacement_mm() - lost
    }

    /// The truth jumps: the change took no time.
    fn settle(&mut self) {
        self.lvdt.follow(self.displacement_mm(), 0.0);
    }
}

impl Device for SpringPlant {
    fn read(&mut self) -> Reading {
        Reading {
            output: self.lvdt.read(),
            input: Some(self.thermocouple.read()),
        }
    }

    /// Sets the current, A, held within the source's limits. NaN leaves it as it is.
    fn write(&mut self, drive: f64) {
        if !drive.is_nan() {
            self.current_a = drive.clamp(0.0, self.limit_a);
        }
    }
}

impl SimulatedPlant for SpringPlant {
    fn advance(&mut self, dt_s: f64) {
        let longest = self
            .plant
            .rig()
            .wire
            .substep_s
            .min(self.thermocouple.longest_step_s())
            .min(self.lvdt.longest_step_s());
        let (steps, h) = divided(dt_s, longest);
        for _ in 0..steps {
            let current_a = self.current_a;
            self.transforming(|plant| plant.substep(current_a, h));
            if let Some(fatigue) = self.fatigue {
                let shift_k = fatigue.shift_k * fatigue.share(self.transformed);
                // The options were checked: the shift is within its range.
                let _ = self.transforming(|plant| plant.set_transformation_shift_k(shift_k));
            }
            self.thermocouple.follow(self.plant.temperature_degc(), h);
            self.lvdt.follow(self.displacement_mm(), h);
        }
    }

    fn truth(&self) -> Reading {
        Reading {
            output: self.displacement_mm(),
            input: Some(self.plant.temperature_degc()),
        }
    }

    fn disturb(&mut self, disturbance: Disturbance) -> hysteron::Result<()> {
        match disturbance {
            Disturbance::Load(load_n) => {
                check_load(load_n)?;
                self.transforming(|plant| plant.set_load_n(load_n))?;
            }
            Disturbance::Room(degc) => self.plant.set_room_degc(degc)?,
            Disturbance::Predeformation(mm) => self.plant.set_predeformation_mm(mm)?,
            Disturbance::Gain(_) => return Err(RigError::NoSuchDisturbance("gain").into()),
            Disturbance::Stuck(stuck) => self.lvdt.set_stuck(stuck),
            Disturbance::Lost(lost) => self.lvdt.set_lost(lost),
        }
        self.settle();
        Ok(())
    }
}

fn check_load(load_n: f64) -> Result<(), RigError> {
    check("load (N)", load_n, 0.0, MAX_LOAD_N)
}
