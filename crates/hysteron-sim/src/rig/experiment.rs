//! The chapter's experiment (section 5.2) on the virtual rig: one complete cycle and partial
//! cycles, twice.

use super::error::{RigError, check};
use super::plant::{Plant, Rig};
use super::sensors::Sensor;
use hysteron::filter::{FilterError, low_pass};
use hysteron::{Origin, Quantity, Recording};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Cut-off of the filter in [`prepared`], Hz.
///
/// The thermocouple's noise has a standard deviation of ⅓ °C, which on the steep part of a branch
/// counts as much as that of the LVDT. The signals themselves are slow (tens of seconds a branch)
/// except for the corners, where the current is switched; a lower cut-off would round them by more
/// than the noise that it takes away.
pub const CUTOFF_HZ: f64 = 0.3;

/// Samples that [`prepared`] keeps in a period of the cut-off frequency.
const KEPT_PER_PERIOD: f64 = 6.0;

/// Stretch in which a switching time is searched, s. The time found does not depend on it.
const SEARCH_STEP_S: f64 = 1.0;
/// Longest time of one heating or cooling, s.
const SEARCH_LIMIT_S: f64 = 3600.0;

/// An experiment: a rig, a profile of temperatures, two sensors.
///
/// The current is switched as in the chapter, full on or off: on until the temperature has risen to
/// the next target, off until it has fallen to it. The plant itself finds these times, without
/// noise, so repeated experiments share one schedule.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// The plant.
    pub rig: Rig,
    /// Current when heating, A. Default 2.
    pub current_a: f64,
    /// Temperatures at which the current is switched, °C; each is heated or cooled to, whichever
    /// leads there.
    pub targets_degc: Vec<f64>,
    /// Rest at room temperature before the first heating, s. Default 5.
    pub rest_s: f64,
    /// Time between samples, s. Default 0.05: the noise of many samples averages out in the filter.
    pub sample_interval_s: f64,
    /// Sensor of the temperature.
    pub thermocouple: Sensor,
    /// Sensor of the displacement.
    pub lvdt: Sensor,
}

/// Default: the experiment of the chapter. It does not give its temperatures; these excite its
/// plane from 20 to 80 °C by one complete cycle, partial heatings from cold, partial coolings from
/// hot, and loops within loops.
impl Default for Experiment {
    fn default() -> Self {
        Self {
            rig: Rig::default(),
            current_a: 2.0,
            targets_degc: vec![
                81.0, 25.0, // complete cycle
                55.0, 25.0, 60.0, 25.0, 66.0, 25.0, // partial heating
                80.0, 50.0, 79.0, 44.0, 79.0, 38.0, 79.0, 25.0, // partial cooling
                62.0, 42.0, 58.0, 46.0, 66.0, 38.0, 56.0, 25.0, // loops within loops
            ],
            rest_s: 5.0,
            sample_interval_s: 0.05,
            thermocouple: Sensor::THERMOCOUPLE,
            lvdt: Sensor::LVDT,
        }
    }
}

/// A current that flows for some time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phase {
    /// The current, A.
    pub current_a: f64,
    /// How long it flows, s.
    pub duration_s: f64,
}

impl Experiment {
    /// The profile of the current: the rest, then one phase for each target.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] for numbers that do not fit, [`RigError::TargetNotReached`] where a
    /// target lies beyond what the current can heat to or below room temperature.
    pub fn schedule(&self) -> Result<Vec<Phase>, RigError> {
        check("rest (s)", self.rest_s, 0.0, 3600.0)?;
        let mut plant = Plant::new(self.rig)?;
        let mut phases = vec![Phase {
            current_a: 0.0,
            duration_s: self.rest_s,
        }];
        plant.step(0.0, self.rest_s)?;
        for &target in &self.targets_degc {
            let heating = target > plant.temperature_degc();
            let current_a = if heating { self.current_a } else { 0.0 };
            let duration_s = time_to(&mut plant, current_a, target)?;
            phases.push(Phase {
                current_a,
                duration_s,
            });
        }
        Ok(phases)
    }

