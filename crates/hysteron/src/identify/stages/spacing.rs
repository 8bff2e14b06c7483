//! Places the levels where the output moves.

use crate::error::Result;
use crate::identify::changed::{on_grid, with_inputs};
use crate::identify::choose::{Open, Seen};
use crate::identify::options::FitOptions;
use crate::identify::weights::experiment::plane_of_all;
use crate::identify::weights::problem::Problem;
use crate::identify::weights::sums::least_squares;
use crate::model::{Plane, Validation};
use crate::parallel;
use crate::progress::Progress;
use crate::recording::Recording;
use serde::Serialize;

/// Shares of the levels that are at equal distances. Without them, a stretch of the input where the
/// output rests would have no level, and the output could not move there in another recording.
const EVEN: [f64; 3] = [0.1, 0.3, 0.6];

/// The levels follow the path of the output to these powers.
const POWERS: [f64; 3] = [0.5, 0.7, 1.0];

/// The input axis is divided into this many bins for each level.
const BINS: usize = 50;

/// Other spacings have to be better than equal distances by this share: they make a model that
/// fewer tools understand.
const WORTH: f64 = 0.05;

/// How levels follow the path of the output.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SpacingShape {
    /// Share of the levels that are at equal distances.
    pub even: f64,
    /// The others follow the path of the output to this power.
    pub power: f64,
}

/// The shapes that are tried.
fn shapes() -> impl Iterator<Item = SpacingShape> {
    let of = |even| POWERS.map(|power| SpacingShape { even, power });
    EVEN.into_iter().flat_map(of)
}

/// The shape of a model's levels, by the recording that it was fitted to; `None` for equal
/// distances.
#[cfg(feature = "data")]
pub(crate) fn shape_of(model: &crate::model::Model, recording: &Recording) -> Option<SpacingShape> {
    if model.spacing().is_empty() {
        return None;
    }
    let plane = model.plane();
    let path = path(std::slice::from_ref(recording), plane);
    // Stages move the output a little, so the nearest one is it.
    let far = |shape: &SpacingShape| -> f64 {
        let corners = corners(&path, plane, *shape);
        let pairs = corners.iter().zip(model.spacing());
        pairs.map(|(a, b)| (a - b).abs()).sum()
    };
    shapes().min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// Levels that are not at equal distances.
pub(super) struct Spaced {
    /// The `K + 1` corners of the grid, ascending, from the bottom of the plane to its top.
    pub(super) corners: Vec<f64>,
    plane: Plane,
    /// The recordings of the choice on the uniform grid of the plane.
    pub(super) recordings: Vec<Recording>,
    /// The options, with the smoothness that is best with these levels.
    pub(super) options: FitOptions,
    pub(super) validation: Option<Validation>,
}

impl Spaced {
    /// Recordings on the uniform grid of the plane.
    pub(super) fn behind(&self, recordings: &[Recording]) -> Vec<Recording> {
        behind(&self.corners, &self.plane, recordings)
    }
}

/// Finds the corners that fit the recordings best. `None` if equal distances fit as well. Where
/// levels or smoothness were chosen (`chosen`), the same criterion decides. A `shape` that was
/// chosen before is taken.
pub(super) fn find(
    seen: Seen<'_>,
    options: &FitOptions,
    (open, chosen): (Open, &Option<Validation>),
    shape: Option<SpacingShape>,
    progress: Progress<'_>,
) -> Result<Option<Spaced>> {
    let recordings = seen.operators;
    let plane = plane_of_all(recordings, options)?;
    let mut options = FitOptions {
        range: Some((plane.min(), plane.max())),
        ..options.clone()
    };
    let corners = match shape {
        Some(shape) => corners(&path(recordings, &plane), &plane, shape),
        None => best_fit(recordings, &plane, &options, progress)?,
    };
    if corners.is_empty() {
        return Ok(None);
    }
    let recordings = behind(&corners, &plane, recordings);
    options = resting(&corners, &plane, &options);
    let mut validation = None;
    if let Some(uniform) = chosen {
        let open = Open {
            levels: false,
            ..open
        };
        let bent = Seen {
            operators: &recordings,
            ..seen
        };
        // What is best with equal distances is good here too.
        let near = Some(options.smooth);
        let (again, found) = open.choose(bent, &options, near, progress)?;
        if let Some(found) = &found
            && !found
                .criterion
                .is_worth(found.value(), uniform.value(), WORTH)
        {
            return Ok(None);
        }
        // Without the smoothness to choose, the fits themselves have decided.
        (options, validation) = (again, found.or_else(|| chosen.clone()));
    }
    Ok(Some(Spaced {
        corners,
        plane,
        recordings,
        options,
        validation,
    }))
}

fn best_fit(
    recordings: &[Recording],
    plane: &Plane,
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<Vec<f64>> {
    let sign = match options.sign {
        Some(sign) => sign,
        None => {
            let mut problem = Problem::new(recordings, options)?;
            problem.solve(None, Progress::NONE)?.sign
        }
    };
    let rated = |corners: &[f64], start: &[f64]| {
        progress.tell("spacing of the levels", f64::NAN)?;
        let seen = behind(corners, plane, recordings);
        let options = resting(corners, plane, options);
        least_squares(&Problem::new(&seen, &options)?, sign, start)
    };
    let (even, weights) = rated(&[], &[])?;
    let path = path(recordings, plane);
    let all: Vec<Vec<f64>> = shapes().map(|shape| corners(&path, plane, shape)).collect();
    let squares = parallel::map(all.len(), |n| Ok(rated(&all[n], &weights)?.0))?;
    let mut best = (Vec::new(), (1.0 - WORTH).powi(2) * even);
    for (corners, squares) in all.into_iter().zip(squares) {
        if squares < best.1 {
            best = (corners, squares);
        }
    }
    Ok(best.0)
}

/// The path of the output in each bin of the input.
fn path(recordings: &[Recording], plane: &Plane) -> Vec<f64> {
    let bins = BINS * plane.levels();
    let low = plane.bottom();
    let width = (plane.max() - low) / bins as f64;
    let mut path = vec![0.0; bins];
    for recording in recordings {
        let pairs = recording.input.windows(2).zip(recording.output.windows(2));
        for (x, y) in pairs {
            let ends = [x[0], x[1]].map(|x| (x - low) / width);
            spread(&mut path, ends, (y[1] - y[0]).abs());
        }
    }
    path
}

/// Quantiles of the path to a power, mixed with equal distances.
fn corners(path: &[f64], plane: &Plane, shape: SpacingShape) -> Vec<f64> {
    let SpacingShape { even, power } = shape;
    let (levels, bins) = (plane.levels(), path.len());
    let (low, high) = (plane.bottom(), plane.max());
    let width = (high - low) / bins as f64;
    let path: Vec<f64> = path.iter().map(|path| path.powf(power)).collect();
    let total: f64 = path.iter().sum();
    let share = |path: f64| match total > 0.0 {
        true => even / bins as f64 + (1.0 - even) * path / total,
        false => 1.0 / bins as f64,
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
    let on_grid = on_grid(corners, plane);
    with_inputs(recordings, |recording| {
        recording.input.iter().map(|x| on_grid(*x)).collect()
    })
}

/// The options with their rest on the uniform grid of the plane.
fn resting(corners: &[f64], plane: &Plane, options: &FitOptions) -> FitOptions {
    let on_grid = on_grid(corners, plane);
    FitOptions {
        rest: options.rest.map(|rest| rest.map(on_grid)),
        ..options.clone()
    }
}
