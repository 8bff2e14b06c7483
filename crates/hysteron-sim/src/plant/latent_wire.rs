//! A wire whose transformation binds heat, pulled by a spring: duty or current in, displacement out.
//!
//! - **Transformation**: cosine kinetics with stress-dependent temperatures (Liang & Rogers 1990)
//!   and partial loops, as in the [`rig`](crate::rig), for one material point.
//! - **Strain** `ε = σ/E(ξ) + ε_L ξ`, `E` and `ε_L` of Brinson 1993. The spring adds to the load as
//!   the wire contracts, so stress and martensite fraction are found together.
//! - **Heat** `H = m c T − m L ξ`, `dH/dt = P − h(T) A (T − T_room)`, with natural convection
//!   (Churchill & Chu 1975). The heat content is what is integrated. So no heat is lost in a step,
//!   however steep the transformation is.

use super::sensor::{SensorChain, SensorOptions};
use super::{check_room, divided};
use crate::rig::{Body, Direction, MaterialPoint, RigError, Spring, Transformation, Wire, check};
use core::f64::consts::PI;
use hysteron::control::{Device, Disturbance, Reading, SimulatedPlant};
use serde::Deserialize;

/// Diameter and length of the wire, mm: Flexinol of 0.006 inch.
const DIAMETER_MM: f64 = 0.15;
const LENGTH_MM: f64 = 100.0;
/// Longest step of the integration, s. Its error is below 1e-7 mm, of a stroke of 4 mm (tested).
const LONGEST_S: f64 = 0.01;
/// Most steps towards a martensite fraction; some eight reach rounding.
const ROUNDS: usize = 100;

/// What the drive, from 0 to 1, is a share of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HeatingDrive {
    /// The time that the current of [`LatentWirePlantOptions::limit_a`] flows, as a fast pulse-width
    /// modulation gives it: the power is proportional to the drive.
    #[default]
    Duty,
    /// The current itself: the power is proportional to the drive squared.
    Current,
}

/// The simulated wire, its spring and its sensor.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LatentWirePlantOptions {
    /// Force on the cold wire, N, from 1 to 4. Default 3: 170 MPa, which orients all martensite
    /// (Brinson 1993) and is what Dynalloy recommends for Flexinol.
    pub load_n: f64,
    /// Stiffness of the bias spring, N/mm, from 0 (a weight) to 0.2. Default 0.1.
    pub stiffness_n_per_mm: f64,
    /// Temperature of the room, °C, from −20 to 50. Default 20.
    pub room_degc: f64,
    /// Latent heat of the whole transformation, J/g, from 0 to 40. Default 20; measured values lie
    /// between 10 and 25 (Dynalloy gives 24.2).
    pub latent_heat_j_per_g: f64,
    /// Largest recoverable strain `ε_L`, from 0.01 to 0.067 (Brinson 1993). Default 0.04, what
    /// Dynalloy recommends for long life.
    pub strain: f64,
    /// What the drive is a share of. Default the duty.
    pub drive: HeatingDrive,
    /// Current at full drive, A, from 0.1 to 0.6. Default 0.3. Dynalloy gives 0.41 for a contraction
    /// in one second.
    pub limit_a: f64,
    /// Sensor of the displacement, mm. Default ±0.03 (a standard deviation of 0.01 mm).
    pub sensor: SensorOptions,
    /// Seed of the sensor's noise. Default 1.
    pub seed: u64,
}

impl Default for LatentWirePlantOptions {
    fn default() -> Self {
        Self {
            load_n: 3.0,
            stiffness_n_per_mm: 0.1,
            room_degc: 20.0,
            latent_heat_j_per_g: 20.0,
            strain: 0.04,
            drive: HeatingDrive::Duty,
            limit_a: 0.3,
            sensor: SensorOptions {
                accuracy: 0.03,
                ..SensorOptions::default()
            },
            seed: 1,
        }
    }
}

/// A **simulated** shape-memory wire with latent heat, driven by a share from 0 to 1. Only its
/// displacement is measured.
///
/// It is made of published laws of the material, not of operators, and its heat is not that of a
/// first-order body: the transformation takes and gives some 25 times what 1 K does, and the loss
/// grows with the temperature. Radiation and the heat that flows into the clamps are left out. A load
/// acts without exchange of heat, so it warms the wire as it transforms it. The wire knows
/// [`Disturbance::Load`], [`Disturbance::Room`], [`Disturbance::Gain`] (what it no longer recovers
/// stays as strain of the hot wire) and the sensor's faults.
///
/// ```
/// use hysteron::control::{Device, SimulatedPlant};
/// use hysteron_sim::plant::{LatentWirePlant, LatentWirePlantOptions};
/// let mut wire = LatentWirePlant::new(&LatentWirePlantOptions::default())?;
/// wire.write(1.0);
/// wire.advance(10.0);
/// assert!(wire.truth().output > 3.9); // mm
/// assert!(wire.martensite_fraction() < 1e-12);
/// # Ok::<(), hysteron_sim::rig::RigError>(())
/// ```
#[derive(Debug, Clone)]
pub struct LatentWirePlant {
    options: LatentWirePlantOptions,
    law: Transformation,
    body: Body,
    point: MaterialPoint,
    drive: f64,
    /// Share of the first stroke that is left.
    gain: f64,
    /// Strain of the cold wire under its first load.
    cold_strain: f64,
    heat_j: f64,
    sensor: SensorChain,
}

