//! Where a model errs most, and its errors without outliers.

use crate::error::Place;
use crate::model::Outlier;
use crate::recording::{Recording, named};
use serde::Serialize;

/// The sample with the largest error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Worst {
    /// The file of a recording that was held out; `None` in what was fitted or evaluated.
    pub file: Option<String>,
    /// Index of the recording, from 0.
    pub recording: usize,
    /// Index of the sample in it, from 0.
    pub sample: usize,
    /// Where it stands in the file, if rows count otherwise there.
    #[serde(skip)]
    pub place: Option<Place>,
    /// Its time in seconds; `None` without time.
    pub time: Option<f64>,
    /// The input there.
    pub input: f64,
    /// The output measured.
    pub measured: f64,
    /// The output of the model.
    pub modelled: f64,
}

impl Worst {
    /// Which sample it is, in words: `recording 2, sample 124 (line 130 of the file)`, counted from
    /// 1.
    #[must_use]
    pub fn named(&self) -> String {
        let recording = match (&self.file, self.recording) {
            (Some(file), _) => format!("{file}, "),
            (None, 0) => String::new(),
            (None, number) => format!("recording {}, ", number + 1),
        };
        format!("{recording}{}", named(self.sample + 1, self.place))
    }
}

/// The errors of the outputs of a model over recordings, and where they are, but for `outliers`.
fn errors<'a>(
    recordings: &'a [Recording],
    modelled: &'a [f64],
    outliers: &'a [Outlier],
) -> impl Iterator<Item = (f64, usize, usize, f64)> + 'a {
    let each = recordings.iter().enumerate();
    let samples = each.flat_map(|(n, recording)| {
        let measured = recording.output.iter().enumerate();
        measured.map(move |(sample, y)| (n, sample, *y))
    });
    let is_outlier = move |place: (usize, usize)| {
        let mut outliers = outliers.iter();
        outliers.any(|outlier| (outlier.recording, outlier.sample) == place)
    };
    let errors = samples.zip(modelled);
    let errors = errors.filter(move |((n, sample, _), _)| !is_outlier((*n, *sample)));
    errors.map(|((n, sample, y), modelled)| ((y - modelled).abs(), n, sample, *modelled))
}

/// The error without `outliers`; `None` without a series.
pub(super) fn rmse_without(
    recordings: &[Recording],
    modelled: &[f64],
    outliers: &[Outlier],
) -> Option<f64> {
    let squares = errors(recordings, modelled, outliers).map(|(error, ..)| error * error);
    let (count, sum) = squares.fold((0.0, 0.0), |(count, sum), square| {
        (count + 1.0, sum + square)
    });
    (count > 0.0).then(|| f64::sqrt(sum / count))
}

/// Where a model errs most.
pub(super) fn worst(
    recordings: &[Recording],
    modelled: &[f64],
    outliers: &[Outlier],
) -> Option<Worst> {
    let errors = errors(recordings, modelled, outliers);
    let (_, number, sample, modelled) = errors.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let recording = &recordings[number];
    Some(Worst {
        file: None,
        recording: number,
        sample,
        place: recording.place(sample),
        time: recording.time.as_ref().map(|time| time[sample]),
        input: recording.input[sample],
        measured: recording.output[sample],
        modelled,
    })
}
