//! The modules of each crate import each other in one direction, but for circles that are known.
#![allow(clippy::unwrap_used)]

use std::process::Command;

#[test]
fn no_new_module_imports_itself_through_others() {
    let found = Command::new(env!("CARGO_BIN_EXE_hysteron-measure"))
        .args(["modules", "all"])
        .output()
        .unwrap();
    let graph = String::from_utf8(found.stdout).unwrap();
    assert!(graph.contains("\nhysteron-core\n"), "{graph}");
    assert!(found.status.success(), "{graph}");
}
