//! Detects the format of a file and opens it with the reader for that format.

use super::Source;
use super::arrow::Arrow;
use super::budget::Budget;
use super::labels::Labels;
use super::mat::{MatV5, MatV73};
use super::parquet::Parquet;
use super::stored::{Asked, Format, Stored};
use super::text::{self, Text};
use super::wanted::Wanted;
use crate::data::recording::Repair;
use crate::error::{Error, Result};
use crate::files::{begins_as_json, begins_as_model, contains};
use bytes::Bytes;
use hysteron_files::{Hash, Hashing};
use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

/// The formats that store columns. A file of none of them is text.
const FORMATS: [&dyn Format; 4] = [&Parquet, &Arrow, &MatV5, &MatV73];

/// The beginnings of files that hold tables which are not read as they are, and what to do.
const FOREIGN: [(&[u8], &str); 4] = [
    (
        b"\x1f\x8b",
        "the file is compressed by gzip: unpack it first",
    ),
    (b"PK\x03\x04", WORKBOOK),
    (b"\xd0\xcf\x11\xe0", WORKBOOK),
    (
        b"FEA1",
        "this is Feather of version 1: write it again as version 2",
    ),
];
const WORKBOOK: &str = "this is a workbook or an archive: save the table as CSV";

/// The format that the first bytes of a file show; `None` for text. The ending of its name tells
/// what was meant where the bytes show nothing.
fn format_of(
    path: &Path,
    head: &[u8],
) -> std::result::Result<Option<&'static dyn Format>, &'static str> {
    if let Some(problem) = json(head) {
        return Err(problem);
    }
    if let Some(format) = FORMATS.into_iter().find(|format| format.begins(head)) {
        return Ok(Some(format));
    }
    if let Some((_, problem)) = FOREIGN.iter().find(|(mark, _)| head.starts_with(mark)) {
        return Err(problem);
    }
    let named = |ending: &&str| {
        path.extension()
            .is_some_and(|e| e.eq_ignore_ascii_case(ending))
    };
    let meant = |format: &&dyn Format| format.endings().iter().any(named);
    match FORMATS.into_iter().find(meant) {
        Some(format) => Err(format.misnamed()),
        None => Ok(None),
    }
}

/// What a file is that begins as JSON; none for any other.
fn json(head: &[u8]) -> Option<&'static str> {
    begins_as_json(head).then(|| match () {
        // A session has models in it.
        () if contains(head, "hysteron-studio") => {
            "this is a session of the studio, not a table: open it there"
        }
        () if begins_as_model(head) => "this is a model, not a table: name a recording",
        () => "this is JSON, not a table: save the columns as CSV",
    })
}

/// Opens a file of any format. Returns the names of its columns and its rows. Of a file that is
/// `held` in memory, `path` is only the name. `labels`, if given, are read as another column, after
/// those of numbers; of these, the `wanted` ones are read where the format lets others be left out.
pub(super) fn open(
    path: &Path,
    held: Option<&Bytes>,
    repair: Option<Repair>,
    hash: Option<Hash>,
    (labels, wanted): (Option<&Labels>, &Wanted),
    budget: &mut Budget,
) -> Result<(Vec<String>, Source)> {
    let failed = |source| Error::File {
        path: path.to_owned(),
        source,
    };
    let refused = |problem: String| Error::Recording {
        path: Some(path.to_owned()),
        row: None,
        column: None,
        problem,
    };
    let mut seekable = false;
    let file: Box<dyn Read> = if let Some(bytes) = held {
        seekable = true;
        Box::new(Cursor::new(bytes.clone()))
    } else if path == Path::new("-") {
        Box::new(std::io::stdin())
    } else {
        let file = File::open(path).map_err(failed)?;
        let about = file.metadata().map_err(failed)?;
        if about.is_dir() {
            let problem = "this is a folder: name a file in it";
            return Err(failed(std::io::Error::other(problem)));
        }
        seekable = about.is_file();
        Box::new(file)
    };
    let mut file = Hashing::new(file, hash);
    let (head, whole) = text::head(&mut file).map_err(failed)?;
    match format_of(path, &head).map_err(|problem| refused(problem.to_owned()))? {
        None => {
            let rest = file;
            let source = text::Source { head, whole, rest };
            let (header, text) = Text::open(path, source, repair, budget)?;
            Ok((header, Source::Text(Box::new(text))))
        }
        Some(_) if !seekable => {
            let problem = "only CSV can be read from a pipe: name the file";
            Err(refused(problem.to_owned()))
        }
        Some(format) => {
            let asked = Asked { labels, wanted };
            let opened = format.open(Stored { path, held }, asked, budget);
            let opened = opened.map_err(refused)?;
            let numbers = opened.numbers.with_times(opened.times);
            Ok((opened.header, Source::Numbers(numbers)))
        }
    }
}
