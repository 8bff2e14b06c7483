//! Tables as people have them: CSV in its dialects, Parquet and MATLAB files, row by row through one reader.

mod dialect;
mod format;
mod mat;
mod mat_v5;
mod mat_v73;
mod numbers;
mod parquet;
mod text;

use crate::{Error, Place, Result};
use numbers::Numbers;
pub(crate) use parquet::caught;
use std::path::{Path, PathBuf};
use text::Text;

/// Reads a table with named columns, one row at a time.
///
/// CSV is read as a stream and Parquet by row groups, so that memory does not grow with the file; a
/// MATLAB file is held whole. In a MATLAB file a vector is a column under its own name, and a matrix
/// `M` is the columns `M:1`, `M:2` and so on.
pub struct TableReader {
    path: PathBuf,
    header: Vec<String>,
    source: Source,
    hashed: bool,
}

enum Source {
    Text(Box<Text>),
    Numbers(Numbers),
}

/// A column found by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column(usize);

/// A row of a table as it was read, with decimal points.
#[derive(Debug, Clone, Default)]
pub struct Row(csv::ByteRecord);

impl Row {
    /// Its cells.
    pub fn cells(&self) -> impl Iterator<Item = &[u8]> {
        self.0.iter()
    }
}

impl TableReader {
    /// Opens a file and reads its header; `-` is standard input, for CSV only.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Recording`] for an empty file, a header that cannot be, or a file
    /// that is not of the format it seems to be of.
    pub fn open(path: &Path) -> Result<Self> {
        Self::open_with(path, false)
    }

    /// As [`TableReader::open`], to ask for [`TableReader::sha256`] at the end.
    pub(crate) fn open_hashed(path: &Path) -> Result<Self> {
        Self::open_with(path, true)
    }

    fn open_with(path: &Path, hashed: bool) -> Result<Self> {
        let (header, source) = format::open(path, hashed)?;
        Ok(Self {
            path: path.to_owned(),
            header,
            source,
            hashed,
        })
    }

    /// The file, as it was named.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The columns' names. Asking for a column of a MATLAB file leaves those that are as long.
    #[must_use]
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// Finds a column. In a MATLAB file a matrix `[TimeValues DataValues]` of two columns is found
    /// under its own name as well, and means its data; and the first column found decides how many
    /// rows there are: shorter and longer ones are then left out.
    ///
    /// # Errors
    /// [`Error::Recording`] where there is none of that name, naming those that there are, or two,
    /// or where it is not as long as the first one.
    pub fn column(&mut self, name: &str) -> Result<Column> {
        let mut place = self.place(name)?;
        if let (None, Some([_, data])) = (place, self.pair_at(name)) {
            place = Some(data);
        }
        let Some(place) = place else {
            return Err(self.fault_at(None, None, self.no_column(name)));
        };
        let Source::Numbers(numbers) = &mut self.source else {
            return Ok(Column(place));
        };
        let kept = numbers.keep_as_long_as(place, &mut self.header);
        Ok(Column(kept))
    }

    fn place(&self, name: &str) -> Result<Option<usize>> {
        let mut places = (0..self.header.len()).filter(|&n| self.header[n] == name);
        match (places.next(), places.next()) {
            (_, Some(_)) => {
                Err(self.fault_at(None, None, format!("two columns are called `{name}`")))
            }
            (place, None) => Ok(place),
        }
    }

    fn no_column(&self, name: &str) -> String {
        if let Source::Numbers(numbers) = &self.source
            && let Some((length, expected)) = numbers.left_out(name)
        {
            return format!(
                "`{name}` has {length} values where the column asked for before it has {expected}: \
                 name columns that were sampled together"
            );
        }
        const MOST: usize = 20;
        let names = self.header.iter().take(MOST);
        let names: Vec<String> = names.map(|n| format!("`{}`", shortened(n))).collect();
        let more = match self.header.len().saturating_sub(MOST) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!("no column `{name}`: there are {}{more}", names.join(", "))
    }

    /// Where the two columns of a matrix `[TimeValues DataValues]` are.
    fn pair_at(&self, name: &str) -> Option<[usize; 2]> {
        let at = |n: usize| {
            let name = format!("{name}:{n}");
            self.header.iter().position(|h| *h == name)
        };
        match (&self.source, at(1), at(2), at(3)) {
            (Source::Numbers(numbers), Some(time), Some(data), None) if numbers.has_matrices() => {
                Some([time, data])
            }
            _ => None,
        }
    }

