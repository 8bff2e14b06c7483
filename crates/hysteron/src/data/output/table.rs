//! Tables written row by row, as CSV or Parquet.

use super::destination::folder_of;
use super::sign::is_our_table;
use super::splice::{Original, Splice};
use super::spool::Spool;
use super::{AtomicFile, Destination, Own};
use crate::data::table::{Row, TableReader};
use crate::error::{Error, Result};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A column that is added to those of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Added {
    /// One of numbers, with its name.
    Numbers(&'static str),
    /// One of words, with its name.
    Words(&'static str),
}

impl Added {
    /// The column's name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Numbers(name) | Self::Words(name) => name,
        }
    }
}

/// A cell of an added column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell<'a> {
    /// In a column of numbers.
    Number(f64),
    /// In a column of words.
    Word(&'a str),
}

impl Cell<'_> {
    fn text(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Word(word) => (*word).to_owned(),
        }
    }
}

/// The path that errors name where standard output cannot be written to.
pub const STANDARD_OUTPUT: &str = "standard output";

/// Writes a table, to standard output or to a file that appears only when it is whole.
///
/// The end of the file's name tells the format: `.parquet` is Parquet; `.csv`, `.txt`, `.dat` or
/// none is CSV; no other can be written. Memory does not grow with the table. In Parquet, the
/// columns of a source that is Parquet too go over as they are stored, with all their types; what
/// Apache Arrow notes beside these (the name of a time zone, dictionaries, durations) does not. Of
/// other sources, a column whose cells are all numbers becomes one of doubles, any other one of
/// text; an empty cell is null. A cell is a number where a double holds all of it: `007` and 2⁵³ +
/// 1 are text.
pub struct TableWriter {
    path: PathBuf,
    to: Format,
}

enum Format {
    Csv(csv::Writer<Sink>),
    Parquet(Spool, AtomicFile),
    Spliced(Box<Splice>),
}

enum Sink {
    Stdout(BufWriter<io::Stdout>),
    File(BufWriter<AtomicFile>),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Sink::Stdout(out) => out.write(bytes),
            Sink::File(out) => out.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Sink::Stdout(out) => out.flush(),
            Sink::File(out) => out.flush(),
        }
    }
}

/// Whether a table of this name is Parquet.
fn is_parquet(path: &Path) -> io::Result<bool> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    // The name of a pipe or of `/dev/null` says nothing.
    if path.metadata().is_ok_and(|there| !there.is_file()) {
        return Ok(ending.as_deref() == Some("parquet"));
    }
    match ending.as_deref() {
        None | Some("csv" | "txt" | "dat") => Ok(false),
        Some("parquet") => Ok(true),
        Some(other) => Err(io::Error::other(format!(
            "a table cannot be written as `.{other}`: let the name end with .csv or .parquet"
        ))),
    }
}

impl TableWriter {
    /// A table with columns that a command adds, to `target`, or to standard output without one or
    /// with `-`.
    ///
    /// # Errors
    /// [`Error::File`], also for a name whose end is of a format that cannot be written.
    pub fn create(target: Option<Destination<'_>>) -> Result<Self> {
        Self::start(target, Own::Marked(is_our_table))
    }

    /// As [`TableWriter::create`], for a table without such columns: one in CSV is not known as
    /// ours when it is there.
    ///
    /// # Errors
    /// As [`TableWriter::create`].
    pub fn plain(target: Option<Destination<'_>>) -> Result<Self> {
        Self::start(target, Own::Unmarked(is_our_table))
    }

    fn start(target: Option<Destination<'_>>, own: Own) -> Result<Self> {
        let Some(target) = target.filter(|target| target.path() != Path::new("-")) else {
            return Ok(Self {
                path: STANDARD_OUTPUT.into(),
                to: Format::Csv(csv(Sink::Stdout(BufWriter::new(io::stdout())))),
            });
        };
        let path = target.path().to_owned();
        let failed = |source| Error::File {
            path: path.clone(),
            source,
        };
        let parquet = is_parquet(&path).map_err(failed)?;
        let file = AtomicFile::create(target, own)?;
        let to = match parquet {
            false => Format::Csv(csv(Sink::File(BufWriter::new(file)))),
            true => Format::Parquet(Spool::create_in(folder_of(&path)).map_err(failed)?, file),
        };
        Ok(Self { path, to })
    }

    /// Begins a table that has the columns of another, and more.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn begin(mut self, table: &TableReader, added: &[Added]) -> Result<Self> {
        if let Format::Parquet(spool, file) = self.to {
            let original = Original::open(table.path()).map_err(|source| Error::File {
                path: table.path().to_owned(),
                source,
            })?;
            self.to = match original {
                None => Format::Parquet(spool, file),
                Some(original) => {
                    let splice =
                        Splice::start(original, file, added).map_err(|source| Error::File {
                            path: self.path.clone(),
                            source,
                        })?;
                    return Ok(Self {
                        to: Format::Spliced(Box::new(splice)),
                        ..self
                    });
                }
            };
        }
        let names = added.iter().map(|column| column.name().to_owned());
        self.row(table.header().iter().cloned().chain(names))?;
        Ok(self)
    }

    /// Writes a row as it was read, and further cells after it.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn extend_row(&mut self, row: &Row, cells: &[Cell<'_>]) -> Result<()> {
        if let Format::Spliced(splice) = &mut self.to {
            let written = splice.row(cells);
            return written.map_err(|source| self.failed(source));
        }
        let cells: Vec<String> = cells.iter().map(Cell::text).collect();
        self.write(row.cells().chain(cells.iter().map(String::as_bytes)))
    }

    /// Writes a row of cells; the first row holds the columns' names.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn row<C: AsRef<[u8]>>(&mut self, cells: impl IntoIterator<Item = C>) -> Result<()> {
        self.write(cells.into_iter())
    }

    fn write<C: AsRef<[u8]>>(&mut self, cells: impl Iterator<Item = C>) -> Result<()> {
        let written = match &mut self.to {
            Format::Csv(csv) => csv.write_record(cells),
            Format::Parquet(spool, _) => spool.row(cells),
            // Its rows come with those of the source.
            Format::Spliced(_) => Ok(()),
        };
        written.map_err(|error| self.failed(io_error(error)))
    }

    fn failed(&self, source: io::Error) -> Error {
        Error::File {
            path: self.path.clone(),
            source,
        }
    }

    /// Ends the table; a file takes its name now.
    ///
    /// # Errors
    /// [`Error::File`], the system's.
    pub fn finish(self) -> Result<()> {
        let path = self.path;
        let ended = match self.to {
            Format::Csv(csv) => end_csv(csv),
            Format::Parquet(spool, file) => spool.finish(file).map(Some),
            Format::Spliced(splice) => splice.finish().map(Some),
        };
        match ended {
            Ok(Some(file)) => file.commit(),
            Ok(None) => Ok(()),
            Err(source) => Err(Error::File { path, source }),
        }
    }
}

fn csv(to: Sink) -> csv::Writer<Sink> {
    csv::WriterBuilder::new().flexible(true).from_writer(to)
}

/// The system's error as it was, so that its kind can be asked for.
fn io_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(source) => source,
        other => io::Error::other(format!("{other:?}")),
    }
}

/// The file, where the table went to one.
fn end_csv(csv: csv::Writer<Sink>) -> io::Result<Option<AtomicFile>> {
    match csv.into_inner().map_err(|error| error.into_error())? {
        Sink::Stdout(mut out) => out.flush().map(|()| None),
        Sink::File(out) => out
            .into_inner()
            .map(Some)
            .map_err(|error| error.into_error()),
    }
}
