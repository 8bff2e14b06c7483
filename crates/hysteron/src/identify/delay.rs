//! Finds the dead time of an actuator: the shift by whole samples with which the operators predict
//! best what was left out.
//!
//! Slow inputs do not tell a dead time from a lag of the same length, and either predicts the same.
//! A shift that is still better at the longest one tried is taken for a lag, and left to it. A
//! shift counts only if the output goes on for so long after its input has turned.

use crate::error::{Error, Result};
use crate::identify::options::FitOptions;
use crate::identify::stages::blocks::{BLOCKS, SMOOTH, WORTH, blocks};
use crate::identify::weights::problem::Problem;
use crate::model::{Delay, Sign};
use crate::progress::Progress;
use crate::recording::{Recording, gaps};
use crate::series::{Turning, mean_and_deviation, usual_tolerance};

/// Shifts tried, in samples, up to this one.
const LONGEST: usize = 8;

/// Where the longest is the best, these are tried until they are worse, and then those between.
const FURTHER: [usize; 6] = [12, 16, 24, 32, 48, 64];

/// Levels of the models that compare shifts: enough to resolve a loop, and few enough to fit
/// eighteen models.
const LEVELS: usize = 12;

/// So many reversals at least tell whether the output goes on after them, and so many standard
/// errors are no chance.
const REVERSALS: usize = 3;
const CHANCE: f64 = 3.0;

/// Samples of each recording that are looked at.
const LOOKED_AT: usize = 20_000;

/// Samples stand at equal distances where so many of the steps are within a tenth of the median.
const EVEN: f64 = 0.95;
const NEAR: f64 = 0.1;

/// The interval of the first recording, s; `None` where its samples do not stand at equal
/// distances.
pub(super) fn interval(recordings: &[Recording]) -> Option<f64> {
    let time = recordings.first()?.time.as_deref()?;
    let (median, _) = gaps(time)?;
    let steps = time.windows(2).map(|pair| pair[1] - pair[0]);
    let near = steps.filter(|step| (step - median).abs() <= NEAR * median);
    let even = near.count() as f64 >= EVEN * (time.len() - 1) as f64;
    (even && median > 0.0).then_some(median)
}

/// The delay that was asked for.
///
/// # Errors
/// [`Error::Fit`] where the samples are of no interval, and as [`Delay::new`].
pub(super) fn fixed(samples: usize, recordings: &[Recording]) -> Result<Delay> {
    match (samples, interval(recordings)) {
        (0, _) => Ok(Delay::NONE),
        (_, Some(interval)) => Delay::new(samples, interval),
        (_, None) => Err(Error::Fit(
            "a delay is in samples of an interval: it needs time, with samples at equal distances"
                .into(),
        )),
    }
}

