//! Tables in CSV files, read row by row so that memory does not grow with the file.

use crate::{Error, Result};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Reads a CSV file with a header row, one row at a time.
pub struct TableReader {
    path: PathBuf,
    header: Vec<String>,
    csv: csv::Reader<Hashing>,
    row: Row,
    line: u64,
}

/// A column found by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column(usize);

/// A row of a table as it was read.
#[derive(Debug, Clone)]
pub struct Row(csv::ByteRecord);

impl Row {
    /// Its cells.
    pub fn cells(&self) -> impl Iterator<Item = &[u8]> {
        self.0.iter()
    }
}

impl TableReader {
    /// Opens a file and reads its header; `-` is standard input.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Recording`] for an empty file or a header that cannot be.
    pub fn open(path: &Path) -> Result<Self> {
        Self::open_with(path, None)
    }

    /// As [`TableReader::open`], to ask for [`TableReader::sha256`] at the end.
    pub(crate) fn open_hashed(path: &Path) -> Result<Self> {
        Self::open_with(path, Some(Sha256::new()))
    }

    fn open_with(path: &Path, digest: Option<Sha256>) -> Result<Self> {
        let file: Box<dyn Read> = if path == Path::new("-") {
            Box::new(std::io::stdin())
        } else {
            let file = File::open(path).and_then(|file| match file.metadata()?.is_dir() {
                true => Err(std::io::Error::other(
                    "this is a folder: name a CSV file in it",
                )),
                false => Ok(file),
            });
            Box::new(file.map_err(|source| Error::File {
                path: path.to_owned(),
                source,
            })?)
        };
        let csv = csv::ReaderBuilder::new()
            .flexible(true) // ragged rows are reported here, with their line and what to do
            .buffer_capacity(1 << 16)
            .from_reader(Hashing {
                file,
                digest,
                quotes: 0,
            });
        let mut reader = Self {
            path: path.to_owned(),
            header: Vec::new(),
            csv,
            row: Row(csv::ByteRecord::new()),
            line: 1,
        };
        let header = match reader.csv.headers() {
            Ok(header) => header.clone(),
            Err(error) => return Err(reader.csv_fault(error)),
        };
        // A byte order mark would hide the first column's name.
        let clean = |name: &str| name.trim_start_matches('\u{feff}').trim().to_owned();
        reader.header = header.iter().map(clean).collect();
        if reader.header.iter().all(String::is_empty) {
            return Err(reader.fault(
                None,
                "the file is empty: a header row with the columns' names is needed".into(),
            ));
        }
        if reader.header.iter().all(|name| name.parse::<f64>().is_ok()) {
            return Err(reader.fault(
                None,
                "the first row holds numbers: put a header row with the columns' names above it"
                    .into(),
            ));
        }
        Ok(reader)
    }

    /// The columns' names.
    #[must_use]
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// Finds a column.
    ///
    /// # Errors
    /// [`Error::Recording`] where there is none of that name, naming those that there are, or two.
    pub fn column(&self, name: &str) -> Result<Column> {
        let mut places = (0..self.header.len()).filter(|&n| self.header[n] == name);
        match (places.next(), places.next()) {
            (Some(place), None) => Ok(Column(place)),
            (Some(_), Some(_)) => Err(self.fault(None, format!("two columns are called `{name}`"))),
            (None, _) => {
                let names: Vec<String> = self
                    .header
                    .iter()
                    .map(|n| format!("`{}`", shortened(n)))
                    .collect();
                let mut problem = format!("no column `{name}`: there are {}", names.join(", "));
                if let ([only], true) = (&self.header[..], self.header[0].contains([';', '\t'])) {
                    let separator = if only.contains(';') {
                        "semicolons"
                    } else {
                        "tabs"
                    };
                    problem += &format!("; separate the columns by commas, not {separator}");
                }
                Err(self.fault(None, problem))
            }
        }
    }

