//! The choice of levels and smoothness.
//!
//! Where there are enough branches, whole branches are left out. Neighbouring samples of a branch
//! are almost equal, so leaving out single samples would test nothing. A few branches say little
//! about each other. Then the evidence of the prior decides, which needs nothing left out.

use crate::error::Result;
use crate::identify::choose::criterion::Level;
use crate::identify::choose::rivals;
use crate::identify::choose::search::{
    ALONG_AXES, AROUND, Point, Step, best, place_of, smooth_at, walk,
};
use crate::identify::choose::seen::Seen;
use crate::identify::options::FitOptions;
use crate::identify::weights::experiment::Experiment;
use crate::identify::weights::problem::Problem;
use crate::identify::weights::units::{Folds, Units};
use crate::model::{Criterion, Score, Smooth, Solver, Validation};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::fair_range;

/// Largest number of folds.
const FOLDS: usize = 10;

/// With fewer branches than this, the evidence decides, and parts of branches are left out instead
/// of whole ones.
const ENOUGH_BRANCHES: usize = 6;

/// More levels have to be better by this share, see [`Criterion::is_worth`].
const WORTH: f64 = 0.01;

/// So many levels are always tried: noise can hide for a few steps that more of them help.
const FEWEST: usize = 28;

/// More columns are not tried, because they would take long: 40 levels have 820, and those with an
/// unknown start up to twice as many.
const MOST_COLUMNS: usize = 900;

/// From so many levels on a candidate takes long. The smoothness that was best with fewer levels
/// is rated first, because the strengths do not depend on the number of levels. A search then goes
/// along the axes, unless that first one is worse than the best of fewer levels by more than one
/// part in the number of levels: a search seldom makes up for more.
const FINE: usize = 20;

/// With more levels than this, that first one is the only candidate: a search has hardly anything
/// left to gain, and takes longer than all before. So the smoothness of one given number of levels
/// above it is searched for with so many first.
const SEARCHED: usize = 28;

/// A search goes on while it gains this share. On a plateau any place will do.
const GAIN: f64 = 1e-3;

/// The candidates to choose from.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidates {
    /// Numbers of levels, ascending.
    pub levels: Vec<usize>,
    /// The smoothness; `None` to search for it.
    pub smooth: Option<Smooth>,
}

impl Candidates {
    /// The usual candidates, where the argument is `None`; otherwise only the value given.
    ///
    /// The usual numbers of levels are from 5 to 40 in steps of `√2`. The usual strengths are
    /// decades from 1e-10 to 1e-3 along and to 1e-5 across, and 0.
    #[must_use]
    pub fn new(levels: Option<usize>, smooth: Option<Smooth>) -> Self {
        Self {
            levels: levels.map_or(vec![5, 7, 10, 14, 20, 28, 40], |levels| vec![levels]),
            smooth,
        }
    }
}

/// Chooses levels and smoothness. Returns the options with these values, and the record of the
/// choice.
///
/// With six branches or more the criterion is the error on branches left out. Otherwise it is the
/// evidence, see [`Criterion`]. At least 28 levels are tried, and more until two numbers in a row
/// have not been better by 1 % (by 1 in the logarithm of the evidence). From 20 levels on, the
/// smoothness that was best before is rated first; others follow where they can win, up to 28
/// levels. If the starts of several recordings are unknown, only two patterns of starts are tried:
/// all off and all on.
///
/// For one given number of levels above 28, the smoothness is searched for with 28, where a candidate
/// takes little time, and rated with all.
///
/// # Errors
/// As [`crate::Fit::run`].
pub fn cross_validate(
    recordings: &[Recording],
    options: &FitOptions,
    candidates: &Candidates,
    progress: Progress<'_>,
) -> Result<(FitOptions, Validation)> {
    validated(recordings.into(), options, candidates, None, progress)
}

/// As [`cross_validate`], for recordings that stages have changed. The search for the smoothness
/// begins `near` one that was good in a similar problem.
pub(super) fn validated(
    seen: Seen<'_>,
    options: &FitOptions,
    candidates: &Candidates,
    near: Option<Smooth>,
    progress: Progress<'_>,
) -> Result<(FitOptions, Validation)> {
    let Choice {
        options,
        folds,
        criterion,
        chosen,
        scores,
    } = choose(seen, options, candidates, (None, near), progress)?;
    let problem = Problem::new(seen.operators, &options)?;
    let (low, high) = fair_range(&problem.experiment.output);
    let rivals = rivals::left_out(seen.measured, &folds)?;
    // What the choice is worth is the error on what was left out, whatever chose.
    let rmse = match criterion {
        Criterion::LeftOut => chosen.rmse,
        Criterion::Evidence => {
            let sign = options.sign.unwrap_or_default();
            let level = Level::new(problem, sign, &folds, progress)?;
            level.left_out_rmse(chosen.smooth, &mut level.starts())?
        }
    };
    let validation = Validation {
        criterion,
        folds: folds.count,
        whole_branches: folds.units.whole_branches,
        rmse,
        nrmse_percent: 100.0 * rmse / (high - low),
        scores,
        rivals,
    };
    Ok((options, validation))
}

/// The candidate that was chosen, and how.
pub(super) struct Choice {
    /// With its levels and smoothness.
    pub(super) options: FitOptions,
    folds: Folds,
    pub(super) criterion: Criterion,
    chosen: Score,
    scores: Vec<Score>,
}

