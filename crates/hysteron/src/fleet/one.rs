//! The fit of one actuator of a fleet: the same steps as for one alone.

use super::choice::FleetShared;
use super::options::FleetOptions;
use super::row::FleetRow;
use crate::advice::advice;
use crate::data::Note;
use crate::error::{Error, Result};
use crate::hold_out::{HeldOut, fit_holding_out};
use crate::identify::Fit;
use crate::model::Model;
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

/// Fits the actuator `id`, with what the pilots `shared` or by itself. A defect of this library is
/// an error of this actuator alone.
pub(super) fn fit(
    id: &str,
    file: String,
    digest: [u8; 32],
    (recording, notes): (Recording, Vec<Note>),
    (options, shared): (&FleetOptions<'_>, Option<&FleetShared>),
    progress: Progress<'_>,
) -> Result<FleetRow> {
    let (model, warnings) = guarded(|| {
        let ready = Ready::new(recording, &notes, options, progress)?;
        let fitted = match shared {
            None => ready.fitted(&options.fit, options, progress)?,
            Some(shared) => ready.fitted_sharing(shared, options, progress)?,
        };
        ready.advised(fitted)
    })?;
    let digest = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    Ok(FleetRow::new(id, file, digest, model, warnings))
}

/// What `work` returns; a defect of this library is an error of it.
pub(super) fn guarded<T>(work: impl FnOnce() -> Result<T>) -> Result<T> {
    let failed = |_| Err(Error::Fit("a defect of hysteron ended this fit".into()));
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(failed)
}

/// A recording that can be fitted, and what there is to say of it.
pub(super) struct Ready {
    recording: Recording,
    warnings: Vec<String>,
}

/// A model, and what was held out of its fit.
pub(super) type Fitted = (Model, Option<HeldOut>);

impl Ready {
    pub(super) fn new(
        mut recording: Recording,
        notes: &[Note],
        options: &FleetOptions<'_>,
        progress: Progress<'_>,
    ) -> Result<Self> {
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
        Ok(Self {
            recording,
            warnings,
        })
    }

    pub(super) fn recording(&self) -> &Recording {
        &self.recording
    }

    /// The model of a fit.
    pub(super) fn fitted(
        &self,
        fit: &Fit<'_>,
        options: &FleetOptions<'_>,
        progress: Progress<'_>,
    ) -> Result<Fitted> {
        let recording = &self.recording;
        let fit = fit.clone().repeats(Vec::new()).progress(progress);
        match &options.hold_out {
            None => Ok((fit.run(recording)?, None)),
            Some(what) => {
                let (model, held_out) = fit_holding_out(&fit, recording, what)?;
                Ok((model, Some(held_out)))
            }
        }
    }

    /// The model with its warnings.
    fn advised(self, (model, held_out): Fitted) -> Result<(Model, Vec<String>)> {
        let mut warnings = self.warnings;
        let advice = advice(&model, std::slice::from_ref(&self.recording))?;
        let of_held_out = held_out.iter().flat_map(HeldOut::advice);
        warnings.extend(advice.into_iter().chain(of_held_out).map(|a| a.to_string()));
        Ok((model, warnings))
    }
}
