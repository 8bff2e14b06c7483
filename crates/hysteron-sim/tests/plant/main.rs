//! The simulated plants: time, load, drift, sensors, and what they refuse.
#![allow(clippy::unwrap_used)]

mod bouc_wen;
mod changes;
mod latent_wire;
mod options;
mod time;

use hysteron::control::{Device, Disturbance, Reading, SimulatedPlant};
use hysteron::{Error, Result};
use hysteron_sim::plant::{
    DriftOptions, FatigueOptions, PreisachPlant, PreisachPlantOptions, SensorOptions, SpringPlant,
    SpringPlantOptions,
};
use hysteron_sim::rig::RigError;

const PERFECT: SensorOptions = SensorOptions {
    lag_s: 0.0,
    accuracy: 0.0,
    resolution: 0.0,
    range: None,
    dropout: 0.0,
};

fn spring(options: SpringPlantOptions) -> SpringPlant {
    SpringPlant::new(&options).unwrap()
}

fn preisach(options: PreisachPlantOptions) -> PreisachPlant {
    PreisachPlant::new(&options).unwrap()
}

/// Holds `drive` for `time_s`, in `pieces`, and tells the true output.
fn hold(plant: &mut impl SimulatedPlant, drive: f64, time_s: f64, pieces: u32) -> f64 {
    plant.write(drive);
    for _ in 0..pieces {
        plant.advance(time_s / f64::from(pieces));
    }
    plant.truth().output
}

/// The true output after each held drive, each held for `time_s` in `pieces`.
fn outputs(plant: &mut impl SimulatedPlant, drives: &[f64], time_s: f64, pieces: u32) -> Vec<f64> {
    drives
        .iter()
        .map(|&drive| hold(plant, drive, time_s, pieces))
        .collect()
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn refused<T>(result: Result<T>) -> bool {
    result.is_err_and(|error| matches!(of_the_rig(&error), Some(RigError::OutOfRange { .. })))
}

fn of_the_rig(error: &Error) -> Option<&RigError> {
    match error {
        Error::Plant(error) => error.downcast_ref(),
        _ => None,
    }
}