impl Choice {
    /// What the criterion says of it: the smaller, the better.
    pub(super) fn value(&self) -> f64 {
        self.criterion.value(&self.chosen)
    }
}

pub(super) fn choose(
    seen: Seen<'_>,
    options: &FitOptions,
    candidates: &Candidates,
    (kept, near): (Option<&[f64]>, Option<Smooth>),
    progress: Progress<'_>,
) -> Result<Choice> {
    let mut options = options.clone();
    let at = |levels: usize, options: &FitOptions| {
        let options = FitOptions {
            levels,
            ..options.clone()
        };
        Problem::new(seen.operators, &options)
    };
    let first = candidates.levels.first().copied().unwrap_or(options.levels);
    if options.sign.is_none() && options.solver == Solver::Nnls {
        // Few levels tell it too.
        let mut rough = at(first.min(SEARCHED), &options)?;
        options.sign = Some(rough.solve(kept, Progress::NONE)?.sign);
    }
    let sign = options.sign.unwrap_or_default();
    let even = Experiment::new(seen.even, &options)?;
    let folds = Folds::new(Units::new(&even, kept, ENOUGH_BRANCHES), FOLDS);
    let criterion = match folds.units.whole_branches {
        true => Criterion::LeftOut,
        false => Criterion::Evidence,
    };

    let mut scores: Vec<Score> = Vec::new();
    let mut search = Search {
        criterion,
        smooth: candidates.smooth,
        from: near.and_then(place_of).into_iter().collect(),
    };
    let open = candidates.smooth.is_none() && search.from.is_empty();
    let least = |found: &[Score]| {
        let values = found.iter().map(|score| criterion.value(score));
        values.fold(f64::INFINITY, f64::min)
    };
    let mut best_value = f64::INFINITY;
    // The best value with fewer levels than the one that is given. It is compared with, not chosen.
    let mut coarse_value = f64::INFINITY;
    if open && first > SEARCHED {
        let level = Level::new(at(SEARCHED, &options)?, sign, &folds, progress)?;
        coarse_value = least(&search.rate(&level, SEARCHED, f64::INFINITY)?);
    }
    let mut no_better = 0;
    // A candidate takes time about as the cube of its levels.
    let time = |levels: &[usize]| levels.iter().map(|k| (*k as f64).powi(3)).sum::<f64>();
    for (n, &levels) in candidates.levels.iter().enumerate() {
        let done = time(&candidates.levels[..n]) / time(&candidates.levels);
        progress.tell("choice of levels", done)?;
        let problem = at(levels, &options)?;
        if n > 0 && problem.regressor.columns().len() > MOST_COLUMNS {
            break;
        }
        let level = Level::new(problem, sign, &folds, progress)?;
        let found = search.rate(&level, levels, best_value.min(coarse_value))?;
        let value = least(&found);
        scores.extend(found);
        no_better = match criterion.is_worth(value, best_value, WORTH) {
            true => 0,
            false => no_better + 1,
        };
        best_value = best_value.min(value);
        if no_better >= 2 && levels >= FEWEST {
            break;
        }
    }
    let chosen = scores
        .iter()
        .copied()
        .min_by(|a, b| criterion.value(a).total_cmp(&criterion.value(b)))
        .ok_or_else(|| crate::error::Error::Fit("there are no candidates".into()))?;
    options.levels = chosen.levels;
    options.smooth = chosen.smooth;
    Ok(Choice {
        options,
        folds,
        criterion,
        chosen,
        scores,
    })
}

/// The search for the smoothness, from one number of levels to the next.
struct Search {
    criterion: Criterion,
    /// The smoothness, where it is given.
    smooth: Option<Smooth>,
    /// Where the last walk ended.
    from: Vec<Point>,
}

impl Search {
    /// The candidates at one number of levels, where the best value of fewer levels is known.
    fn rate(&mut self, level: &Level<'_>, levels: usize, least: f64) -> Result<Vec<Score>> {
        let mut starts = level.starts();
        let mut scores = Vec::new();
        let mut rate = |smooth: Smooth| -> Result<f64> {
            let mut score = Score {
                levels,
                smooth,
                rmse: 0.0,
                log_evidence: None,
            };
            match self.criterion {
                Criterion::LeftOut => {
                    score.rmse = level.left_out_rmse(smooth, &mut starts)?;
                }
                Criterion::Evidence => {
                    score.log_evidence = Some(level.log_evidence(smooth, &mut starts)?);
                    score.rmse = level.fitted(smooth, &starts)?;
                }
            }
            scores.push(score);
            Ok(self.criterion.value(&score))
        };
        match self.smooth {
            Some(smooth) => _ = rate(smooth)?,
            None => {
                let criterion = self.criterion;
                let steps: &[Step] = match self.from.is_empty() || levels < FINE {
                    true => &AROUND,
                    false => &ALONG_AXES,
                };
                let goes_on = |before: f64, value: f64| match before.is_infinite() {
                    true if levels < FINE || least.is_infinite() => value.is_finite(),
                    true => {
                        let reach = 1.0 / levels as f64;
                        levels <= SEARCHED && criterion.is_worth(value, least, -reach)
                    }
                    false => criterion.is_worth(value, before, GAIN),
                };
                let known = walk(&self.from, steps, goes_on, |place| rate(smooth_at(place)))?;
                self.from = best(&known).into_iter().collect();
            }
        }
        Ok(scores)
    }
}