impl LatentWirePlant {
    /// A wire at the temperature of the room, cooled to it from austenite under its load.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] names the first number that does not fit.
    pub fn new(options: &LatentWirePlantOptions) -> Result<Self, RigError> {
        check_load(options.load_n)?;
        check_room(options.room_degc)?;
        let stiffness = options.stiffness_n_per_mm;
        check("stiffness of the spring (N/mm)", stiffness, 0.0, 0.2)?;
        check("latent heat (J/g)", options.latent_heat_j_per_g, 0.0, 40.0)?;
        check("recoverable strain", options.strain, 0.01, 0.067)?;
        check("current at full drive (A)", options.limit_a, 0.1, 0.6)?;
        let law = Transformation::default();
        let material = Wire {
            latent_heat_j_per_kg: 1e3 * options.latent_heat_j_per_g,
            ..Wire::default()
        };
        let mut wire = Self {
            options: *options,
            law,
            body: Body::new(&material, DIAMETER_MM, LENGTH_MM),
            point: MaterialPoint::cooled_from_austenite(&law, 300.0, 0.0),
            drive: 0.0,
            gain: 1.0,
            cold_strain: options.load_n / area_mm2() / modulus_mpa(1.0) + options.strain,
            heat_j: 0.0,
            sensor: SensorChain::new(options.sensor, 0.0, options.seed, 0)?,
        };
        let room = options.room_degc;
        let xi = wire.fraction_towards(Direction::Cooling, |_| room);
        wire.point.advance(&law, room, wire.stress_mpa(xi));
        wire.heat_j = wire.body.heat_j(room, wire.martensite_fraction());
        wire.sensor.settle(wire.output_mm());
        Ok(wire)
    }

    /// Martensite fraction, from 0 to 1.
    #[must_use]
    pub fn martensite_fraction(&self) -> f64 {
        self.point.fraction()
    }

    /// Heat content, J, over that of austenite at 0 °C.
    #[must_use]
    pub fn heat_j(&self) -> f64 {
        self.heat_j
    }

    /// Heat that flows into the wire, W: what the current makes less what the air takes.
    #[must_use]
    pub fn net_power_w(&self) -> f64 {
        self.power_w(self.martensite_fraction(), self.temperature_degc())
    }

    /// Stress in the wire, MPa.
    #[must_use]
    pub fn stress(&self) -> f64 {
        self.stress_mpa(self.martensite_fraction())
    }

    fn temperature_degc(&self) -> f64 {
        let xi = self.martensite_fraction();
        self.body.temperature_degc(self.heat_j, xi)
    }

    fn power_w(&self, xi: f64, degc: f64) -> f64 {
        // The root of the mean square of the current.
        let share = match self.options.drive {
            HeatingDrive::Duty => self.drive.sqrt(),
            HeatingDrive::Current => self.drive,
        };
        let current_a = self.options.limit_a * share;
        self.body
            .net_power_w(current_a, xi, degc, self.options.room_degc)
    }

    /// Strain that the transformation makes at the martensite fraction `xi`.
    fn transformation_strain(&self, xi: f64) -> f64 {
        self.options.strain * (1.0 - self.gain * (1.0 - xi))
    }

    /// Stress at which wire, spring and load balance, from `σ A = F + k ℓ (ε_cold − ε)`, MPa.
    fn stress_mpa(&self, xi: f64) -> f64 {
        let pull = self.options.stiffness_n_per_mm * LENGTH_MM;
        let free = self.cold_strain - self.transformation_strain(xi);
        (self.options.load_n + pull * free) / (area_mm2() + pull / modulus_mpa(xi))
    }

    /// Contraction from the cold wire under its first load.
    fn output_mm(&self) -> f64 {
        let xi = self.martensite_fraction();
        let strain = self.stress_mpa(xi) / modulus_mpa(xi) + self.transformation_strain(xi);
        LENGTH_MM * (self.cold_strain - strain)
    }

