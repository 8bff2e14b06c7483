//! Recordings with another input, or with fewer samples.

use crate::model::Plane;
use crate::recording::Recording;
use crate::series::{branch_spans, usual_tolerance};
use hysteron_core::{Axis, Direction, Loaded};
use std::borrow::Cow;

/// The recordings with another input.
pub(super) fn with_inputs(
    recordings: &[Recording],
    input: impl Fn(&Recording) -> Vec<f64>,
) -> Vec<Recording> {
    let with = |recording: &Recording| Recording {
        input: input(recording),
        ..recording.clone()
    };
    recordings.iter().map(with).collect()
}

/// Where an input is on the uniform grid of the plane.
pub(super) fn on_grid<'a>(spacing: &'a [f64], plane: &'a Plane) -> impl Fn(f64) -> f64 + 'a {
    let axis = Axis {
        spacing,
        ..Axis::PLAIN
    };
    move |t| axis.forward(plane, Loaded::NONE, Direction::Rising, t)
}

/// Keeps of each run of `stride` samples the first one and those with extreme inputs. Without the
/// extremes the turning points would change, and with them the memory of the operators.
pub(super) fn thin(recording: &Recording, stride: usize) -> Recording {
    at(recording, &kept(&recording.input, stride))
}

/// The samples that [`thin`] keeps.
fn kept(input: &[f64], stride: usize) -> Vec<usize> {
    let starts = (0..input.len()).step_by(stride);
    let mut kept: Vec<usize> = starts
        .flat_map(|start| {
            let block = start..(start + stride).min(input.len());
            let by = |a: &usize, b: &usize| input[*a].total_cmp(&input[*b]);
            [block.clone().min_by(by), block.max_by(by), Some(start)]
        })
        .flatten()
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept
}

/// Some samples of a recording.
pub(super) fn at(recording: &Recording, kept: &[usize]) -> Recording {
    recording.picked(|series| kept.iter().map(|n| series[*n]).collect())
}

/// Choices see about so many samples of all recordings, up to three times as many: the extremes.
/// More of them tell candidates apart no better than their noise, and a pass over them takes
/// longer.
const ENOUGH: usize = 50_000;

/// The samples of a recording that choices need, where it has more.
pub(super) fn enough(recording: &Recording) -> Option<Vec<usize>> {
    let stride = recording.len().div_ceil(ENOUGH);
    (stride > 1).then(|| chosen(recording, stride))
}

/// The samples that [`thin`] keeps, and those with the least and the largest load: weights are
/// functions of the load between these, and a fit to some samples may predict all.
fn chosen(recording: &Recording, stride: usize) -> Vec<usize> {
    let mut samples = kept(&recording.input, stride);
    if let Some(load) = &recording.load {
        let by = |a: &usize, b: &usize| load[*a].total_cmp(&load[*b]);
        let all = || 0..load.len();
        samples.extend([all().min_by(by), all().max_by(by)].into_iter().flatten());
        samples.sort_unstable();
        samples.dedup();
    }
    samples
}

/// The recordings with as many samples as choices need: the same of each as are chosen of
/// the recording in its place in `like`.
pub(super) fn few<'a>(recordings: &'a [Recording], like: &[Recording]) -> Cow<'a, [Recording]> {
    let samples: usize = like.iter().map(Recording::len).sum();
    let stride = samples.div_ceil(ENOUGH);
    if stride <= 1 {
        return Cow::Borrowed(recordings);
    }
    let own = recordings.iter().zip(like);
    own.map(|(own, like)| at(own, &chosen(like, stride)))
        .collect()
}

/// A beginning whose input turns so often shows what happens in time.
const TURNS: usize = 20;

/// The recordings with as many samples as a search in time needs: the beginning of each, where its
/// input turns often enough, else as [`thin`] keeps.
pub(super) fn few_in_time(recordings: &[Recording]) -> Cow<'_, [Recording]> {
    let most = ENOUGH / recordings.len().max(1);
    if recordings.iter().all(|recording| recording.len() <= most) {
        return Cow::Borrowed(recordings);
    }
    let shortened = |recording: &Recording| {
        let beginning = recording.part(0..recording.len().min(most));
        let tolerance = usual_tolerance(&recording.input);
        match branch_spans(&beginning.input, tolerance).count() < TURNS {
            true => thin(recording, recording.len().div_ceil(most)),
            false => beginning,
        }
    };
    recordings.iter().map(shortened).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::series::range;

    #[test]
    fn a_search_in_time_sees_a_beginning_that_turns_or_the_whole_length() {
        let of = |samples: usize, rate: f64| {
            let input: Vec<f64> = (0..samples).map(|n| (n as f64 * rate).sin()).collect();
            let output = (0..samples).map(|n| n as f64).collect();
            Recording::new(input, output).unwrap()
        };
        assert!(matches!(few_in_time(&[of(ENOUGH, 0.1)]), Cow::Borrowed(_)));
        let quick = [of(3 * ENOUGH, 0.1)];
        let found = few_in_time(&quick);
        assert_eq!(found[0].output, quick[0].output[..ENOUGH]);
        let slow = [of(3 * ENOUGH, 1e-4)];
        let found = few_in_time(&slow);
        assert!((ENOUGH..=3 * ENOUGH).contains(&found[0].len()));
        assert!(range(&found[0].output).1 > 2.9 * ENOUGH as f64);
    }

    #[test]
    fn choices_see_the_extremes_of_long_recordings_and_all_of_short_ones() {
        let waves = |n: usize| (n as f64 * 0.37).sin() * (n as f64 * 0.001).cos();
        let of = |samples: usize| {
            let input: Vec<f64> = (0..samples).map(waves).collect();
            let output = (0..samples).map(|n| n as f64).collect();
            Recording::new(input, output).unwrap()
        };
        let short = [of(ENOUGH)];
        assert!(matches!(few(&short, &short), Cow::Borrowed(_)));
        let long = [of(4 * ENOUGH), of(3 * ENOUGH)];
        let found = few(&long, &long);
        let samples: usize = found.iter().map(Recording::len).sum();
        assert!((ENOUGH..=3 * ENOUGH).contains(&samples), "{samples}");
        for (few, all) in found.iter().zip(&long) {
            assert_eq!(range(&few.input), range(&all.input));
            assert_eq!(few.output[0], 0.0);
            // The output is the number of the sample: inputs and outputs stay together.
            let pairs = few.input.iter().zip(&few.output);
            assert!(pairs.into_iter().all(|(x, n)| *x == waves(*n as usize)));
        }
        // What stands beside the operators keeps the same samples.
        let other = long.clone().map(|own| Recording {
            input: own.output.clone(),
            ..own
        });
        for (few, other) in found.iter().zip(few(&other, &long).iter()) {
            assert_eq!(few.output, other.output);
        }
    }
}
