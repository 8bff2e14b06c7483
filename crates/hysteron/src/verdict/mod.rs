//! Whether a model is good enough, for what, why it is not better, and what to do next.
//!
//! This file makes a [`Verdict`] of a fit or of an evaluation. `grade` is what a model is good for;
//! `parts` tells what an error consists of, `cause` what is behind it, and `words` says all of it in
//! sentences. `serial` writes it.

mod cause;
mod grade;
mod parts;
mod serial;
mod words;

pub use cause::Cause;
pub use grade::{Basis, Grade};
pub use parts::{ErrorPart, PartKind, error_parts};

use crate::error::{Place, Result};
use crate::evaluate::{Evaluation, evaluate_from};
use crate::forward::Forward;
use crate::hold_out::{HeldOut, PART};
use crate::model::{Criterion, FitSummary, Model, Start};
use crate::recording::{Quantity, Recording, no_recordings};
use crate::rivals::{Rival, RivalKind};
use crate::series::Errors;
use crate::series::noise::noise;
use serde::Serialize;

/// The sample with the largest error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Worst {
    /// Index of the recording, from 0.
    pub recording: usize,
    /// Index of the sample in it, from 0.
    pub sample: usize,
    /// Where it stands in the file, if rows count otherwise there.
    #[serde(skip)]
    pub place: Option<Place>,
    /// Its time in seconds; `None` without time.
    pub time: Option<f64>,
    /// The input there.
    pub input: f64,
    /// The output measured.
    pub measured: f64,
    /// The output of the model.
    pub modelled: f64,
}

/// Whether a model is good enough, and if not, why.
///
/// Errors are in percent of the measured range of the output, of the input for the inverse.
///
/// ```
/// use hysteron::{Fit, Grade, Recording, Verdict};
/// let input: Vec<f64> = (0..900).map(|n| 50.0 - 30.0 * (f64::from(n) * 0.02).cos()).collect();
/// let play = |y: &mut f64, x: &f64| { *y = y.clamp(x - 2.0, x + 2.0); Some(*y) };
/// let recording = Recording::new(input.clone(), input.iter().scan(20.0, play).collect())?;
/// let model = Fit::new().run(&recording)?;
/// let verdict = Verdict::of_fit(&model, &recording)?;
/// assert_eq!(verdict.grade, Grade::Good);
/// println!("{verdict}"); // verdict: good …
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// What the model is good for.
    pub grade: Grade,
    /// What its error was measured on.
    pub basis: Basis,
    /// The error of the output, in its unit.
    pub rmse: f64,
    /// The same in percent; `None` for an output that does not move.
    pub percent: Option<f64>,
    /// Standard deviation of the white noise of the readings, in the output's unit; zero where it
    /// is not known.
    pub noise: f64,
    /// Errors of the inverse while the output moves; `None` without an inverse, or where it was not
    /// tested.
    pub inverse: Option<Errors>,
    /// The best simple predictor and its error in percent; `None` where none was tried.
    pub rival: Option<(String, f64)>,
    /// Why the model is not better, the weightiest first.
    pub causes: Vec<Cause>,
    /// Where it errs most; `None` where no recording was looked at.
    pub worst: Option<Worst>,
    /// The input.
    pub input: Quantity,
    /// The output.
    pub output: Quantity,
}

/// Errors up to this, in percent, are good.
const GOOD: f64 = 1.0;
/// So are errors up to this many deviations of the noise: no model predicts that.
const OF_NOISE: f64 = 1.5;
/// Errors up to this, in percent, are usable.
const USABLE: f64 = 5.0;
/// A fit whose error on what it saw is so many times that on what was left out has a stage that was
/// not there when something was left out.
const BEYOND: f64 = 1.5;
/// The rival of an evaluation.
const LINE: &str = "a straight line fitted to this very recording";
/// The inverse of so many samples is tested. More would cost as much as some fits.
const TESTED: usize = 100_000;

impl Verdict {
    /// The verdict on a fit from its own record: without the inverse and without a worst sample.
    /// `None` for a model without such a record.
    #[must_use]
    pub fn of_record(model: &Model) -> Option<Self> {
        let mut verdict = Self::unjudged(model)?;
        verdict.judge();
        Some(verdict)
    }

    fn unjudged(model: &Model) -> Option<Self> {
        let fit = model.fit.as_ref()?;
        let (basis, rmse, percent, rival) = tested(fit);
        Some(Self {
            grade: Grade::Untested,
            basis,
            rmse,
            percent,
            noise: fit.confidence.as_ref().map_or(0.0, |found| found.sensor),
            inverse: None,
            causes: cause::of_record(fit, percent, rival.as_ref(), on_others(fit)),
            rival,
            worst: None,
            input: model.input.clone(),
            output: model.output.clone(),
        })
    }

