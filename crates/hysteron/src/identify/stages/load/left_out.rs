//! Predicts loads that were left out, by each law.

use crate::error::Result;
use crate::identify::options::FitOptions;
use crate::identify::stages::load::curves::{fine, moving_only, still, without};
use crate::identify::stages::load::search::Search;
use crate::identify::stages::load::{Moves, Tried};
use crate::identify::weights::problem::Problem;
use crate::model::Registration;
use crate::progress::Progress;
use crate::series::range;

impl Search<'_> {
    /// The error on each load that was left out, between those next to it, in percent of the range
    /// of its output; the root of the mean square. A load with hardly any stroke has no say. Without
    /// a load between two others it is the error on all of them, fitted.
    pub(super) fn left_out(&self, moves: &Moves, tried: Tried) -> Result<f64> {
        let Some(group) = &self.groups.group else {
            return Ok(0.0);
        };
        let count = self.groups.knots.len();
        let judged: Vec<usize> = self.inner().collect();
        let squares: Vec<f64> = match judged.is_empty() {
            true => {
                let predicted = self.predicted(moves, tried, group, None)?;
                (0..count)
                    .map(|g| self.judged(group, g, &predicted))
                    .collect()
            }
            false => judged
                .into_iter()
                .map(|g| Ok(self.judged(group, g, &self.predicted(moves, tried, group, Some(g))?)))
                .collect::<Result<_>>()?,
        };
        Ok(100.0 * (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
    }

    /// The loads between two others that are left out in turn.
    pub(super) fn inner(&self) -> impl Iterator<Item = usize> {
        let count = match self.groups.group {
            Some(_) => self.groups.knots.len(),
            None => 0,
        };
        (1..count.saturating_sub(1)).filter(|g| self.groups.telling[*g])
    }

    /// The outputs of a fit, to all loads or to all but one.
    pub(super) fn predicted(
        &self,
        moves: &Moves,
        tried: Tried,
        group: &[usize],
        left: Option<usize>,
    ) -> Result<Vec<f64>> {
        let known = match left {
            Some(g) => without(&moves.curves, g),
            None => moves.curves.clone(),
        };
        let rows = fine(&known.loads);
        let (others, registration, degree) = match (tried, &moves.loops) {
            (Tried::Weights { degree, .. }, _) => {
                (moving_only(&known), Registration::default(), degree)
            }
            (Tried::Alone { degree }, _) => (still(&known), Registration::default(), degree),
            (Tried::Gain { stroke, .. }, _) => {
                let others = stroke.at(&known, moves.reach, &rows);
                (others, Registration::default(), 0)
            }
            (Tried::Registered { stroke }, loops) => {
                let others = stroke.at(&known, moves.reach, &rows);
                let loops = match left {
                    Some(g) => loops.as_ref().map(|loops| loops.without(g)),
                    None => loops.clone(),
                };
                let registration = loops.map(|loops| loops.registration(&moves.curves, &rows));
                (others, registration.unwrap_or_default(), 0)
            }
        };
        let seen = self.seen(&others, &registration, self.recordings)?;
        let options = FitOptions {
            load_degree: Some(degree),
            load_curves: (!others.gains.is_empty()).then(|| others.clone()),
            ..self.options.clone()
        };
        let mut problem = Problem::new(&seen, &options)?;
        let kept: Vec<f64> = group
            .iter()
            .map(|at| f64::from(Some(*at) != left))
            .collect();
        let fitted = problem.solve(Some(&kept), Progress::NONE)?;
        problem.measured_outputs(&fitted)
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
