//! Writes tables row by row, as CSV, Parquet or Arrow, to a file, to standard output or to memory.

use super::added::{Added, AddedCells};
use super::arrow::ArrowCopy;
use super::columnar::{Columnar, ColumnsWriter};
use super::csv::Csv;
use super::sign::is_our_table;
use super::sink::Sink;
use super::splice::Splice;
use super::spool::Spool;
use super::writer::{RowWriter, Rows};
use crate::data::cells::push_row;
use crate::data::table::{Block, Growing, Memory, Needs, TableReader};
use crate::error::{Error, Result};
use hysteron_files::{AtomicFile, Destination, Own, folder_of};
use std::io;
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
    to: To,
    /// The row being written.
    row: Vec<u8>,
}

enum To {
    /// Rows of cells, until their kinds are known: by columns, if the source is not told.
    Spooled(Box<Spool>),
    Rows(Box<dyn RowWriter>),
}

impl To {
    fn writer(&mut self) -> &mut dyn RowWriter {
        match self {
            To::Spooled(spool) => spool.as_mut(),
            To::Rows(writer) => writer.as_mut(),
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
            let csv = Csv::new(Sink::Stdout(io::stdout()));
            return Ok(Self::over(STANDARD_OUTPUT.into(), To::Rows(Box::new(csv))));
        };
        let path = target.path().to_owned();
        let failed = |source| Error::File {
            path: path.clone(),
            source,
        };
        let columnar = format_of(&path).map_err(failed)?;
        let file = Sink::File(AtomicFile::create(target, own)?);
        let to = match columnar {
            None => To::Rows(Box::new(Csv::new(file))),
            Some(format) => {
                let spool = Spool::create_in(folder_of(&path), file, format);
                To::Spooled(Box::new(spool.map_err(failed)?))
            }
        };
        Ok(Self::over(path, to))
    }

    fn over(path: PathBuf, to: To) -> Self {
        Self {
            path,
            to,
            row: Vec::new(),
        }
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
            None => To::Rows(Box::new(Csv::new(memory))),
            Some(format) => To::Spooled(Box::new(Spool::in_memory(account, memory, format))),
        };
        Ok(Self::over(path, to))
    }

    /// Begins a table with the columns of another one, followed by `added`.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn begin(mut self, table: &TableReader, added: &[Added]) -> Result<Self> {
        if let To::Spooled(spool) = self.to {
            self.to = Self::columnar(&self.path, table, added, spool)?;
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
        spool: Box<Spool>,
    ) -> Result<To> {
        let of = |path: &Path| {
            let path = path.to_owned();
            move |source| Error::File { path, source }
        };
        let (from, to) = (of(table.path()), of(path));
        let format = spool.format();
        if format == Columnar::Parquet {
            if let Some(file) = table.pages().map_err(io::Error::other).map_err(from)? {
                let splice = Splice::start(file, spool.unused(), added).map_err(to)?;
                return Ok(To::Rows(Box::new(splice)));
            }
        } else if let Some(batches) = table.batches().map_err(io::Error::other).map_err(from)? {
            let is_stream = format == Columnar::ArrowStream;
            let copy = ArrowCopy::start(batches, spool.unused(), is_stream, added).map_err(to)?;
            return Ok(To::Rows(Box::new(copy)));
        }
        if !table.is_by_columns() {
            return Ok(To::Spooled(spool));
        }
        let columns = ColumnsWriter::of_numbers(spool.unused(), format, table.header(), added);
        Ok(To::Rows(Box::new(columns.map_err(to)?)))
    }

    /// What [`TableWriter::extend_rows`] needs of the source.
    pub(crate) fn needs(&self) -> Needs {
        match &self.to {
            To::Spooled(spool) => spool.needs(),
            To::Rows(writer) => writer.needs(),
        }
    }

    /// Writes `count` rows of the source, followed by more cells: the rows of a block and the cells,
    /// each from a place on.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn extend_rows(
        &mut self,
        block: (&Block, usize),
        cells: (&AddedCells, usize),
        count: usize,
    ) -> Result<()> {
        let rows = Rows {
            block,
            cells,
            count,
        };
        let written = self.to.writer().extended(&rows);
        written.map_err(|source| self.failed(source))
    }

    /// Hands the rows so far on to a reader who may be waiting.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn hand_on(&mut self) -> Result<()> {
        let handed = self.to.writer().hand_on();
        handed.map_err(|source| self.failed(source))
    }

    /// Writes a row of cells. The first row holds the names of the columns.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn row<C: AsRef<[u8]>>(&mut self, cells: impl IntoIterator<Item = C>) -> Result<()> {
        self.row.clear();
        push_row(&mut self.row, cells);
        let written = self.to.writer().row(&self.row);
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
            To::Spooled(spool) => spool.finish(),
            To::Rows(writer) => writer.finish(),
        };
        ended.map_err(|source| Error::File { path, source })
    }
}
