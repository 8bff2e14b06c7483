//! How good a candidate is: one number of levels with one smoothness.

use crate::error::Result;
use crate::identify::options::Prior;
use crate::identify::weights::not_definite::not_definite;
use crate::identify::weights::problem::Problem;
use crate::identify::weights::sums::{Reduced, Sums, centred};
use crate::identify::weights::units::Folds;
use crate::model::{Sign, Smooth, Solver};
use crate::parallel;
use crate::progress::Progress;

/// Ridge of the prior in the evidence where the fit has none: without any, the prior is not a
/// density.
const SMALLEST_RIDGE: f64 = 1e-9;

/// With more columns, the problem of the other folds is made where it is solved, so that few of
/// them take memory at a time.
const LARGE: usize = 2000;

/// The samples of one number of levels, as sums over the folds.
pub(super) struct Level<'a> {
    problem: Problem<'a>,
    all: Sums,
    folds: Vec<Fold>,
    whole: Reduced,
    progress: Progress<'a>,
}

struct Fold {
    /// The sums over the fold.
    own: Sums,
    /// The problem of all other folds, where it is held.
    rest: Option<Reduced>,
}

/// Solutions of the folds, from which a search at a similar candidate starts; the last is the
/// solution of all samples. Zeros are a start too.
pub(super) type Starts = Vec<Vec<f64>>;

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
        let all = Sums::total(&own).ok_or_else(not_definite)?;
        let is_held = problem.regressor.columns().len() <= LARGE;
        let folds = own.into_iter().map(|own| {
            let rest = is_held.then(|| all.without(&own).reduced());
            let rest = rest.transpose()?;
            Ok(Fold { own, rest })
        });
        Ok(Self {
            folds: folds.collect::<Result<_>>()?,
            whole: all.clone().reduced()?,
            all,
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
        let solver = self.problem.options.solver;
        // The folds have nearly the same weights above zero as all samples together. A solution
        // with smoothness is no start for one without, which has far fewer.
        let far = smooth.is_none() || starts.iter().flatten().all(|x| *x == 0.0);
        let near = match far && solver == Solver::Nnls {
            true => {
                let penalised = self.whole.penalised(self.prior(smooth), &self.problem);
                let zeros = vec![0.0; self.problem.regressor.columns().len()];
                let whole = &self.whole;
                Some(whole.solve(&penalised, solver, &zeros, Progress::NONE)?.x)
            }
            false => None,
        };
        let before = &*starts;
        let solved = parallel::map(self.folds.len(), |n| {
            self.progress.tell("choice of levels", f64::NAN)?;
            let Fold { own, rest } = &self.folds[n];
            let start = near.as_ref().unwrap_or(&before[n]);
            let solve = |rest: &Reduced| {
                let penalised = rest.penalised(self.prior(smooth), &self.problem);
                rest.solve(&penalised, solver, start, Progress::NONE)
            };
            let at = match rest {
                Some(rest) => solve(rest)?,
                None => solve(&self.all.without(own).reduced()?)?,
            };
            Ok((own.error(&at), at.x))
        })?;
        let mut squares = 0.0;
        for (start, (error, x)) in starts.iter_mut().zip(solved) {
            squares += error;
            if !smooth.is_none() {
                *start = x;
            }
        }
        Ok((squares / self.whole.samples).sqrt())
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
