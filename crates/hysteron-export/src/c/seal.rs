//! The first line of every file, by which it is known as exported and not edited since.

use sha2::{Digest, Sha256};
use std::io;
use std::path::Path;

const WORDS: &str = "Written by `hysteron export c`; SHA-256 of the lines below: ";

/// How a language has its comments.
#[derive(Clone, Copy)]
pub(super) enum Comment {
    /// C: between two marks.
    Block,
    /// make and CMake: from a mark to the end of the line.
    Line,
}

impl Comment {
    const ALL: [Self; 2] = [Self::Block, Self::Line];

    fn marks(self) -> (&'static str, &'static str) {
        match self {
            Self::Block => ("/* ", " */\n"),
            Self::Line => ("# ", "\n"),
        }
    }
}

/// A text with the line above it.
pub(super) fn sealed(text: &str, comment: Comment) -> String {
    let (open, close) = comment.marks();
    format!("{open}{WORDS}{}{close}{text}", digest(text.as_bytes()))
}

/// Whether a file is as it was exported.
pub(super) fn is_whole(path: &Path) -> io::Result<bool> {
    let bytes = std::fs::read(path)?;
    Ok(Comment::ALL.into_iter().any(|comment| {
        let (open, close) = comment.marks();
        let rest = bytes.strip_prefix(open.as_bytes());
        let rest = rest.and_then(|rest| rest.strip_prefix(WORDS.as_bytes()));
        let rest = rest.and_then(|rest| rest.split_at_checked(64));
        rest.is_some_and(|(said, rest)| {
            let text = rest.strip_prefix(close.as_bytes());
            text.is_some_and(|text| digest(text).as_bytes() == said)
        })
    }))
}

fn digest(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}
