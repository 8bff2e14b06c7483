//! Places the levels where the output moves.

use crate::identify::stages::{on_grid, with_inputs};
use crate::model::Plane;
use crate::recording::Recording;

/// Share of the levels that are at equal distances. Without them, a stretch of the input where the
/// output rests would have no level, and the output could not move there in another recording.
const EVEN: f64 = 0.3;

/// The input axis is divided into this many bins for each level.
const BINS: usize = 50;

/// The `K + 1` corners of the grid, ascending, from the bottom of the plane to its top: quantiles of
/// the path of the output over the input, mixed with equal distances.
pub(super) fn corners(recordings: &[Recording], plane: &Plane) -> Vec<f64> {
    let levels = plane.levels();
    let bins = BINS * levels;
    let (low, high) = (plane.bottom(), plane.max());
    let width = (high - low) / bins as f64;
    let mut path = vec![0.0; bins];
    for recording in recordings {
        let pairs = recording.input.windows(2).zip(recording.output.windows(2));
        for (x, y) in pairs {
            spread(
                &mut path,
                [x[0], x[1]].map(|x| (x - low) / width),
                (y[1] - y[0]).abs(),
            );
        }
    }
    let total: f64 = path.iter().sum();
    let even = 1.0 / bins as f64;
    let share = |path: f64| match total > 0.0 {
        true => EVEN * even + (1.0 - EVEN) * path / total,
        false => even,
    };
    let mut corners = vec![low];
    let mut sum = 0.0;
    for (bin, path) in path.into_iter().enumerate() {
        let next = sum + share(path);
        // Every level within the bin.
        while corners.len() < levels {
            let wanted = corners.len() as f64 / levels as f64;
            if wanted > next {
                break;
            }
            corners.push(low + width * (bin as f64 + (wanted - sum) / (next - sum)));
        }
        sum = next;
    }
    corners.resize(levels, high);
    corners.push(high);
    corners
}

/// Adds `amount` to the bins between two positions, evenly.
fn spread(bins: &mut [f64], [a, b]: [f64; 2], amount: f64) {
    let last = bins.len() as f64;
    let (from, to) = (a.min(b).clamp(0.0, last), a.max(b).clamp(0.0, last));
    let (first, end) = (from as usize, (to.ceil() as usize).min(bins.len()));
    if to - from < 1e-9 {
        if let Some(bin) = bins.get_mut(first) {
            *bin += amount;
        }
        return;
    }
    for (n, bin) in bins.iter_mut().enumerate().take(end).skip(first) {
        let inside = to.min(n as f64 + 1.0) - from.max(n as f64);
        *bin += amount * inside.max(0.0) / (to - from);
    }
}

/// The recordings on the uniform grid of the plane.
pub(super) fn behind(corners: &[f64], plane: &Plane, recordings: &[Recording]) -> Vec<Recording> {
    with_inputs(recordings, |recording| on_grid(corners, plane, recording))
}
