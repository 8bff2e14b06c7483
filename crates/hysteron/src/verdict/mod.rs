//! Whether a model is good enough, for what, why it is not better, and what to do next.
//!
//! This file makes a [`Verdict`] of a fit or of an evaluation. `grade` is what a model is good for,
//! and `judge` finds it. `tested` reads from the record of a fit what it was tested on; `parts`
//! tells what an error consists of, `tried` what a fit has looked for, `readings` which of it is in
//! readings that are wrong, `worst` where it is largest, and `cause` what is behind it. `words`
//! says all of it in sentences. `serial` writes it.

mod cause;
mod grade;
mod judge;
mod parts;
mod readings;
mod serial;
mod tested;
mod tried;
mod words;
mod worst;

pub use cause::Cause;
pub use grade::{Basis, Grade};
pub use parts::{ErrorPart, PartKind, error_parts};
pub use worst::Worst;

use crate::error::Result;
use crate::evaluate::{Evaluation, evaluate_from};
use crate::forward::{Forward, forward};
use crate::hold_out::held_out;
use crate::identify::kept::speed_fitted;
use crate::model::{Model, Start};
use crate::recording::{HoldOut, Quantity, Recording, no_recordings, one_speed};
use crate::rivals::{Rival, RivalKind, SMALL};
use crate::series::Errors;
use crate::series::coarse::noise_behind;
use crate::series::noise::noise;
use grade::{GOOD, OF_NOISE};
use std::borrow::Cow;
use tested::{Tested, best_of, on_others};
use tried::Tried;
use worst::{rmse_without, worst};

