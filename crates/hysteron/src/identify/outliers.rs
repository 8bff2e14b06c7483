//! Outliers: readings that do not belong to the recording. One wrong reading would bend the whole
//! model.

use crate::error::Result;
use crate::identify::changed::few;
use crate::identify::neighbours::Neighbours;
use crate::identify::options::{FitOptions, LoadLaw, SOME_SMOOTHNESS};
use crate::identify::weights::experiment::Experiment;
use crate::identify::weights::problem::Problem;
use crate::model::{Model, Outlier};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::spikes::isolated;
use std::borrow::Cow;

/// Levels of the model that outliers are judged by: enough to follow a loop.
const LEVELS: usize = 20;

/// An outlier is this many deviations away from its neighbours. Of a million readings with Gaussian
/// noise, none is.
const DEVIATIONS: f64 = 6.0;

/// A smaller distance, as a share of the output's range, hardly moves a fit.
const SMALLEST: f64 = 0.01;

/// Each round uses a model that the outliers of the round before have not bent.
const ROUNDS: usize = 10;

/// Rounds end when outliers move by less than this share of the output's range.
const SETTLED: f64 = 1e-3;

/// The recordings with every outlier moved to where its neighbours say, and the outliers.
///
/// What a smooth model leaves of the output is compared from sample to sample. The misfit of a
/// model changes slowly along a recording, so a reading that stands out from those on both sides is
/// suspect (Hampel 1974). On a steep branch the misfit changes fast. So a reading that agrees with
/// its neighbours is none ([`Neighbours`]). An outlier loses its influence altogether, unlike with
/// weights that only fall with the distance (Huber 1964).
///
/// # Errors
/// As [`crate::Fit::run`].
pub(super) fn mended<'a>(
    recordings: &'a [Recording],
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<(Cow<'a, [Recording]>, Vec<Outlier>)> {
    let options = FitOptions {
        levels: LEVELS,
        smooth: options.smooth.at_least(SOME_SMOOTHNESS),
        load_law: LoadLaw::Weights,
        load_curves: None,
        load_degree: Some(0),
        bootstrap: 0,
        ..options.clone()
    };
    let all = recordings.iter().flat_map(|recording| &recording.output);
    let span = usual_span(all.copied().collect());
    let own = recordings.iter().map(|own| usual_span(own.output.clone()));
    let smallest: Vec<f64> = own.map(|span| SMALLEST * span).collect();
    let mut mended = Cow::Borrowed(recordings);
    let mut outliers: Vec<Outlier> = Vec::new();
    for _ in 0..ROUNDS {
        progress.tell("outliers", f64::NAN)?;
        let found = judged(recordings, &mended, &smallest, &options)?;
        let settled = found.len() == outliers.len()
            && found.iter().zip(&outliers).all(|(a, b)| {
                let moved = (a.by - b.by).abs();
                (a.recording, a.sample) == (b.recording, b.sample) && moved <= SETTLED * span
            });
        outliers = found;
        mended = moved(recordings, &outliers);
        if settled {
            break;
        }
    }
    Ok((mended, outliers))
}

/// The recordings with the outliers of a model's fit moved to where their neighbours say.
pub(super) fn mended_by<'a>(recordings: &'a [Recording], model: &Model) -> Cow<'a, [Recording]> {
    moved(
        recordings,
        model.fit.as_ref().map_or(&[], |fit| &fit.outliers),
    )
}

fn moved<'a>(recordings: &'a [Recording], outliers: &[Outlier]) -> Cow<'a, [Recording]> {
    let mut moved = Cow::Borrowed(recordings);
    for outlier in outliers {
        moved.to_mut()[outlier.recording].output[outlier.sample] -= outlier.by;
    }
    moved
}

/// A sample that is far from its neighbours, and how far.
type Far = (usize, f64);

/// The outliers of the recordings, judged by a model of the mended ones. `smallest` has the least
/// distance that counts in each.
fn judged(
    recordings: &[Recording],
    mended: &[Recording],
    smallest: &[f64],
    options: &FitOptions,
) -> Result<Vec<Outlier>> {
    let mut residuals = {
        let few = few(mended, mended);
        let mut problem = Problem::new(&few, options)?;
        let fitted = problem.solve(None, Progress::NONE)?;
        match few {
            Cow::Borrowed(_) => {
                let sign = fitted.sign.factor();
                let mut residual = fitted.solution.residual;
                residual.iter_mut().for_each(|r| *r *= sign);
                residual
            }
            Cow::Owned(_) => {
                let all = Experiment::new(mended, options)?;
                let mut left = problem.outputs_over(&all, &fitted)?;
                let pairs = left.iter_mut().zip(all.output.iter());
                pairs.for_each(|(h, y)| *h = y - *h);
                left
            }
        }
    };
    let mut found = Vec::new();
    let mut end = 0;
    for (recording, (own, mended)) in recordings.iter().zip(mended).enumerate() {
        let start = end;
        end += own.len();
        // The residual of a single recording is not copied.
        let mut residual = match recordings.len() {
            1 => std::mem::take(&mut residuals),
            _ => residuals[start..end].to_vec(),
        };
        let moved = own.output.iter().zip(&mended.output).map(|(y, m)| y - m);
        residual
            .iter_mut()
            .zip(moved)
            .for_each(|(r, moved)| *r += moved);
        let (far, residual) = isolated(residual, DEVIATIONS, smallest[recording]);
        let with = Neighbours::new(own, &far, smallest[recording]);
        let (agree, alone): (_, Vec<Far>) = far.into_iter().partition(|far| with.agree(far.0));
        let heights = heights(residual, agree, &alone);
        found.extend(alone.iter().zip(heights).map(|((sample, _), by)| Outlier {
            recording,
            sample: *sample,
            by,
        }));
    }
    Ok(found)
}

/// The heights of the readings that are `alone` above the line through the nearest others, among
/// which are those that `agree`. The `residual` is without the heights of both.
fn heights(mut residual: Vec<f64>, agree: Vec<Far>, alone: &[Far]) -> Vec<f64> {
    for (sample, height) in agree {
        residual[sample] += height;
    }
    let mut heights = Vec::with_capacity(alone.len());
    for run in alone.chunk_by(|a, b| a.0 + 1 == b.0) {
        let (first, end) = (run[0].0, run[0].0 + run.len());
        let after = residual.get(end).copied();
        let before = first.checked_sub(1).map(|n| residual[n]).or(after);
        let before = before.unwrap_or_default();
        let step = (after.unwrap_or(before) - before) / (run.len() + 1) as f64;
        let line = (1_u32..).map(|n| before + step * f64::from(n));
        let read = run.iter().map(|(n, height)| residual[*n] + height);
        heights.extend(read.zip(line).map(|(read, line)| read - line));
    }
    heights
}

/// The size of the range of the values without the hundredth that is largest and the hundredth that
/// is smallest, so that an outlier does not make the range.
fn usual_span(mut values: Vec<f64>) -> f64 {
    // What is wrong with an empty recording is told when it is fitted.
    let Some(last) = values.len().checked_sub(1) else {
        return 0.0;
    };
    let cut = (values.len() / 100).max(1).min(last / 2);
    let (_, &mut low, above) = values.select_nth_unstable_by(cut, f64::total_cmp);
    // The place of the other end among those above; with few values both ends are one.
    let high = match (last - cut).checked_sub(cut + 1) {
        Some(place) => *above.select_nth_unstable_by(place, f64::total_cmp).1,
        None => low,
    };
    high - low
}
