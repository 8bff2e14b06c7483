//! Identifies creep and lag after the operators, where they predict parts of the recordings that
//! were left out.

use super::search::{Candidate, Search};
use super::undone::After;
use crate::error::{Error, Result};
use crate::identify::choose::Open;
use crate::identify::options::{Choice, FitOptions};
use crate::progress::Progress;
use crate::recording::Recording;
use hysteron_core::MAX_CREEP;
use serde::Serialize;

/// Terms that are tried by `auto`.
const TERMS: [usize; 2] = [1, 3];

/// What was tried, for the model file.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Report {
    /// Error on blocks left out without creep and lag, in percent of the range.
    without: f64,
    /// The same with the creep and the lag taken.
    with: f64,
    /// Whether creep was looked for, and not a lag alone.
    creep: bool,
}

impl Report {
    /// Where a lag alone was looked for.
    pub(super) fn of_lag(without: f64, with: f64) -> Self {
        Self {
            without,
            with,
            creep: false,
        }
    }
}

/// Looks for the creep and the lag that are asked for.
pub(super) fn find(
    recordings: &[Recording],
    options: &FitOptions,
    open: Open,
    progress: Progress<'_>,
) -> Result<(After, Report)> {
    if let Choice::Fixed(count) = options.creep
        && count > MAX_CREEP
    {
        return Err(Error::Fit(format!(
            "{count} creep terms: take {MAX_CREEP} at most"
        )));
    }
    if let Choice::Fixed(lag) = options.lag
        && !(lag >= 0.0 && lag.is_finite())
    {
        return Err(Error::Fit(format!(
            "a lag of {lag} s: it must be a finite number from 0 on"
        )));
    }
    let mut search = Search::new(recordings, options, open, progress)?;
    let without = search.left_out(&After::default())?;
    let counts = match options.creep {
        Choice::Fixed(count) => vec![count],
        Choice::Auto => [0].into_iter().chain(TERMS).collect(),
    };
    // The simpler first. What was asked for is taken with its best constants.
    let mut best: Option<Candidate> = None;
    for found in search.candidates(&counts, options.lag)? {
        let next = search.judged(found)?;
        if best
            .as_ref()
            .is_none_or(|best| next.is_worth(best, search.noise))
        {
            best = Some(next);
        }
    }
    let (after, with) = match best {
        Some(best) => (best.after, best.left_out),
        None => (After::default(), without),
    };
    let creep = options.creep != Choice::Fixed(0);
    let report = Report {
        without,
        with,
        creep,
    };
    Ok((after, report))
}
