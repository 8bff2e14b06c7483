//! What is behind an error.

use super::grade::USABLE;
use super::parts::{ErrorPart, PartKind, parts_after};
use super::tested::BEYOND;
use crate::error::Result;
use crate::evaluate::{Evaluation, OTHER_START};
use crate::forward::forward;
use crate::hold_out::HeldOut;
use crate::identify::kept::{DIFFERENT, UNDONE_LAG, speed_fitted};
use crate::model::{FitSummary, Model, Start};
use crate::recording::{ONE, Recording, one_speed};
use crate::series::clipped::clipped;
use crate::series::lost::held_between_readings;
use crate::series::{Errors, different_branches, mean_and_deviation, usual_tolerance};

/// Why a model is not better.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Cause {
    /// Rows are not to be believed ([`crate::doubts`]). No other reason counts before they are
    /// mended.
    Doubted {
        /// The number of doubts.
        doubts: usize,
    },
    /// Inputs are outside the plane.
    Outside {
        /// Their share of all inputs, from 0 to 1.
        share: f64,
    },
    /// A few numbers explain much of the error.
    Part(ErrorPart),
    /// Much of the error is in readings that stand out from their neighbours, or were held.
    Readings {
        /// Their share of the squared error, from 0 to 1.
        share: f64,
        /// Their number.
        samples: usize,
        /// Number of these samples that [`crate::prepare`] would replace.
        replaced: usize,
    },
    /// The output keeps one value at an end of its range while the input goes on: its sensor may
    /// end there, or a stop.
    Clipped {
        /// The value.
        value: f64,
        /// How often it came there.
        times: usize,
        /// The number of such readings.
        samples: usize,
    },
    /// The input is held between readings of its sensor, while the output goes on.
    HeldInput {
        /// For so many samples.
        samples: usize,
    },
    /// The model's band, which should hold 95 % of the samples, holds much less of them.
    Elsewhere {
        /// What it holds, in percent.
        coverage: f64,
        /// Number of sessions that the band knows.
        sessions: usize,
    },
    /// The output hardly follows the input: what a model says of it is little more than its mean.
    Unrelated {
        /// The share of the output's squared deviations that the model explains, from 0 to 1.
        share: f64,
    },
    /// A simple predictor errs less.
    Rival {
        /// Its name.
        name: String,
        /// Its error, in percent.
        percent: f64,
    },
    /// The error is that of the readings.
    Noise {
        /// Standard deviation of the noise, in the output's unit.
        noise: f64,
    },
    /// The recording has few branches, or few that are unlike each other, so that many weights come
    /// from the prior.
    FewBranches {
        /// Their number.
        branches: usize,
        /// The number of those that are unlike each other.
        different: usize,
    },
    /// The input stands at few points, so that many weights come from the prior.
    FewPoints {
        /// Their number.
        points: usize,
    },
    /// What comes late was found where the input had one speed, so that a lag could not be told
    /// from a wider loop.
    OneSpeed {
        /// The speed, per second.
        speed: f64,
    },
    /// The model was fitted where the input had one speed, and this one has others.
    OtherSpeed {
        /// The speed, per second.
        speed: f64,
        /// Whether the model has what comes late. Without it, what another speed changes looks like
        /// a gain or a shift.
        late: bool,
    },
    /// The actuator was not where the model begins: from another start it errs much less.
    OtherStart {
        /// That start.
        start: Start,
        /// The error from there, in percent.
        percent: f64,
        /// The share of the squared error that it explains, from 0 to 1.
        share: f64,
    },
    /// The model was fitted to inputs in which the lag of the sensor was undone, and here it is
    /// not.
    LagLeft {
        /// Its time constant, s.
        tau: f64,
    },
    /// The model errs much more on what it was fitted to than on what was held out.
    Easier {
        /// The error on what was fitted, in percent.
        percent: f64,
    },
    /// Loads that were left out are predicted badly, so others may be as well.
    LoadsLeftOut {
        /// The error there, in percent of the range of the output at such a load.
        percent: f64,
    },
    /// The model cannot follow what is more than noise.
    Misfit {
        /// The part of the error that is no noise, in the output's unit.
        misfit: f64,
        /// Standard deviation of the noise.
        noise: f64,
    },
}

