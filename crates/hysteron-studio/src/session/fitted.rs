//! What a fit found, and which fit is the best.

use super::id::Id;
use super::judged::Judged;
use super::opened::Opened;
use hysteron::{Budget, Errors, HeldOut, Model, Quantity, State};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Rows, counted from 1: the first and the last one of each span.
pub(super) type Spans = Arc<[(usize, usize)]>;

/// A fit that was made.
#[derive(Debug)]
pub(super) struct Fitted {
    pub(super) id: Id,
    pub(super) files: Vec<Id>,
    pub(super) options: BTreeMap<String, String>,
    /// What was held out, in words.
    pub(super) words: String,
    pub(super) validated: Vec<Id>,
    /// A number for the samples of each of these files, as the fit saw them.
    pub(super) samples: BTreeMap<Id, u64>,
    pub(super) model: Arc<Model>,
    pub(super) judged: Judged,
    /// Lowest and highest input and output of the recordings fitted.
    pub(super) input: (f64, f64),
    pub(super) output: (f64, f64),
    /// Median time step of the recordings, in seconds.
    pub(super) dt: Option<f64>,
    /// A number for the samples that its test is of, the same for the same samples.
    pub(super) tested_on: u64,
    /// The modelled output on each file that it was drawn with.
    pub(super) courses: BTreeMap<Id, (Arc<Vec<f64>>, Budget)>,
    /// Half the width of the band there.
    pub(super) bands: BTreeMap<Id, (Arc<Vec<f64>>, Budget)>,
    /// The rows of each file that were held out.
    pub(super) held: BTreeMap<Id, Spans>,
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
    /// Errors of the inverse on what was fitted, while the output moves, in the input's unit; `None`
    /// without an inverse.
    pub inverse_errors: Option<Errors>,
    /// Whether it is good enough: headings and sentences.
    pub verdict: Vec<(String, String)>,
    /// What comes late in the model, in words.
    pub late: Vec<String>,
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
    /// The number of samples that it took for outliers.
    pub outliers: usize,
    /// Whether standard errors are known.
    pub confidence: bool,
    /// The files that have changed since: its errors are of before.
    pub changed: Vec<Id>,
    /// Whether its errors can be computed anew without another fit.
    pub can_be_judged_anew: bool,
}

impl Fitted {
    pub(super) fn view(&self, files: &[Opened]) -> FitView {
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
            held_out: self.judged.held_out.clone(),
            inverse_errors: self.judged.inverse,
            late: model.late_words(),
            advice: self.judged.advice.clone(),
            verdict: self.judged.verdict.clone(),
            inverse: model.inverse().is_ok(),
            timed: model.is_timed(),
            load: model.load.as_ref().map(hysteron::LoadDependence::range),
            input: shown(&model.input),
            output: shown(&model.output),
            outliers: fit.map_or(0, |fit| fit.outliers.len()),
            confidence: fit.is_some_and(|fit| fit.confidence.is_some()),
            changed: self.changed(files),
            can_be_judged_anew: self.can_be_judged_anew(files),
        }
    }

    /// Whether another fit was tested on the same samples as this one. A file that was prepared, or
    /// read in another way, is another test.
    fn is_tested_as(&self, other: &Self) -> bool {
        self.test() == other.test() && self.tested_on == other.tested_on
    }

    /// What tested it.
    fn test(&self) -> (&str, &[Id], &[Id]) {
        // Files for validation test whatever was fitted; parts are those of the files fitted.
        match self.validated.as_slice() {
            [] => (&self.words, &[], &self.files),
            validated => (&self.words, validated, &[]),
        }
    }

    /// Its errors on what was held out.
    pub(super) fn tested(&self) -> Option<&Errors> {
        let held_out = self.judged.held_out.as_ref();
        held_out.map(|held_out| &held_out.model)
    }
}

/// The best fit, and by what. Errors on what was held out count: of the fits that were tested on the
/// same as the newest of them. Errors of fits alone count only where nothing was held out from any.
pub(super) fn best(fits: &[Fitted]) -> (Option<Id>, &'static str) {
    let least = |errors: &mut dyn Iterator<Item = (f64, Id)>| {
        errors.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, id)| id)
    };
    let tested = fits
        .iter()
        .filter_map(|fit| Some((fit.tested()?.rmse, fit)));
    let Some((_, newest)) = tested.clone().next_back() else {
        let rmse = |fit: &Fitted| fit.model.fit.as_ref().map_or(0.0, |fit| fit.rmse);
        let mut fitted = fits.iter().map(|fit| (rmse(fit), fit.id));
        let by = "the smallest error of the fit: nothing was held out";
        return (least(&mut fitted), by);
    };
    let alike = tested.clone().filter(|(_, fit)| fit.is_tested_as(newest));
    let by = match alike.clone().count() == tested.count() {
        true => "the smallest error on what was held out",
        false => {
            "the smallest error on what was held out from the newest fit, too: others had another test, and \
             are not compared"
        }
    };
    (least(&mut alike.map(|(error, fit)| (error, fit.id))), by)
}