/// The delay with which the operators predict parts of the recordings that were left out clearly
/// better than without; none where the recordings have no time or a load.
pub(super) fn find(
    recordings: &[Recording],
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<Delay> {
    let Some(interval) = interval(recordings) else {
        return Ok(Delay::NONE);
    };
    let shortest = recordings.iter().map(Recording::len).min().unwrap_or(0);
    let is_enough = |shift: usize| shortest > 2 * BLOCKS * shift;
    let loaded = recordings.iter().any(|recording| recording.load.is_some());
    if loaded || !is_enough(LONGEST) {
        return Ok(Delay::NONE);
    }
    let beginning = |recording: &Recording| recording.part(0..recording.len().min(LOOKED_AT));
    let looked_at: Vec<Recording> = recordings.iter().map(beginning).collect();
    let with_levels = |levels| FitOptions {
        levels,
        smooth: options.smooth.at_least(SMOOTH),
        bootstrap: 0,
        ..options.clone()
    };
    let mut from = LONGEST;
    let squares = |samples, options: &FitOptions, from| {
        progress.tell("delay", f64::NAN)?;
        let shifted = Delay::new(samples, interval)?.of_recordings(&looked_at);
        squares_left_out(&shifted, options, from, progress)
    };
    let coarse = with_levels(LEVELS);
    let error = |samples, from| Ok::<_, Error>((samples, squares(samples, &coarse, from)?.0));
    let tried = (0..=LONGEST).map(|samples| error(samples, from));
    let mut tried = tried.collect::<Result<Vec<_>>>()?;
    if best_of(&tried) == LONGEST && is_enough(FURTHER[FURTHER.len() - 1]) {
        from = FURTHER[FURTHER.len() - 1];
        tried = further(|samples| error(samples, from))?;
    }
    let less = |with: f64, without: f64| with < (1.0 - WORTH).powi(2) * without;
    let best = best_of(&tried);
    let of = |shift: usize| tried.iter().find(|(samples, _)| *samples == shift);
    let [at_once, late] = [of(0), of(best)].map(|found| found.map_or(f64::INFINITY, |(_, e)| *e));
    let is_longest = tried.iter().all(|(samples, _)| *samples <= best);
    if is_longest || !less(late, at_once) {
        return Ok(Delay::NONE);
    }
    let sign = squares(best, &coarse, from)?.1;
    if !goes_on(&looked_at, sign, best) {
        return Ok(Delay::NONE);
    }
    // What a finer grid resolves is a loop, not a dead time.
    let fine = with_levels(options.levels.max(LEVELS));
    match less(squares(best, &fine, from)?.0, squares(0, &fine, from)?.0) {
        true => Delay::new(best, interval),
        false => Ok(Delay::NONE),
    }
}

/// The shift with the least error.
fn best_of(tried: &[(usize, f64)]) -> usize {
    let best = tried.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    best.map_or(0, |(samples, _)| *samples)
}

/// Tries longer shifts until they are worse, and then halves the distances beside the best. No shift
/// is with them.
fn further(error: impl Fn(usize) -> Result<(usize, f64)>) -> Result<Vec<(usize, f64)>> {
    let mut tried = vec![error(0)?, error(LONGEST)?];
    for samples in FURTHER {
        tried.push(error(samples)?);
        if best_of(&tried) != samples {
            break;
        }
    }
    let longest = tried[tried.len() - 1].0;
    let steps = std::iter::successors(Some(longest / 4), |step| Some(step / 2));
    for step in steps.take_while(|step| *step > 0) {
        let best = best_of(&tried);
        for samples in [best - step.min(best), best + step] {
            if samples < longest && tried.iter().all(|(known, _)| *known != samples) {
                tried.push(error(samples)?);
            }
        }
    }
    Ok(tried)
}

/// Whether the output goes on for so many `samples` after its input has turned, on the mean over
/// all reversals and beyond chance. Hysteresis alone turns the output at once, or holds it. So this
/// tells a dead time from a loop that is as much wider, which at one rate predicts the same.
fn goes_on(recordings: &[Recording], sign: Sign, samples: usize) -> bool {
    let mut ways = Vec::new();
    for Recording { input, output, .. } in recordings {
        let mut turning = Turning::new(usual_tolerance(input));
        let turns = input.iter().filter_map(|&x| turning.push(x));
        let mut last = 0;
        for (turn, _) in turns {
            let rises = (input[turn] - input[last]).signum() * sign.factor();
            last = turn;
            if let Some(after) = output.get(turn + samples) {
                ways.push(rises * (after - output[turn]));
            }
        }
    }
    let (mean, deviation) = mean_and_deviation(&ways);
    ways.len() >= REVERSALS && mean > CHANCE * deviation / (ways.len() as f64).sqrt()
}

/// Sum of the squared errors over the blocks left out, and the sign of the output. The samples before
/// the one numbered `from` do not count: the longest shift does not know them.
fn squares_left_out(
    recordings: &[Recording],
    options: &FitOptions,
    from: usize,
    progress: Progress<'_>,
) -> Result<(f64, Sign)> {
    let mut problem = Problem::new(recordings, options)?;
    let places: Vec<(usize, usize)> = recordings
        .iter()
        .flat_map(|one| blocks(one, BLOCKS).enumerate())
        .collect();
    let (mut squares, mut sign) = (0.0, Sign::Positive);
    for parity in 0..2 {
        let kept = places
            .iter()
            .map(|(_, block)| f64::from(block % 2 != parity));
        let kept: Vec<f64> = kept.collect();
        let fitted = problem.solve(Some(&kept), progress)?;
        sign = fitted.sign;
        let modelled = problem.predict(&fitted.solution)?;
        for (sample, h) in modelled.into_iter().enumerate() {
            if kept[sample] == 0.0 && places[sample].0 >= from {
                squares += (problem.target(fitted.sign, sample) - h).powi(2);
            }
        }
    }
    Ok((squares, sign))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::identify::{Fit, Spacing};
    use crate::model::Model;
    use hysteron_core::{Operator, Plane};

    /// Swings of another size each time, and what a model answers `late` samples later. A slow swing
    /// does not tell a short dead time, and a quick one has turned again after a long one.
    fn recorded(late: usize, noise: f64) -> Recording {
        let plane = Plane::new(0.0, 100.0, 15).unwrap();
        let model = Model::new(Operator::Mkp, plane, vec![1.0; 120], 3.0, Sign::Negative).unwrap();
        let swing = |n: usize| {
            let phase = if late < LONGEST { 0.1 } else { 0.04 } * n as f64;
            50.0 - (50.0 - 0.012 * n as f64) * phase.cos()
        };
        let input: Vec<f64> = (0..3000).map(swing).collect();
        let interval = 0.004;
        let time = (0..3000).map(|n| interval * n as f64).collect();
        let delay = Delay::new(late, interval).unwrap();
        let mut output = model.simulate(&delay.acting(&input, None)).unwrap();
        for (n, y) in output.iter_mut().enumerate() {
            let turns = (n as f64 * 12.9898).sin() * 43758.5453;
            *y += noise * (turns - turns.floor() - 0.5);
        }
        Recording {
            time: Some(time),
            ..Recording::new(input, output).unwrap()
        }
    }

    #[test]
    fn a_known_delay_is_found_with_and_without_noise() {
        let lates = (0..LONGEST).chain([9, 13, 22, 41]);
        for (late, noise) in lates.flat_map(|late| [(late, 0.0), (late, 0.3)]) {
            let recording = [recorded(late, noise)];
            let found = find(&recording, &FitOptions::plain(), Progress::NONE).unwrap();
            assert_eq!(found.samples(), late, "noise {noise}");
        }
    }

    #[test]
    fn a_loop_finer_than_the_grid_is_no_delay() {
        // Triangles of one rate: a shift by n samples widens the loop by 2 n.
        let plane = Plane::new(0.0, 100.0, 150).unwrap();
        let near = |(i, j): (usize, usize)| f64::from(u8::from(j - i < 8));
        let weights = hysteron_core::operators(150).map(near).collect();
        let model = Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive).unwrap();
        let mut input = Vec::new();
        for size in (2..20).rev() {
            let top = 5 * size;
            input.extend((0..top).chain((1..=top).rev()).map(f64::from));
        }
        let output = model.simulate(&input).unwrap();
        let recording = Recording {
            time: Some((0..input.len()).map(|n| 0.01 * n as f64).collect()),
            ..Recording::new(input, output).unwrap()
        };
        let found = find(&[recording], &FitOptions::plain(), Progress::NONE).unwrap();
        assert!(found.is_none(), "{found:?}");
    }

    #[test]
    fn what_is_later_than_tried_is_no_delay() {
        let recording = [recorded(FURTHER[FURTHER.len() - 1] + 4, 0.0)];
        let found = find(&recording, &FitOptions::plain(), Progress::NONE).unwrap();
        assert!(found.is_none(), "{found:?}");
    }

    #[test]
    fn a_model_keeps_its_delay_and_predicts_with_it() {
        let recording = recorded(2, 0.0);
        let plain = || {
            Fit::new()
                .levels(15)
                .range(0.0, 100.0)
                .spacing(Spacing::Uniform)
                .smooth(0.0)
                .bootstrap(0)
        };
        let found = plain().run(&recording).unwrap();
        let told = plain().delay(2).run(&recording).unwrap();
        assert_eq!(
            found.delay(),
            Delay::new(2, found.delay().seconds() / 2.0).unwrap()
        );
        assert_eq!(found, told);
        let without = plain().delay(0).run(&recording).unwrap();
        let rmse = |model: &Model| crate::evaluate(model, &recording).unwrap().forward.rmse;
        // The model is as the plant, so only its ridge is left.
        assert!(rmse(&found) < 0.01 * rmse(&without));
        assert_eq!(rmse(&found), found.fit.as_ref().unwrap().rmse);
        assert_eq!(Model::from_json(&found.to_json()).unwrap(), found);
    }

    #[test]
    fn without_time_there_is_no_delay() {
        let mut recording = recorded(2, 0.0);
        recording.time = None;
        let model = Fit::new().levels(8).bootstrap(0).run(&recording).unwrap();
        assert!(model.delay().is_none());
        let refused = Fit::new().delay(2).run(&recording).unwrap_err();
        assert!(refused.to_string().contains("needs time"), "{refused}");
    }
}
