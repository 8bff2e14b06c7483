//! The fit of one actuator of a fleet: the same steps as for one alone.

use super::options::FleetOptions;
use super::row::FleetRow;
use crate::data::Note;
use crate::error::{Error, Result};
use crate::hold_out::fit_holding_out;
use crate::identify::advice;
use crate::prepare::{Doubt, doubts, prepare, rate_dependence};
use crate::progress::Progress;
use crate::recording::Recording;
use sha2::{Digest, Sha256};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Digest of what is fitted: names, units and bits of all samples.
pub(super) fn digest(recording: &Recording) -> [u8; 32] {
    let mut hash = Sha256::new();
    let series = [
        (Some(&recording.input), Some(&recording.input_quantity)),
        (Some(&recording.output), Some(&recording.output_quantity)),
        (recording.time.as_ref(), None),
        (recording.load.as_ref(), Some(&recording.load_quantity)),
    ];
    let mut bytes = Vec::new();
    for (samples, quantity) in series {
        let samples = samples.map_or(&[][..], Vec::as_slice);
        let quantity = quantity.filter(|_| !samples.is_empty());
        let about = (samples.len(), quantity);
        hash.update(format!("{about:?}"));
        bytes.clear();
        bytes.extend(samples.iter().flat_map(|sample| sample.to_le_bytes()));
        hash.update(&bytes);
    }
    hash.finalize().into()
}

/// Fits the actuator `id`. A defect of this library is an error of this actuator alone.
pub(super) fn fit(
    id: &str,
    file: String,
    digest: [u8; 32],
    recording: Recording,
    notes: Vec<Note>,
    options: &FleetOptions<'_>,
    progress: Progress<'_>,
) -> Result<FleetRow> {
    let fitted = catch_unwind(AssertUnwindSafe(|| {
        fit_one(recording, notes, options, progress)
    }));
    let failed = |_| Err(Error::Fit("a defect of hysteron ended this fit".into()));
    let (model, warnings) = fitted.unwrap_or_else(failed)?;
    let digest = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    Ok(FleetRow::new(id, file, digest, model, warnings))
}

fn fit_one(
    mut recording: Recording,
    notes: Vec<Note>,
    options: &FleetOptions<'_>,
    progress: Progress<'_>,
) -> Result<(crate::model::Model, Vec<String>)> {
    let mut warnings: Vec<String> = notes.iter().map(Note::to_string).collect();
    let units = [
        (&options.input_unit, &mut recording.input_quantity),
        (&options.output_unit, &mut recording.output_quantity),
    ];
    for (unit, quantity) in units {
        if unit.is_some() {
            quantity.unit.clone_from(unit);
        }
    }
    if let Some(steps) = options.steps() {
        recording = prepare(&recording, steps, progress)?.0;
    } else {
        warnings.extend(doubts(&recording)?.iter().map(Doubt::to_string));
    }
    if recording.time.is_some()
        && let Some(rate) = rate_dependence(&recording)?.filter(|rate| rate.is_material())
    {
        warnings.push(format!(
            "the loops depend on rate ({:.2} % of the range), which a static model cannot follow",
            rate.percent
        ));
    }
    let fit = options.fit.clone().repeats(Vec::new()).progress(progress);
    let (model, held_out) = match &options.hold_out {
        None => (fit.run(&recording)?, None),
        Some(what) => {
            let (model, held_out) = fit_holding_out(&fit, &recording, what)?;
            (model, Some(held_out))
        }
    };
    let advice = advice(&model, std::slice::from_ref(&recording))?;
    let of_held_out = held_out.iter().flat_map(|held_out| held_out.advice());
    warnings.extend(advice.into_iter().chain(of_held_out).map(|a| a.to_string()));
    Ok((model, warnings))
}
