//! Fits of which a file has changed since: which they are, and their errors computed anew.

use super::fault::Fault;
use super::fitted::Fitted;
use super::fitting::FILES;
use super::id::Id;
use super::judged::Judged;
use super::opened::Opened;
use super::parts::number;
use super::state::Session;
use hysteron::{HoldOut, Model, held_out};
use std::sync::Arc;

impl Fitted {
    /// The files whose samples are others now than this fit saw. One that is closed is none of
    /// them.
    pub(super) fn changed(&self, files: &[Opened]) -> Vec<Id> {
        let other = |file: &&Opened| {
            let seen = self.samples.get(&file.id);
            seen.is_some_and(|seen| *seen != file.samples)
        };
        files.iter().filter(other).map(|file| file.id).collect()
    }

    /// Whether its errors can be computed anew without another fit: whole files tested it, and only
    /// these have changed.
    pub(super) fn can_be_judged_anew(&self, files: &[Opened]) -> bool {
        let changed = self.changed(files);
        let is_test = |id: &Id| self.validated.contains(id);
        self.words == FILES && !changed.is_empty() && changed.iter().all(is_test)
    }
}

impl Session {
    /// Computes the errors of a fit anew, on the files for validation as they are now.
    ///
    /// # Errors
    /// [`Fault`] 102 for a fit that another one has to replace.
    pub(super) fn judge_anew(&mut self, id: Id) -> Result<(), Fault> {
        let fitted = self.fitted(id)?;
        if !fitted.can_be_judged_anew(&self.files) {
            return Err(Fault::missing(
                "the errors of this fit cannot be computed anew: no file that it was tested on has \
                 changed, or what it was fitted to has",
                "fit again",
            ));
        }
        let recordings = |ids: &[Id]| {
            let each = ids.iter().map(|id| Ok(self.file(*id)?.parts()?.all()));
            Ok::<_, Fault>(each.collect::<Result<Vec<_>, Fault>>()?.concat())
        };
        let (training, tests) = (recordings(&fitted.files)?, recordings(&fitted.validated)?);
        let mut model = Model::clone(&fitted.model);
        let errors = held_out(&model, &training, &tests)?;
        errors.record_in(&mut model);
        let tested_on = number(tests.iter());
        let what = HoldOut::Recordings(tests);
        let judged = Judged::of(&model, &training, Some(&what), Some(errors))?;
        let files = self.files.iter();
        let samples: Vec<(Id, u64)> = files.map(|file| (file.id, file.samples)).collect();
        if let Some(fitted) = self.fits.iter_mut().find(|other| other.id == id) {
            for (file, now) in samples {
                fitted.samples.entry(file).and_modify(|seen| *seen = now);
            }
            fitted.model = Arc::new(model);
            fitted.judged = judged;
            fitted.tested_on = tested_on;
        }
        Ok(())
    }
}
