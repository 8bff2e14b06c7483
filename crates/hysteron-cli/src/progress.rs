//! A progress bar on standard error, where that is a terminal.

use indicatif::{ProgressBar, ProgressStyle};
use std::path::Path;

/// A bar over the bytes of a file; none where its size is not known.
pub(crate) fn bytes_of(path: &Path) -> ProgressBar {
    let Ok(size) = std::fs::metadata(path).map(|file| file.len()) else {
        return ProgressBar::hidden();
    };
    let bar = ProgressBar::new(size);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {bytes}/{total_bytes}  {eta} left") {
        bar.set_style(style);
    }
    bar
}
