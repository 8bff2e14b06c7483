//! The chapter's sections 5 and 6 on the virtual rig: record twice, fit one recording, test on the
//! other.

use super::experiment::{Experiment, prepared};
use hysteron::{Evaluation, Fit, FitOptions, Model, Recording, Result, evaluate};

/// Levels of the chapter's plane (Table 2).
pub const LEVELS: usize = 20;

/// Its lowest and highest level in °C (Table 2).
pub const RANGE_DEGC: (f64, f64) = (20.0, 80.0);

/// Replicates for standard errors and band: enough for their second digit.
const REPLICATES: usize = 200;

/// The chapter's experiment, simulated, with what comes of it.
#[derive(Debug, Clone)]
pub struct Reproduction {
    /// Two recordings of one profile with different noise, as the sensors gave them.
    pub raw: [Recording; 2],
    /// The same, low-pass filtered.
    pub prepared: [Recording; 2],
    /// The model identified from the first, on the plane of Table 2.
    pub model: Model,
    /// Its forward and inverse tests on the second.
    pub evaluation: Evaluation,
}

impl Reproduction {
    /// Runs `experiment` with two seeds.
    ///
    /// # Errors
    /// [`hysteron::Error::Plant`] for an experiment outside the rig's physics.
    pub fn run(experiment: &Experiment, seeds: [u64; 2]) -> Result<Self> {
        let [first, second] = seeds.map(|seed| experiment.record(seed));
        let raw = [first?, second?];
        let prepared = [prepared(&raw[0])?, prepared(&raw[1])?];
        let options = FitOptions {
            levels: LEVELS,
            range: Some(RANGE_DEGC),
            bootstrap: REPLICATES,
            ..FitOptions::plain()
        };
        let model = Fit::from(&options).run(&prepared[0])?;
        let evaluation = evaluate(&model, &prepared[1])?;
        Ok(Self {
            raw,
            prepared,
            model,
            evaluation,
        })
    }
}
