//! A file whose columns are stored, as a path or in memory, and the table that is found in it.

use super::budget::Budget;
use super::labels::Labels;
use super::numbers::Numbers;
use super::wanted::Wanted;
use bytes::Bytes;
use std::fs::File;
use std::io::{Cursor, Read, Seek};
use std::path::Path;

/// A file, or bytes in memory.
pub(in crate::data) trait ReadSeek: Read + Seek + Send {}

impl<T: Read + Seek + Send> ReadSeek for T {}

/// So many bytes show the format of a file.
const HEAD: u64 = 16;

/// A file that can be read from any place on. If its bytes are in memory, the path is only a name.
#[derive(Clone, Copy)]
pub(super) struct Stored<'a> {
    pub(super) path: &'a Path,
    pub(super) held: Option<&'a Bytes>,
}

impl Stored<'_> {
    /// Opens it. Returns its length in bytes, too.
    pub(super) fn open(self) -> Result<(Box<dyn ReadSeek>, u64), String> {
        let text = |error: std::io::Error| error.to_string();
        if let Some(bytes) = self.held {
            return Ok((Box::new(Cursor::new(bytes.clone())), bytes.len() as u64));
        }
        let file = File::open(self.path).map_err(text)?;
        let length = file.metadata().map_err(text)?.len();
        Ok((Box::new(file), length))
    }

    /// Whether it begins as a format does. What is no file, such as a pipe, is of none.
    pub(super) fn is(self, format: &dyn Format) -> Result<bool, String> {
        if self.held.is_none() && !self.path.is_file() {
            return Ok(false);
        }
        let mut head = Vec::new();
        let read = self.open()?.0.take(HEAD).read_to_end(&mut head);
        read.map_err(|error| error.to_string())?;
        Ok(format.begins(&head))
    }
}

/// What is asked of a table: a column of labels, if any, and the columns of numbers that are read.
#[derive(Clone, Copy)]
pub(super) struct Asked<'a> {
    pub(super) labels: Option<&'a Labels>,
    pub(super) wanted: &'a Wanted,
}

/// The columns of numbers of a file: their names and rows. A column of labels, if asked for, comes
/// last, as codes.
pub(super) struct Opened {
    pub(super) header: Vec<String>,
    /// Columns of times, converted to seconds.
    pub(super) times: Vec<usize>,
    pub(super) numbers: Numbers,
}

/// A format that stores columns. Each has one file beside this one, and its place in the list of
/// `format.rs`.
pub(super) trait Format: Sync {
    /// Whether a file with these first bytes is of this format.
    fn begins(&self, head: &[u8]) -> bool;

    /// The endings of names that promise this format.
    fn endings(&self) -> &'static [&'static str];

    /// What is said of a file that has such an ending and does not begin as it promises.
    fn misnamed(&self) -> &'static str;

    /// Opens a file that begins as this format. All memory for what is read is taken from the budget
    /// before it is used.
    ///
    /// # Errors
    /// The problem of the file.
    fn open(
        &self,
        file: Stored<'_>,
        asked: Asked<'_>,
        budget: &mut Budget,
    ) -> Result<Opened, String>;
}