    /// Times and data of a matrix `[TimeValues DataValues]` asked for by its name alone.
    pub(crate) fn pair(&self, name: &str) -> Option<[Vec<f64>; 2]> {
        let at = self.pair_at(name)?;
        match (&self.source, self.header.iter().any(|h| h == name)) {
            (Source::Numbers(numbers), false) => Some(at.map(|at| numbers.held(at).to_vec())),
            _ => None,
        }
    }

    /// Reads the next row; false at the end.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Recording`] for a row with more or fewer cells than the header, or
    /// a part of the file that cannot be read.
    pub fn advance(&mut self) -> Result<bool> {
        match &mut self.source {
            Source::Text(text) => text.advance(self.header.len()),
            Source::Numbers(numbers) => {
                let read = numbers.advance();
                read.map_err(|problem| self.fault(None, problem))
            }
        }
    }

    /// The present row's number in a column; `None` where there is none, or none that is finite.
    #[must_use]
    pub fn value(&self, column: Column) -> Option<f64> {
        let value = match &self.source {
            Source::Text(text) => std::str::from_utf8(text.cell(column.0)).ok()?.parse().ok(),
            Source::Numbers(numbers) => numbers.value(column.0),
        };
        value.filter(|value: &f64| value.is_finite())
    }

    /// The present row's number in a column.
    ///
    /// # Errors
    /// [`Error::Recording`] with its place and column where it is missing or no finite number.
    pub fn number(&self, column: Column) -> Result<f64> {
        self.value(column).ok_or_else(|| {
            let problem = format!("{}: mend or remove the row", self.no_number(column));
            self.fault(Some(column), problem)
        })
    }

    /// What stands in the present row where a number is needed.
    pub(crate) fn no_number(&self, column: Column) -> String {
        let found = match &self.source {
            Source::Text(text) => {
                shortened(std::str::from_utf8(text.cell(column.0)).unwrap_or("\u{fffd}"))
            }
            Source::Numbers(numbers) => numbers
                .value(column.0)
                .map_or(String::new(), |v| v.to_string()),
        };
        let found = match found.is_empty() {
            true => "an empty cell".to_owned(),
            false => format!("`{found}`"),
        };
        format!("{found} where a finite number is needed")
    }

    /// Bytes read so far; of a file of another format than CSV, its size by the share of rows read.
    #[must_use]
    pub fn bytes_read(&self) -> u64 {
        match &self.source {
            Source::Text(text) => text.bytes_read(),
            Source::Numbers(numbers) => numbers.bytes_read(),
        }
    }

    /// The present row, to be written out again.
    pub fn row(&mut self) -> &Row {
        match &mut self.source {
            Source::Text(text) => text.row(),
            Source::Numbers(numbers) => numbers.row(),
        }
    }

    /// The columns in order, whatever their names.
    pub fn columns(&self) -> impl Iterator<Item = Column> + use<> {
        (0..self.header.len()).map(Column)
    }

    /// The unit that a row of units below the header gives a column.
    pub(crate) fn unit(&self, column: Column) -> Option<&str> {
        match &self.source {
            Source::Text(text) => text.unit(column.0),
            Source::Numbers(_) => None,
        }
    }

    /// Where the present row is.
    pub(crate) fn row_place(&self) -> Place {
        match &self.source {
            Source::Text(text) => Place::Line(text.line()),
            Source::Numbers(numbers) => Place::Row(numbers.number_of_row()),
        }
    }

    /// SHA-256 in hexadecimal of the file; to be asked for at the end of the table.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn sha256(self) -> Result<Option<String>> {
        match self.source {
            _ if !self.hashed => Ok(None),
            Source::Text(text) => Ok(text.sha256()),
            Source::Numbers(_) => {
                text::Hashing::file(&self.path)
                    .map(Some)
                    .map_err(|source| Error::File {
                        path: self.path,
                        source,
                    })
            }
        }
    }

    /// An error at the present row.
    #[must_use]
    pub fn fault(&self, column: Option<Column>, problem: String) -> Error {
        let row = match self.row_place() {
            // Before the first row of a file without lines, it is the whole that is meant.
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

/// SHA-256 in hexadecimal of a whole file.
pub(crate) fn file_sha256(path: &Path) -> std::io::Result<String> {
    text::Hashing::file(path)
}

/// At most 40 characters of a text, for a message.
fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
