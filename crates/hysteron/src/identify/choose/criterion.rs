//! How good a candidate is: one number of levels with one smoothness.

use crate::error::Result;
use crate::identify::options::Prior;
use crate::identify::weights::problem::Problem;
use crate::identify::weights::sums::{Reduced, Sums, centred};
use crate::identify::weights::units::Folds;
use crate::model::{Sign, Smooth, Solver};
use crate::parallel;
use crate::progress::Progress;

/// Ridge of the prior in the evidence where the fit has none: without any, the prior is not a
/// density.
const SMALLEST_RIDGE: f64 = 1e-9;

/// The samples of one number of levels, as sums over the folds.
pub(super) struct Level<'a> {
    problem: Problem<'a>,
    folds: Vec<Fold>,
    whole: Reduced,
    progress: Progress<'a>,
}

struct Fold {
    /// The sums over the fold.
    own: Sums,
    /// The problem of all other folds.
    rest: Reduced,
}

/// Solutions of the folds, from which a search at a similar candidate starts; the last is the
/// solution of all samples. Zeros are a start too.
pub(super) type Starts = Vec<Vec<f64>>;

/// A candidate that errs more than the best one by this factor, on half of the folds, is given up.
/// The folds take every so many branches, so their halves are alike.
const LOST: f64 = 1.05;

/// The squared errors of the best candidate so far, on each fold. A candidate that is clearly worse
/// on half of them is not tried on the others (racing: Maron and Moore 1994).
#[derive(Default)]
pub(super) struct Race {
    best: Vec<f64>,
}

impl Race {
    /// Whether a candidate with these squares on the folds with even numbers is out.
    fn is_lost(&self, squares: &[f64]) -> bool {
        let of_half = |squares: &[f64]| squares.iter().step_by(2).sum::<f64>();
        !self.best.is_empty() && of_half(squares) > LOST * LOST * of_half(&self.best)
    }

    fn enter(&mut self, squares: Vec<f64>) {
        let sum = |squares: &[f64]| squares.iter().sum::<f64>();
        if self.best.is_empty() || sum(&squares) < sum(&self.best) {
            self.best = squares;
        }
    }
}

impl<'a> Level<'a> {
    pub(super) fn new(
        problem: Problem<'a>,
        sign: Sign,
        folds: &Folds,
        progress: Progress<'a>,
    ) -> Result<Self> {
        let report = |_: &'static str, _: f64| progress.tell("choice of levels", f64::NAN);
        let unnamed = Progress::new(&report);
        let own = {
            let target = centred(&problem, sign);
            Sums::of_groups(&problem, target, |n| folds.fold(n), folds.count, unnamed)?
        };
        let mut all = own[0].clone();
        own[1..].iter().for_each(|fold| all.add(fold));
        let folds = own.into_iter().map(|own| {
            let rest = all.without(&own).reduced()?;
            Ok(Fold { own, rest })
        });
        Ok(Self {
            folds: folds.collect::<Result<_>>()?,
            whole: all.reduced()?,
            problem,
            progress,
        })
    }

    pub(super) fn starts(&self) -> Starts {
        vec![vec![0.0; self.problem.regressor.columns().len()]; self.folds.len() + 1]
    }

    fn prior(&self, smooth: Smooth) -> Prior {
        Prior {
            smooth,
            ..self.problem.options.prior()
        }
    }

    /// Root mean squared error over all samples, each from a fit without its fold.
    pub(super) fn left_out_rmse(&self, smooth: Smooth, starts: &mut Starts) -> Result<f64> {
        let alone = self.raced(smooth, starts, &mut Race::default())?;
        Ok(alone.unwrap_or(f64::INFINITY))
    }

