//! The modules of each crate import each other in one direction only.
#![allow(clippy::unwrap_used)]

use std::process::Command;

#[test]
fn no_module_imports_itself_through_others() {
    let found = Command::new(env!("CARGO_BIN_EXE_modules"))
        .output()
        .unwrap();
    let graph = String::from_utf8(found.stdout).unwrap();
    assert!(graph.contains("\nhysteron-core\n"), "{graph}");
    assert!(found.status.success(), "{graph}");
}
