//! A piezo stage: Bouc-Wen hysteresis, creep, a resonance, and a drive that comes late.
//!
//! - **Hysteresis** `h = g (d u − z)`, `ż = α d u̇ − β |u̇| z − γ u̇ |z|` (Wen 1976; for piezo Low &
//!   Guo 1995). With the exponent 1 it is linear on each side of `z = 0`, so a jump of the voltage
//!   is followed exactly. It has no turning points to remember, and minor loops that do not close.
//! - **Creep** `v = h + Σ_k c L_k[h]`, three first-order lags (Croft, Shed & Devasia 2001).
//! - **Resonance** `ẍ/ω² + 2 ζ ẋ/ω + x = v − F/k`.
//!
//! Between two jumps of the voltage `v` is a sum of exponentials, so each step is exact. The sizes
//! are chosen, not measured: a stage of some 20 µm at 100 V.

use super::divided;
use super::sensor::{SensorChain, SensorOptions};
use crate::rig::{RigError, check};
use core::f64::consts::TAU;
use hysteron::control::{Device, Disturbance, Reading, SimulatedPlant};
use serde::Deserialize;
use std::collections::VecDeque;

/// Displacement for each volt without hysteresis `d`, µm/V.
const UM_PER_V: f64 = 0.2;
/// Stiffness `k` of the stage, N/µm.
const N_PER_UM: f64 = 5.0;
/// Time constants of the creep, s.
const CREEP_S: [f64; 3] = [0.3, 3.0, 30.0];

/// The simulated stage and its sensor.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BoucWenPlantOptions {
    /// Force against the stage, N, from 0 to 20; 5 N push it back by 1 µm. Default 0.
    pub load_n: f64,
    /// Highest drive, V, from 1 to 150; the lowest is 0. Default 100.
    pub limit_v: f64,
    /// Share `α` of the displacement that the hysteresis takes away at first, from 0 to 0.9.
    /// Default 0.3, which makes a loop some 10 % wide.
    pub alpha: f64,
    /// How fast the hysteresis saturates `β`, 1/V, from 0.001 to 1. Default 0.02.
    pub beta: f64,
    /// How unlike rising and falling towards zero are `γ`, 1/V, from −β to β (Ismail, Ikhouane &
    /// Rodellar 2009). Default 0.01.
    pub gamma: f64,
    /// Share that creeps, of all three terms together, from 0 to 0.3. Default 0.03.
    pub creep: f64,
    /// Resonance, Hz, from 20 to 20 000. Default 400.
    pub resonance_hz: f64,
    /// Damping ratio `ζ`, from 0.001 to 0.9. Default 0.03.
    pub damping: f64,
    /// Time until a drive acts, s, from 0 to 0.1. Default 0.0005, one sample at 2 kHz.
    pub delay_s: f64,
    /// Sensor of the displacement, µm. Default ±0.015 (a standard deviation of 5 nm).
    pub sensor: SensorOptions,
    /// Seed of the sensor's noise. Default 1.
    pub seed: u64,
}

impl Default for BoucWenPlantOptions {
    fn default() -> Self {
        Self {
            load_n: 0.0,
            limit_v: 100.0,
            alpha: 0.3,
            beta: 0.02,
            gamma: 0.01,
            creep: 0.03,
            resonance_hz: 400.0,
            damping: 0.03,
            delay_s: 0.0005,
            sensor: SensorOptions {
                accuracy: 0.015,
                ..SensorOptions::default()
            },
            seed: 1,
        }
    }
}

impl BoucWenPlantOptions {
    fn check(&self) -> Result<(), RigError> {
        check_load(self.load_n)?;
        check("limit of the drive (V)", self.limit_v, 1.0, 150.0)?;
        check("alpha of the hysteresis", self.alpha, 0.0, 0.9)?;
        check("beta of the hysteresis (1/V)", self.beta, 0.001, 1.0)?;
        let most = self.beta;
        check("gamma of the hysteresis (1/V)", self.gamma, -most, most)?;
        check("share of the creep", self.creep, 0.0, 0.3)?;
        check("resonance (Hz)", self.resonance_hz, 20.0, 2e4)?;
        check("damping ratio", self.damping, 0.001, 0.9)?;
        check("delay of the drive (s)", self.delay_s, 0.0, 0.1)
    }
}