    /// The verdict on a model that was fitted to `recordings`. A model without a record of its fit
    /// is judged as by [`Verdict::of_evaluation`].
    ///
    /// # Errors
    /// As [`crate::evaluate`].
    pub fn of_fit(model: &Model, recordings: &(impl AsRef<[Recording]> + ?Sized)) -> Result<Self> {
        let recordings = recordings.as_ref();
        let Some(mut verdict) = Self::unjudged(model) else {
            let evaluation = evaluate_from(model, recordings, Start::Fitted)?;
            return Self::of_evaluation(recordings, &evaluation);
        };
        let samples: usize = recordings.iter().map(Recording::len).sum();
        let first = recordings.first().ok_or_else(no_recordings)?;
        let shortened;
        let looked_at = match samples > TESTED {
            true => {
                shortened = first.part(0..TESTED.min(first.len()));
                std::slice::from_ref(&shortened)
            }
            false => recordings,
        };
        let evaluation = evaluate_from(model, looked_at, Start::Fitted)?;
        verdict.inverse = of_inverse(&evaluation);
        verdict.noise = verdict.noise.max(noise_of(looked_at));
        verdict.worst = worst(looked_at, &evaluation.output_model);
        verdict
            .causes
            .extend(cause::of_parts(looked_at, &evaluation.output_model, true));
        verdict.judge();
        Ok(verdict)
    }

    /// The verdict on a model that was evaluated on `recordings`. The rival is a straight line
    /// fitted to these recordings themselves, which favours it. An evaluation that kept no series
    /// ([`crate::evaluate_errors`]) tells neither the worst sample nor the parts of the error.
    ///
    /// # Errors
    /// [`crate::Error::Recording`] for an invalid recording, or none.
    pub fn of_evaluation(
        recordings: &(impl AsRef<[Recording]> + ?Sized),
        evaluation: &Evaluation,
    ) -> Result<Self> {
        let run = (evaluation.forward, evaluation.was_fitted);
        let mut verdict = Self::of_run(recordings.as_ref(), &evaluation.output_model, run)?;
        verdict.causes.extend(cause::outside(evaluation));
        verdict.causes.extend(cause::elsewhere(evaluation));
        verdict.inverse = of_inverse(evaluation);
        verdict.judge();
        Ok(verdict)
    }

    /// As [`Verdict::of_evaluation`], without the inverse.
    ///
    /// # Errors
    /// [`crate::Error::Recording`] for an invalid recording, or none.
    pub fn of_forward(
        recordings: &(impl AsRef<[Recording]> + ?Sized),
        forward: &Forward,
    ) -> Result<Self> {
        let run = (forward.errors, forward.was_fitted);
        let mut verdict = Self::of_run(recordings.as_ref(), &forward.output_model, run)?;
        verdict.judge();
        Ok(verdict)
    }

    /// What the outputs of a model over recordings say; not judged yet.
    fn of_run(
        recordings: &[Recording],
        output: &[f64],
        (errors, was_fitted): (Errors, bool),
    ) -> Result<Self> {
        let first = recordings.first().ok_or_else(no_recordings)?;
        let line = Rival::fit(RivalKind::Line, recordings)?;
        let each = recordings.iter().map(|recording| line.predict(recording));
        let predicted = each.collect::<Result<Vec<_>>>()?.concat();
        let measured = recordings.iter().flat_map(|recording| &recording.output);
        let measured: Vec<f64> = measured.copied().collect();
        let line = Errors::between(&measured, &predicted, |_| true);
        let line = line.and_then(|errors| errors.nrmse_percent);
        Ok(Self {
            grade: Grade::Untested,
            basis: match was_fitted {
                true => Basis::Fitted,
                false => Basis::OtherRecording,
            },
            rmse: errors.rmse,
            percent: errors.nrmse_percent,
            noise: noise_of(recordings),
            inverse: None,
            rival: line.map(|percent| (LINE.to_owned(), percent)),
            causes: cause::of_parts(recordings, output, was_fitted),
            worst: worst(recordings, output),
            input: first.input_quantity.clone(),
            output: first.output_quantity.clone(),
        })
    }

