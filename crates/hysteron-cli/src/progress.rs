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

/// A bar over a share of the work, with the time that is left.
pub(crate) fn share() -> ProgressBar {
    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// A line that names what is being done and how far it is.
pub(crate) fn stages() -> ProgressBar {
    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {elapsed}") {
        bar.set_style(style);
    }
    bar
}

/// `done` from 0 to 1; NaN where only the time passes.
pub(crate) fn stage(bar: &ProgressBar, stage: &'static str, done: f64) {
    if bar.message() != stage {
        bar.set_message(stage);
    }
    match done.is_nan() {
        true => bar.tick(),
        false => bar.set_position((1000.0 * done) as u64),
    }
}
