//! Cross-validation over whole branches. Neighbouring samples of a branch are almost equal, so
//! leaving out single samples would test nothing.

use crate::error::Result;
use crate::identify::options::FitOptions;
use crate::identify::weights::problem::Problem;
use crate::identify::weights::solve::NormalEquations;
use crate::model::Solver;
use crate::model::{Score, Validation};
use crate::parallel;
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::range;

/// Largest number of folds.
const FOLDS: usize = 10;

/// With fewer branches than this, parts of branches are left out instead of whole ones.
const ENOUGH_BRANCHES: usize = 6;

/// The candidates to choose from.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidates {
    /// Numbers of levels, ascending.
    pub levels: Vec<usize>,
    /// Strengths of the smoothness.
    pub smooth: Vec<f64>,
}

impl Candidates {
    /// The usual candidates, where the argument is `None`; otherwise only the value given.
    ///
    /// The usual numbers of levels are from 5 to 40 in steps of `√2`. The usual strengths are
    /// decades, and 0.
    #[must_use]
    pub fn new(levels: Option<usize>, smooth: Option<f64>) -> Self {
        Self {
            levels: levels.map_or(vec![5, 7, 10, 14, 20, 28, 40], |levels| vec![levels]),
            smooth: smooth.map_or_else(
                || (-10..=-3).map(|n| 10_f64.powi(n)).chain([0.0]).collect(),
                |smooth| vec![smooth],
            ),
        }
    }
}

/// Chooses levels and smoothness by the error on left-out branches. Returns the options with these
/// values, and the record of the choice.
///
/// The choice is the smoothest candidate that is worse than the best by at most one standard error
/// over the folds. More levels are tried until two numbers in a row have not reduced the error by 1
/// %. If the starts of several recordings are unknown, only two patterns of starts are tried: all
/// off and all on.
///
/// # Errors
/// As [`crate::Fit::run`].
pub fn cross_validate(
    recordings: &[Recording],
    options: &FitOptions,
    candidates: &Candidates,
    progress: Progress<'_>,
) -> Result<(FitOptions, Validation)> {
    choose(recordings, options, candidates, None, progress)
}

pub(crate) fn choose(
    recordings: &[Recording],
    options: &FitOptions,
    candidates: &Candidates,
    kept: Option<&[f64]>,
    progress: Progress<'_>,
) -> Result<(FitOptions, Validation)> {
    let mut options = options.clone();
    let first = FitOptions {
        levels: candidates.levels.first().copied().unwrap_or(options.levels),
        ..options.clone()
    };
    let mut problem = Problem::new(recordings, &first)?;
    if options.sign.is_none() && options.solver == Solver::Nnls {
        options.sign = Some(problem.solve(kept, Progress::NONE)?.sign);
    }
    let (folds, whole_branches) = folds(&problem, kept);
    let count = folds.iter().flatten().max().map_or(0, |fold| fold + 1);
    // The strongest first, because each solution is the starting point of the next.
    let mut smooth = candidates.smooth.clone();
    smooth.sort_by(|a, b| b.total_cmp(a));
    let mut scores: Vec<Score> = Vec::new();
    let mut by_fold: Vec<Vec<f64>> = Vec::new();
    let mut best: Option<Score> = None;
    let mut no_better = 0;
    for (n, &levels) in candidates.levels.iter().enumerate() {
        progress.tell(
            "cross-validation",
            n as f64 / candidates.levels.len() as f64,
        )?;
        let at = FitOptions {
            levels,
            ..options.clone()
        };
        let problem = Problem::new(recordings, &at)?;
        let all: Vec<Vec<f64>> = parallel::map(count, |fold| {
            squares_left_out(&problem, &folds, fold, &smooth, progress)
        })?;
        let samples = folds.iter().flatten().count() as f64;
        let before = best.map_or(f64::INFINITY, |best| best.rmse);
        for (k, &smooth) in smooth.iter().enumerate() {
            let squares: f64 = all.iter().map(|fold| fold[k]).sum();
            let rmse = (squares / samples).sqrt();
            let score = Score {
                levels,
                smooth,
                rmse,
            };
            if best.is_none_or(|best| rmse < best.rmse) {
                best = Some(score);
            }
            scores.push(score);
            by_fold.push(all.iter().map(|fold| fold[k]).collect());
        }
        no_better = match best {
            Some(best) if best.rmse < before * 0.99 => 0,
            _ => no_better + 1,
        };
        if no_better == 2 {
            break;
        }
    }
    let best = simplest(&scores, &by_fold)
        .ok_or_else(|| crate::error::Error::Fit("there are no candidates".into()))?;
    let (low, high) = range(&problem.experiment.output);
    let validation = Validation {
        folds: count,
        whole_branches,
        rmse: best.rmse,
        nrmse_percent: 100.0 * best.rmse / (high - low),
        scores,
    };
    options.levels = best.levels;
    options.smooth = best.smooth;
    Ok((options, validation))
}