    /// What perfect sensors would record.
    ///
    /// # Errors
    /// As [`schedule`](Self::schedule).
    pub fn truth(&self) -> Result<Recording, RigError> {
        let interval = self.sample_interval_s;
        check("time between samples (s)", interval, 1e-3, 60.0)?;
        let phases = self.schedule()?;
        let mut plant = Plant::new(self.rig)?;
        let (mut time, mut input, mut output) = (vec![], vec![], vec![]);
        // Time since the phases began, and the time at which the present phase ends.
        let (mut now, mut end) = (0.0, 0.0);
        for phase in phases {
            end += phase.duration_s;
            loop {
                let sample = time.len() as f64 * interval;
                if sample >= end {
                    break;
                }
                plant.step(phase.current_a, sample - now)?;
                now = sample;
                time.push(now);
                input.push(plant.temperature_degc());
                output.push(plant.displacement_mm());
            }
            plant.step(phase.current_a, end - now)?;
            now = end;
        }
        Ok(Recording {
            time: Some(time),
            input,
            output,
            input_quantity: Quantity::with_unit("temperature", "degC"),
            output_quantity: Quantity::with_unit("displacement", "mm"),
            load: None,
            load_quantity: Quantity::named("load"),
            origin: Origin::Simulated,
            source: None,
            undone: None,
            rest: None,
        })
    }

    /// Runs the experiment and records it with the sensors' noise. Equal seeds give equal
    /// recordings.
    ///
    /// # Errors
    /// As [`schedule`](Self::schedule).
    ///
    /// ```
    /// use hysteron_sim::rig::{Experiment, prepared};
    ///
    /// let experiment = Experiment::default();
    /// let fitted = prepared(&experiment.record(1)?)?;
    /// let tested = prepared(&experiment.record(2)?)?; // the same profile, other noise
    /// assert_eq!(fitted.input.len(), tested.input.len());
    /// # Ok::<(), hysteron_sim::rig::RigError>(())
    /// ```
    pub fn record(&self, seed: u64) -> Result<Recording, RigError> {
        self.thermocouple.check()?;
        self.lvdt.check()?;
        let mut recording = self.truth()?;
        let mut noise = ChaCha8Rng::seed_from_u64(seed);
        for (t, y) in recording.input.iter_mut().zip(&mut recording.output) {
            *t = self.thermocouple.read(*t, &mut noise);
            *y = self.lvdt.read(*y, &mut noise);
        }
        Ok(recording)
    }
}

/// The recording with input and output low-pass filtered at [`CUTOFF_HZ`], as the chapter did "to
/// remove the noise and disturbance". Both go through the same filter, so the loops keep their
/// width.
///
/// # Errors
/// [`RigError::NoTime`] without time, [`RigError::Filter`] where the filter refuses, for example
/// fewer than two samples or samples too far apart.
pub fn prepared(recording: &Recording) -> Result<Recording, RigError> {
    let time = recording.time.as_deref().ok_or(RigError::NoTime)?;
    let [first, .., last] = time else {
        return Err(FilterError::TooShort(time.len()).into());
    };
    let rate = (recording.len() as f64 - 1.0) / (last - first);
    // What is left varies over several samples: fewer of them say the same.
    let every = ((rate / (KEPT_PER_PERIOD * CUTOFF_HZ)).round() as usize).max(1);
    let thin = |values: &[f64]| values.iter().copied().step_by(every).collect::<Vec<f64>>();
    Ok(Recording {
        time: recording.time.as_deref().map(thin),
        input: thin(&low_pass(&recording.input, rate, CUTOFF_HZ)?),
        output: thin(&low_pass(&recording.output, rate, CUTOFF_HZ)?),
        ..recording.clone()
    })
}

/// Steps the plant until its temperature reaches `target` (°C) and returns how long that took, s.
fn time_to(plant: &mut Plant, current_a: f64, target: f64) -> Result<f64, RigError> {
    let heating = target > plant.temperature_degc();
    let reached = |plant: &Plant| {
        let t = plant.temperature_degc();
        if heating { t >= target } else { t <= target }
    };
    let mut time = 0.0;
    while !reached(plant) {
        if time >= SEARCH_LIMIT_S || target.is_nan() {
            return Err(RigError::TargetNotReached {
                target_degc: target,
                reached_degc: plant.temperature_degc(),
            });
        }
        let start = plant.clone();
        plant.step(current_a, SEARCH_STEP_S)?;
        if !reached(plant) {
            time += SEARCH_STEP_S;
            continue;
        }
        // Bisection, until the interval cannot be told from its middle.
        let (mut low, mut high) = (0.0, SEARCH_STEP_S);
        while high - low > 1e-12 {
            let middle = 0.5 * (low + high);
            *plant = start.clone();
            plant.step(current_a, middle)?;
            if reached(plant) {
                high = middle;
            } else {
                low = middle;
            }
        }
        *plant = start;
        plant.step(current_a, high)?;
        time += high;
    }
    Ok(time)
}
