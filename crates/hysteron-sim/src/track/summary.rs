//! The result of a comparison: medians over the seeds.

use super::{Comparison, Kind, Score, score::median};
use hysteron::{Result, TableWriter};
use serde::Serialize;
use std::path::Path;

/// The medians of a controller in a window.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Median {
    /// The window.
    pub window: String,
    /// The controller.
    pub controller: &'static str,
    /// Its name in a scenario.
    pub name: &'static str,
    /// Medians over the seeds.
    #[serde(flatten)]
    pub score: Score,
}

/// A controller beside the one that it has to be better than: medians over the seeds of the ratios.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ratio {
    /// The window.
    pub window: String,
    /// The controller.
    pub controller: &'static str,
    /// Its name in a scenario.
    pub name: &'static str,
    /// What it is compared with.
    pub compared_with: &'static str,
    /// Ratio of the tracking errors (RMSE).
    pub rmse: f64,
    /// Ratio of the prediction errors; NaN where one of them has no model.
    pub prediction_rmse: f64,
}

/// Which controllers are set against which.
const PAIRS: [(Kind, Kind); 4] = [
    (Kind::InversePid, Kind::Pid),
    (Kind::InversePidAnticipate, Kind::Pid),
    (Kind::AdaptivePid, Kind::InversePid),
    (Kind::AdaptivePidAnticipate, Kind::InversePidAnticipate),
];

impl Comparison {
    /// Medians over the seeds, by window and controller.
    #[must_use]
    pub fn medians(&self) -> Vec<Median> {
        let mut medians = Vec::new();
        for (w, window) in self.windows.iter().enumerate() {
            for (kind, seeds) in self.controllers.iter().zip(&self.scores) {
                let of = |field: fn(&Score) -> f64| {
                    let values = seeds.iter().map(|windows| field(&windows[w]));
                    median(&mut values.filter(|v| !v.is_nan()).collect::<Vec<f64>>())
                };
                medians.push(Median {
                    window: window.name.clone(),
                    controller: kind.words(),
                    name: kind.name(),
                    score: Score {
                        rmse: of(|s| s.rmse),
                        max_abs: of(|s| s.max_abs),
                        prediction_rmse: of(|s| s.prediction_rmse),
                        frozen_rmse: of(|s| s.frozen_rmse),
                        lag_s: of(|s| s.lag_s),
                        drive_travel: of(|s| s.drive_travel),
                        saturated: of(|s| s.saturated),
                        faults: of(|s| s.faults),
                    },
                });
            }
        }
        medians
    }

    /// Inverse and PID against PID, and adaptive against fixed inverse, by window. Only settled
    /// windows: right after a jump of the load all controllers have the same error.
    #[must_use]
    pub fn ratios(&self) -> Vec<Ratio> {
        let place = |kind: Kind| self.controllers.iter().position(|k| *k == kind);
        let mut ratios = Vec::new();
        let windows = self.windows.iter().enumerate();
        for (w, window) in windows.filter(|(_, window)| window.settled) {
            for (a, b) in PAIRS {
                let (Some(one), Some(other)) = (place(a), place(b)) else {
                    continue;
                };
                let of = |field: fn(&Score) -> f64| {
                    let pairs = self.scores[one].iter().zip(&self.scores[other]);
                    let ratios = pairs.map(|(a, b)| field(&a[w]) / field(&b[w]));
                    median(&mut ratios.filter(|v| !v.is_nan()).collect::<Vec<f64>>())
                };
                ratios.push(Ratio {
                    window: window.name.clone(),
                    controller: a.words(),
                    name: a.name(),
                    compared_with: b.words(),
                    rmse: of(|s| s.rmse),
                    prediction_rmse: of(|s| s.prediction_rmse),
                });
            }
        }
        ratios
    }

    /// Writes a table of all scores: a row for each controller, seed and window.
    ///
    /// # Errors
    /// [`hysteron::Error::File`].
    pub fn write_scores(&self, path: &Path) -> Result<()> {
        let mut table = TableWriter::plain(Some(path.into()))?;
        table.row([
            "controller",
            "seed",
            "window",
            "from_s",
            "to_s",
            "rmse",
            "max_abs",
            "prediction_rmse",
            "frozen_rmse",
            "lag_s",
            "drive_travel",
            "saturated",
            "faults",
        ])?;
        for (kind, seeds) in self.controllers.iter().zip(&self.scores) {
            for (seed, windows) in seeds.iter().enumerate() {
                for (window, s) in self.windows.iter().zip(windows) {
                    let numbers = [
                        window.from_s,
                        window.to_s,
                        s.rmse,
                        s.max_abs,
                        s.prediction_rmse,
                        s.frozen_rmse,
                        s.lag_s,
                        s.drive_travel,
                        s.saturated,
                        s.faults,
                    ];
                    let names = [
                        kind.words().to_owned(),
                        (seed + 1).to_string(),
                        window.name.clone(),
                    ];
                    table.row(names.into_iter().chain(numbers.map(cell)))?;
                }
            }
        }
        table.finish()
    }
}

/// A number, or nothing where there is none.
fn cell(value: f64) -> String {
    match value.is_nan() {
        true => String::new(),
        false => value.to_string(),
    }
}
