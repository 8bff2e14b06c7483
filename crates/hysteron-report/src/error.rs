//! What can go wrong when a report is written.

use std::path::PathBuf;

/// Why a report could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A series of the evaluation does not belong to the recording.
    #[error(
        "{series} has {found} values, but the recording has {expected} samples: evaluate the model on this recording"
    )]
    Length {
        /// The series, for example `output_model`.
        series: &'static str,
        /// Samples of the recording.
        expected: usize,
        /// Values of the series.
        found: usize,
    },
    /// A file or the directory could not be written.
    #[error(transparent)]
    Write(#[from] hysteron::Error),
    /// A figure could not be turned into pixels.
    #[error("cannot draw {}: {reason}", path.display())]
    Raster {
        /// The PNG file that is missing.
        path: PathBuf,
        /// What the renderer said.
        reason: String,
    },
}
