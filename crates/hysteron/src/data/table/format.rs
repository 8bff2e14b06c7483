//! Detects the format of a file and opens it with the reader for that format.

use super::budget::Budget;
use super::labels::Labels;
use super::text::{self, Text};
use super::wanted::Wanted;
use super::{Source, arrow, mat, parquet};
use crate::data::recording::Repair;
use crate::error::{Error, Result};
use crate::files::{begins_as_json, begins_as_model, contains};
use bytes::Bytes;
use hysteron_files::{Hash, Hashing};
use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

/// The format that the first bytes of a file show, or otherwise the ending of its name.
enum Format {
    Csv,
    Parquet,
    Arrow,
    MatV5,
    MatV73,
}

impl Format {
    fn of(path: &Path, head: &[u8]) -> std::result::Result<Self, &'static str> {
        let named = |ending: &str| {
            path.extension()
                .is_some_and(|e| e.eq_ignore_ascii_case(ending))
        };
        let begins = |mark: &[u8]| head.starts_with(mark);
        if let Some(problem) = json(head) {
            return Err(problem);
        }
        if begins(b"PAR1") {
            Ok(Self::Parquet)
        } else if begins(arrow::FILE) || begins(arrow::STREAM) {
            Ok(Self::Arrow)
        } else if begins(b"MATLAB 5.0") {
            Ok(Self::MatV5)
        } else if begins(b"MATLAB 7.3") || begins(b"\x89HDF\r\n\x1a\n") {
            Ok(Self::MatV73)
        } else if begins(b"\x1f\x8b") {
            Err("the file is compressed by gzip: unpack it first")
        } else if begins(b"PK\x03\x04") || begins(b"\xd0\xcf\x11\xe0") {
            Err("this is a workbook or an archive: save the table as CSV")
        } else if begins(b"FEA1") {
            Err("this is Feather of version 1: write it again as version 2")
        } else if named("arrow") || named("arrows") || named("feather") {
            Err("this is no Arrow file or stream, for all its name")
        } else if named("parquet") {
            Err("this is no Parquet file, for all its name: it does not begin with `PAR1`")
        } else if named("mat") {
            Err("this is no MATLAB file of version 5, 7 or 7.3: save it in MATLAB with `-v7`")
        } else {
            Ok(Self::Csv)
        }
    }
}

/// What a file is that begins as JSON; none for any other.
fn json(head: &[u8]) -> Option<&'static str> {
    begins_as_json(head).then(|| match () {
        () if begins_as_model(head) => "this is a model, not a table: name a recording",
        () if contains(head, "hysteron-studio") => {
            "this is a session of the studio, not a table: open it there"
        }
        () => "this is JSON, not a table: save the columns as CSV",
    })
}

/// An open file: the names of its columns, and its rows.
pub(super) struct Opened {
    pub(super) header: Vec<String>,
    pub(super) source: Source,
    pub(super) is_arrow: bool,
}

/// Opens a file of any format. Returns the names of its columns and its rows. Of a file that is
/// `held` in memory, `path` is only the name. `labels`, if given, are read as another column, after
/// those of numbers; of these, a Parquet file is read for the `wanted` ones.
pub(super) fn open(
    path: &Path,
    held: Option<&Bytes>,
    repair: Option<Repair>,
    hash: Option<Hash>,
    (labels, wanted): (Option<&Labels>, &Wanted),
    budget: &mut Budget,
) -> Result<Opened> {
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
    let format = Format::of(path, &head).map_err(|problem| refused(problem.to_owned()))?;
    let is_arrow = matches!(format, Format::Arrow);
    let (header, numbers) = match format {
        Format::Csv => {
            let rest = file;
            let source = text::Source { head, whole, rest };
            let (header, text) = Text::open(path, source, repair, budget)?;
            return Ok(Opened {
                header,
                source: Source::Text(Box::new(text)),
                is_arrow: false,
            });
        }
        _ if !seekable => {
            let problem = "only CSV can be read from a pipe: name the file";
            return Err(refused(problem.to_owned()));
        }
        Format::Parquet => {
            let opened = match held {
                Some(bytes) => parquet::open_bytes(bytes, budget.another(), (labels, wanted)),
                None => parquet::open(path, budget.another(), (labels, wanted)),
            };
            let opened = opened.map_err(refused)?;
            (opened.header, opened.numbers.with_times(opened.times))
        }
        Format::Arrow => {
            let (batches, length) =
                arrow::batches(path, held, budget.another()).map_err(refused)?;
            let opened = arrow::open(batches, length, (labels, wanted)).map_err(refused)?;
            (opened.header, opened.numbers.with_times(opened.times))
        }
        #[cfg(not(feature = "hdf5"))]
        Format::MatV73 => {
            let problem = "this build does not read MATLAB 7.3: save the file in MATLAB with `-v7`";
            return Err(refused(problem.to_owned()));
        }
        #[cfg(feature = "hdf5")]
        Format::MatV73 => {
            let variables = mat::v73::read(path, held, budget).map_err(refused)?;
            mat::table(variables, budget).map_err(refused)?
        }
        Format::MatV5 => {
            // Bytes that are there already are their holder's.
            let size = match held {
                Some(_) => 0,
                None => std::fs::metadata(path).map_err(failed)?.len(),
            };
            budget.take(u128::from(size), "the file").map_err(refused)?;
            let bytes = match held {
                Some(bytes) => bytes.clone(),
                None => std::fs::read(path).map_err(failed)?.into(),
            };
            let variables = mat::v5::read(&bytes, budget).map_err(refused)?;
            budget.give_back(u128::from(size));
            mat::table(variables, budget).map_err(refused)?
        }
    };
    Ok(Opened {
        header,
        source: Source::Numbers(numbers),
        is_arrow,
    })
}