    /// Reads the next row; false at the end.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Recording`] for a row with more or fewer cells than the header.
    pub fn advance(&mut self) -> Result<bool> {
        match self.csv.read_byte_record(&mut self.row.0) {
            Ok(false) if self.csv.get_ref().quotes % 2 == 1 => {
                // The last row read is the one that goes on to the end of the file.
                return Err(Error::Recording {
                    path: Some(self.path.clone()),
                    row: Some(self.line),
                    column: None,
                    problem: "a quote is opened here and never closed".into(),
                });
            }
            Ok(false) => return Ok(false),
            Ok(true) => {}
            Err(error) => return Err(self.csv_fault(error)),
        }
        self.line = self
            .row
            .0
            .position()
            .map_or(self.line + 1, csv::Position::line);
        let (found, expected) = (self.row.0.len(), self.header.len());
        if found != expected {
            let problem = format!(
                "{found} cells where the header has {expected}: give every row as many, separated by commas"
            );
            return Err(self.fault(None, problem));
        }
        Ok(true)
    }

    /// The present row's number in a column.
    ///
    /// # Errors
    /// [`Error::Recording`] with line and column where it is empty or no finite number.
    pub fn number(&self, column: Column) -> Result<f64> {
        let cell = self.row.0.get(column.0).unwrap_or_default().trim_ascii();
        let text = std::str::from_utf8(cell).unwrap_or("\u{fffd}");
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => {
                let what = if text.is_empty() {
                    "an empty cell".to_owned()
                } else {
                    format!("`{}`", shortened(text))
                };
                let problem =
                    format!("{what} where a finite number is needed: mend or remove the row");
                Err(self.fault(Some(column), problem))
            }
        }
    }

    /// Bytes read so far.
    #[must_use]
    pub fn bytes_read(&self) -> u64 {
        self.csv.position().byte()
    }

    /// The present row, to be written out again.
    #[must_use]
    pub fn row(&self) -> &Row {
        &self.row
    }

    /// The columns in order, whatever their names.
    pub fn columns(&self) -> impl Iterator<Item = Column> + use<> {
        (0..self.header.len()).map(Column)
    }

    /// SHA-256 in hexadecimal of what was read; to be asked for at the end of the table.
    pub(crate) fn sha256(self) -> Option<String> {
        let digest = self.csv.into_inner().digest?;
        Some(
            digest
                .finalize()
                .iter()
                .map(|byte| format!("{byte:02x}"))
                .collect(),
        )
    }

    /// An error at the present row.
    #[must_use]
    pub fn fault(&self, column: Option<Column>, problem: String) -> Error {
        Error::Recording {
            path: Some(self.path.clone()),
            row: Some(self.line_of_row().unwrap_or(self.line)),
            column: column.map(|column| self.header[column.0].clone()),
            problem,
        }
    }

    /// The line that the present row begins on, counted in the file itself: the parser leaves the end
    /// of a line, and blank lines, to the row after them. `None` where the file cannot be read again.
    fn line_of_row(&self) -> Option<u64> {
        let start = self.row.0.position()?.byte();
        if !std::fs::metadata(&self.path).ok()?.is_file() {
            return None;
        }
        let mut bytes = std::io::BufReader::new(File::open(&self.path).ok()?).bytes();
        let mut line = 1;
        for _ in 0..start {
            line += u64::from(bytes.next()?.ok()? == b'\n');
        }
        while let Some(Ok(byte @ (b'\r' | b'\n'))) = bytes.next() {
            line += u64::from(byte == b'\n');
        }
        Some(line)
    }

    fn csv_fault(&self, error: csv::Error) -> Error {
        let row = error.position().map(csv::Position::line);
        match error.into_kind() {
            csv::ErrorKind::Io(source) => Error::File {
                path: self.path.clone(),
                source,
            },
            csv::ErrorKind::Utf8 { err, .. } => Error::Recording {
                path: Some(self.path.clone()),
                row,
                column: self.header.get(err.field()).cloned(),
                problem: "the text is not UTF-8: save the file as UTF-8 CSV".into(),
            },
            other => Error::Recording {
                path: Some(self.path.clone()),
                row,
                column: None,
                problem: format!("{other:?}"),
            },
        }
    }
}

/// At most 40 characters of a text, for a message.
fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// Hashes what passes through, where asked to: a file is read once only, and may be a pipe.
struct Hashing {
    file: Box<dyn Read>,
    digest: Option<Sha256>,
    /// Quotation marks so far: they come in pairs.
    quotes: usize,
}

impl Read for Hashing {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.quotes += buffer[..count].iter().filter(|byte| **byte == b'"').count();
        if let Some(digest) = &mut self.digest {
            digest.update(&buffer[..count]);
        }
        Ok(count)
    }
}
