//! The horizontal axis of a series: time, or sample numbers where there is no time.

use crate::quantity::Labelled;
use hysteron::Recording;
use std::borrow::Cow;

/// A value for each sample of the recording, and what it is.
pub(crate) fn clock(recording: &Recording) -> (Cow<'_, [f64]>, Labelled) {
    let samples = recording.input.len();
    let (time, name, unit) = match recording.time.as_deref() {
        Some(time) if time.len() == samples => (Cow::Borrowed(time), "time", Some("s".to_owned())),
        _ => (
            Cow::Owned((0..samples).map(|k| k as f64).collect()),
            "sample number",
            None,
        ),
    };
    let label = Labelled {
        name: name.to_owned(),
        unit,
    };
    (time, label)
}
