//! Measured recordings.

pub mod skip;

use std::path::{Path, PathBuf};

/// Where recordings are looked for, in this order: beside the repository, where all of them are,
/// and in it, where those are that may be handed on.
const FOLDERS: [&str; 2] = ["../../../shared/data", "tests/recordings"];

/// The recordings that are there; the others after saying that they are skipped.
pub fn shared<N: AsRef<str>, const COUNT: usize>(names: [N; COUNT]) -> [Option<PathBuf>; COUNT] {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut absent = Vec::new();
    let found = names.each_ref().map(|name| {
        let name = name.as_ref();
        let mut places = FOLDERS
            .map(|folder| package.join(folder).join(name))
            .into_iter();
        let place = places.find(|path| path.exists());
        if place.is_none() {
            absent.push(name);
        }
        place
    });
    if !absent.is_empty() {
        skip::skipped(&format!("there is no recording {}", absent.join(", ")));
    }
    found
}
