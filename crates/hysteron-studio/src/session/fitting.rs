//! Fits: the work while it runs, and what it found.

use super::fault::{Fault, spelt};
use super::request::{Id, Purpose, Response};
use super::{Answer, MOST, Session};
use hysteron::{
    Advice, Errors, Fit, HeldOut, HoldOut, Model, Progress, Quantity, Recording, State, advice,
    fit_holding_out,
};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The most fits that run or wait at once.
const WAITING: usize = 8;

/// What tests a fit.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Held {
    /// The files for validation; without any the rows marked; without any a fifth of the branches,
    /// where there are enough of them.
    #[default]
    Usual,
    /// Nothing.
    Nothing,
    /// A part of each recording, as on the command line: `branches:20%`.
    Words(String),
}

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
    pub(super) watch: Arc<Watch>,
}

impl std::fmt::Debug for Job {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Job {}", self.id)
    }
}

/// A job that has ended, for [`Session::finish`].
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

    fn is_cancelled(&self) -> bool {
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

/// A fit that was made.
#[derive(Debug)]
pub(super) struct Fitted {
    pub(super) id: Id,
    pub(super) files: Vec<Id>,
    pub(super) options: BTreeMap<String, String>,
    /// What was held out, in words.
    pub(super) words: String,
    pub(super) validated: Vec<Id>,
    pub(super) model: Arc<Model>,
    pub(super) held_out: Option<HeldOut>,
    pub(super) advice: Vec<String>,
    /// Lowest and highest input and output of the recordings fitted.
    pub(super) input: (f64, f64),
    pub(super) output: (f64, f64),
    /// Median time step of the recordings, in seconds.
    pub(super) dt: Option<f64>,
    /// The modelled output on each file that it was drawn with.
    pub(super) courses: BTreeMap<Id, Arc<Vec<f64>>>,
    /// A file, a number of its rows, and the state after them.
    pub(super) reached: Option<(Id, usize, State)>,
}

/// A fit as the page shows it.
#[derive(Debug, Clone, Serialize)]
pub struct FitView {
    /// Its number.
    pub id: Id,
    /// The files fitted.
    pub files: Vec<Id>,
    /// Options that differ from their defaults.
    pub options: BTreeMap<String, String>,
    /// What was held out, in words; empty for nothing.
    pub hold_out: String,
    /// Number of levels.
    pub levels: usize,
    /// Error over the samples fitted, in the output's unit.
    pub rmse: f64,
    /// The same in percent of the range.
    pub nrmse_percent: f64,
    /// The largest error there.
    pub max_abs: f64,
    /// Errors over what was held out, of the model and of simple predictors.
    pub held_out: Option<HeldOut>,
    /// What there is to know about the fit.
    pub advice: Vec<String>,
    /// Whether the model has an inverse.
    pub inverse: bool,
    /// Whether each sample needs the time since the one before.
    pub timed: bool,
    /// Lowest and highest load, if the model depends on one.
    pub load: Option<(f64, f64)>,
    /// The input, with its unit.
    pub input: String,
    /// The output, with its unit.
    pub output: String,
    /// Whether standard errors are known.
    pub confidence: bool,
}

impl Session {
    pub(super) fn fit(
        &mut self,
        options: BTreeMap<String, String>,
        held: Held,
    ) -> Result<Answer, Fault> {
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
            recordings.push(Recording::clone(file.recording()?));
        }
        if recordings.is_empty() {
            return Err(Fault::missing(
                "no recording is there to be fitted",
                "open a file, and choose its columns",
            ));
        }
        let marked: Vec<_> = of(Purpose::Fit)
            .flat_map(|file| file.marked.clone())
            .collect();
        let mut others = Vec::new();
        for file in of(Purpose::Validate) {
            others.push(Recording::clone(file.recording()?));
        }
        let mut validated = Vec::new();
        let (hold_out, words) = match (held, marked.is_empty()) {
            (Held::Nothing, _) => (None, String::new()),
            (Held::Words(words), _) => (Some(words.parse::<HoldOut>()?), words),
            (Held::Usual, _) if !others.is_empty() => {
                validated = of(Purpose::Validate).map(|file| file.id).collect();
                (Some(HoldOut::Recordings(others)), "files".into())
            }
            (Held::Usual, false) => {
                let rows = marked.iter().map(|(first, last)| *first..=*last).collect();
                let spans = marked.iter().map(|(first, last)| format!("{first}-{last}"));
                let words = format!("rows:{}", spans.collect::<Vec<_>>().join(","));
                (Some(HoldOut::Rows(rows)), words)
            }
            (Held::Usual, true) => {
                let fifth = HoldOut::Branches(0.2);
                match recordings.iter().all(|r| r.split(&fifth).is_ok()) {
                    true => (Some(fifth), "branches:20%".into()),
                    false => (None, String::new()),
                }
            }
        };
        let fitted = of(Purpose::Fit).map(|file| file.id).collect();
        let id = self.next();
        let watch = Arc::new(Watch::default());
        self.running.insert(id, watch.clone());
        let started = watch.view(id);
        let job = Job {
            id,
            fitted,
            recordings,
            options,
            hold_out,
            words,
            validated,
            watch,
        };
        Ok(Answer {
            response: Response::Started(started),
            job: Some(job),
        })
    }

    /// Takes what a job found. Its fit is then in the list.
    ///
    /// # Errors
    /// [`Fault`] why there is none; 103 if it was cancelled.
    pub fn finish(&mut self, finished: Finished) -> Result<Id, Fault> {
        let watch = self.running.remove(&finished.id);
        if watch.is_some_and(|watch| watch.is_cancelled()) {
            return Err(Fault::cancelled());
        }
        let fitted = finished.found?;
        self.fits.push(*fitted);
        Ok(finished.id)
    }
}

