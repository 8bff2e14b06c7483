//! Programs that tests start, and what happens where one is missing. The tests of the C interface
//! share this file.
#![allow(clippy::unwrap_used, dead_code)]

#[path = "../../../hysteron/tests/common/skip.rs"]
mod skipping;

use std::path::Path;
use std::process::Command;

/// Whether a tool can be started; says so if not, and fails where nothing may be skipped.
pub fn has(tool: &str) -> bool {
    let found = Command::new(tool).arg("--version").output();
    found.is_ok_and(|done| done.status.success()) || skip(&format!("there is no `{tool}`"))
}

/// What is missing is skipped, or fails where nothing may be.
pub fn skip(why: &str) -> bool {
    assert!(std::env::var_os("HYSTERON_NO_SKIP").is_none(), "{why}");
    skipping::skipped(why);
    false
}

pub fn run(command: &mut Command) {
    let output = command.output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success(),
        "{command:?}: {}\n{text}",
        output.status
    );
}

/// Whether a program for this machine can be made with these flags.
pub fn links(cc: &str, flags: &[&str]) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("a.c");
    std::fs::write(
        &source,
        "#include <stdio.h>\nint main(void) { return puts(\"\") < 0; }\n",
    )
    .unwrap();
    let done = Command::new(cc)
        .args(flags)
        .arg(&source)
        .arg("-o")
        .arg(folder.path().join("a"))
        .output();
    done.is_ok_and(|done| done.status.success())
}

/// The text of a page of `docs/`, and the C program in it.
pub fn page(name: &str) -> (String, String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../docs")
        .join(name);
    let page = std::fs::read_to_string(path).unwrap();
    let after = page.split_once("```c\n").unwrap().1;
    let program = after.split("```").next().unwrap().to_owned();
    (page, program)
}
