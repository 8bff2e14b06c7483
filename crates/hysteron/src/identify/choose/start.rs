//! Chooses the state of the operators before the first sample.

use crate::error::Result;
use crate::identify::choose::validate::{Candidates, Choice, choose};
use crate::identify::options::{FitOptions, SOME_SMOOTHNESS};
use crate::identify::weights::problem::Problem;
use crate::model::Start;
use crate::progress::Progress;
use crate::recording::Recording;

/// From this share of operators on, it matters that the first sample does not determine their
/// state.
pub(crate) const MANY_OPEN: f64 = 0.05;

/// An unknown start has to be better than a known one by this share, see
/// [`Criterion::is_worth`](crate::model::Criterion::is_worth).
const WORTH: f64 = 0.02;

/// The start that the recordings ask for: off where the first samples determine nearly all
/// operators; otherwise off, on or unknown, by the same criterion as levels and smoothness. The
/// unknown start has to be clearly better than the others.
///
/// # Errors
/// As [`crate::Fit::run`] for invalid recordings and options.
pub fn usual_start(recordings: &[Recording], options: &FitOptions) -> Result<Start> {
    let off = FitOptions {
        start: Start::Off,
        ..options.clone()
    };
    let problem = Problem::new(recordings, &off)?;
    let operators = problem.regressor.plane().operators() as f64;
    if problem.regressor.open_at_start as f64 <= MANY_OPEN * operators {
        return Ok(Start::Off);
    }
    let smooth = options.smooth.at_least(SOME_SMOOTHNESS);
    let candidates = Candidates::new(Some(options.levels), Some(smooth));
    let tried = |start: Start| -> Result<Choice> {
        let options = FitOptions {
            start,
            ..options.clone()
        };
        choose(recordings.into(), &options, &candidates, None, Progress::NONE)
    };
    let (off, on) = (tried(Start::Off)?, tried(Start::On)?);
    let known = match on.value() < off.value() {
        true => (on.value(), Start::On),
        false => (off.value(), Start::Off),
    };
    let unknown = tried(Start::Unknown)?;
    let better = unknown.criterion.is_worth(unknown.value(), known.0, WORTH);
    Ok(if better { Start::Unknown } else { known.1 })
}
