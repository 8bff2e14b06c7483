//! Writes tables row by row, as CSV or Parquet, to a file, to standard output or to memory.

use super::added::{Added, AddedCells};
use super::csv::Csv;
use super::destination::folder_of;
use super::sign::is_our_table;
use super::splice::{Original, Splice};
use super::spool::Spool;
use super::{AtomicFile, Destination, Own};
use crate::data::table::{Block, TableReader};
use crate::error::{Error, Result};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The path in errors about standard output.
pub const STANDARD_OUTPUT: &str = "standard output";

/// Writes a table to standard output, or to a file that appears only when it is complete. Memory
/// does not grow with the table.
///
/// The ending of the file's name decides the format: `.parquet` is Parquet; `.csv`, `.txt`, `.dat`
/// or no ending is CSV; other formats cannot be written.
///
/// If the output and its source are both Parquet, the columns of the source are copied as stored,
/// with their types. Only the metadata of Apache Arrow (time zone names, dictionaries, durations)
/// are not copied. From other sources, a column of numbers only becomes a column of doubles and any
/// other column becomes text; an empty cell is null. A cell is a number if a double can hold all of
/// it: `007` and 2⁵³ + 1 are text.
pub struct TableWriter {
    path: PathBuf,
    to: Format,
}

enum Format {
    Csv(Csv<Sink>),
    Parquet(Spool, Sink),
    Spliced(Box<Splice>),
}

pub(super) enum Sink {
    Stdout(io::Stdout),
    File(AtomicFile),
    Memory(Vec<u8>),
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

/// Whether a table with this name is Parquet.
fn is_parquet(path: &Path) -> io::Result<bool> {
    // The name of a pipe or of `/dev/null` does not decide the format.
    match path.metadata().is_ok_and(|there| !there.is_file()) {
        true => Ok(by_ending(path).unwrap_or(false)),
        false => by_ending(path),
    }
}

/// Whether the ending of a name is that of Parquet.
fn by_ending(path: &Path) -> io::Result<bool> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        None | Some("csv" | "txt" | "dat") => Ok(false),
        Some("parquet") => Ok(true),
        Some(other) => Err(io::Error::other(format!(
            "a table cannot be written as `.{other}`: let the name end with .csv or .parquet"
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
        let parquet = is_parquet(&path).map_err(failed)?;
        let file = AtomicFile::create(target, own)?;
        let to = match parquet {
            false => Format::Csv(Csv::new(Sink::File(file))),
            true => {
                let spool = Spool::create_in(folder_of(&path)).map_err(failed)?;
                Format::Parquet(spool, Sink::File(file))
            }
        };
        Ok(Self { path, to })
    }

    /// A table in memory, in the format that the ending of `name` decides. No file is touched.
    ///
    /// ```
    /// use hysteron::TableWriter;
    /// let mut table = TableWriter::in_memory("run.csv")?;
    /// table.row(["temperature [degC]", "lift"])?;
    /// table.row(["20", "0.5"])?;
    /// assert_eq!(table.into_bytes()?, b"temperature [degC],lift\n20,0.5\n");
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`] for a name with the ending of a format that cannot be written.
    pub fn in_memory(name: &str) -> Result<Self> {
        let path = PathBuf::from(name);
        let parquet = by_ending(&path).map_err(|source| Error::File {
            path: path.clone(),
            source,
        })?;
        let memory = Sink::Memory(Vec::new());
        let to = match parquet {
            false => Format::Csv(Csv::new(memory)),
            true => Format::Parquet(Spool::in_memory(), memory),
        };
        Ok(Self { path, to })
    }

    /// Begins a table with the columns of another one, followed by `added`.
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

    /// Whether the rows of the source are copied as they are stored, so that only added cells are
    /// needed.
    pub(crate) fn copies(&self) -> bool {
        matches!(self.to, Format::Spliced(_))
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
            Format::Parquet(spool, _) => spool.extended(rows, cells, count),
            Format::Spliced(splice) => splice.rows(cells, count),
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
            Format::Parquet(..) | Format::Spliced(_) => Ok(()),
        }
    }

    /// Writes a row of cells. The first row holds the names of the columns.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn row<C: AsRef<[u8]>>(&mut self, cells: impl IntoIterator<Item = C>) -> Result<()> {
        let written = match &mut self.to {
            Format::Csv(csv) => csv.row(cells),
            Format::Parquet(spool, _) => spool.row(cells),
            // The stored columns already contain the source's header.
            Format::Spliced(_) => Ok(()),
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
            Some(Sink::File(file)) => file.commit(),
            Some(Sink::Stdout(_) | Sink::Memory(_)) | None => Ok(()),
        }
    }

    /// Ends a table in memory; empty for any other.
    ///
    /// # Errors
    /// [`Error::File`], as for two columns of one name in Parquet.
    pub fn into_bytes(self) -> Result<Vec<u8>> {
        match self.end()? {
            Some(Sink::Memory(bytes)) => Ok(bytes),
            Some(Sink::Stdout(_) | Sink::File(_)) | None => Ok(Vec::new()),
        }
    }

    fn end(self) -> Result<Option<Sink>> {
        let path = self.path;
        let ended = match self.to {
            Format::Csv(csv) => csv.finish(),
            Format::Parquet(spool, to) => spool.finish(to).map(Some),
            Format::Spliced(splice) => splice.finish().map(Some),
        };
        ended.map_err(|source| Error::File { path, source })
    }
}