/// Whether a model is good enough, and if not, why.
///
/// Errors are in percent of the measured range of the output, of the input for the inverse.
///
/// ```
/// use hysteron::{Fit, Grade, Recording, Verdict};
/// let swing = |n: f64| 50.0 - (30.0 - 0.02 * n) * (n * 0.05).cos();
/// let input: Vec<f64> = (0..900).map(|n| swing(f64::from(n))).collect();
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
    /// Where it errs most; `None` where no recording was looked at. Readings that the fit took for
    /// outliers do not count.
    pub worst: Option<Worst>,
    /// Whether the recordings have a time.
    pub has_time: bool,
    /// Whether the recordings have a load.
    pub has_load: bool,
    /// The speed of the input per second, if all of the recordings was made at about the same.
    pub one_speed: Option<f64>,
    /// The input.
    pub input: Quantity,
    /// The output.
    pub output: Quantity,
    /// What a fit looked for by request, or has: it is no advice.
    tried: Tried,
}

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
        let Tested {
            basis,
            rmse,
            percent,
            rival,
        } = Tested::of(fit);
        Some(Self {
            grade: Grade::Untested,
            basis,
            rmse,
            percent,
            noise: fit.confidence.as_ref().map_or(0.0, |found| found.sensor),
            inverse: None,
            causes: cause::of_record(fit, on_others(fit)),
            rival,
            worst: None,
            has_time: false,
            has_load: model.load.is_some(),
            one_speed: None,
            input: model.input.clone(),
            output: model.output.clone(),
            tried: Tried::default(),
        })
    }

    /// The verdict on a model that was fitted to `recordings`. A model without a record of its fit
    /// is judged as by [`Verdict::of_evaluation`].
    ///
    /// # Errors
    /// As [`crate::evaluate`].
    pub fn of_fit(model: &Model, recordings: &(impl AsRef<[Recording]> + ?Sized)) -> Result<Self> {
        let looked_at = match model.fit {
            Some(_) => few(recordings.as_ref()),
            None => Cow::Borrowed(recordings.as_ref()),
        };
        let mut evaluation = evaluate_from(model, &looked_at, Start::Fitted)?;
        // A part of what was fitted was fitted.
        evaluation.was_fitted |= model.fit.is_some();
        Self::of_evaluation(model, &looked_at, &evaluation)
    }

    /// The verdict on a model that was fitted to `recordings` while `what` was held out, if
    /// anything was. Where other recordings are among it, these tell, and the rivals are those
    /// fitted to `recordings` ([`crate::held_out`]). Else as [`Verdict::of_fit`].
    ///
    /// # Errors
    /// As [`crate::evaluate`].
    pub fn of_fit_holding_out(
        model: &Model,
        recordings: &(impl AsRef<[Recording]> + ?Sized),
        what: Option<&HoldOut>,
    ) -> Result<Self> {
        let others = what.into_iter().flat_map(HoldOut::recordings);
        let others: Vec<Recording> = others.cloned().collect();
        if others.is_empty() {
            return Self::of_fit(model, recordings);
        }
        let run = forward(model, &others, Start::Fitted)?;
        let mut verdict = Self::of_run(model, &others, &run.output_model, (run.errors, false))?;
        verdict.rival = best_of(&held_out(model, recordings, &others)?.rivals);
        if let Some(worst) = &mut verdict.worst {
            let source = others[worst.recording].source.as_ref();
            worst.file = source.map(|source| source.path.display().to_string());
        }
        verdict.add(&evaluate_from(model, &few(&others), Start::Fitted)?);
        verdict.judge();
        Ok(verdict)
    }

    /// The verdict on a model that was evaluated on `recordings`. If it was fitted to them, what
    /// its fit was tested on tells. If not, the rival is a straight line fitted to these recordings
    /// themselves, which favours it; where they are what its fit held out, it is that of the fit.
    /// An evaluation that kept no series ([`crate::evaluate_errors`]) tells neither the worst
    /// sample nor the parts of the error.
    ///
    /// # Errors
    /// [`crate::Error::Recording`] for an invalid recording, or none.
    pub fn of_evaluation(
        model: &Model,
        recordings: &(impl AsRef<[Recording]> + ?Sized),
        evaluation: &Evaluation,
    ) -> Result<Self> {
        let run = (evaluation.forward, evaluation.was_fitted);
        let mut verdict = Self::of_run(model, recordings.as_ref(), &evaluation.output_model, run)?;
        verdict.add(evaluation);
        verdict.judge();
        Ok(verdict)
    }

    /// The same, where there are doubts about rows of what was fitted ([`crate::doubts`]): to mend
    /// them comes before all else.
    #[must_use]
    pub fn doubting(mut self, doubts: usize) -> Self {
        if doubts > 0 {
            self.causes.insert(0, Cause::Doubted { doubts });
        }
        self
    }

    /// What an evaluation says beside the outputs.
    fn add(&mut self, evaluation: &Evaluation) {
        self.causes.extend(cause::outside(evaluation));
        if !evaluation.was_fitted {
            self.causes.extend(cause::elsewhere(evaluation));
        }
        self.inverse = of_inverse(evaluation);
    }

    /// As [`Verdict::of_evaluation`], without the inverse.
    ///
    /// # Errors
    /// [`crate::Error::Recording`] for an invalid recording, or none.
    pub fn of_forward(
        model: &Model,
        recordings: &(impl AsRef<[Recording]> + ?Sized),
        forward: &Forward,
    ) -> Result<Self> {
        let run = (forward.errors, forward.was_fitted);
        let mut verdict = Self::of_run(model, recordings.as_ref(), &forward.output_model, run)?;
        verdict.judge();
        Ok(verdict)
    }

    /// What the outputs of a model over recordings say; not judged yet.
    fn of_run(
        model: &Model,
        recordings: &[Recording],
        output: &[f64],
        (errors, was_fitted): (Errors, bool),
    ) -> Result<Self> {
        let first = recordings.first().ok_or_else(no_recordings)?;
        let outliers = match (was_fitted, &model.fit) {
            (true, Some(fit)) => &fit.outliers[..],
            _ => &[],
        };
        // From another start the model errs by what its fit never saw.
        let rmse = rmse_without(recordings, output, outliers).unwrap_or(errors.rmse);
        let fitted = model.fit.as_ref().map_or(0.0, |fit| fit.rmse);
        let is_as_fitted = |record: &Self| rmse <= tested::BEYOND * record.rmse.max(fitted);
        let record = Self::unjudged(model).filter(|_| was_fitted);
        let fit = model.fit.as_ref();
        let rival = fit.and_then(|fit| tested::rival_here(fit, &errors));
        let mut verdict = match record.filter(is_as_fitted) {
            Some(record) => record,
            None => Self {
                grade: Grade::Untested,
                basis: match was_fitted {
                    true => Basis::Fitted,
                    false => Basis::OtherRecording,
                },
                rmse: errors.rmse,
                percent: errors.nrmse_percent,
                noise: 0.0,
                inverse: None,
                rival: match rival {
                    None => line(recordings)?,
                    rival => rival,
                },
                causes: Vec::new(),
                worst: None,
                has_time: false,
                has_load: false,
                one_speed: None,
                input: first.input_quantity.clone(),
                output: first.output_quantity.clone(),
                tried: Tried::default(),
            },
        };
        verdict.noise = noise_of(recordings, output);
        // A part of what was fitted may have one speed where all of it has several.
        verdict.one_speed = match fit.filter(|_| was_fitted) {
            Some(fit) => speed_fitted(fit),
            None => one_speed(recordings),
        };
        verdict.has_time = recordings.iter().all(|recording| recording.time.is_some());
        verdict.has_load = recordings.iter().all(|recording| recording.load.is_some());
        let percent = verdict.percent.unwrap_or(f64::INFINITY);
        if percent > GOOD {
            let rmse = Some(verdict.rmse).filter(|_| was_fitted);
            verdict
                .causes
                .extend(cause::unrelated(recordings, output, rmse));
        }
        if percent > SMALL {
            let parts = cause::of_parts(recordings, output, was_fitted);
            verdict.causes.extend(parts);
        }
        if percent > GOOD && !was_fitted {
            verdict
                .causes
                .extend(cause::other_start(model, recordings, &errors)?);
        }
        let at_one = verdict.one_speed.filter(|_| cause::comes_late(model));
        verdict.causes.extend(match was_fitted {
            true => at_one
                .map(|speed| Cause::OneSpeed { speed })
                .into_iter()
                .collect(),
            false if percent > GOOD => cause::other_circumstances(model, recordings),
            false => Vec::new(),
        });
        verdict.tried = Tried::by(model, recordings);
        if let Some(fit) = &model.fit {
            let is_noise = verdict.rmse <= OF_NOISE * verdict.noise;
            verdict.causes.extend(match was_fitted {
                true => cause::few_points(recordings),
                false if percent > GOOD && !is_noise => cause::few_fitted(fit),
                false => cause::few_loops(fit, recordings),
            });
        }
        if percent > GOOD {
            verdict.causes.extend(readings::cause(recordings, output));
        }
        if was_fitted || percent > GOOD {
            verdict.causes.extend(cause::cut_off(recordings));
            verdict.causes.extend(cause::held_input(recordings));
        }
        verdict.worst = worst(recordings, output, outliers);
        Ok(verdict)
    }
}

