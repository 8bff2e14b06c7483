//! Writes tables row by row, as CSV, Parquet or Arrow, to a file, to standard output or to memory.

use super::added::{Added, AddedCells};
use super::arrow::ArrowCopy;
use super::columnar::{Columnar, ColumnsWriter};
use super::csv::Csv;
use super::sign::is_our_table;
use super::splice::{Original, Splice};
use super::spool::Spool;
use crate::data::table::{Block, Growing, Memory, TableReader};
use crate::error::{Error, Result};
use hysteron_files::{AtomicFile, Destination, Own, folder_of};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The path in errors about standard output.
pub const STANDARD_OUTPUT: &str = "standard output";

/// Writes a table to standard output, or to a file that appears only when it is complete. Memory
/// does not grow with the table.
///
/// The ending of the file's name decides the format: `.parquet` is Parquet; `.arrow` or `.feather` is
/// an Arrow file and `.arrows` an Arrow stream; `.csv`, `.txt`, `.dat` or no ending is CSV; other
/// formats cannot be written.
///
/// If the output and its source are both Parquet, or both Arrow, the columns of the source are
/// copied as stored, with their types. Only the metadata of Apache Arrow (time zone names,
/// dictionaries, durations) are not copied into Parquet. From other sources that store columns, the
/// columns of numbers become doubles. From text, a column of numbers only becomes a column of
/// doubles and any other column becomes text; an empty cell is null. A cell is a number if a double
/// can hold all of it: `007` and 2⁵³ + 1 are text.
pub struct TableWriter {
    path: PathBuf,
    to: Format,
}

enum Format {
    Csv(Csv<Sink>),
    /// Rows of cells, until their kinds are known.
    Spooled(Spool, Sink, Columnar),
    Columns(Box<ColumnsWriter>),
    Spliced(Box<Splice>),
    Arrow(Box<ArrowCopy>),
}

/// What a writer needs of the rows of its source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Needs {
    /// Nothing: it copies them itself.
    Nothing,
    /// Their numbers.
    Numbers,
    /// Their text.
    Text,
}

pub(super) enum Sink {
    Stdout(io::Stdout),
    File(AtomicFile),
    Memory(Growing),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Sink::Stdout(out) => out.write(bytes),
            Sink::File(out) => out.write(bytes),
            Sink::Memory(out) => out.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Sink::Stdout(out) => out.flush(),
            Sink::File(out) => out.flush(),
            Sink::Memory(_) => Ok(()),
        }
    }
}

/// The format of a table with this name; `None` for CSV.
fn format_of(path: &Path) -> io::Result<Option<Columnar>> {
    // The name of a pipe or of `/dev/null` does not decide the format.
    match path.metadata().is_ok_and(|there| !there.is_file()) {
        true => Ok(by_ending(path).unwrap_or(None)),
        false => by_ending(path),
    }
}

/// The format that the ending of a name says; `None` for CSV.
fn by_ending(path: &Path) -> io::Result<Option<Columnar>> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        None | Some("csv" | "txt" | "dat") => Ok(None),
        Some("parquet") => Ok(Some(Columnar::Parquet)),
        Some("arrow" | "feather") => Ok(Some(Columnar::Arrow)),
        Some("arrows") => Ok(Some(Columnar::ArrowStream)),
        Some(other) => Err(io::Error::other(format!(
            "a table cannot be written as `.{other}`: let the name end with .csv, .parquet or .arrow"
        ))),
    }
}

impl TableWriter {
    /// A table with columns that a command adds. It goes to `target`, or to standard output if
    /// `target` is `None` or `-`.
    ///
    /// # Errors
    /// [`Error::File`], also for a name with the ending of a format that cannot be written.
    pub fn create(target: Option<Destination<'_>>) -> Result<Self> {
        Self::start(target, Own::Marked(is_our_table))
    }

