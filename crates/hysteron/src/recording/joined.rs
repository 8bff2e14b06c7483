//! Several recordings as one, to be shown.

use crate::error::Error;
use crate::recording::{Recording, gaps};
use std::borrow::Cow;

/// Recordings one after the other, for figures and counts. Their clocks go on: each begins one
/// median step after the end of the one before. No model may run over it, for an actuator's history
/// does not go on. `None` for no recordings.
///
/// ```
/// use hysteron::{Recording, one_after_the_other};
/// let at = |time: Vec<f64>| {
///     let mut recording = Recording::new(vec![0.0, 1.0, 2.0], vec![0.0; 3])?;
///     recording.time = Some(time);
///     Ok::<_, hysteron::Error>(recording)
/// };
/// let segments = [at(vec![10.0, 11.0, 12.0])?, at(vec![0.0, 2.0, 4.0])?];
/// let joined = one_after_the_other(&segments).unwrap();
/// assert_eq!(joined.time.as_deref().unwrap(), [10.0, 11.0, 12.0, 13.0, 15.0, 17.0]);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[must_use]
pub fn one_after_the_other(recordings: &[Recording]) -> Option<Cow<'_, Recording>> {
    let (first, others) = recordings.split_first()?;
    if others.is_empty() {
        return Some(Cow::Borrowed(first));
    }
    let mut joined = first.clone();
    for next in others {
        joined.input.extend(&next.input);
        joined.output.extend(&next.output);
        joined.load = both(joined.load, next.load.as_deref());
        let moved = joined.time.as_deref().zip(next.time.as_deref());
        let moved = moved.map(|(before, time)| going_on(before, time));
        joined.time = both(joined.time, moved.as_deref());
    }
    Some(Cow::Owned(joined))
}

/// A series and the next one; `None` if one of them is missing.
fn both(before: Option<Vec<f64>>, next: Option<&[f64]>) -> Option<Vec<f64>> {
    let (mut before, next) = (before?, next?);
    before.extend(next);
    Some(before)
}

/// The times of a recording, moved behind those before.
fn going_on(before: &[f64], time: &[f64]) -> Vec<f64> {
    let step = gaps(before).map_or(0.0, |(median, _)| median);
    let by = match (before.last(), time.first()) {
        (Some(end), Some(begin)) => end + step - begin,
        _ => 0.0,
    };
    time.iter().map(|t| t + by).collect()
}

/// What is wrong with no recordings at all.
pub(crate) fn no_recordings() -> Error {
    Error::Recording {
        path: None,
        row: None,
        column: None,
        problem: "there is no recording".into(),
    }
}
