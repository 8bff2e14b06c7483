//! What the first bytes of a file show.

use crate::model::FORMAT;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Whether a file begins as a model does.
pub(crate) fn begins_as_model(head: &[u8]) -> bool {
    begins_as_json(head) && contains(head, FORMAT)
}

/// An object with a name in it. A table may begin with a brace.
pub(crate) fn begins_as_json(head: &[u8]) -> bool {
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let object = text.trim_ascii_start().strip_prefix(b"{");
    object.is_some_and(|object| object.trim_ascii_start().starts_with(b"\""))
}

pub(crate) fn contains(head: &[u8], word: &str) -> bool {
    head.windows(word.len()).any(|part| part == word.as_bytes())
}

/// Whether a file begins with these bytes.
pub(crate) fn begins_with(path: &Path, mark: &[u8]) -> io::Result<bool> {
    let mut head = Vec::new();
    File::open(path)?
        .take(mark.len() as u64)
        .read_to_end(&mut head)?;
    Ok(head == mark)
}