    /// As [`TableWriter::create`], for a table without added columns. An existing CSV table of this
    /// kind cannot be recognised as ours.
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
                to: Format::Csv(Csv::new(Sink::Stdout(io::stdout()))),
            });
        };
        let path = target.path().to_owned();
        let failed = |source| Error::File {
            path: path.clone(),
            source,
        };
        let columnar = format_of(&path).map_err(failed)?;
        let file = AtomicFile::create(target, own)?;
        let to = match columnar {
            None => Format::Csv(Csv::new(Sink::File(file))),
            Some(format) => {
                let spool = Spool::create_in(folder_of(&path)).map_err(failed)?;
                Format::Spooled(spool, Sink::File(file), format)
            }
        };
        Ok(Self { path, to })
    }

    /// A table in memory, within an account, in the format that the ending of `name` decides. No file
    /// is touched.
    ///
    /// ```
    /// use hysteron::{Memory, TableWriter};
    /// let mut table = TableWriter::in_memory("run.csv", &Memory::new(1 << 20))?;
    /// table.row(["temperature [degC]", "lift"])?;
    /// table.row(["20", "0.5"])?;
    /// assert_eq!(table.into_bytes()?, b"temperature [degC],lift\n20,0.5\n");
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`] for a name with the ending of a format that cannot be written.
    pub fn in_memory(name: &str, account: &Memory) -> Result<Self> {
        let path = PathBuf::from(name);
        let columnar = by_ending(&path).map_err(|source| Error::File {
            path: path.clone(),
            source,
        })?;
        let memory = Sink::Memory(Growing::new(account));
        let to = match columnar {
            None => Format::Csv(Csv::new(memory)),
            Some(format) => Format::Spooled(Spool::in_memory(account), memory, format),
        };
        Ok(Self { path, to })
    }

    /// Begins a table with the columns of another one, followed by `added`.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn begin(mut self, table: &TableReader, added: &[Added]) -> Result<Self> {
        if let Format::Spooled(spool, sink, format) = self.to {
            self.to = Self::columnar(&self.path, table, added, (spool, sink, format))?;
        }
        let names = added.iter().map(|column| column.name().to_owned());
        self.row(table.header().iter().cloned().chain(names))?;
        Ok(self)
    }

    /// A table by columns: copied as it is stored, if source and target are of one format, or
    /// written from the numbers of a source that is stored by columns.
    fn columnar(
        path: &Path,
        table: &TableReader,
        added: &[Added],
        (spool, sink, format): (Spool, Sink, Columnar),
    ) -> Result<Format> {
        let of = |path: &Path, source| Error::File {
            path: path.to_owned(),
            source,
        };
        if format == Columnar::Parquet {
            let original = Original::open(table);
            if let Some(original) = original.map_err(|source| of(table.path(), source))? {
                let splice = Splice::start(original, sink, added);
                let splice = splice.map_err(|source| of(path, source))?;
                return Ok(Format::Spliced(Box::new(splice)));
            }
        } else {
            let batches = table.batches().map_err(io::Error::other);
            if let Some(batches) = batches.map_err(|source| of(table.path(), source))? {
                let is_stream = format == Columnar::ArrowStream;
                let copy = ArrowCopy::start(batches, sink, is_stream, added);
                return Ok(Format::Arrow(Box::new(
                    copy.map_err(|source| of(path, source))?,
                )));
            }
        }
        if !table.is_by_columns() {
            return Ok(Format::Spooled(spool, sink, format));
        }
        let columns = ColumnsWriter::of_numbers(sink, format, table.header(), added);
        Ok(Format::Columns(Box::new(
            columns.map_err(|source| of(path, source))?,
        )))
    }

    /// What [`TableWriter::extend_rows`] needs of the source.
    pub(crate) fn needs(&self) -> Needs {
        match self.to {
            Format::Csv(_) | Format::Spooled(..) => Needs::Text,
            Format::Columns(_) => Needs::Numbers,
            Format::Spliced(_) | Format::Arrow(_) => Needs::Nothing,
        }
    }

    /// Writes `count` rows of the source, followed by more cells: the rows of a block and the cells,
    /// each from a place on.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn extend_rows(
        &mut self,
        rows: (&Block, usize),
        cells: (&AddedCells, usize),
        count: usize,
    ) -> Result<()> {
        let written = match &mut self.to {
            Format::Csv(csv) => csv.extended(rows, cells, count),
            Format::Spooled(spool, ..) => spool.extended(rows, cells, count),
            Format::Columns(columns) => columns.extended(rows, cells, count),
            Format::Spliced(splice) => splice.rows(cells, count),
            Format::Arrow(copy) => copy.rows(cells, count),
        };
        written.map_err(|source| self.failed(source))
    }

    /// Hands the rows so far on to a reader who may be waiting.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn hand_on(&mut self) -> Result<()> {
        match &mut self.to {
            Format::Csv(csv) => csv.hand_on().map_err(|source| self.failed(source)),
            _ => Ok(()),
        }
    }

    /// Writes a row of cells. The first row holds the names of the columns.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn row<C: AsRef<[u8]>>(&mut self, cells: impl IntoIterator<Item = C>) -> Result<()> {
        let written = match &mut self.to {
            Format::Csv(csv) => csv.row(cells),
            Format::Spooled(spool, ..) => spool.row(cells),
            // The header is there since the beginning.
            Format::Columns(_) | Format::Spliced(_) | Format::Arrow(_) => Ok(()),
        };
        written.map_err(|source| self.failed(source))
    }

    fn failed(&self, source: io::Error) -> Error {
        Error::File {
            path: self.path.clone(),
            source,
        }
    }

    /// Ends the table and gives a file its name.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn finish(self) -> Result<()> {
        match self.end()? {
            Some(Sink::File(file)) => Ok(file.commit()?),
            Some(Sink::Stdout(_) | Sink::Memory(_)) | None => Ok(()),
        }
    }

    /// Ends a table in memory; empty for any other.
    ///
    /// # Errors
    /// [`Error::File`], as for two columns of one name in Parquet.
    pub fn into_bytes(self) -> Result<Vec<u8>> {
        match self.end()? {
            Some(Sink::Memory(bytes)) => Ok(bytes.into_bytes()),
            Some(Sink::Stdout(_) | Sink::File(_)) | None => Ok(Vec::new()),
        }
    }

    fn end(self) -> Result<Option<Sink>> {
        let path = self.path;
        let ended = match self.to {
            Format::Csv(csv) => csv.finish(),
            Format::Spooled(spool, to, format) => spool.finish(to, format).map(Some),
            Format::Columns(columns) => columns.finish().map(Some),
            Format::Spliced(splice) => splice.finish().map(Some),
            Format::Arrow(copy) => copy.finish().map(Some),
        };
        ended.map_err(|source| Error::File { path, source })
    }
}
