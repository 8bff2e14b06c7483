//! Fits that are asked for, and what becomes of them.

use super::fault::Fault;
use super::id::Id;
use super::job::{Finished, Job, JobView, Watch, build};
use super::opened::{Opened, Purpose};
use super::parts::numbers_of;
use super::state::{MOST, Running, Session};
use hysteron::HoldOut;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The most fits that run or wait at once.
const WAITING: usize = 8;

/// What tests a fit.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Held {
    /// The files for validation and the rows marked; without either a fifth of the branches, where
    /// there are enough of them.
    #[default]
    Usual,
    /// Nothing.
    Nothing,
    /// A part of each recording, as on the command line: `branches:20%`.
    Words(String),
}

/// What stands for files that tested a fit. It comes last in the words of what was held out.
pub(super) const FILES: &str = "files";

/// The part of the files fitted that these words hold out; empty for none.
pub(super) fn held_part(words: &str) -> &str {
    words.strip_suffix(FILES).unwrap_or(words).trim_end()
}

/// A part that is held out, in words without spaces.
///
/// # Errors
/// [`Fault`] for words that say no part.
pub(super) fn part(words: &str) -> Result<String, Fault> {
    words.parse::<HoldOut>()?;
    Ok(words.split_whitespace().collect())
}

impl Session {
    pub(super) fn fit(
        &mut self,
        options: BTreeMap<String, String>,
        held: Held,
    ) -> Result<(JobView, Job), Fault> {
        if self.fits.len() + self.running.len() >= MOST {
            return Err(Fault::missing(
                &format!("there are {MOST} fits in this session"),
                "remove some of them",
            ));
        }
        // Each holds a copy of its recordings while it waits.
        if self.running.len() >= WAITING {
            return Err(Fault::missing(
                &format!("{WAITING} fits are running or waiting"),
                "wait for one of them, or cancel it",
            ));
        }
        build(&options)?;
        let of = |purpose: Purpose| {
            self.files
                .iter()
                .filter(move |file| file.purpose == purpose)
        };
        let mut recordings = Vec::new();
        for file in of(Purpose::Fit) {
            recordings.extend_from_slice(file.parts()?.all());
        }
        if recordings.is_empty() {
            return Err(Fault::missing(
                "no recording is there to be fitted",
                "open a file, and choose its columns",
            ));
        }
        // Rows are counted through all that is fitted.
        let mut before = 0;
        let mut marked = Vec::new();
        for file in of(Purpose::Fit) {
            let spans = file.marked.iter();
            marked.extend(spans.map(|(first, last)| (before + first, before + last)));
            before += file.parts()?.shown.len();
        }
        let mut others = Vec::new();
        for file in of(Purpose::Validate) {
            others.extend_from_slice(file.parts()?.all());
        }
        let mut validated = Vec::new();
        let (hold_out, words) = match (held, marked.is_empty()) {
            (Held::Nothing, _) => (None, String::new()),
            (Held::Words(words), _) => (Some(words.parse::<HoldOut>()?), part(&words)?),
            (Held::Usual, is_unmarked) if !is_unmarked || !others.is_empty() => {
                let rows = marked.iter().map(|(first, last)| *first..=*last);
                let rows = (!is_unmarked).then(|| HoldOut::Rows(rows.collect()));
                let spans = marked.iter().map(|(first, last)| format!("{first}-{last}"));
                let spans = spans.collect::<Vec<_>>().join(",");
                let rows_named = rows.iter().map(|_| format!("rows:{spans}"));
                let files_named = others.first().map(|_| FILES.to_owned());
                let words: Vec<String> = rows_named.chain(files_named).collect();
                validated = of(Purpose::Validate).map(|file| file.id).collect();
                (HoldOut::together(rows, others), words.join(" "))
            }
            (Held::Usual, _) => {
                let fifth = HoldOut::Branches(0.2);
                match recordings.iter().all(|r| r.split(&fifth).is_ok()) {
                    true => (Some(fifth), "branches:20%".into()),
                    false => (None, String::new()),
                }
            }
        };
        let fitted: Vec<Id> = of(Purpose::Fit).map(|file| file.id).collect();
        let of_fit = |file: &&Opened| fitted.contains(&file.id) || validated.contains(&file.id);
        let samples = self.files.iter().filter(of_fit);
        let samples = samples.map(|file| (file.id, file.samples)).collect();
        let others = hold_out.iter().flat_map(HoldOut::recordings);
        let bytes = recordings.iter().chain(others);
        let bytes = bytes.map(numbers_of).sum();
        let held = self.held(bytes, "the recordings of the fit")?;
        let id = self.next()?;
        let watch = Arc::new(Watch::default());
        let running = Running {
            watch: watch.clone(),
            _held: held,
        };
        self.running.insert(id, running);
        let started = watch.view(id);
        let job = Job {
            id,
            fitted,
            recordings,
            options,
            hold_out,
            words,
            validated,
            samples,
            watch,
        };
        Ok((started, job))
    }

    /// Takes what a job found. Its fit is then in the list.
    ///
    /// # Errors
    /// [`Fault`] why there is none; 103 if it was cancelled.
    pub fn finish(&mut self, finished: Finished) -> Result<Id, Fault> {
        let running = self.running.remove(&finished.id);
        // One that was cancelled is no longer there.
        if running.is_none_or(|running| running.watch.is_cancelled()) {
            return Err(Fault::cancelled());
        }
        let fitted = finished.found?;
        self.fits.push(*fitted);
        Ok(finished.id)
    }
}
