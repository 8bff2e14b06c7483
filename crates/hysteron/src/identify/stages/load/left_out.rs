//! Predicts loads that were left out, by each law.

use crate::error::{Error, Result};
use crate::identify::options::FitOptions;
use crate::identify::stages::load::Tried;
use crate::identify::stages::load::curves::{behind, moving_only};
use crate::identify::stages::load::search::Search;
use crate::identify::weights::problem::Problem;
use crate::model::LoadCurves;
use crate::progress::Progress;
use crate::series::range;

impl Search<'_> {
    /// The error on each load that was left out, between those next to it, in percent of the range
    /// of its output; the root of the mean square. Without a load between two others it is the error
    /// on all of them, fitted.
    pub(super) fn left_out(&self, curves: &LoadCurves, tried: Tried) -> Result<f64> {
        let Some(group) = &self.groups.group else {
            return Ok(0.0);
        };
        let count = self.groups.knots.len();
        let squares: Vec<f64> = match count {
            2 => {
                let predicted = self.predicted(curves, tried, group, None)?;
                (0..count)
                    .map(|g| self.judged(group, g, &predicted))
                    .collect()
            }
            _ => (1..count - 1)
                .map(|g| Ok(self.judged(group, g, &self.predicted(curves, tried, group, Some(g))?)))
                .collect::<Result<_>>()?,
        };
        Ok(100.0 * (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
    }

    /// The outputs of a fit, to all loads or to all but one.
    pub(super) fn predicted(
        &self,
        curves: &LoadCurves,
        tried: Tried,
        group: &[usize],
        left: Option<usize>,
    ) -> Result<Vec<f64>> {
        let mut loads = curves.loads.clone();
        if let Some(g) = left {
            loads.remove(g);
        }
        let (others, degree, load_curves) = match tried {
            Tried::Gain { power, .. } => {
                let others = curves.resampled(&loads, power);
                // What lies between them follows from the neighbours.
                let others = others.resampled(&curves.loads, power);
                (others.clone(), 0, Some(others))
            }
            Tried::Weights { degree, .. } => {
                (moving_only(&curves.resampled(&loads, 1.0)), degree, None)
            }
        };
        let seen = behind(&others, self.recordings);
        let options = FitOptions {
            load_degree: Some(degree),
            load_curves: load_curves.clone(),
            ..self.options.clone()
        };
        let mut problem = Problem::new(&seen, &options)?;
        let kept: Vec<f64> = group
            .iter()
            .map(|at| f64::from(Some(*at) != left))
            .collect();
        let fitted = problem.solve(Some(&kept), Progress::NONE)?;
        let sums = problem.predict(&fitted.solution)?;
        let offset = |n: usize| match &load_curves {
            Some(curves) => Ok::<_, Error>(curves.at(self.samples.load[n])?.offset),
            None => Ok(0.0),
        };
        let sums = sums.into_iter().enumerate();
        sums.map(|(n, sum)| Ok(offset(n)? + fitted.sign.factor() * sum))
            .collect()
    }

    /// The mean square error at one load, in squares of the range of its output.
    pub(super) fn judged(&self, group: &[usize], g: usize, predicted: &[f64]) -> f64 {
        let output = &self.samples.output;
        let own: Vec<usize> = (0..group.len()).filter(|n| group[*n] == g).collect();
        let sum: f64 = own
            .iter()
            .map(|n| (output[*n] - predicted[*n]).powi(2))
            .sum();
        let (low, high) = range(&own.iter().map(|n| output[*n]).collect::<Vec<_>>());
        sum / own.len().max(1) as f64 / (high - low).max(f64::MIN_POSITIVE).powi(2)
    }
}
