//! The first line of every file, by which it is known as exported and not edited since.

use sha2::{Digest, Sha256};
use std::io;
use std::path::Path;

const HEAD: &str = "/* Written by `hysteron export c`; SHA-256 of the lines below: ";
const TAIL: &str = " */\n";

/// A text with the line above it.
pub(super) fn sealed(text: &str) -> String {
    format!("{HEAD}{}{TAIL}{text}", digest(text.as_bytes()))
}

/// Whether a file is as it was exported.
pub(super) fn is_whole(path: &Path) -> io::Result<bool> {
    let bytes = std::fs::read(path)?;
    let rest = bytes.strip_prefix(HEAD.as_bytes());
    Ok(rest
        .and_then(|rest| rest.split_at_checked(64))
        .is_some_and(|(said, rest)| {
            let text = rest.strip_prefix(TAIL.as_bytes());
            text.is_some_and(|text| digest(text).as_bytes() == said)
        }))
}

fn digest(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}
