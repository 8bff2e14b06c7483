//! Looks for a lag that nobody asked for.

use super::after::Report;
use super::blocks::WORTH;
use super::search::{Search, step_of, time_passes};
use super::undone::After;
use crate::error::Result;
use crate::identify::changed::few_in_time;
use crate::identify::choose::Open;
use crate::identify::options::FitOptions;
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::lost::fill;

/// A lag alone can be judged by shorter blocks than creep. The error of long ones is that of loops
/// that the others do not have, and it hides a lag.
const SHORT_BLOCKS: usize = 24;

/// One of these lags, in sampling steps, has to reduce the error on what is fitted by this share,
/// or none is looked for.
const HINTS: [f64; 3] = [1.0, LONG, 32.0];
const HINT: f64 = 0.05;

/// A lag of more sampling steps has to take this share of the error. It smooths whatever the model
/// does wrong, and so gains a little where there is none.
const LONG: f64 = 4.0;
const LONG_WORTH: f64 = 0.5;

/// Looks for a lag; `None` where it does not predict parts of the recordings that were left out, is
/// shorter than a sampling step, or samples come at the same time.
pub(super) fn find(
    recordings: &[Recording],
    options: &FitOptions,
    open: Open,
    progress: Progress<'_>,
) -> Result<Option<(After, Report)>> {
    if !recordings.iter().all(time_passes) {
        return Ok(None);
    }
    // A wrong reading of the input moves the model at once and the output not at all: as if it came
    // late.
    let looked_at = few_in_time(recordings);
    let right: Vec<Recording> = looked_at.iter().map(with_right_input).collect();
    let mut search = Search::new(&right, options, open, progress)?;
    search.blocks = SHORT_BLOCKS;
    let bare = search.lagging(0.0)?;
    let mut helps = false;
    for steps in HINTS {
        helps = helps || search.lagging(steps * search.step)?.1 <= (1.0 - HINT) * bare.1;
    }
    if !helps {
        return Ok(None);
    }
    let Some(mut best) = search.lag_alone()? else {
        return Ok(None);
    };
    search.refine_lag(&mut best)?;
    let (without, with) = (search.judged(bare)?, search.judged(best)?);
    let report = Report::of_lag(without.left_out, with.left_out);
    let worth = match with.after.lag() > LONG * search.step {
        true => LONG_WORTH,
        false => WORTH,
    };
    // A lag shorter than a step cannot be told from how the input is held between samples. It would
    // be wrong at any other step.
    let steps = recordings.iter().map(step_of);
    let is_seen = with.after.lag() >= steps.fold(0.0, f64::max);
    let is_worth = is_seen && with.gains(worth, &without, search.noise);
    Ok(is_worth.then_some((with.after, report)))
}

/// The recording with lines in place of wrong readings of its input.
pub(crate) fn with_right_input(recording: &Recording) -> Recording {
    let [wrong, _] = recording.wrong_readings();
    let mut mended = recording.clone();
    for run in wrong.chunk_by(|a, b| a + 1 == *b) {
        fill(&mut mended.input, &(run[0]..run[0] + run.len()));
    }
    mended
}