/// More than this share of the inputs outside the plane, and the model is not for this recording.
pub(super) const OUTSIDE: f64 = 0.2;
/// A band that should hold 95 % and holds less than this, in percent, is of other recordings.
/// Branches held out of recordings with enough of them keep above 90 (docs/measured/coverage.md).
const BELONGS: f64 = 80.0;
/// A model that explains less than this of the squared deviations is of something else.
const FOLLOWED: f64 = 0.2;
/// A part of this share is worth a sentence.
pub(super) const WORTH: f64 = 0.25;
/// A delay of fewer samples is none.
const LATE: f64 = 0.05;
/// From this share of noise on, in the squared error, noise is what is behind it.
const NOISY: f64 = 0.5;
/// Fewer inputs outside the plane are the noise at its ends.
const SEEN: f64 = 0.01;
/// With fewer branches than this, one that is left out is often the only one of its kind, and its
/// error and band do not hold for another recording (docs/measured/coverage.md). Where many repeat
/// few, what is left out is a copy of what is not: models of one or two loops in turn erred 0.1 to
/// 0.6 % there, and 1.6 to 3.3 % on other paths.
const FEW: usize = 8;

/// With thirty points, the error on another recording was five times that on what was left out,
/// which stood at the same ones; with 120 it was the same.
const POINTS: usize = 60;

/// At eight places, visited over and over, the error on a staircase with others was four to thirty
/// times that on what was left out; from sixteen on it was at most twice.
const PLACES: usize = 15;

/// With so few that are unlike each other, at most two loops were seen, however often.
const TWO_LOOPS: usize = 4;

impl Cause {
    /// Their weights: what weighs less than these may go unsaid.
    pub(super) const NOISE: f64 = 0.2;
    pub(super) const MISFIT: f64 = 0.1;

    /// One word for it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Doubted { .. } => "doubted",
            Self::Outside { .. } => "outside",
            Self::Part(part) => match part.kind {
                PartKind::Offset => "offset",
                PartKind::Gain => "gain",
                PartKind::Shift => "shift",
                PartKind::Late => "late",
                PartKind::Drift => "drift",
            },
            Self::Readings { .. } => "readings",
            Self::Clipped { .. } => "clipped",
            Self::HeldInput { .. } => "held_input",
            Self::Elsewhere { .. } => "elsewhere",
            Self::Unrelated { .. } => "unrelated",
            Self::Rival { .. } => "rival",
            Self::Noise { .. } => "noise",
            Self::FewBranches { .. } => "few_branches",
            Self::FewPoints { .. } => "few_points",
            Self::OneSpeed { .. } => "one_speed",
            Self::OtherSpeed { .. } => "other_speed",
            Self::OtherStart { .. } => "other_start",
            Self::LagLeft { .. } => "lag_left",
            Self::Easier { .. } => "easier",
            Self::LoadsLeftOut { .. } => "loads_left_out",
            Self::Misfit { .. } => "misfit",
        }
    }

    /// The weightiest is told first, and its remedy is the next step.
    pub(super) fn weight(&self) -> f64 {
        match self {
            Self::Doubted { .. } => 4.0,
            Self::Outside { share } if *share > OUTSIDE => 3.0,
            Self::LagLeft { .. } => 2.5,
            Self::OtherSpeed { late: true, .. } => 2.2,
            // It asks whether these are input and output at all.
            Self::Unrelated { .. } => 2.1,
            // A part that explains nearly all of the error is not there by chance.
            Self::OtherSpeed { late: false, .. } => 1.95,
            Self::Readings { share, .. } => 1.0 + share,
            Self::Part(part) => 1.0 + part.share,
            Self::OtherStart { share, .. } => 1.0 + share,
            Self::Rival { .. } => 0.9,
            Self::Clipped { .. } | Self::HeldInput { .. } => 0.86,
            Self::Elsewhere { .. } => 0.85,
            Self::LoadsLeftOut { .. } => 0.82,
            Self::OneSpeed { .. } => 0.81,
            Self::FewBranches { .. } | Self::FewPoints { .. } => 0.8,
            Self::Easier { .. } => 0.4,
            Self::Outside { share } if *share > SEEN => 0.3,
            Self::Noise { .. } => Self::NOISE,
            Self::Misfit { .. } => Self::MISFIT,
            Self::Outside { .. } => 0.0,
        }
    }
}

/// What the record of a fit says.
pub(super) fn of_record(fit: &FitSummary, on_others: bool) -> Vec<Cause> {
    let loads = fit.other.get("load");
    let percent = loads.and_then(|found| found["left_out_percent"].as_f64());
    let loads = percent.filter(|percent| *percent > USABLE && !on_others);
    let loads = loads.map(|percent| Cause::LoadsLeftOut { percent });
    let few = few_fitted(fit).filter(|_| !on_others);
    let causes = loads.into_iter().chain(few);
    let easier = easier(fit).filter(|_| !on_others);
    causes.chain(easier).collect()
}

