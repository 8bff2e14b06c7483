//! Chooses levels and smoothness.
//!
//! `criterion` says how good a candidate is: by the error on branches left out, or by the
//! evidence where there are few branches. `search` walks through the candidates. `sums` are the
//! products of groups of samples, from which a fit and its error follow without the samples.
//! `validate` puts them together. `rivals` are simple predictors on the same branches. `left_out` tests the whole fit, including these choices.

mod criterion;
pub(super) mod left_out;
mod rivals;
mod search;
mod sums;
pub(super) mod validate;

use crate::error::Result;
use crate::identify::options::FitOptions;
use crate::identify::weights::problem::Problem;
use crate::model::{Start, Validation};
use crate::progress::Progress;
use crate::recording::Recording;
use validate::{Candidates, cross_validate};

/// From this share of operators on, it matters that the first sample does not determine their
/// state.
pub(super) const MANY_OPEN: f64 = 0.05;

/// What is left to the data.
#[derive(Debug, Clone, Copy)]
pub(super) struct Open {
    pub(super) levels: bool,
    pub(super) smooth: bool,
}

impl Open {
    /// The options with levels and smoothness, for recordings as the operators see them.
    pub(super) fn choose(
        self,
        recordings: &[Recording],
        options: &FitOptions,
        progress: Progress<'_>,
    ) -> Result<(FitOptions, Option<Validation>)> {
        if !self.levels && !self.smooth {
            return Ok((options.clone(), None));
        }
        let candidates = Candidates::new(
            (!self.levels).then_some(options.levels),
            (!self.smooth).then_some(options.smooth),
        );
        let (options, found) = cross_validate(recordings, options, &candidates, progress)?;
        Ok((options, Some(found)))
    }
}

/// The start that the recordings ask for: off where the first samples determine nearly all
/// operators, otherwise unknown.
///
/// # Errors
/// As [`crate::Fit::run`] for invalid recordings and options.
pub fn usual_start(recordings: &[Recording], options: &FitOptions) -> Result<Start> {
    let problem = Problem::new(recordings, options)?;
    let operators = problem.regressor.plane().operators() as f64;
    let open = problem.regressor.open_at_start as f64;
    Ok(match open > MANY_OPEN * operators {
        true => Start::Unknown,
        false => Start::Off,
    })
}
