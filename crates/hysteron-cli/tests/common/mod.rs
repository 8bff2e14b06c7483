//! The command, run in a folder.
#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use serde_json::Value;
use std::path::Path;
use std::process::Output;

/// Runs `hysteron` with the words of a line.
pub fn run(folder: &Path, line: &str) -> Output {
    Command::cargo_bin("hysteron")
        .unwrap()
        .current_dir(folder)
        .args(line.split_whitespace())
        .output()
        .unwrap()
}

/// What it printed.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// The JSON of a run that has to succeed.
pub fn json(folder: &Path, line: &str) -> Value {
    let done = run(folder, &format!("{line} --json"));
    assert!(done.status.success(), "{line}: {}", text(&done.stderr));
    serde_json::from_slice(&done.stdout).unwrap()
}

/// What it says of a run that has to fail.
pub fn refused(folder: &Path, line: &str) -> String {
    let done = run(folder, line);
    assert_eq!(
        done.status.code(),
        Some(1),
        "{line}: {}",
        text(&done.stdout)
    );
    text(&done.stderr)
}
