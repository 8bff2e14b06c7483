//! A progress bar on standard error, where that is a terminal.

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Write;
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

/// A line that names what is being done, how far it is, and the time that is left of that, as far as
/// the share tells.
pub(crate) fn stages() -> ProgressBar {
    let bar = ProgressBar::new(1000);
    let template = "{bar:40} {percent:>3} %  {msg}{left}  {elapsed}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        let left = |state: &ProgressState, text: &mut dyn Write| {
            if state.pos() > 0 {
                // A line that cannot be written is not shown, as everywhere in a bar.
                _ = write!(text, ", {:#} left", HumanDuration(state.eta()));
            }
        };
        bar.set_style(style.with_key("left", left));
    }
    bar
}

/// `done` from 0 to 1; NaN where only the time passes.
pub(crate) fn stage(bar: &ProgressBar, stage: &'static str, done: f64) {
    if bar.message() != stage {
        bar.set_message(stage);
        // Each stage is estimated by itself.
        bar.set_position(0);
        bar.reset_eta();
    }
    match done.is_nan() {
        true => bar.tick(),
        false => bar.set_position((1000.0 * done) as u64),
    }
}
