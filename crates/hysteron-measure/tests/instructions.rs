//! What a sample costs is counted, and does not grow unseen.
#![allow(clippy::unwrap_used)]

#[path = "../../hysteron/tests/common/skip.rs"]
mod skip;

use std::process::{Command, Output};

const TABLE: &str = include_str!("../src/text/instructions.csv");

/// What a program prints, if it is there.
fn printed(program: &str, word: &str) -> Option<String> {
    let Output { stdout, .. } = Command::new(program).arg(word).output().ok()?;
    Some(String::from_utf8(stdout).unwrap())
}

/// Dense algebra takes what the processor has; valgrind has no AVX-512.
fn is_as_counted() -> bool {
    #[cfg(target_arch = "x86_64")]
    let has = std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    let has = false;
    has && cfg!(debug_assertions)
}

#[test]
fn nothing_costs_more_instructions_than_the_table_says() {
    if !is_as_counted() {
        return skip::skipped(
            "the table is of x86-64 with AVX2 and of the usual build of the tests",
        );
    }
    if printed("valgrind", "--version").is_none() {
        return skip::skipped("there is no valgrind, which counts instructions");
    }
    // Another compiler makes other instructions: the table is counted anew with it.
    let with = TABLE
        .lines()
        .find_map(|line| line.strip_prefix("# tests: "));
    let rustc = std::env::var("RUSTC").unwrap_or("rustc".to_owned());
    let here = printed(&rustc, "--version").unwrap_or_default();
    if with.unwrap() != here.trim() {
        return skip::skipped("instructions are counted with the compiler that the table names");
    }
    let found = Command::new(env!("CARGO_BIN_EXE_hysteron-measure"))
        .args(["instructions", "watch"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&found.stderr);
    assert!(found.status.success(), "{said}");
}