    /// The martensite fraction on the branch in `direction` where the wire has the temperature
    /// `degc(ξ)`, which rises with `ξ`. More martensite means less stress too. So the branch falls
    /// with `ξ`, and `ξ − branch(ξ)` has one zero (found by regula falsi, Illinois).
    fn fraction_towards(&self, direction: Direction, degc: impl Fn(f64) -> f64) -> f64 {
        let past = |xi: f64| {
            let stress = self.stress_mpa(xi);
            xi - self.point.ahead(&self.law, direction, degc(xi), stress).0
        };
        let here = self.martensite_fraction();
        let (mut near, mut far) = match direction {
            Direction::Heating => ((here, past(here)), (0.0, past(0.0))),
            Direction::Cooling => ((here, past(here)), (1.0, past(1.0))),
        };
        for _ in 0..ROUNDS {
            if near.1 == 0.0 || (near.0 - far.0).abs() <= f64::EPSILON {
                break;
            }
            let next = near.0 - near.1 * (far.0 - near.0) / (far.1 - near.1);
            let next = (next, past(next));
            if (next.1 > 0.0) == (near.1 > 0.0) {
                far.1 *= 0.5;
            } else {
                far = near;
            }
            near = next;
            if near.1.abs() <= f64::EPSILON {
                break;
            }
        }
        near.0
    }

    /// Lets the wire transform in `direction` until it fits its heat content.
    fn transform(&mut self, direction: Direction) {
        let (body, heat_j) = (self.body, self.heat_j);
        let xi = self.fraction_towards(direction, |xi| body.temperature_degc(heat_j, xi));
        let degc = body.temperature_degc(heat_j, xi);
        self.point.advance(&self.law, degc, self.stress_mpa(xi));
    }

    /// One step of the classical Runge–Kutta method of order 4 for the heat content.
    fn step(&mut self, h: f64) {
        let start_j = self.heat_j;
        // The drive is constant, so the heat content goes one way within a step.
        let direction = match self.net_power_w() >= 0.0 {
            true => Direction::Heating,
            false => Direction::Cooling,
        };
        let power = |heat_j: f64| {
            let degc = |xi| self.body.temperature_degc(heat_j, xi);
            let xi = self.fraction_towards(direction, degc);
            self.power_w(xi, degc(xi))
        };
        let k1 = power(start_j);
        let k2 = power(start_j + 0.5 * h * k1);
        let k3 = power(start_j + 0.5 * h * k2);
        let k4 = power(start_j + h * k3);
        self.heat_j = start_j + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        self.transform(direction);
    }

    /// Lets the wire take what acts on it now, without exchange of heat.
    fn feel(&mut self) {
        self.transform(Direction::Heating);
        self.transform(Direction::Cooling);
        self.sensor.follow(self.output_mm(), 0.0);
    }
}

impl Device for LatentWirePlant {
    fn read(&mut self) -> Reading {
        Reading {
            output: self.sensor.read(),
            input: None,
        }
    }

    /// Sets the drive, held within 0 and 1. NaN leaves it as it is.
    fn write(&mut self, drive: f64) {
        if !drive.is_nan() {
            self.drive = drive.clamp(0.0, 1.0);
        }
    }
}

impl SimulatedPlant for LatentWirePlant {
    fn advance(&mut self, dt_s: f64) {
        let longest = LONGEST_S.min(self.sensor.longest_step_s());
        let (steps, h) = divided(dt_s, longest);
        for _ in 0..steps {
            self.step(h);
            self.sensor.follow(self.output_mm(), h);
        }
    }

    fn truth(&self) -> Reading {
        Reading {
            output: self.output_mm(),
            input: Some(self.temperature_degc()),
        }
    }

    fn disturb(&mut self, disturbance: Disturbance) -> hysteron::Result<()> {
        match disturbance {
            Disturbance::Load(load_n) => {
                check_load(load_n)?;
                self.options.load_n = load_n;
                self.feel();
            }
            Disturbance::Room(degc) => {
                check_room(degc)?;
                self.options.room_degc = degc;
            }
            Disturbance::Gain(gain) => {
                check("gain", gain, 0.5, 1.0)?;
                self.gain = gain;
                self.feel();
            }
            Disturbance::Stuck(stuck) => self.sensor.set_stuck(stuck),
            Disturbance::Lost(lost) => self.sensor.set_lost(lost),
            Disturbance::Predeformation(_) => {
                return Err(RigError::NoSuchDisturbance("pre-deformation").into());
            }
        }
        Ok(())
    }
}

fn area_mm2() -> f64 {
    PI * DIAMETER_MM * DIAMETER_MM / 4.0
}

/// Young's modulus at the martensite fraction `xi`, MPa: both phases share the strain.
fn modulus_mpa(xi: f64) -> f64 {
    let Spring {
        austenite_modulus_gpa: austenite,
        martensite_modulus_gpa: martensite,
        ..
    } = Spring::default();
    1e3 * (austenite + xi * (martensite - austenite))
}

/// Beyond 300 MPa the martensite would start above where the austenite does, and both
/// transformations would be driven at once.
fn check_load(load_n: f64) -> Result<(), RigError> {
    check("load (N)", load_n, 1.0, 4.0)
}
