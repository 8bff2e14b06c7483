//! The method `load` over a recording: an estimate of the shift, sample by sample.

use super::stuck::at_the_end;
use super::{AdaptOptions, Adapted, AdaptiveLoad, Begun, Learned, covered, on_probation, run_from};
use crate::error::{Error, Result};
use crate::model::{Model, Start, Surroundings};
use crate::progress::{Progress, SAMPLES_BETWEEN};
use crate::recording::Recording;

/// What the method `load` found.
#[derive(Debug, Clone, PartialEq)]
pub struct ShiftFound {
    /// The shift of the axis before each sample was learned from, in the input's unit: of the
    /// temperature, for a model with a thermal body.
    pub shifts: Vec<f64>,
    /// The load that each shift tells. `None` if the model's shift says nothing of a load.
    pub loads: Option<Vec<f64>>,
    /// The shift of the model that was written.
    pub shift: f64,
    /// Its standard deviation, as the filter believes it.
    pub deviation: f64,
    /// The load that this shift tells.
    pub load: Option<f64>,
    /// The load that the shift departs from.
    pub from: Option<f64>,
}

/// `joined` are the recordings one after the other.
pub(super) fn adapt(
    model: &Model,
    (recordings, joined): (&[Recording], &Recording),
    options: &AdaptOptions,
    progress: Progress<'_>,
) -> Result<Adapted> {
    let learned_by = options.resolve(model, joined)?;
    let mut adaptive = AdaptiveLoad::new(model, options.load, learned_by.shift()?)?;
    let offline = match adaptive.told() {
        Some(load) => model.at_load(load)?,
        None => model.clone(),
    };
    if options.start == Start::Rest {
        let what = "no rest is found on an axis that shifts: take the start fitted, off, on or \
                    unknown";
        return Err(Error::Fit(what.into()));
    }
    let others = [Start::Off, Start::On];
    let begun = Begun::new(&offline, recordings, options.start, &others)?;
    let (offline, start) = (&begun.model, begun.start);
    let around = |one| Surroundings {
        load: None,
        ..Surroundings::from_recording(model, one)
    };
    let seen = recordings.iter();
    let seen = seen.map(|one| offline.seen(&one.input, around(one)));
    let seen = seen.collect::<Result<Vec<_>>>()?.concat();
    let count = joined.len();
    let probation = on_probation(learned_by, count);
    let still = match learned_by.watches() {
        true => at_the_end(offline, recordings, &begun.output),
        false => 0,
    };
    let unsure = probation.max(still);
    let (mut learned, mut shifts, mut loads) = (Vec::new(), Vec::new(), Vec::new());
    let mut last = adaptive.clone();
    for recording in recordings {
        adaptive.start_from(start);
        for (n, sample) in around(recording).samples(model, &recording.input)? {
            let done = learned.len();
            if done % SAMPLES_BETWEEN == 0 {
                progress.tell("adaptation", done as f64 / count as f64)?;
            }
            if done + unsure == count {
                last = adaptive.clone();
            }
            shifts.push(adaptive.shift());
            loads.extend(adaptive.load());
            learned.push(adaptive.step(sample, recording.output[n])?);
        }
    }
    // One that found a channel still has undone what it learned there.
    if unsure == 0 || adaptive.stuck().is_some() {
        last = adaptive;
    }
    progress.tell("adaptation", 1.0)?;
    let found = super::ShiftFound {
        loads: (loads.len() == count).then_some(loads),
        shifts,
        shift: last.shift(),
        deviation: last.deviation(),
        load: last.load(),
        from: last.told(),
    };
    let last = match start {
        // It was shifted with the axis.
        Start::Fitted => last.model()?,
        _ => offline.starts(last.model()?, start)?,
    };
    Learned {
        again: run_from(&last, Start::Fitted, recordings)?,
        covered: covered(offline, &seen),
        begun,
        last,
        learned,
        probation,
        still,
        held: Vec::new(),
        session: false,
        shares: Vec::new(),
        shift: Some(found),
        options: learned_by,
    }
    .judged(joined, options)
}
