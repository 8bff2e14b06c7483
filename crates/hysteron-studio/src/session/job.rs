//! The work of a fit, while it runs and when it ends.

use super::fault::Fault;
use super::fitted::Fitted;
use super::id::Id;
use super::judged::Judged;
use super::parts::number;
use super::thinned::fair_ends;
use hysteron::{Fit, HoldOut, Progress, Recording, fit_holding_out};
use serde::Serialize;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// A fit that is to be made. It owns all that it needs.
pub struct Job {
    /// Its number.
    pub id: Id,
    pub(super) fitted: Vec<Id>,
    pub(super) recordings: Vec<Recording>,
    pub(super) options: BTreeMap<String, String>,
    pub(super) hold_out: Option<HoldOut>,
    pub(super) words: String,
    pub(super) validated: Vec<Id>,
    /// A number for the samples of each file.
    pub(super) samples: BTreeMap<Id, u64>,
    pub(super) watch: Arc<Watch>,
}

impl std::fmt::Debug for Job {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Job {}", self.id)
    }
}

/// A job that has ended, for [`Session::finish`](super::Session::finish).
#[derive(Debug)]
pub struct Finished {
    pub(super) id: Id,
    pub(super) found: Result<Box<Fitted>, Fault>,
}

impl Finished {
    /// A job that was ended from outside before it found anything.
    #[must_use]
    pub fn without(job: Id, why: Fault) -> Self {
        let found = Err(why);
        Self { id: job, found }
    }
}

/// How far a job is, and whether it shall end.
#[derive(Debug, Default)]
pub(super) struct Watch {
    cancelled: AtomicBool,
    stage: Mutex<(Cow<'static, str>, f64)>,
}

/// A job as the page shows it.
#[derive(Debug, Clone, Serialize)]
pub struct JobView {
    /// Its number.
    pub id: Id,
    /// What it does now.
    pub stage: Cow<'static, str>,
    /// The share of that which is done, 0 to 1; `None` where it is not known.
    pub share: Option<f64>,
}

impl Watch {
    pub(super) fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    pub(super) fn view(&self, id: Id) -> JobView {
        let (stage, share) = self
            .stage
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        JobView {
            id,
            stage,
            share: Some(share).filter(|share| share.is_finite()),
        }
    }

    pub(super) fn at(&self, stage: Cow<'static, str>, share: f64) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = (stage, share);
    }

    fn tell(&self, stage: &'static str, share: f64) -> hysteron::Result<()> {
        self.at(stage.into(), share);
        match self.is_cancelled() {
            true => Err(hysteron::Error::Fit("cancelled".into())),
            false => Ok(()),
        }
    }
}

/// A fit with these options.
pub(super) fn build(options: &BTreeMap<String, String>) -> Result<Fit<'static>, Fault> {
    let mut fit = Fit::new();
    for (name, text) in options {
        fit = fit.with(name, text)?;
    }
    fit.check()?;
    Ok(fit)
}

impl Job {
    /// Does the work. This takes seconds to minutes.
    #[must_use]
    pub fn run(self) -> Finished {
        self.run_telling(&|_, _| ())
    }

    /// As [`Job::run`]. `told` gets each stage, and the share of it that is done; not a number where
    /// that is not known.
    #[must_use]
    pub fn run_telling(self, tell: &(dyn Fn(&'static str, f64) + Sync)) -> Finished {
        let id = self.id;
        let watch = self.watch.clone();
        let found = catch_unwind(AssertUnwindSafe(|| self.fit(tell)));
        let found = found.unwrap_or_else(|_| Err(Fault::defect("a fit ended in a panic")));
        let found = match watch.is_cancelled() {
            true => Err(Fault::cancelled()),
            false => found.map(Box::new),
        };
        Finished { id, found }
    }

    fn fit(self, tell: &(dyn Fn(&'static str, f64) + Sync)) -> Result<Fitted, Fault> {
        // One that was cancelled while it waited does nothing.
        self.watch.tell("beginning", f64::NAN)?;
        let report = |stage, share| {
            tell(stage, share);
            self.watch.tell(stage, share)
        };
        let fit = build(&self.options)?.progress(Progress::new(&report));
        let (model, held_out) = match &self.hold_out {
            None => (fit.run(&self.recordings)?, None),
            Some(what) => {
                let (model, held_out) = fit_holding_out(&fit, &self.recordings, what)?;
                (model, Some(held_out))
            }
        };
        let judged = Judged::of(&model, &self.recordings, self.hold_out.as_ref(), held_out)?;
        let ends = |of: fn(&Recording) -> &[f64]| {
            let values = self.recordings.iter().flat_map(of).copied();
            fair_ends(values).map_or((0.0, 0.0), |ends| (ends.low, ends.high))
        };
        let time = self.recordings.iter().find_map(|r| r.time.as_deref());
        // Whole recordings test whatever was fitted; a part is one of what was fitted.
        let fitted = self.recordings.iter();
        let tested_on = match &self.hold_out {
            Some(HoldOut::Recordings(whole)) => number(whole.iter()),
            Some(HoldOut::Both(_, whole)) => number(fitted.chain(whole)),
            _ => number(fitted),
        };
        Ok(Fitted {
            id: self.id,
            input: ends(|r| &r.input),
            output: ends(|r| &r.output),
            dt: time.and_then(median_step),
            tested_on,
            files: self.fitted,
            options: self.options,
            words: self.words,
            validated: self.validated,
            samples: self.samples,
            model: Arc::new(model),
            judged,
            courses: BTreeMap::new(),
            bands: BTreeMap::new(),
            held: BTreeMap::new(),
            reached: None,
        })
    }
}

/// Without the rounding of the times that it lies between, as a field on the page shows it.
fn median_step(time: &[f64]) -> Option<f64> {
    let rounded = |step: f64| format!("{step:.9e}").parse().unwrap_or(step);
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps
        .get(steps.len() / 2)
        .copied()
        .filter(|step| *step > 0.0)
        .map(rounded)
}
