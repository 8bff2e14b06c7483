//! The state before a recording, as a history of turning points that a real actuator can have had.

use crate::error::Result;
use crate::model::{FittedStart, Model, State, Surroundings};
use crate::recording::Recording;
use crate::series::range;

/// Candidates for a turning point, evenly over the positions it can have.
const CANDIDATES: usize = 24;

/// Largest number of turning points of a history. More of them explain noise.
const MOST: usize = 6;

/// A further turning point has to reduce the error by this share.
const WORTH: f64 = 0.02;

/// Refinements of the last turning points, each with half the step of the one before.
const REFINED: usize = 6;

/// Finds the history that explains the beginning of `recording` best, and the number of samples
/// that count as its beginning: up to the first one after which the input has covered nearly all
/// of its range, which wipes out most of the memory.
///
/// The history starts with every operator off. Turning points are added one or two at a time while
/// that reduces the error by more than a fiftieth. Unlike a state of each operator for itself, it is
/// one that an input can lead to, so a model can start from it.
///
/// # Errors
/// As [`Model::run_in`].
pub(crate) fn find_start(model: &Model, recording: &Recording) -> Result<(FittedStart, usize)> {
    let around = Surroundings::from_recording(model, recording);
    let seen = model.seen(&recording.input, around)?;
    let beginning = beginning(&seen);
    let search = Search {
        model,
        recording: &recording.part(0..beginning),
        first: model.plane().normalise(seen[0]),
        input: seen[0],
    };
    let mut best = search.rated(Vec::new())?;
    while best.points.len() < MOST {
        let next = search.extended(&best)?;
        if next.error >= (1.0 - WORTH) * best.error {
            break;
        }
        best = next;
    }
    let mut turning_points = best.points;
    turning_points.push(search.first);
    let input = search.input;
    Ok((
        FittedStart {
            turning_points,
            input,
        },
        beginning,
    ))
}

/// Number of samples until the input has covered nine tenths of its range.
pub(in crate::identify) fn beginning(input: &[f64]) -> usize {
    let (low, high) = range(input);
    let (mut least, mut most) = (input[0], input[0]);
    let covers = |x: &f64| {
        (least, most) = (least.min(*x), most.max(*x));
        most - least >= 0.9 * (high - low)
    };
    1 + input.iter().position(covers).unwrap_or(input.len() - 1)
}

/// The sum of the squared errors over a recording, from a state.
pub(super) fn squares(model: &Model, mut from: State, recording: &Recording) -> Result<f64> {
    let (output, _) = model.run_over(&mut from, recording)?;
    let pairs = recording.output.iter().zip(&output);
    Ok(pairs.map(|(y, h)| (y - h) * (y - h)).sum())
}

/// Turning points before the first sample, and the squared error with them.
#[derive(Clone)]
struct History {
    points: Vec<f64>,
    error: f64,
}

struct Search<'a> {
    model: &'a Model,
    recording: &'a Recording,
    /// The first input of the operators, normalised and in its unit.
    first: f64,
    input: f64,
}

impl Search<'_> {
    fn rated(&self, points: Vec<f64>) -> Result<History> {
        let mut all = points.clone();
        all.push(self.first);
        let Ok(state) = self.model.restore(&all, self.input) else {
            // Rounding made the points cross.
            return Ok(History {
                points,
                error: f64::INFINITY,
            });
        };
        let error = squares(self.model, state, self.recording)?;
        Ok(History { points, error })
    }

    /// Where the next turning point can be: between the last two, on the other side of the first
    /// input.
    fn room(&self, points: &[f64]) -> (f64, f64) {
        let levels = self.model.plane().levels() as f64;
        let last = |parity: usize, other: f64| {
            let same = points.iter().enumerate().rev();
            let mut same = same.filter(|(n, _)| n % 2 == parity);
            same.next().map_or(other, |(_, point)| *point)
        };
        match points.len() % 2 {
            0 => (self.first, last(0, levels)),
            _ => (last(1, 0.0), self.first),
        }
    }

    /// The best history with one or two more turning points.
    fn extended(&self, from: &History) -> Result<History> {
        let mut best = from.clone();
        let mut consider = |history: History| {
            if history.error < best.error {
                best = history;
            }
        };
        let with = |points: &[f64], point: f64| [points, &[point]].concat();
        for one in candidates(self.room(&from.points)) {
            let points = with(&from.points, one);
            consider(self.rated(points.clone())?);
            for two in candidates(self.room(&points)) {
                consider(self.rated(with(&points, two))?);
            }
        }
        self.refined(best, from.points.len())
    }

    /// Moves each turning point from number `from` on, as long as that helps.
    fn refined(&self, mut best: History, from: usize) -> Result<History> {
        let mut step = self.model.plane().levels() as f64 / CANDIDATES as f64;
        for _ in 0..REFINED {
            step *= 0.5;
            for n in from..best.points.len() {
                for change in [-step, step] {
                    let mut points = best.points.clone();
                    points[n] += change;
                    let moved = self.rated(points)?;
                    if moved.error < best.error {
                        best = moved;
                    }
                }
            }
        }
        Ok(best)
    }
}

fn candidates((low, high): (f64, f64)) -> impl Iterator<Item = f64> {
    let at = move |n: usize| low + (high - low) * n as f64 / CANDIDATES as f64;
    (0..=CANDIDATES).map(at)
}
