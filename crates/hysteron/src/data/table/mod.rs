//! Reads tables row by row through one reader: CSV in its dialects, Parquet, Arrow and MATLAB files.
//!
//! `format` detects the format; `text` reads text, and `parquet`, `arrow` and `mat` what is `stored`
//! by columns, each behind one trait. `columns` and `names` find columns, `time` converts times to
//! seconds, and `clock` reads timestamps. `numbers` holds stored columns in memory, within the limit
//! of `budget`. `block` reads many rows at once. `remark` reports assumptions, `options` are the
//! settings. `quiet` turns panics of libraries into errors. `labels` is the column whose text tells which recording a row belongs to.

mod arrow;
mod block;
mod budget;
mod clock;
mod columns;
mod format;
mod labels;
mod machine;
mod mat;
mod names;
mod numbers;
mod options;
mod parquet;
mod quiet;
mod remark;
mod stored;
mod text;
mod time;
mod wanted;

pub use budget::{Budget, Growing, Memory};
pub use options::ReadOptions;
pub use remark::Remark;

pub(in crate::data) use arrow::{Batches, FILE as ARROW_FILE, caught as arrow_caught};
pub(crate) use block::{Block, Needs};
pub(crate) use clock::is_timestamp;
pub(crate) use labels::Label;

use crate::data::recording::Places;
use crate::data::recording::Repair;
use crate::error::{Error, Place, Result};
use bytes::Bytes;
use hysteron_files::Hash;
use numbers::Numbers;
pub(crate) use parquet::caught;
pub(in crate::data) use parquet::{MARK as PARQUET_FILE, Pages};
use std::path::{Path, PathBuf};
pub(in crate::data) use text::Splitter;
use text::Text;
use time::Time;
use wanted::Wanted;

/// Reads a table with named columns, one row at a time.
///
/// CSV is read as a stream, Parquet and Arrow by their parts, so memory does not grow with the file. A
/// MATLAB file is held in memory as a whole. There a vector is a column under its own name, and a
/// matrix `M` is the columns `M:1`, `M:2` and so on.
pub struct TableReader {
    path: PathBuf,
    /// The bytes of the file, if they are in memory. Then the path is only a name.
    held: Option<Bytes>,
    header: Vec<String>,
    source: Source,
    hash: Option<Hash>,
    budget: Budget,
    /// What was assumed about the columns asked for.
    remarks: Vec<Remark>,
    /// The column of time.
    time: Option<(usize, Time)>,
    /// The texts of a column of labels that is stored as numbers.
    labels: Option<labels::Labels>,
    /// The columns of numbers that are read.
    wanted: Wanted,
    /// An error that comes after the last block.
    late: Option<Error>,
}

enum Source {
    Text(Box<Text>),
    Numbers(Numbers),
}

/// A column that was found by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column(usize);

impl Column {
    /// Its index in the header, from 0.
    pub(crate) fn place(self) -> usize {
        self.0
    }
}

/// A row of a table as it was read, with decimal points.
#[derive(Debug, Clone, Default)]
pub struct Row(csv::ByteRecord);

impl Row {
    /// Its cells.
    pub fn cells(&self) -> impl Iterator<Item = &[u8]> {
        self.0.iter()
    }

    /// The approximate memory that it takes, in bytes.
    pub(crate) fn size(&self) -> usize {
        self.0.as_slice().len() + (self.0.len() + 16) * size_of::<usize>()
    }
}

impl TableReader {
    /// Opens a file and reads its header. The path `-` is standard input, for text only.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Recording`] for an empty file, an invalid header, a file that is
    /// not of the format that it seems to be, or one that needs more memory than
    /// [`ReadOptions::usual_memory`].
    pub fn open(path: &Path) -> Result<Self> {
        Self::open_with(path, ReadOptions::usual_memory())
    }

    /// As [`TableReader::open`], with a limit for the contents of the file: a number of bytes, or an
    /// account that others draw from, too.
    ///
    /// # Errors
    /// As [`TableReader::open`].
    pub fn open_with(path: &Path, memory: impl Into<Memory>) -> Result<Self> {
        Self::open_as(path, None, &memory.into(), None, None, None)
    }

