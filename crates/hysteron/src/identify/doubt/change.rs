//! How much gain and shift of an actuator change between sessions, learned from its repeats.

use crate::error::Result;
use crate::identify::history::find_start;
use crate::model::{Change, Model};
use crate::recording::Recording;
use crate::series::Line;

/// Shifts up to this share of the plane are tried, and so many in each direction.
const MOST: f64 = 0.15;
const SHIFTS: i32 = 30;

/// What is usual counts as so many repeats.
const USUAL: f64 = 1.0;

/// The standard deviations of gain and shift between sessions, from one recording of each of
/// `repeats`: the usual ones ([`Change`]), and the squares of what each repeat changed, in one mean.
/// `None` for a model that depends on a load, which changes both.
///
/// # Errors
/// As [`Model::run_in`].
pub(super) fn change(model: &Model, repeats: &[Recording]) -> Result<Option<Change>> {
    if model.load.is_some() || repeats.is_empty() {
        return Ok(None);
    }
    let usual = Change::default();
    let (mut gain, mut shift) = (USUAL * usual.gain.powi(2), USUAL * usual.shift.powi(2));
    let mut count = USUAL;
    for repeat in repeats {
        if let Some((by, along)) = changed(model, repeat)? {
            (gain, shift) = (gain + by * by, shift + along * along);
            count += 1.0;
        }
    }
    let deviation = |squares: f64| (squares / count).sqrt();
    Ok(Some(Change {
        gain: deviation(gain),
        shift: deviation(shift),
    }))
}

/// How much more the output moves in `repeat` than the model's, and how far the loops lie along the
/// input, as a share of the plane. Beside both an offset is free. `None` where the output of the
/// model stands still or moves the other way.
fn changed(model: &Model, repeat: &Recording) -> Result<Option<(f64, f64)>> {
    let (inner, seen) = (model.within(), model.recording_within(repeat)?);
    let (start, _) = find_start(&inner, &seen)?;
    let begin = inner.restore(&start.turning_points, start.input)?;
    let width = inner.plane().max() - inner.plane().min();
    let mut best = (f64::INFINITY, None);
    for n in -SHIFTS..=SHIFTS {
        let share = MOST * f64::from(n) / f64::from(SHIFTS);
        let input = seen.input.iter().map(|x| x - share * width).collect();
        let moved = Recording {
            input,
            ..seen.clone().into_owned()
        };
        let (output, _) = inner.run_over(&mut begin.clone(), &moved)?;
        let pairs = output.iter().copied().zip(seen.output.iter().copied());
        let line = Line::through(pairs.clone());
        let errors = pairs.map(|(h, y)| y - line.at(h));
        let squares: f64 = errors.map(|error| error * error).sum();
        if squares < best.0 && line.slope() > 0.0 {
            best = (squares, Some((line.slope() - 1.0, share)));
        }
    }
    Ok(best.1)
}
