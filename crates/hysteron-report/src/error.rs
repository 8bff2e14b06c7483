//! What can go wrong when a report is written.

use std::path::PathBuf;

/// Why a report could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A series of the evaluation does not belong to the recording.
    #[error(
        "{series} has {found} values, but the recording has {expected} samples: evaluate the model \
         on this recording"
    )]
    Length {
        /// The series, for example `output_model`.
        series: &'static str,
        /// Samples of the recording.
        expected: usize,
        /// Values of the series.
        found: usize,
    },
    /// An evaluation without a recording.
    #[error("no recording to show: a report needs at least one")]
    NoRecording,
    /// A comparison without a run.
    #[error("no run to show: a report needs the trace of at least one controller")]
    NoRun,
    /// A comparison without a model.
    #[error("no model to show: a report needs at least one")]
    NoModel,
    /// A run without samples.
    #[error("the run of {run} has no samples: nothing can be shown of it")]
    EmptyRun {
        /// The controller's name.
        run: String,
    },
    /// A series of a run has another length than the time of the first run.
    #[error(
        "{series} of {run} has {found} values, but the first run has {expected} samples: give runs \
         over the same samples"
    )]
    RunLength {
        /// The controller's name.
        run: String,
        /// The series, for example `output`.
        series: &'static str,
        /// Samples of the first run.
        expected: usize,
        /// Values of the series.
        found: usize,
    },
    /// A snapshot has more or fewer weights than the plane has operators.
    #[error(
        "a snapshot of {run} has {found} weights, but the plane has {expected} operators: give the \
         plane of the model that adapted"
    )]
    Snapshot {
        /// The controller's name.
        run: String,
        /// Operators of the plane.
        expected: usize,
        /// Weights of the snapshot.
        found: usize,
    },
    /// A row of the table has more or fewer cells than there are headers.
    #[error("the table's row {row} has {found} values under {expected} headers")]
    Row {
        /// The row's name.
        row: String,
        /// Headers.
        expected: usize,
        /// Values of the row.
        found: usize,
    },
    /// A figure that a report of this kind never has.
    #[error("there is no figure {stem:?}; there can be {}", stems.join(", "))]
    NoFigure {
        /// What was asked for.
        stem: String,
        /// The figures that there can be.
        stems: Vec<&'static str>,
    },
    /// A recording that the model cannot be run over.
    #[error(transparent)]
    Run(#[from] hysteron::Error),
    /// A file or the directory could not be written.
    #[error(transparent)]
    Write(#[from] hysteron_files::Error),
    /// A figure could not be turned into pixels.
    #[error("cannot draw {}: {reason}", path.display())]
    Raster {
        /// The PNG file that is missing.
        path: PathBuf,
        /// What the renderer said.
        reason: String,
    },
}