/// What was held out may be small loops, or a calm end: it is no proof of the rest.
fn easier(fit: &FitSummary) -> Option<Cause> {
    let held_out = HeldOut::from_record(fit.other.get("hold_out")?)?;
    let percent = fit.nrmse_percent;
    (fit.rmse > BEYOND * held_out.model.rmse).then_some(Cause::Easier { percent })
}

fn few_branches((branches, different): (usize, usize)) -> Cause {
    Cause::FewBranches {
        branches,
        different,
    }
}

/// How many branches a fit saw, and how many that are unlike each other, if it tells.
fn branches_of(fit: &FitSummary) -> Option<(usize, usize)> {
    let branches = fit.confidence.as_ref().map(|found| found.branches);
    let different = fit.other.get(DIFFERENT).and_then(serde_json::Value::as_u64);
    let different = different.map(|count| count as usize).or(branches)?;
    let branches = branches.unwrap_or(different);
    Some((branches, different))
}

/// A model of two loops at most, on recordings that have no more: they may be the same.
pub(super) fn few_loops(fit: &FitSummary, recordings: &[Recording]) -> Option<Cause> {
    let (branches, different) = branches_of(fit)?;
    let here = different_branches(recordings.iter().map(|one| &one.input[..]));
    (different.max(here) <= TWO_LOOPS).then_some(few_branches((branches, different)))
}

/// A model of few branches, on recordings that it errs on.
pub(super) fn few_fitted(fit: &FitSummary) -> Option<Cause> {
    let few = branches_of(fit).filter(|(_, different)| *different < FEW);
    few.map(few_branches)
}

/// Recordings whose output has little to do with what a model says, whatever its offset and gain.
/// `rmse` is the error on what was not fitted, of a model that was fitted to them.
pub(super) fn unrelated(
    recordings: &[Recording],
    modelled: &[f64],
    rmse: Option<f64>,
) -> Option<Cause> {
    let measured = || recordings.iter().flat_map(|one| &one.output).copied();
    if measured().count() != modelled.len() {
        return None;
    }
    let (_, deviation) = mean_and_deviation(&measured().collect::<Vec<_>>());
    let explained = correlation(measured(), modelled)?.powi(2);
    let predicted = rmse.map_or(1.0, |rmse| 1.0 - (rmse / deviation).powi(2));
    let share = explained.min(predicted).max(0.0);
    (share < FOLLOWED).then_some(Cause::Unrelated { share })
}

/// Of two series that move; `None` where one does not.
fn correlation(a: impl Iterator<Item = f64>, b: &[f64]) -> Option<f64> {
    let a: Vec<f64> = a.collect();
    let ((a_mean, a_deviation), (b_mean, b_deviation)) =
        (mean_and_deviation(&a), mean_and_deviation(b));
    let together = a.iter().zip(b).map(|(a, b)| (a - a_mean) * (b - b_mean));
    let found = together.sum::<f64>() / (a.len() as f64 * a_deviation * b_deviation);
    found.is_finite().then_some(found)
}

/// Recordings that were fitted and stand at few points, or at the same ones over and over.
pub(super) fn few_points(recordings: &[Recording]) -> Option<Cause> {
    let mut all = Vec::new();
    for recording in recordings {
        all.extend(places(&recording.input));
    }
    let moves = all.len();
    all.sort_unstable_by(f64::total_cmp);
    let different = places(&all).count();
    let points = match different < PLACES {
        true => different,
        false => moves,
    };
    (moves < POINTS || different < PLACES).then_some(Cause::FewPoints { points })
}

/// The places that a series moves on to, by more than it trembles.
fn places(values: &[f64]) -> impl Iterator<Item = f64> {
    let tolerance = usual_tolerance(values);
    let mut last = f64::INFINITY;
    values.iter().copied().filter(move |value| {
        let moves = (value - last).abs() > tolerance;
        if moves {
            last = *value;
        }
        moves
    })
}

/// Recordings whose output is cut off; the one with most such readings tells.
pub(super) fn cut_off(recordings: &[Recording]) -> Option<Cause> {
    let found = recordings.iter();
    let found = found.filter_map(|recording| clipped(&recording.input, &recording.output));
    let most = found.max_by_key(|found| found.samples)?;
    Some(Cause::Clipped {
        value: most.value,
        times: most.times,
        samples: most.samples,
    })
}

