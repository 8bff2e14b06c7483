//! What is said of a fit: its errors, its verdict, and what there is to know. Said anew where a file
//! that tested it has changed.

use super::fault::{Fault, spelt};
use super::fitted::Fitted;
use super::fitting::FILES;
use super::id::Id;
use super::opened::Opened;
use super::parts::number;
use super::state::Session;
use hysteron::{Advice, Errors, HeldOut, HoldOut, Model, Recording, Verdict, advice, held_out};
use std::sync::Arc;

/// What is said of a fit.
#[derive(Debug, Clone)]
pub(super) struct Judged {
    pub(super) held_out: Option<HeldOut>,
    /// The errors of the inverse on what was fitted, while the output moves.
    pub(super) inverse: Option<Errors>,
    pub(super) advice: Vec<String>,
    /// Whether it is good enough: headings and sentences.
    pub(super) verdict: Vec<(String, String)>,
}

impl Judged {
    /// What is said of a model that was fitted to `recordings` while `what` was held out, which gave
    /// `held_out`. Its record has that, too.
    pub(super) fn of(
        model: &Model,
        recordings: &[Recording],
        what: Option<&HoldOut>,
        held_out: Option<HeldOut>,
    ) -> Result<Self, Fault> {
        let verdict = match what {
            Some(what) => Verdict::of_fit_holding_out(model, recordings, what)?,
            None => Verdict::of_fit(model, recordings)?,
        };
        let lines = verdict.lines(spelt).into_iter();
        let mut all: Vec<Advice> = advice(model, recordings)?;
        all.extend(held_out.iter().flat_map(HeldOut::advice));
        let advice = all.iter();
        let advice = advice.map(|advice| format!("{advice}: {}", advice.remedy().spelt(spelt)));
        Ok(Self {
            inverse: verdict.inverse,
            verdict: lines
                .map(|(heading, text)| (heading.to_owned(), text))
                .collect(),
            advice: advice.collect(),
            held_out,
        })
    }
}

impl Fitted {
    /// The files whose samples are others now than this fit saw. One that is closed is none of them.
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
