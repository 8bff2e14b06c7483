//! What a test says when it is skipped. The tests of other crates share this file.
#![allow(clippy::unwrap_used)]

use std::fs::OpenOptions;
use std::io::Write;

/// Says which test is skipped, and why. `./check` prints these lines again at its end: it collects
/// them in the file that `HYSTERON_SKIPPED` names.
pub fn skipped(why: &str) {
    let thread = std::thread::current();
    let line = format!("skipped: {}: {why}\n", thread.name().unwrap_or("a test"));
    eprint!("{line}");
    if let Some(path) = std::env::var_os("HYSTERON_SKIPPED") {
        let mut file = OpenOptions::new()
            .create(true)
            .append(true)
            .open(path)
            .unwrap();
        // Tests run side by side: one write, so that the line stays whole.
        file.write_all(line.as_bytes()).unwrap();
    }
}