/// Recordings whose input is held; the one that holds it longest tells.
pub(super) fn held_input(recordings: &[Recording]) -> Option<Cause> {
    let held = recordings.iter();
    let held = held.filter_map(|one| held_between_readings(&one.input, &one.output));
    held.max().map(|samples| Cause::HeldInput { samples })
}

/// What the recordings of an evaluation have not in common with those that were fitted.
pub(super) fn other_circumstances(model: &Model, recordings: &[Recording]) -> Vec<Cause> {
    let Some(fit) = &model.fit else {
        return Vec::new();
    };
    let undone = fit
        .other
        .get(UNDONE_LAG)
        .and_then(|found| found["tau"].as_f64());
    let left = recordings
        .iter()
        .all(|recording| recording.undone.is_none());
    let left = undone.filter(|_| left).map(|tau| Cause::LagLeft { tau });
    let here = one_speed(recordings);
    let late = comes_late(model);
    // Of few branches the speed is not known; what is late was a guess then, too.
    let is_other =
        |speed: &f64| here.map_or(late, |here| here.max(*speed) >= ONE * here.min(*speed));
    let timed = recordings.iter().all(|recording| recording.time.is_some());
    let speed = speed_fitted(fit).filter(is_other).filter(|_| timed);
    let speed = speed.map(|speed| Cause::OtherSpeed { speed, late });
    left.into_iter().chain(speed).collect()
}

/// The start from which a model errs least on recordings, if that is much less than it erred.
///
/// # Errors
/// As [`forward`].
pub(super) fn other_start(
    model: &Model,
    recordings: &[Recording],
    errors: &Errors,
) -> Result<Option<Cause>> {
    let mut least = (errors.rmse / OTHER_START, None);
    for start in [Start::Fitted, Start::Off, Start::On, Start::Rest] {
        let found = forward(model, recordings, start)?.errors;
        let percent = found.nrmse_percent.filter(|_| found.rmse < least.0);
        if let Some(percent) = percent {
            let share = 1.0 - (found.rmse / errors.rmse).powi(2);
            let cause = Cause::OtherStart {
                start,
                percent,
                share,
            };
            least = (found.rmse, Some(cause));
        }
    }
    Ok(least.1)
}

/// Whether a model has what at one speed is not told from a wider loop.
pub(super) fn comes_late(model: &Model) -> bool {
    let guessed = || {
        let fit = model.fit.as_ref()?;
        fit.other.get(UNDONE_LAG)?["estimated"].as_bool()
    };
    model.is_timed() || !model.delay().is_none() || guessed().unwrap_or(false)
}

/// The inputs of an evaluation that the model does not know.
pub(super) fn outside(evaluation: &Evaluation) -> Option<Cause> {
    let samples = evaluation.forward.samples.max(1);
    let share = evaluation.clipped as f64 / samples as f64;
    (share > 0.0).then_some(Cause::Outside { share })
}

/// A recording that the model's band does not hold: the band is not for it.
pub(super) fn elsewhere(evaluation: &Evaluation) -> Option<Cause> {
    let band = evaluation.band.as_ref()?;
    (band.coverage_percent < BELONGS).then_some(Cause::Elsewhere {
        coverage: band.coverage_percent,
        sessions: band.sessions,
    })
}

/// Noise, or what the model cannot follow, whichever is more of an error `rmse`; `None` where the
/// noise is not known.
pub(super) fn of_noise(noise: f64, rmse: f64) -> Option<Cause> {
    let misfit = (rmse * rmse - noise * noise).max(0.0).sqrt();
    (noise > 0.0).then_some(match noise * noise > NOISY * rmse * rmse {
        true => Cause::Noise { noise },
        false => Cause::Misfit { misfit, noise },
    })
}

/// The parts that are worth a sentence. A fit has found offset, gain and shift already: they go
/// first, since the mean of a drift would pass for an offset.
pub(super) fn of_parts(recordings: &[Recording], modelled: &[f64], fitted: bool) -> Vec<Cause> {
    let found: &[PartKind] = match fitted {
        true => &[PartKind::Offset, PartKind::Gain, PartKind::Shift],
        false => &[],
    };
    let parts = parts_after(found, recordings, modelled).into_iter();
    let is_some = |part: &ErrorPart| part.kind != PartKind::Late || part.size.abs() >= LATE;
    let parts = parts.filter(is_some);
    let worth = parts.filter(|part| part.share >= WORTH && !found.contains(&part.kind));
    worth.map(Cause::Part).collect()
}