    /// Finds the grade and puts the causes in order.
    fn judge(&mut self) {
        // Of an output that does not move, any error is too much.
        let percent = self.percent.unwrap_or(match self.rmse > 0.0 {
            true => f64::INFINITY,
            false => 0.0,
        });
        let by_error = match percent {
            _ if self.rmse <= OF_NOISE * self.noise && percent <= USABLE => Grade::Good,
            p if p <= GOOD => Grade::Good,
            p if p <= USABLE => Grade::Usable,
            _ => Grade::Poor,
        };
        let rival = self.rival.as_ref();
        let rival_wins = rival.is_some_and(|(_, rival)| *rival < percent);
        let outside = self
            .causes
            .iter()
            .any(|cause| matches!(cause, Cause::Outside { share } if *share > cause::OUTSIDE));
        let few = self.causes.iter().any(|cause| {
            matches!(cause, Cause::FewBranches { branches } if *branches <= cause::TWO_LOOPS)
        });
        self.grade = match (by_error, rival_wins) {
            _ if outside => Grade::Poor,
            (Grade::Good, _) if few => Grade::Usable,
            (Grade::Good, true) => Grade::Usable,
            (Grade::Usable, true) => Grade::Poor,
            (grade, _) => grade,
        };
        // A good fit is a promise only where something was left out; a bad one needs no test.
        if self.basis == Basis::Fitted && self.grade != Grade::Poor {
            self.grade = Grade::Untested;
        }
        self.causes.extend(cause::of_noise(self.noise, self.rmse));
        self.causes
            .sort_by(|a, b| b.weight().total_cmp(&a.weight()));
    }
}

/// The errors of the inverse while the output moves.
fn of_inverse(evaluation: &Evaluation) -> Option<Errors> {
    evaluation.inverse.as_ref().ok()?.hold.moving
}

/// Where the outputs of a model over recordings err most.
fn worst(recordings: &[Recording], modelled: &[f64]) -> Option<Worst> {
    let each = recordings.iter().enumerate();
    let samples = each.flat_map(|(n, recording)| {
        let measured = recording.output.iter().enumerate();
        measured.map(move |(sample, y)| (n, sample, *y))
    });
    let errors = samples.zip(modelled);
    let errors =
        errors.map(|((n, sample, y), modelled)| ((y - modelled).abs(), n, sample, modelled));
    let (_, number, sample, &modelled) = errors.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let recording = &recordings[number];
    Some(Worst {
        recording: number,
        sample,
        place: recording.place(sample),
        time: recording.time.as_ref().map(|time| time[sample]),
        input: recording.input[sample],
        measured: recording.output[sample],
        modelled,
    })
}

/// Whether the fit was tested on another recording, and not on a part of one that it saw.
fn on_others(fit: &FitSummary) -> bool {
    fit.other.contains_key("hold_out") && !fit.other.contains_key(PART)
}

/// What the fit was tested on, its error there and that of the best rival.
fn tested(fit: &FitSummary) -> (Basis, f64, Option<f64>, Option<(String, f64)>) {
    let best =
        |rivals: &mut dyn Iterator<Item = (String, f64)>| rivals.min_by(|a, b| a.1.total_cmp(&b.1));
    if let Some(held_out) = fit.other.get("hold_out").and_then(HeldOut::from_record) {
        let mut rivals = held_out
            .rivals
            .iter()
            .filter_map(|rival| Some((rival.name.to_owned(), rival.errors.nrmse_percent?)));
        let model = held_out.model;
        return (
            Basis::HeldOut,
            model.rmse,
            model.nrmse_percent,
            best(&mut rivals),
        );
    }
    match &fit.validation {
        Some(found) if found.criterion == Criterion::LeftOut && fit.rmse <= BEYOND * found.rmse => {
            let rivals = found.rivals.iter();
            let mut rivals = rivals.map(|rival| (rival.name.clone(), rival.nrmse_percent));
            let basis = match found.whole_branches {
                true => Basis::BranchesLeftOut,
                false => Basis::PartsLeftOut,
            };
            (
                basis,
                found.rmse,
                Some(found.nrmse_percent),
                best(&mut rivals),
            )
        }
        _ => (Basis::Fitted, fit.rmse, Some(fit.nrmse_percent), None),
    }
}

/// The white noise of the readings, as a root mean square over recordings.
fn noise_of(recordings: &[Recording]) -> f64 {
    let each = recordings
        .iter()
        .map(|r| (r.len() as f64, noise(&r.output)));
    let (samples, squares) = each.fold((0.0, 0.0), |(n, sum), (len, noise)| {
        (n + len, sum + len * noise * noise)
    });
    (squares / f64::max(samples, 1.0)).sqrt()
}
