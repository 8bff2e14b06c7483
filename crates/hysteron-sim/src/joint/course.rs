//! A simulated run of the loop: up and down through the model's range, with noise, and with a
//! disturbance that no inverse knows of.

use super::plant::{Outer, Plant, SHORTEST};
use hysteron::control::{Compensator, Controller, Gains, Reading, Reference, Scheme};
use hysteron::{Model, Result};

/// What is added to the drive in every second quarter of a run, as a share of its range.
const DISTURBANCE: f64 = 0.05;
/// How much noise may move the drive through the proportional part: a standard deviation, as a
/// share of its range.
const LOUDEST: f64 = 0.05;
/// The first part of a run, which does not count.
const SETTLES: f64 = 0.125;

pub(super) struct Course<'a> {
    model: &'a Model,
    outer: &'a Outer,
    samples: usize,
}

/// What is added to the readings of a run.
#[derive(Debug, Clone, Copy)]
pub(super) enum Noise {
    None,
    /// The error of the fit, as if it were noise.
    OfFit,
}

/// What a loop did in a run.
pub(super) struct Run {
    /// How far the drive travelled.
    pub(super) travel: f64,
    /// RMS of output less reference; infinite where the drive travelled too far.
    pub(super) error: f64,
}

impl<'a> Course<'a> {
    pub(super) fn new(model: &'a Model, outer: &'a Outer, samples: usize) -> Self {
        Self {
            model,
            outer,
            samples,
        }
    }

    /// The range of the drives, once for each shortest run.
    pub(super) fn usual_travel(&self) -> f64 {
        let (low, high) = self.outer.scheme.drives;
        (high - low) * self.samples as f64 / SHORTEST as f64
    }

    /// The standard deviation of what noise does to the drive through the proportional part.
    pub(super) fn noise(&self, gains: Gains) -> f64 {
        let Scheme {
            interval_s,
            filter_s,
            ..
        } = self.outer.scheme;
        let new = 1.0 - (-interval_s / filter_s).exp();
        let left = (new / (2.0 - new)).sqrt();
        gains.gain.abs() * self.noise_of_fit() * left
    }

    /// What it may be.
    pub(super) fn loudest(&self) -> f64 {
        let (low, high) = self.outer.scheme.drives;
        LOUDEST * (high - low)
    }

    fn noise_of_fit(&self) -> f64 {
        self.model.fit.as_ref().map_or(0.0, |fit| fit.rmse)
    }

    /// A run with these gains, given up where the drive travels further than `most`.
    pub(super) fn run(
        &self,
        pid: Option<Gains>,
        inverse: bool,
        noise: Noise,
        most: f64,
    ) -> Result<Run> {
        let Scheme { drives, .. } = self.outer.scheme;
        let mut controller = Controller::new(Scheme {
            compensator: match inverse {
                true => Some(Compensator::fixed(self.model)?),
                false => None,
            },
            pid,
            ..self.outer.scheme.clone()
        })?;
        let rest = controller.rest_drive();
        let mut plant = Plant::new(self.model, self.outer, rest);
        let noise = match noise {
            Noise::None => 0.0,
            Noise::OfFit => self.noise_of_fit(),
        };
        let begin = (SETTLES * self.samples as f64) as usize;
        let (mut drive, mut travel, mut sum) = (rest, 0.0, 0.0);
        for n in 0..self.samples {
            let disturbed = drive + self.disturbance(n);
            let output = plant.step(disturbed.clamp(drives.0, drives.1))?;
            if n >= begin {
                sum += (output - self.reference(n)).powi(2);
            }
            // A fixed sequence that looks like noise of this standard deviation.
            let turns = (n as f64 * 12.9898).sin() * 43758.5453;
            let wrong = noise * 12f64.sqrt() * (turns - turns.floor() - 0.5);
            let reading = Reading {
                output: output + wrong,
                input: None,
            };
            let target = Reference {
                output: self.reference(n),
                heading: None,
            };
            let due = self.outer.scheme.due();
            let next: Vec<f64> = (1..=due).map(|k| self.reference(n + k)).collect();
            let action = controller.step_ahead(target, &next, reading)?;
            travel += (action.drive - drive).abs();
            drive = action.drive;
            if travel > most {
                let error = f64::INFINITY;
                return Ok(Run { travel, error });
            }
        }
        let error = (sum / (self.samples - begin) as f64).sqrt();
        Ok(Run { travel, error })
    }

    fn reference(&self, n: usize) -> f64 {
        let (low, high) = self.model.output_range();
        let phase = std::f64::consts::TAU * n as f64 / self.samples as f64;
        0.5 * (low + high) - 0.4 * (high - low) * phase.cos()
    }

    fn disturbance(&self, n: usize) -> f64 {
        let (low, high) = self.outer.scheme.drives;
        match 4 * n / self.samples % 2 {
            0 => 0.0,
            _ => DISTURBANCE * (high - low),
        }
    }
}