/// The one-standard-error rule of Breiman et al. (1984). Among the candidates that are worse than
/// the best by at most one standard error of that difference over the folds, take the smoothest,
/// and of these the best. Otherwise the noise of the folds could choose too little smoothness.
fn simplest(scores: &[Score], by_fold: &[Vec<f64>]) -> Option<Score> {
    let best = (0..scores.len()).min_by(|a, b| scores[*a].rmse.total_cmp(&scores[*b].rmse))?;
    let as_good = |n: &usize| {
        let pairs = by_fold[*n].iter().zip(&by_fold[best]);
        let worse: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
        let folds = worse.len() as f64;
        let mean = worse.iter().sum::<f64>() / folds;
        let variance = worse.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (folds - 1.0);
        mean <= (variance / folds).sqrt()
    };
    let chosen = (0..scores.len()).filter(as_good).min_by(|a, b| {
        let (a, b) = (scores[*a], scores[*b]);
        b.smooth
            .total_cmp(&a.smooth)
            .then(a.rmse.total_cmp(&b.rmse))
    });
    chosen.map(|n| scores[n])
}

/// For each sample the fold that leaves it out, `None` for samples that are not kept at all. Also
/// whether the folds are of whole branches.
fn folds(problem: &Problem, kept: Option<&[f64]>) -> (Vec<Option<usize>>, bool) {
    let (unit, units, whole) = problem.experiment.units(kept, ENOUGH_BRANCHES);
    let count = units.min(FOLDS);
    let folds = unit.into_iter().map(|u| u.map(|u| u % count)).collect();
    (folds, whole)
}

/// Squared errors on the samples that a fold leaves out, for each strength of the smoothness.
fn squares_left_out(
    problem: &Problem,
    folds: &[Option<usize>],
    fold: usize,
    smooth: &[f64],
    progress: Progress<'_>,
) -> Result<Vec<f64>> {
    let rest = |f: &Option<usize>| {
        if f.is_some_and(|f| f != fold) {
            1.0
        } else {
            0.0
        }
    };
    let kept: Vec<f64> = folds.iter().map(rest).collect();
    let target = problem.target(problem.options.sign.unwrap_or_default());
    let free = problem.free(Some(&kept))?;
    let told = |_: &'static str, _: f64| progress.tell("cross-validation", f64::NAN);
    let quiet = Progress::new(&told);
    let gram = problem
        .regressor
        .gram(&problem.experiment, Some(&kept), quiet)?;
    let mut start: Option<Vec<f64>> = None;
    let mut squares = Vec::with_capacity(smooth.len());
    for &smooth in smooth {
        let equations = NormalEquations::of_gram(
            &problem.regressor,
            &problem.experiment,
            &free,
            Some(&kept),
            smooth,
            gram.clone(),
        )?;
        // Without smoothness most weights are zero. Then zero is a better starting point.
        let start_here = start.as_deref().filter(|_| smooth > 0.0);
        let solution = equations.solve(&target, problem.options.solver, start_here, 1, quiet)?;
        let predicted = problem.predict(&solution)?;
        let left_out = (0..target.len()).filter(|&n| folds[n] == Some(fold));
        squares.push(left_out.map(|n| (target[n] - predicted[n]).powi(2)).sum());
        start = Some(solution.x);
    }
    Ok(squares)
}
