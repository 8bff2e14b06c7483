//! Recordings with another input, or with fewer samples.

use crate::model::Plane;
use crate::recording::Recording;
use hysteron_core::{Axis, Direction, Loaded};

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
pub(super) fn thin(recording: Recording, stride: usize) -> Recording {
    let input = &recording.input;
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
    let every = |values: &Vec<f64>| kept.iter().map(|n| values[*n]).collect::<Vec<f64>>();
    Recording {
        time: recording.time.as_ref().map(every),
        output: every(&recording.output),
        load: recording.load.as_ref().map(every),
        input: every(&recording.input),
        ..recording
    }
}