/// As many of the recordings as are evaluated beside a fit: all, or the beginning of the first.
fn few(recordings: &[Recording]) -> Cow<'_, [Recording]> {
    let samples: usize = recordings.iter().map(Recording::len).sum();
    match recordings.first() {
        Some(first) if samples > TESTED => vec![first.part(0..TESTED.min(first.len()))].into(),
        _ => recordings.into(),
    }
}

/// The errors of the inverse while the output moves.
fn of_inverse(evaluation: &Evaluation) -> Option<Errors> {
    evaluation.inverse.as_ref().ok()?.hold.moving
}

/// A straight line fitted to these recordings, and its error in percent.
fn line(recordings: &[Recording]) -> Result<Option<(String, f64)>> {
    let line = Rival::fit(RivalKind::Line, recordings)?;
    let each = recordings.iter().map(|recording| line.predict(recording));
    let predicted = each.collect::<Result<Vec<_>>>()?.concat();
    let measured = recordings.iter().flat_map(|recording| &recording.output);
    let measured: Vec<f64> = measured.copied().collect();
    let errors = Errors::between(&measured, &predicted, |_| true);
    let percent = errors.and_then(|errors| errors.nrmse_percent);
    Ok(percent.map(|percent| (LINE.to_owned(), percent)))
}

/// The white noise of the readings, as a root mean square over recordings; of one whose input jumps
/// nothing is known. Where few samples are on a stroke, the signal looks like noise; what is left
/// beside a model then tells more.
fn noise_of(recordings: &[Recording], modelled: &[f64]) -> f64 {
    let (mut samples, mut squares, mut first) = (0.0, 0.0, 0);
    for recording in recordings {
        let mut found = noise_behind(&recording.input, &recording.output);
        if let Some(modelled) = modelled.get(first..first + recording.len()) {
            let pairs = recording.output.iter().zip(modelled);
            let left: Vec<f64> = pairs.map(|(y, h)| y - h).collect();
            found = found.min(noise(&left));
        }
        first += recording.len();
        samples += recording.len() as f64;
        squares += recording.len() as f64 * found * found;
    }
    (squares / f64::max(samples, 1.0)).sqrt()
}