/// A **simulated** piezo stage, driven by a voltage from 0 to [`BoucWenPlantOptions::limit_v`].
///
/// Output is the displacement in µm, input of the hysteresis the voltage that acts. It knows
/// [`Disturbance::Load`], [`Disturbance::Gain`] (the stage depolarises) and the sensor's faults; it
/// has no room and no pre-deformation.
///
/// ```
/// use hysteron::control::{Device, SimulatedPlant};
/// use hysteron_sim::plant::{BoucWenPlant, BoucWenPlantOptions};
/// let mut stage = BoucWenPlant::new(&BoucWenPlantOptions::default())?;
/// let mut at_50_v = |from_v: f64| {
///     for drive in [from_v, 50.0] {
///         stage.write(drive);
///         stage.advance(0.1);
///     }
///     stage.truth().output
/// };
/// assert!(at_50_v(100.0) > at_50_v(0.0) + 1.0);
/// # Ok::<(), hysteron_sim::rig::RigError>(())
/// ```
#[derive(Debug, Clone)]
pub struct BoucWenPlant {
    options: BoucWenPlantOptions,
    /// Drives that do not act yet, and the time until each does, s.
    coming: VecDeque<(f64, f64)>,
    voltage_v: f64,
    /// `z`, µm.
    hysteresis_um: f64,
    /// Share of the first stroke that is left.
    gain: f64,
    /// What each lag of the creep is away from its end, µm.
    creep_um: [f64; 3],
    position_um: f64,
    speed_um_per_s: f64,
    sensor: SensorChain,
}

impl BoucWenPlant {
    /// A stage that has never been driven, at rest under its load.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] names the first number that does not fit.
    pub fn new(options: &BoucWenPlantOptions) -> Result<Self, RigError> {
        options.check()?;
        let mut stage = Self {
            options: *options,
            coming: VecDeque::new(),
            voltage_v: 0.0,
            hysteresis_um: 0.0,
            gain: 1.0,
            creep_um: [0.0; 3],
            position_um: -options.load_n / N_PER_UM,
            speed_um_per_s: 0.0,
            sensor: SensorChain::new(options.sensor, 0.0, options.seed, 0)?,
        };
        stage.sensor.settle(stage.position_um);
        Ok(stage)
    }

    /// The displacement without creep, resonance and load, µm.
    fn fast_um(&self) -> f64 {
        self.gain * (UM_PER_V * self.voltage_v - self.hysteresis_um)
    }

    /// Lets `change` happen at once. The lags of the creep stay where they are.
    fn jump(&mut self, change: impl FnOnce(&mut Self)) {
        let before = self.fast_um();
        change(self);
        let more = self.fast_um() - before;
        self.creep_um.iter_mut().for_each(|left| *left -= more);
    }

    /// The voltage goes to `volts`. In the direction of travel `w = ± z` follows
    /// `dw/du = α d − r w`, with `r = β − γ` below zero and `r = β + γ` above.
    fn travel(&mut self, volts: f64) {
        let BoucWenPlantOptions { beta, gamma, .. } = self.options;
        let slope = self.options.alpha * UM_PER_V;
        let sign = (volts - self.voltage_v).signum();
        let mut way = (volts - self.voltage_v).abs();
        self.voltage_v = volts;
        if slope == 0.0 {
            return;
        }
        let mut w = sign * self.hysteresis_um;
        if w < 0.0 {
            let to_zero = inverse_growth(beta - gamma, -w / slope);
            if way < to_zero {
                w += (slope - (beta - gamma) * w) * growth(beta - gamma, way);
                way = 0.0;
            } else {
                (w, way) = (0.0, way - to_zero);
            }
        }
        w += (slope - (beta + gamma) * w) * growth(beta + gamma, way);
        self.hysteresis_um = sign * w;
    }

