//! Chooses levels and smoothness.
//!
//! `criterion` says how good a candidate is: by the error on branches left out, or by the
//! evidence where there are few branches. `search` walks through the candidates. `start` finds the
//! state before the first sample. `validate` puts them together. `rivals` are simple predictors on
//! the same branches. `left_out` tests the whole fit, including these choices.

mod criterion;
pub(super) mod left_out;
mod rivals;
mod search;
mod seen;
pub(super) mod start;
pub(super) mod validate;

pub(super) use seen::Seen;

use crate::error::Result;
use crate::identify::options::FitOptions;
use crate::model::{Model, Smooth, Validation};
use crate::progress::Progress;
use validate::{Candidates, validated};

/// What is left to the data.
#[derive(Debug, Clone, Copy)]
pub(super) struct Open {
    pub(super) levels: bool,
    pub(super) smooth: bool,
}

impl Open {
    /// The options with levels and smoothness. The search for the smoothness begins `near` one.
    pub(super) fn choose(
        self,
        seen: Seen<'_>,
        options: &FitOptions,
        near: Option<Smooth>,
        progress: Progress<'_>,
    ) -> Result<(FitOptions, Option<Validation>)> {
        if !self.levels && !self.smooth {
            return Ok((options.clone(), None));
        }
        let candidates = Candidates::new(
            (!self.levels).then_some(options.levels),
            (!self.smooth).then_some(options.smooth),
        );
        let (options, found) = validated(seen, options, &candidates, near, progress)?;
        Ok((options, Some(found)))
    }
}

/// What given levels and a given smoothness are worth, by what is left out.
pub(super) fn tested(
    seen: Seen<'_>,
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<Validation> {
    let candidates = Candidates::new(Some(options.levels), Some(options.smooth));
    Ok(validated(seen, options, &candidates, None, progress)?.1)
}

/// A stage that nobody asked for has to be better by this share.
const WORTH: f64 = 0.1;

/// Whether a model with a stage predicts what was left out clearly better than the one without it,
/// and follows what was fitted clearly better, each with the levels and the other stages that it
/// chose. A dead time or a ring adds no weights to follow it with, and few branches that are left
/// out say little.
pub(super) fn is_worth(with: &Model, without: &Model) -> bool {
    let (Some(with), Some(without)) = (&with.fit, &without.fit) else {
        return false;
    };
    let predicts = match (&with.validation, &without.validation) {
        (Some(with), Some(without)) if with.criterion == without.criterion => with
            .criterion
            .is_worth(with.value(), without.value(), WORTH),
        _ => true,
    };
    predicts && with.rmse < (1.0 - WORTH) * without.rmse
}