/// A fit with these options.
fn build(options: &BTreeMap<String, String>) -> Result<Fit<'static>, Fault> {
    let mut fit = Fit::new();
    for (name, text) in options {
        fit = fit.with(name, text)?;
    }
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
    pub fn run_telling(self, told: &(dyn Fn(&'static str, f64) + Sync)) -> Finished {
        let id = self.id;
        let watch = self.watch.clone();
        let found = catch_unwind(AssertUnwindSafe(|| self.fit(told)));
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
        let told = |stage, share| {
            tell(stage, share);
            self.watch.tell(stage, share)
        };
        let fit = build(&self.options)?.progress(Progress::new(&told));
        let (model, held_out) = match &self.hold_out {
            None => (fit.run(&self.recordings)?, None),
            Some(what) => {
                let (model, held_out) = fit_holding_out(&fit, &self.recordings, what)?;
                (model, Some(held_out))
            }
        };
        let mut told: Vec<Advice> = advice(&model, &self.recordings)?;
        told.extend(held_out.iter().flat_map(HeldOut::advice));
        let told = told.iter();
        let advice = told.map(|advice| format!("{advice}: {}", advice.remedy().spelt(spelt)));
        let advice = advice.collect();
        let ends = |of: fn(&Recording) -> &[f64]| {
            let ranges = self.recordings.iter().map(|r| hysteron::range(of(r)));
            ranges.fold((f64::INFINITY, f64::NEG_INFINITY), |all, one| {
                (all.0.min(one.0), all.1.max(one.1))
            })
        };
        let time = self.recordings.iter().find_map(|r| r.time.as_deref());
        Ok(Fitted {
            id: self.id,
            input: ends(|r| &r.input),
            output: ends(|r| &r.output),
            dt: time.and_then(median_step),
            files: self.fitted,
            options: self.options,
            words: self.words,
            validated: self.validated,
            model: Arc::new(model),
            held_out,
            advice,
            courses: BTreeMap::new(),
            reached: None,
        })
    }
}

fn median_step(time: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps
        .get(steps.len() / 2)
        .copied()
        .filter(|step| *step > 0.0)
}

impl Fitted {
    pub(super) fn view(&self) -> FitView {
        let model = &self.model;
        let fit = model.fit.as_ref();
        let shown = |quantity: &Quantity| quantity.to_column();
        FitView {
            id: self.id,
            files: self.files.clone(),
            options: self.options.clone(),
            hold_out: self.words.clone(),
            levels: model.plane().levels(),
            rmse: fit.map_or(0.0, |fit| fit.rmse),
            nrmse_percent: fit.map_or(0.0, |fit| fit.nrmse_percent),
            max_abs: fit.map_or(0.0, |fit| fit.max_abs),
            held_out: self.held_out.clone(),
            advice: self.advice.clone(),
            inverse: model.inverse().is_ok(),
            timed: model.is_timed(),
            load: model.load.as_ref().map(hysteron::LoadDependence::range),
            input: shown(&model.input),
            output: shown(&model.output),
            confidence: fit.is_some_and(|fit| fit.confidence.is_some()),
        }
    }

    fn tested(&self) -> Option<&Errors> {
        self.held_out.as_ref().map(|held_out| &held_out.model)
    }
}

/// The best fit, and by what. Errors on what was held out count, and those of fits alone only where
/// nothing was held out from any.
pub(super) fn best(fits: &[Fitted]) -> (Option<Id>, &'static str) {
    let tested = fits
        .iter()
        .filter_map(|fit| Some((fit.tested()?.rmse, fit.id)));
    let least = |errors: &mut dyn Iterator<Item = (f64, Id)>| {
        errors.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, id)| id)
    };
    let mut tested = tested.peekable();
    if tested.peek().is_some() {
        return (
            least(&mut tested),
            "the smallest error on what was held out",
        );
    }
    let mut fitted = fits.iter().map(|fit| (fit.view().rmse, fit.id));
    (
        least(&mut fitted),
        "the smallest error of the fit: nothing was held out",
    )
}