    /// Lets `dt_s` pass with the voltage held: the homogeneous motion decays around what creep and
    /// load ask for.
    fn step(&mut self, dt_s: f64) {
        let BoucWenPlantOptions {
            resonance_hz,
            damping,
            creep,
            load_n,
            ..
        } = self.options;
        let omega = TAU * resonance_hz;
        let each = creep / CREEP_S.len() as f64;
        let end = self.fast_um() * (1.0 + creep) - load_n / N_PER_UM;
        // Position and speed of the forced motion.
        let forced = |left: &[f64; 3]| {
            let terms = left.iter().zip(CREEP_S).map(|(left, tau)| {
                let rate = 1.0 / tau;
                let near = omega * omega - 2.0 * damping * omega * rate + rate * rate;
                let position = each * left * omega * omega / near;
                (position, -rate * position)
            });
            terms.fold((end, 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1))
        };
        let (position, speed) = forced(&self.creep_um);
        let (x, v) = (self.position_um - position, self.speed_um_per_s - speed);
        let damped = omega * (1.0 - damping * damping).sqrt();
        let decay = (-damping * omega * dt_s).exp();
        let (sin, cos) = (damped * dt_s).sin_cos();
        let both = (v + damping * omega * x) / damped;
        for (left, tau) in self.creep_um.iter_mut().zip(CREEP_S) {
            *left *= (-dt_s / tau).exp();
        }
        let (position, speed) = forced(&self.creep_um);
        self.position_um = position + decay * (x * cos + both * sin);
        let turned = v * cos - (omega * omega * x + damping * omega * v) / damped * sin;
        self.speed_um_per_s = speed + decay * turned;
    }

    /// Lets `dt_s` pass; each drive acts when its time has come.
    fn pass(&mut self, mut dt_s: f64) {
        while let Some(&(wait_s, volts)) = self.coming.front()
            && wait_s <= dt_s
        {
            self.step(wait_s);
            dt_s -= wait_s;
            self.coming.pop_front();
            self.coming.iter_mut().for_each(|(left, _)| *left -= wait_s);
            self.jump(|stage| stage.travel(volts));
        }
        self.step(dt_s);
        self.coming.iter_mut().for_each(|(left, _)| *left -= dt_s);
    }
}

/// `(1 − e^(−r x))/r`.
fn growth(rate: f64, x: f64) -> f64 {
    match rate == 0.0 {
        true => x,
        false => -(-rate * x).exp_m1() / rate,
    }
}

/// `ln(1 + r x)/r`: how long an exponential that decays at the rate `r` and grows by 1 takes for `x`
/// to go to zero.
fn inverse_growth(rate: f64, x: f64) -> f64 {
    match rate == 0.0 {
        true => x,
        false => (rate * x).ln_1p() / rate,
    }
}

impl Device for BoucWenPlant {
    fn read(&mut self) -> Reading {
        Reading {
            output: self.sensor.read(),
            input: None,
        }
    }

    /// Sets the drive, V, held within its limits. It acts after the delay. NaN leaves it as it is.
    fn write(&mut self, drive: f64) {
        if drive.is_nan() {
            return;
        }
        let volts = drive.clamp(0.0, self.options.limit_v);
        let wait_s = self.options.delay_s;
        if wait_s == 0.0 {
            return self.jump(|stage| stage.travel(volts));
        }
        // One that is written in the same instant is replaced.
        self.coming.retain(|(left, _)| *left < wait_s);
        self.coming.push_back((wait_s, volts));
    }
}

impl SimulatedPlant for BoucWenPlant {
    /// Exact up to rounding, in one step; only a sensor with a lag divides it, to follow the
    /// output's path.
    fn advance(&mut self, dt_s: f64) {
        let mut longest = self.sensor.longest_step_s();
        if longest.is_finite() {
            longest = longest.min(0.02 / self.options.resonance_hz);
        }
        let (steps, h) = divided(dt_s, longest);
        for _ in 0..steps {
            self.pass(h);
            self.sensor.follow(self.position_um, h);
        }
    }

    fn truth(&self) -> Reading {
        Reading {
            output: self.position_um,
            input: Some(self.voltage_v),
        }
    }

    fn disturb(&mut self, disturbance: Disturbance) -> hysteron::Result<()> {
        match disturbance {
            Disturbance::Load(load_n) => {
                check_load(load_n)?;
                self.options.load_n = load_n;
            }
            Disturbance::Gain(gain) => {
                check("gain", gain, 0.5, 1.0)?;
                self.jump(|stage| stage.gain = gain);
            }
            Disturbance::Stuck(stuck) => self.sensor.set_stuck(stuck),
            Disturbance::Lost(lost) => self.sensor.set_lost(lost),
            Disturbance::Room(_) => return Err(RigError::NoSuchDisturbance("room").into()),
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
