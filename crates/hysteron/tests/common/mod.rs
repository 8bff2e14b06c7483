//! Measured recordings, which stay outside of the repository.

mod skip;

use std::path::{Path, PathBuf};

/// A file of `../shared/data`, or `None` after saying that it is skipped.
pub fn shared(name: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let path = folder.join(name);
    if path.exists() {
        return Some(path);
    }
    skip::skipped(&format!("there is no recording {}", path.display()));
    None
}
