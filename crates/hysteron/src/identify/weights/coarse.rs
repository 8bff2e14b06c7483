//! Coarse to fine: the smooth weights of half the levels say where a search for those of all begins
//! (nested iteration). From zero it would change its set of weights above zero many times, and each
//! time costs a factor of all levels. Weights without smoothness stand alone, and those of other
//! levels do not help.

use crate::error::Result;
use crate::identify::weights::free::FreeColumns;
use crate::identify::weights::problem::{Fitted, Problem};
use crate::identify::weights::regressor::Regressor;
use crate::identify::weights::solve::{NormalEquations, STEPS};
use crate::model::{Sign, Solver};
use crate::progress::Progress;
use hysteron_core::{Plane, operator_count, operator_index, operators};

/// With more levels than this a search begins with half of them.
const MANY_LEVELS: usize = 120;

impl Problem<'_> {
    /// The sign, and weights for a plane of so many levels, of a fit with half of them; `None` where
    /// a search from zero is fast, or columns are of several starts.
    pub(super) fn coarse(
        &self,
        levels: usize,
        free: &FreeColumns,
        kept: Option<&[f64]>,
        progress: Progress<'_>,
    ) -> Result<Option<(Sign, Vec<f64>)>> {
        let prior = self.options.prior();
        let is_fast = levels <= MANY_LEVELS || self.options.solver == Solver::Ols;
        if is_fast || self.regressor.unknown_start() || prior.smooth.is_none() {
            return Ok(None);
        }
        let plane = self.regressor.plane();
        let half = levels.div_ceil(2);
        let plane = Plane::new(plane.min(), plane.max(), half)?;
        let regressor = Regressor::new(plane, &self.options, &self.experiment)?;
        let equations =
            NormalEquations::new(&regressor, &self.experiment, free, kept, prior, progress)?;
        let start = self.coarse(half, free, kept, progress)?;
        let Fitted { solution, sign } = self.best_sign(&equations, start, STEPS, progress)?;
        Ok(Some((sign, refined(&solution.x, half, levels))))
    }
}

/// Weights of a plane with `levels` levels, from those of one with half as many: a weight is shared
/// by the operators that take its place.
fn refined(x: &[f64], half: usize, levels: usize) -> Vec<f64> {
    let part = |x: &[f64]| -> Vec<f64> {
        let shared = |(i, j): (usize, usize)| x[operator_index(i.div_ceil(2), j.div_ceil(2))] / 4.0;
        operators(levels).map(shared).collect()
    };
    x.chunks_exact(operator_count(half))
        .flat_map(part)
        .collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::identify::options::FitOptions;
    use crate::model::{Smooth, Start};
    use crate::recording::Recording;

    /// The minimum is one: where the search begins does not move it.
    #[test]
    fn a_coarse_start_finds_the_same_minimum() {
        let input: Vec<f64> = (0..700)
            .map(|n| {
                let t = f64::from(n);
                50.0 - 30.0 * (1.0 - t / 1000.0) * (t * 0.06).cos()
            })
            .collect();
        let mut y = 20.0;
        let output = input.iter().map(|x| {
            y = f64::clamp(y, x - 6.0, x + 3.0);
            y
        });
        let recording = [Recording::new(input.clone(), output.collect()).unwrap()];
        let options = FitOptions {
            levels: MANY_LEVELS + 5,
            smooth: Smooth::from((1e-8, 1e-9)),
            start: Start::Off,
            ..FitOptions::plain()
        };
        let problem = Problem::new(&recording, &options).unwrap();
        let free = problem.free(None).unwrap();
        let none = Progress::NONE;
        let start = problem.coarse(options.levels, &free, None, none).unwrap();
        let (sign, start) = start.unwrap();
        let (regressor, experiment) = (&problem.regressor, &problem.experiment);
        let prior = options.prior();
        let equations =
            NormalEquations::new(regressor, experiment, &free, None, prior, none).unwrap();
        let found = |start: Option<&[f64]>| {
            let target = problem.targets(sign);
            equations
                .solve(target, options.solver, start, STEPS, none)
                .unwrap()
                .objective
        };
        let (coarse, zero) = (found(Some(&start)), found(None));
        // Proximal steps end where one gains less than 1e-12 of it.
        assert!((coarse - zero).abs() <= 1e-9 * zero, "{coarse} and {zero}");
        // It begins near the end: the search for it has little left to do.
        let begun = equations
            .solve(problem.targets(sign), options.solver, Some(&start), 0, none)
            .unwrap();
        let nothing = equations
            .solve(problem.targets(sign), options.solver, None, 0, none)
            .unwrap();
        assert!(begun.objective < 0.05 * nothing.objective);
    }
}