    /// As [`TableReader::open_with`], for the bytes of a file. The ending of `name` counts as that
    /// of a path, and errors name it. No file is touched.
    ///
    /// ```
    /// let mut table = hysteron::TableReader::from_bytes("run.csv", "T;lift\n20;0\n80;14\n", 1 << 20)?;
    /// assert_eq!(table.header(), ["T", "lift"]);
    /// assert_eq!(hysteron::inspect_table(&mut table)?.rows, 2);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`TableReader::open`].
    pub fn from_bytes(
        name: &str,
        bytes: impl Into<Bytes>,
        memory: impl Into<Memory>,
    ) -> Result<Self> {
        let held = Some(bytes.into());
        Self::open_as(Path::new(name), held, &memory.into(), None, None, None)
    }

    /// As [`TableReader::open`], for a recording: computes the hash for [`TableReader::sha256`],
    /// and takes what is done with bad rows.
    pub(crate) fn open_recording(
        path: &Path,
        held: Option<Bytes>,
        repair: Repair,
        memory: &Memory,
    ) -> Result<Self> {
        let (repair, hash) = (Some(repair), Some(Hash::default()));
        Self::open_as(path, held, memory, repair, hash, None)
    }

    /// As [`TableReader::open`], for a table of several recordings, told apart by the column
    /// `label`. Rows of another length than the header are dropped:
    /// [`TableReader::take_ragged`] tells them.
    pub(crate) fn open_labelled(path: &Path, max_memory: u64, label: &str) -> Result<Self> {
        let labels = labels::Labels::new(label);
        let repair = Some(Repair::Mend);
        Self::open_as(path, None, &max_memory.into(), repair, None, Some(labels))
    }

    fn open_as(
        path: &Path,
        held: Option<Bytes>,
        memory: &Memory,
        repair: Option<Repair>,
        hash: Option<Hash>,
        labels: Option<labels::Labels>,
    ) -> Result<Self> {
        let mut budget = Budget::of(memory);
        let wanted = Wanted::default();
        let (header, source) = format::open(
            path,
            held.as_ref(),
            repair,
            hash.clone(),
            (labels.as_ref(), &wanted),
            &mut budget,
        )?;
        Ok(Self {
            path: path.to_owned(),
            held,
            header,
            source,
            hash,
            budget,
            remarks: Vec::new(),
            time: None,
            labels,
            wanted,
            late: None,
        })
    }

    /// The path of the file, as given.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// What was assumed while the file was read, for a message. The list is complete at the end of
    /// the table.
    pub fn remarks(&self) -> impl Iterator<Item = &Remark> {
        let of_text: &[Remark] = match &self.source {
            Source::Text(text) => text.remarks(),
            Source::Numbers(_) => &[],
        };
        of_text.iter().chain(&self.remarks)
    }

