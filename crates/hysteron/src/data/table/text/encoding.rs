//! Detects and decodes text that is not UTF-8.

use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};
use encoding_rs_io::DecodeReaderBytesBuilder;
use std::io::Read;

/// The encoding of a text with this beginning; `None` for UTF-8.
///
/// UTF-16 begins with a byte order mark. Other text that is not valid UTF-8 is taken as
/// Windows-1252, which includes Latin-1.
pub(super) fn of(head: &[u8], whole: bool) -> Option<&'static Encoding> {
    if let Some((encoding, _)) = Encoding::for_bom(head) {
        return Some(encoding).filter(|encoding| *encoding != UTF_8);
    }
    match std::str::from_utf8(head) {
        Ok(_) => None,
        // The head may end within a character.
        Err(error) if error.error_len().is_none() && !whole => None,
        Err(_) => Some(WINDOWS_1252),
    }
}

/// The same text in UTF-8.
pub(super) fn decoded(encoding: &'static Encoding, text: impl Read + 'static) -> Box<dyn Read> {
    let mut builder = DecodeReaderBytesBuilder::new();
    Box::new(builder.encoding(Some(encoding)).build(text))
}
