//! Chooses the state of the operators before the first sample.

use crate::error::Result;
use crate::identify::changed::{few, thin};
use crate::identify::choose::validate::{Candidates, Choice, choose};
use crate::identify::options::{FitOptions, SOME_SMOOTHNESS};
use crate::identify::rest::{polished, search};
use crate::identify::weights::problem::Problem;
use crate::model::Start;
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::range;

/// From this share of operators on, it matters that the first sample does not determine their
/// state.
pub(crate) const MANY_OPEN: f64 = 0.05;

/// An unknown start has to be better than a known one by this share, see
/// [`Criterion::is_worth`](crate::model::Criterion::is_worth).
const WORTH: f64 = 0.02;

/// The fits in the search of a rest see about so many samples, and have at most so many levels
/// until the rest is nearly found: their answer is one input.
const SEARCHED: (usize, usize) = (1500, 14);

/// The options with the start that the recordings ask for: off where the first samples determine
/// nearly all operators; otherwise a rest, whose input has the least error of a fit. An unknown
/// start has to be clearly better, by the same criterion as levels and smoothness.
///
/// # Errors
/// As [`crate::Fit::run`] for invalid recordings and options.
pub fn usual_start(recordings: &[Recording], options: &FitOptions) -> Result<FitOptions> {
    let off = FitOptions {
        start: Start::Off,
        ..options.clone()
    };
    let recordings = &few(recordings, recordings)[..];
    let problem = Problem::new(recordings, &off)?;
    let operators = problem.regressor.plane().operators() as f64;
    if problem.regressor.open_at_start as f64 <= MANY_OPEN * operators {
        return Ok(off);
    }
    let smooth = options.smooth.at_least(SOME_SMOOTHNESS);
    let candidates = Candidates::new(Some(options.levels), Some(smooth));
    let tried = |options: &FitOptions| -> Result<Choice> {
        choose(
            recordings.into(),
            options,
            &candidates,
            (None, None),
            Progress::NONE,
        )
    };
    let (rest, unknown) = (
        at_rest(recordings, options)?,
        FitOptions {
            start: Start::Unknown,
            ..options.clone()
        },
    );
    let (known, free) = (tried(&rest)?, tried(&unknown)?);
    let better = free.criterion.is_worth(free.value(), known.value(), WORTH);
    Ok(if better { unknown } else { rest })
}

/// The options with a rest: that with the least error of a fit to the recordings.
///
/// # Errors
/// As [`crate::Fit::run`].
pub(crate) fn at_rest(recordings: &[Recording], options: &FitOptions) -> Result<FitOptions> {
    let samples: usize = recordings.iter().map(Recording::len).sum();
    let stride = samples.div_ceil(SEARCHED.0);
    let recordings: Vec<Recording> = recordings
        .iter()
        .map(|recording| thin(recording, stride))
        .collect();
    let ranges = recordings.iter().map(|recording| range(&recording.input));
    let all = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let with = |rest| FitOptions {
        start: Start::Rest,
        rest: Some(rest),
        ..options.clone()
    };
    let mut tried = FitOptions {
        smooth: options.smooth.at_least(SOME_SMOOTHNESS),
        ..with([0.0; 2])
    };
    let mut error = |levels, rest| {
        (tried.levels, tried.rest) = (levels, Some(rest));
        let mut problem = Problem::new(&recordings, &tried)?;
        let fitted = problem.solve(None, Progress::NONE)?;
        tried.sign = Some(fitted.sign);
        Ok(fitted.solution.residual.iter().map(|r| r * r).sum())
    };
    let (all, coarse) = (all.unwrap_or_default(), options.levels.min(SEARCHED.1));
    let (rest, _) = search(all, |rest| error(coarse, rest))?;
    if coarse == options.levels {
        return Ok(with(rest));
    }
    Ok(with(polished(rest, all, |rest| {
        error(options.levels, rest)
    })?))
}