    fn stored(&self) -> stored::Stored<'_> {
        stored::Stored {
            path: &self.path,
            held: self.held.as_ref(),
        }
    }

    pub(crate) fn budget(&mut self) -> &mut Budget {
        &mut self.budget
    }

    /// The rows that were dropped because they have more or fewer cells than the header.
    pub(crate) fn ragged(&self) -> Places {
        match &self.source {
            Source::Text(text) => text.ragged().clone(),
            Source::Numbers(_) => Places::default(),
        }
    }

    /// As [`TableReader::ragged`], and forgets them.
    pub(crate) fn take_ragged(&mut self) -> Places {
        match &mut self.source {
            Source::Text(text) => text.take_ragged(),
            Source::Numbers(_) => Places::default(),
        }
    }

    /// The names of the columns. In a MATLAB file, asking for a column removes all columns of
    /// another length.
    #[must_use]
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// Reads the next row; false at the end.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Recording`] for a row with more or fewer cells than the header, or
    /// a part of the file that cannot be read.
    pub fn advance(&mut self) -> Result<bool> {
        let more = match &mut self.source {
            Source::Text(text) => text.advance(&self.header)?,
            Source::Numbers(numbers) => {
                let read = numbers.advance();
                read.map_err(|problem| self.fault(None, problem))?
            }
        };
        if more && self.time.is_some() {
            self.read_time()?;
        }
        Ok(more)
    }

    /// The current row's number in a column; `None` if there is no finite number.
    #[must_use]
    pub fn value(&self, column: Column) -> Option<f64> {
        let value = match &self.source {
            Source::Text(_) => self.text(column).and_then(|cell| cell.parse().ok()),
            Source::Numbers(numbers) => numbers.value(column.0),
        };
        let value = match &self.time {
            Some((at, time)) if *at == column.0 => time.in_seconds(value),
            _ => value,
        };
        value.filter(|value: &f64| value.is_finite())
    }

    /// The current row's number in a column.
    ///
    /// # Errors
    /// [`Error::Recording`] with position and column if there is no finite number.
    pub fn number(&self, column: Column) -> Result<f64> {
        self.value(column).ok_or_else(|| {
            let problem = format!("{}: mend or remove the row", self.no_number(column));
            self.fault(Some(column), problem)
        })
    }

    /// The current row's cell in a column of a text.
    pub(crate) fn text(&self, column: Column) -> Option<&str> {
        match &self.source {
            Source::Text(text) => std::str::from_utf8(text.cell(column.0)).ok(),
            Source::Numbers(_) => None,
        }
    }

    /// Describes the cell of the current row where a number is needed.
    pub(crate) fn no_number(&self, column: Column) -> String {
        let found = match &self.source {
            Source::Text(_) => shortened(self.text(column).unwrap_or("\u{fffd}")),
            Source::Numbers(numbers) => numbers
                .value(column.0)
                .map_or(String::new(), |v| v.to_string()),
        };
        let found = match found.is_empty() {
            true => "an empty cell".to_owned(),
            false => format!("`{found}`"),
        };
        let needed = match &self.time {
            Some((at, Time::Stamps(..))) if *at == column.0 => "a timestamp as in the rows before",
            _ => "a finite number",
        };
        format!("{found} where {needed} is needed")
    }

    /// Number of bytes read so far. For formats other than CSV, the file size times the share of
    /// rows read.
    #[must_use]
    pub fn bytes_read(&self) -> u64 {
        match &self.source {
            Source::Text(text) => text.bytes_read(),
            Source::Numbers(numbers) => numbers.bytes_read(),
        }
    }

    /// The current row, to be written again.
    pub fn row(&mut self) -> &Row {
        match &mut self.source {
            Source::Text(text) => text.row(),
            Source::Numbers(numbers) => numbers.row(),
        }
    }

    /// All columns in order.
    pub fn columns(&self) -> impl Iterator<Item = Column> + use<> {
        (0..self.header.len()).map(Column)
    }

    /// The unit that a row of units below the header gives for a column.
    pub(crate) fn unit(&self, column: Column) -> Option<&str> {
        match &self.source {
            Source::Text(text) => text.unit(column.0),
            Source::Numbers(numbers) => numbers.unit(column.0),
        }
    }

    /// Position of the current row.
    pub(crate) fn row_place(&self) -> Place {
        match &self.source {
            Source::Text(text) => Place::Line(text.line()),
            Source::Numbers(numbers) => Place::Row(numbers.number_of_row()),
        }
    }

    /// SHA-256 of the file in hexadecimal. Valid at the end of the table.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn sha256(self) -> Result<Option<String>> {
        match (self.hash, self.source) {
            (None, _) => Ok(None),
            (Some(hash), Source::Text(_)) => Ok(Some(hash.finish())),
            (Some(_), Source::Numbers(_)) => {
                if let Some(bytes) = &self.held {
                    return Ok(Some(Hash::bytes(bytes)));
                }
                Hash::file(&self.path)
                    .map(Some)
                    .map_err(|source| Error::File {
                        path: self.path,
                        source,
                    })
            }
        }
    }

    /// An error at the current row.
    #[must_use]
    pub fn fault(&self, column: Option<Column>, problem: String) -> Error {
        let row = match self.row_place() {
            // Before the first row of a file without lines, the error concerns the whole file.
            Place::Row(0) => None,
            place => Some(place),
        };
        self.fault_at(row, column, problem)
    }

    /// An error at another row.
    pub(crate) fn fault_at(
        &self,
        row: Option<Place>,
        column: Option<Column>,
        problem: String,
    ) -> Error {
        Error::Recording {
            path: Some(self.path.clone()),
            row,
            column: column.map(|column| self.header[column.0].clone()),
            problem,
        }
    }
}

/// A text shortened to at most 40 characters, for a message.
fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
