//! Undoes what comes late behind the operators, and puts it there again.

use crate::error::{Error, Result};
use crate::model::{Model, Operators, StageConstants};
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};

pub(super) type After = StageConstants<f64>;

/// The recordings with the output as it was before these stages.
pub(super) fn before(after: &After, recordings: &[Recording]) -> Result<Vec<Recording>> {
    Ok(with_outputs(
        recordings,
        &undone_outputs(after, recordings)?,
    ))
}

/// The recordings with other outputs, which stand one recording after the other.
pub(super) fn with_outputs(recordings: &[Recording], mut outputs: &[f64]) -> Vec<Recording> {
    let mut others = recordings.to_vec();
    for recording in &mut others {
        let (own, rest) = outputs.split_at(recording.len());
        recording.output.copy_from_slice(own);
        outputs = rest;
    }
    others
}

/// The outputs of all recordings as they were before these stages.
pub(super) fn undone_outputs(after: &After, recordings: &[Recording]) -> Result<Vec<f64>> {
    let around = around(after, recordings)?;
    let undone = recordings.iter().map(|r| around.before_stages(r));
    Ok(undone.collect::<Result<Vec<_>>>()?.concat())
}

/// A model of any operators with these stages.
fn around(after: &After, recordings: &[Recording]) -> Result<Model> {
    let plane = crate::identify::plane_of(&recordings[0], 2)?;
    let operator = hysteron_core::Operator::Mkp;
    let operators = Operators::new(operator, plane, vec![0.0; 3], 0.0, Default::default())?;
    Model::from(operators).with_after(&after.terms(), after.lag())
}

/// Outputs after these stages, from those of the operators.
pub(super) fn forward(after: &After, recordings: &[Recording], sums: &[f64]) -> Result<Vec<f64>> {
    let model = around(after, recordings)?;
    let stages = model.stages();
    let mut output = Vec::with_capacity(sums.len());
    let mut from = 0;
    for recording in recordings {
        let time = recording.time.as_ref().ok_or_else(no_time)?;
        let mut past = None;
        for n in 0..recording.len() {
            let dt = time[n] - time[n.saturating_sub(1)];
            let (y, next) = stages.after(past, dt, sums[from + n]);
            past = Some(next);
            output.push(y);
        }
        from += recording.len();
    }
    Ok(output)
}

/// A recording without time, for options that ask for such a stage.
pub(super) fn no_time() -> Error {
    let what = "creep, lag and ring depend on time, and the recording has none";
    let remedy = Remedy::new("name its column ({})", [Setting::any("time")]);
    Error::Fit(what.into()).remedied(remedy)
}

/// Refuses recordings without time before anything is computed.
pub(crate) fn check_time(recordings: &[Recording]) -> Result<()> {
    match recordings.iter().all(|recording| recording.time.is_some()) {
        true => Ok(()),
        false => Err(no_time()),
    }
}
