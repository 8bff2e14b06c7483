//! How much gain and shift of an actuator change between sessions, learned from its repeats.

use crate::error::Result;
use crate::identify::history::beginning;
use crate::model::{Change, Model};
use crate::recording::Recording;
use crate::series::Line;

/// Shifts up to this share of the plane are tried, and so many in each direction.
const MOST: f64 = 0.15;
const SHIFTS: i32 = 30;

/// What is usual counts as so many repeats.
const USUAL: f64 = 1.0;

/// The standard deviations of gain and shift between sessions: the root mean square of what each of
/// the `repeats` changed, in which the usual deviations ([`Change`]) count as one more repeat. `None`
/// for a model that depends on a load, which changes both.
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
/// model stands still or moves the other way, and where the stages behind the operators cannot be
/// undone.
fn changed(model: &Model, repeat: &Recording) -> Result<Option<(f64, f64)>> {
    let inner = model.within();
    let Ok(seen) = model.recording_within(repeat) else {
        return Ok(None);
    };
    // How the operators began is forgotten once the input has been through its range.
    let first = beginning(&seen.input);
    let width = inner.plane().max() - inner.plane().min();
    let mut output = vec![0.0; seen.len()];
    let mut best = (f64::INFINITY, None);
    for n in -SHIFTS..=SHIFTS {
        let share = MOST * f64::from(n) / f64::from(SHIFTS);
        let input: Vec<f64> = seen.input.iter().map(|x| x - share * width).collect();
        inner.run(&mut inner.start(), &input, &mut output)?;
        let pairs = output.iter().copied().zip(seen.output.iter().copied());
        let pairs = pairs.skip(first);
        let line = Line::through(pairs.clone());
        let errors = pairs.map(|(h, y)| y - line.at(h));
        let squares: f64 = errors.map(|error| error * error).sum();
        if squares < best.0 && line.slope() > 0.0 {
            best = (squares, Some((line.slope() - 1.0, share)));
        }
    }
    Ok(best.1)
}
