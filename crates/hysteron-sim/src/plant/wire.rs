//! A wire without a thermometer: duty in, displacement out, nothing else measured.

use super::relays::{Relay, Relays};
use super::sensor::{SensorChain, SensorOptions};
use super::{check_room, divided};
use crate::rig::{RigError, check};
use hysteron::control::{Device, Disturbance, Reading, SimulatedPlant};
use serde::Deserialize;

/// Stroke, mm, and by how much a load stretches the spring behind the wire, mm/N.
const STROKE_MM: f64 = 4.0;
const STRETCH_MM_PER_N: f64 = 0.1;
/// The load at which the thresholds are those of [`relays`], N, and how far a load moves them, K/N.
const NOMINAL_LOAD_N: f64 = 5.0;
const SHIFT_K_PER_N: f64 = 4.0;
/// How fast the full duty heats, K/s.
const HEATING_K_PER_S: f64 = 60.0;
/// Time constant of cooling a little above the room, s, and by how much it cools faster when hot,
/// 1/K.
const COOLING_S: f64 = 3.0;
const FASTER_PER_K: f64 = 0.004;
/// Longest step of the integration, s.
const LONGEST_S: f64 = 0.005;
/// Centres, and widths for each centre, of the relays.
const CENTRES: usize = 300;
const WIDTHS: usize = 40;

/// The simulated wire and its sensor.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WirePlantOptions {
    /// Load, N, from 0 to 20. Default 5.
    pub load_n: f64,
    /// Temperature of the room, °C, from -20 to 50. Default 20.
    pub room_degc: f64,
    /// Sensor of the displacement, mm. Default ±0.03 (a standard deviation of 0.01 mm).
    pub sensor: SensorOptions,
    /// Seed of the sensor's noise. Default 1.
    pub seed: u64,
}

impl Default for WirePlantOptions {
    fn default() -> Self {
        Self {
            load_n: NOMINAL_LOAD_N,
            room_degc: 20.0,
            sensor: SensorOptions {
                accuracy: 0.03,
                ..SensorOptions::default()
            },
            seed: 1,
        }
    }
}

/// A **simulated** shape-memory wire, heated by a duty from 0 to 1. Only its displacement is
/// measured.
///
/// It cools faster when it is hot, which a first-order body does not do, and it is made of relays
/// that no model of this toolkit has on its plane. A load shifts the transformation by 4 K/N and
/// stretches the spring behind the wire by 0.1 mm/N. It knows [`Disturbance::Load`],
/// [`Disturbance::Room`] and the sensor's faults.
///
/// ```
/// use hysteron::control::{Device, SimulatedPlant};
/// use hysteron_sim::plant::{WirePlant, WirePlantOptions};
/// let mut wire = WirePlant::new(&WirePlantOptions::default())?;
/// wire.write(1.0);
/// wire.advance(20.0);
/// assert!(wire.truth().output > 3.9); // mm
/// # Ok::<(), hysteron_sim::rig::RigError>(())
/// ```
#[derive(Debug, Clone)]
pub struct WirePlant {
    options: WirePlantOptions,
    relays: Relays,
    duty: f64,
    /// Temperature of the wire, °C.
    degc: f64,
    sensor: SensorChain,
}

impl WirePlant {
    /// A wire at the temperature of the room.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] names the first number that does not fit.
    pub fn new(options: &WirePlantOptions) -> Result<Self, RigError> {
        check_load(options.load_n)?;
        check_room(options.room_degc)?;
        let mut wire = Self {
            options: *options,
            relays: Relays::new(&relays(), -100.0),
            duty: 0.0,
            degc: options.room_degc,
            sensor: SensorChain::new(options.sensor, 0.0, options.seed, 0)?,
        };
        wire.feel();
        wire.sensor.settle(wire.output_mm());
        Ok(wire)
    }

    fn output_mm(&self) -> f64 {
        let more = self.options.load_n - NOMINAL_LOAD_N;
        STROKE_MM * self.relays.share() - STRETCH_MM_PER_N * more
    }

    /// Shows the relays the temperature, less the shift by the load.
    fn feel(&mut self) {
        let more = self.options.load_n - NOMINAL_LOAD_N;
        self.relays.travel(self.degc - SHIFT_K_PER_N * more);
    }
}

/// Centres and widths are spread like a logistic distribution; hotter relays are wider. In °C at the
/// nominal load.
fn relays() -> Vec<Relay> {
    let spread = |n: usize, of: usize| {
        let share = (n as f64 + 0.5) / of as f64;
        (share / (1.0 - share)).ln()
    };
    let pairs = (0..CENTRES).flat_map(|c| (0..WIDTHS).map(move |w| (c, w)));
    let relay = |(c, w)| {
        let centre = 72.0 + 7.0 * spread(c, CENTRES);
        let half = (10.0 + 0.04 * (centre - 20.0) + spread(w, WIDTHS)).max(0.5);
        Relay {
            down: centre - half,
            up: centre + half,
        }
    };
    pairs.map(relay).collect()
}

impl Device for WirePlant {
    fn read(&mut self) -> Reading {
        Reading {
            output: self.sensor.read(),
            input: None,
        }
    }

    /// Sets the duty, held within 0 and 1. NaN leaves it as it is.
    fn write(&mut self, drive: f64) {
        if !drive.is_nan() {
            self.duty = drive.clamp(0.0, 1.0);
        }
    }
}

impl SimulatedPlant for WirePlant {
    fn advance(&mut self, dt_s: f64) {
        let longest = LONGEST_S.min(self.sensor.longest_step_s());
        let (steps, h) = divided(dt_s, longest);
        for _ in 0..steps {
            let above = self.degc - self.options.room_degc;
            let loss = above * (1.0 + FASTER_PER_K * above.max(0.0)) / COOLING_S;
            self.degc += h * (HEATING_K_PER_S * self.duty - loss);
            self.feel();
            self.sensor.follow(self.output_mm(), h);
        }
    }

    fn truth(&self) -> Reading {
        Reading {
            output: self.output_mm(),
            input: Some(self.degc),
        }
    }

    fn disturb(&mut self, disturbance: Disturbance) -> hysteron::Result<()> {
        match disturbance {
            Disturbance::Load(load_n) => {
                check_load(load_n)?;
                self.options.load_n = load_n;
                self.feel();
                self.sensor.follow(self.output_mm(), 0.0);
            }
            Disturbance::Room(degc) => {
                check_room(degc)?;
                self.options.room_degc = degc;
            }
            Disturbance::Gain(_) => return Err(RigError::NoSuchDisturbance("gain").into()),
            Disturbance::Stuck(stuck) => self.sensor.set_stuck(stuck),
            Disturbance::Lost(lost) => self.sensor.set_lost(lost),
            Disturbance::Predeformation(_) => {
                return Err(RigError::NoSuchDisturbance("pre-deformation").into());
            }
        }
        Ok(())
    }
}

fn check_load(load_n: f64) -> Result<(), RigError> {
    check("load (N)", load_n, 0.0, 20.0)
}
