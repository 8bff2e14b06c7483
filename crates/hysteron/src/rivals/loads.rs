//! One predictor for each load, and interpolation between them.

use super::path::Measured;
use super::predictor::Predictor;
use crate::error::{Error, Result};
use crate::recording::Recording;

/// Loads that differ by less than this share of the largest one are the same.
const SAME: f64 = 0.01;

/// Predictors in ascending order of their loads; a single one where the load plays no part.
#[derive(Debug, Clone)]
pub(super) struct AtLoads {
    loads: Vec<f64>,
    predictors: Vec<Predictor>,
}

impl AtLoads {
    /// Fits one predictor to the recordings at each load. The load of a recording is its median.
    pub(super) fn fit(
        recordings: &[Recording],
        fit: impl Fn(&[Measured<'_>]) -> Result<Predictor>,
    ) -> Result<Self> {
        let middles: Option<Vec<f64>> = recordings.iter().map(median_load).collect();
        let Some(middles) = middles else {
            let all: Vec<Measured<'_>> = recordings.iter().map(Measured::from).collect();
            return Ok(Self {
                loads: Vec::new(),
                predictors: vec![fit(&all)?],
            });
        };
        let largest = middles.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let mut by_load: Vec<(f64, &Recording)> = middles.into_iter().zip(recordings).collect();
        by_load.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut loads, mut predictors) = (Vec::new(), Vec::new());
        for same in by_load.chunk_by(|a, b| b.0 - a.0 <= SAME * largest) {
            let recordings = same.iter().map(|(_, recording)| Measured::from(*recording));
            let recordings: Vec<Measured<'_>> = recordings.collect();
            loads.push(same.iter().map(|(load, _)| load).sum::<f64>() / same.len() as f64);
            predictors.push(fit(&recordings)?);
        }
        Ok(Self { loads, predictors })
    }

    /// The mean of the two nearest loads, weighted by the distances; beyond the loads the last one.
    pub(super) fn predict(&self, recording: &Recording) -> Result<Vec<f64>> {
        let all = self.predictors.iter();
        let outputs: Vec<Vec<f64>> = all
            .map(|predictor| predictor.predict(&recording.input))
            .collect::<Result<_>>()?;
        let load = match (&recording.load, outputs.len()) {
            (_, 1) => return Ok(outputs.into_iter().next().unwrap_or_default()),
            (Some(load), _) => load,
            (None, _) => {
                return Err(Error::Fit(
                    "the rival was fitted to several loads, and this recording has none".into(),
                ));
            }
        };
        let at = |(n, load): (usize, &f64)| {
            let above = self.loads.partition_point(|known| known <= load);
            let above = above.clamp(1, self.loads.len() - 1);
            let (a, b) = (self.loads[above - 1], self.loads[above]);
            let share = ((load - a) / (b - a)).clamp(0.0, 1.0);
            (1.0 - share) * outputs[above - 1][n] + share * outputs[above][n]
        };
        Ok(load.iter().enumerate().map(at).collect())
    }
}

fn median_load(recording: &Recording) -> Option<f64> {
    let mut load = recording.load.clone()?;
    load.sort_by(f64::total_cmp);
    load.get(load.len() / 2).copied()
}
