//! The same inputs fitted to one output after another. What undoes a stage behind the operators
//! changes outputs alone, so that a search of its constants needs one Gram matrix, and each fit
//! begins at the weights of the one before.

use crate::error::Result;
use crate::identify::weights::problem::{Fitted, Problem};
use crate::identify::weights::solve::{NormalEquations, Penalised};
use crate::model::Sign;
use crate::progress::Progress;
use std::sync::Arc;

pub(crate) struct Again<'a> {
    pub(crate) problem: Problem<'a>,
    last: Option<Last>,
}

/// The last fit, and the samples that it kept.
struct Last {
    kept: Option<Vec<f64>>,
    penalised: Arc<Penalised>,
    sign: Sign,
    x: Vec<f64>,
}

impl<'a> Again<'a> {
    pub(crate) fn new(problem: Problem<'a>) -> Self {
        Self {
            problem,
            last: None,
        }
    }

    /// The best weights over the samples kept, for the outputs that the problem has now. The first
    /// fit of these samples decides the sign, and the columns that an unknown start adds; `steps`
    /// limits the proximal steps of the fits after it.
    pub(crate) fn fit(
        &mut self,
        kept: Option<&[f64]>,
        steps: usize,
        progress: Progress<'_>,
    ) -> Result<Fitted> {
        let last = self.last.take().filter(|last| last.kept.as_deref() == kept);
        let (fitted, penalised) = match last {
            None => self.problem.solve_keeping(kept, progress)?,
            Some(last) => {
                let free = self.problem.free(kept)?;
                let equations = NormalEquations {
                    regressor: &self.problem.regressor,
                    experiment: &self.problem.experiment,
                    free: &free,
                    kept,
                    penalised: last.penalised,
                };
                let start = Some((last.sign, last.x));
                let fitted = self.problem.best_sign(&equations, start, steps, progress)?;
                (fitted, equations.penalised)
            }
        };
        self.last = Some(Last {
            kept: kept.map(<[f64]>::to_vec),
            penalised,
            sign: fitted.sign,
            x: fitted.solution.x.clone(),
        });
        Ok(fitted)
    }

    /// The outputs of the operators, fitted to `targets` over the samples kept, as in
    /// [`Again::fit`].
    pub(crate) fn outputs(
        &mut self,
        targets: Vec<f64>,
        kept: Option<&[f64]>,
        steps: usize,
    ) -> Result<Vec<f64>> {
        self.problem.experiment.replace_outputs(targets);
        let fitted = self.fit(kept, steps, Progress::NONE)?;
        self.problem.measured_outputs(&fitted)
    }

    /// Gives the memory of the Gram matrix back.
    pub(crate) fn forget(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::identify::options::FitOptions;
    use crate::identify::weights::solve::STEPS;
    use crate::model::{Smooth, Solver, Start};
    use crate::recording::Recording;

    /// Each fit after the first is that of a problem of its own, from any outputs before it.
    #[test]
    fn other_outputs_are_fitted_as_by_themselves() {
        let input: Vec<f64> = (0..400)
            .map(|n| 50.0 - 40.0 * (1.0 - f64::from(n) / 500.0) * (f64::from(n) * 0.07).cos())
            .collect();
        let play = |low: f64, high: f64, bend: f64| -> Vec<f64> {
            let mut y = 20.0;
            let outputs = input.iter().map(|x| {
                y = f64::clamp(y, x - low, x + high);
                y + bend * (y - 50.0).powi(2)
            });
            outputs.collect()
        };
        let all = [
            play(6.0, 3.0, 0.0),
            play(12.0, 1.0, 0.01),
            play(2.0, 2.0, -0.01),
        ];
        let kept: Vec<f64> = (0..400).map(|n| f64::from(n % 100 < 60)).collect();
        for (solver, start, smooth) in [
            (Solver::Nnls, Start::Off, Smooth::from((1e-8, 1e-9))),
            (Solver::Nnls, Start::Unknown, Smooth::from((0.0, 1e-6))),
            (Solver::Nnls, Start::On, Smooth::from((0.0, 0.0))),
            (Solver::Ols, Start::Off, Smooth::from((1e-8, 1e-6))),
        ] {
            let options = FitOptions {
                levels: 12,
                solver,
                start,
                smooth,
                ..FitOptions::plain()
            };
            let recording = [Recording::new(input.clone(), all[0].clone()).unwrap()];
            let mut again = Again::new(Problem::new(&recording, &options).unwrap());
            for kept in [None, Some(kept.as_slice()), None] {
                for (n, outputs) in all.iter().enumerate() {
                    let alone = [Recording::new(input.clone(), outputs.clone()).unwrap()];
                    let mut problem = Problem::new(&alone, &options).unwrap();
                    let expected = problem.solve(kept, Progress::NONE).unwrap();
                    again.problem.experiment.replace_outputs(outputs.clone());
                    let fitted = again.fit(kept, STEPS, Progress::NONE).unwrap();
                    let (own, other) = (fitted.solution.objective, expected.solution.objective);
                    // Proximal steps end where one gains less than 1e-12 of it.
                    let near = |share: f64| (own - other).abs() <= share * other + 1e-9;
                    assert!(near(1e-6), "{solver:?} {start:?} {n}: {own} and {other}");
                    assert_eq!(fitted.sign, expected.sign);
                    // One step says an error to more digits than a search compares.
                    let own = again
                        .fit(kept, 1, Progress::NONE)
                        .unwrap()
                        .solution
                        .objective;
                    assert!(
                        (own - other).abs() <= 1e-6 * other + 1e-9,
                        "{own} and {other}"
                    );
                }
            }
        }
    }
}