    /// The same beside the best candidate so far; `None` for one that was given up half way.
    pub(super) fn raced(
        &self,
        smooth: Smooth,
        starts: &mut Starts,
        race: &mut Race,
    ) -> Result<Option<f64>> {
        let solver = self.problem.options.solver;
        let mut squares = vec![0.0; self.folds.len()];
        for half in 0..2 {
            let own: Vec<usize> = (half..self.folds.len()).step_by(2).collect();
            let before = &*starts;
            let solved = parallel::map(own.len(), |k| {
                self.progress.tell("choice of levels", f64::NAN)?;
                let Fold { own: fold, rest } = &self.folds[own[k]];
                let penalised = rest.penalised(self.prior(smooth), &self.problem);
                let at = rest.solve(&penalised, solver, &before[own[k]], Progress::NONE)?;
                Ok((fold.error(&at), at.x))
            })?;
            for (n, (error, x)) in own.into_iter().zip(solved) {
                squares[n] = error;
                // Without smoothness most weights are zero. Then zero is a better starting point.
                if !smooth.is_none() {
                    starts[n] = x;
                }
            }
            if half == 0 && race.is_lost(&squares) {
                return Ok(None);
            }
        }
        let sum: f64 = squares.iter().sum();
        race.enter(squares);
        Ok(Some((sum / self.whole.samples).sqrt()))
    }

    /// The logarithm of the evidence, without constants: how probable the outputs are, whatever the
    /// weights (MacKay 1992).
    ///
    /// With the penalty as a Gaussian prior of precision `P`, the Gram matrix `G` and `J` the
    /// penalised squared error at the best weights, it is `½ ln |P| − ½ ln |G + P| − ½ n ln J`. The
    /// variance of the errors was replaced by its best value. `J` is that of the non-negative
    /// weights, so a prior that only negative weights can satisfy is not preferred.
    pub(super) fn log_evidence(&self, smooth: Smooth, starts: &mut Starts) -> Result<f64> {
        self.progress.tell("choice of levels", f64::NAN)?;
        let mut prior = self.prior(smooth);
        prior.ridge = prior.ridge.max(SMALLEST_RIDGE);
        let penalised = self.whole.penalised(prior, &self.problem);
        let solver = self.problem.options.solver;
        let start = starts.len() - 1;
        let at = self
            .whole
            .solve(&penalised, solver, &starts[start], Progress::NONE)?;
        let objective = self.whole.objective(&penalised, &at.x);
        // Rounding of the squares that are subtracted from each other.
        let objective = objective
            .max(1e-15 * self.whole.squares)
            .max(f64::MIN_POSITIVE);
        let left = (self.whole.samples - self.whole.free()).max(1.0);
        if !smooth.is_none() || solver == Solver::Ols {
            starts[start] = at.x;
        }
        let (alone, both) = penalised.half_log_determinants(&self.problem.regressor)?;
        Ok(alone - both - 0.5 * left * objective.ln())
    }

    /// Root mean squared error of the fit to all samples.
    pub(super) fn fitted(&self, smooth: Smooth, starts: &Starts) -> Result<f64> {
        let penalised = self.whole.penalised(self.prior(smooth), &self.problem);
        let solver = self.problem.options.solver;
        let start = &starts[starts.len() - 1];
        let at = self
            .whole
            .solve(&penalised, solver, start, Progress::NONE)?;
        let mut squares = 0.0;
        for fold in &self.folds {
            squares += fold.own.error(&at);
        }
        Ok((squares / self.whole.samples).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_candidate_is_given_up_only_where_it_is_clearly_worse() {
        let mut race = Race::default();
        assert!(
            !race.is_lost(&[9.0, 0.0, 9.0, 0.0]),
            "the first has no rival"
        );
        race.enter(vec![1.0, 2.0, 1.0, 2.0]);
        race.enter(vec![5.0, 5.0, 5.0, 5.0]);
        // Twice LOST², on the two folds with even numbers.
        for (share, lost) in [(0.5, false), (1.0, false), (1.04, false), (1.06, true)] {
            let squares = share * share;
            let on_half = [squares, 0.0, squares, 0.0];
            assert_eq!(race.is_lost(&on_half), lost, "{share} of the best error");
        }
    }
}
