//! CSV, line by line.

use super::Row;
use super::dialect::{self, Dialect};
use crate::{Error, Place, Result};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{BufRead, BufReader, Chain, Cursor, Read};
use std::path::{Path, PathBuf};

/// A line longer than this is none of a table of numbers, and a quoted cell that goes on for longer is not closed.
const LONGEST: u64 = 1 << 22;

/// The rows of a CSV file.
pub(super) struct Text {
    path: PathBuf,
    lines: BufReader<Chain<Cursor<Vec<u8>>, Hashing>>,
    dialect: Dialect,
    units: Vec<String>,
    row: Row,
    /// The row as it stands in the file.
    raw: Vec<u8>,
    /// The line that the row begins on, and how many it has.
    line: u64,
    height: u64,
    bytes: u64,
    /// Whether the row is still to be given out, because it was read in search of the header.
    held: bool,
}

impl Text {
    /// The header, and the rows below it.
    pub(super) fn open(
        path: &Path,
        file: Chain<Cursor<Vec<u8>>, Hashing>,
        dialect: Dialect,
    ) -> Result<(Vec<String>, Self)> {
        let mut text = Self {
            path: path.to_owned(),
            lines: BufReader::with_capacity(1 << 16, file),
            dialect,
            units: Vec::new(),
            row: Row::default(),
            raw: Vec::new(),
            line: 1,
            height: 0,
            bytes: 0,
            held: false,
        };
        let mut comment = Vec::new();
        if !text.read(Some(&mut comment))? {
            return Err(text.fault(
                "the file is empty: a header row with the columns' names is needed".into(),
            ));
        }
        let mut header = text.names()?;
        if header.iter().all(String::is_empty) {
            return Err(text.fault(
                "the file is empty: a header row with the columns' names is needed".into(),
            ));
        }
        if header.iter().all(|name| name.parse::<f64>().is_ok()) {
            // As NumPy writes it, the header is the comment just above the numbers.
            let (first, cells) = (text.row.clone(), header.len());
            text.split(&comment);
            header = text.names().unwrap_or_default();
            text.row = first;
            if header.len() != cells || header.iter().any(String::is_empty) {
                return Err(text.fault(
                    "the first row holds numbers: put a header row with the columns' names above it"
                        .into(),
                ));
            }
            text.held = true;
        } else if dialect.units {
            text.read(None)?;
            let bare = |cell: String| {
                let inner = [('[', ']'), ('(', ')')]
                    .into_iter()
                    .find_map(|(open, close)| {
                        cell.strip_prefix(open)?.strip_suffix(close).map(str::trim)
                    });
                inner.map(str::to_owned).unwrap_or(cell)
            };
            text.units = text.names()?.into_iter().map(bare).collect();
        }
        Ok((header, text))
    }

    /// Reads the next row that is neither blank nor a comment; false at the end. The last comment
    /// is left in `comment`, without its mark.
    fn read(&mut self, mut comment: Option<&mut Vec<u8>>) -> Result<bool> {
        loop {
            self.line += self.height;
            self.raw.clear();
            self.height = 0;
            if !self.read_line()? {
                self.line = self.line.saturating_sub(1).max(1);
                return Ok(false);
            }
            if self.line == 1 && self.raw.starts_with(b"\xef\xbb\xbf") {
                // A byte order mark would hide the first column's name.
                self.raw.drain(..3);
            }
            if !dialect::is_skipped(&self.raw) {
                break;
            }
            if let (Some(comment), [_, rest @ ..]) = (&mut comment, self.raw.trim_ascii()) {
                rest.trim_ascii().clone_into(comment);
            }
        }
        loop {
            let raw = std::mem::take(&mut self.raw);
            let closed = self.split(&raw);
            self.raw = raw;
            if closed {
                return Ok(true);
            }
            if self.raw.len() as u64 > LONGEST || !self.read_line()? {
                return Err(self.fault("a quote is opened here and never closed".into()));
            }
        }
    }

    /// Adds a line to `raw`; false at the end of the file.
    fn read_line(&mut self) -> Result<bool> {
        let mut lines = (&mut self.lines).take(LONGEST);
        let count = match lines.read_until(self.dialect.end, &mut self.raw) {
            Ok(count) => count as u64,
            Err(source) => {
                return Err(Error::File {
                    path: self.path.clone(),
                    source,
                });
            }
        };
        if count == LONGEST {
            return Err(self.fault("the line does not end: is this a table?".into()));
        }
        self.bytes += count;
        self.height += u64::from(count > 0);
        Ok(count > 0)
    }

    /// Splits a line into `row`; whether every quote in it is closed.
    fn split(&mut self, line: &[u8]) -> bool {
        let (row, decimal_comma) = (&mut self.row.0, self.dialect.decimal_comma);
        row.clear();
        split(line, self.dialect.delimiter, |cell| {
            let pointed = decimal_comma.then(|| dialect::with_point(cell)).flatten();
            row.push_field(pointed.as_deref().unwrap_or(cell));
        })
    }

    /// The row's cells as text.
    fn names(&self) -> Result<Vec<String>> {
        let name = |cell: &[u8]| std::str::from_utf8(cell).map(|name| name.trim().to_owned());
        let names: std::result::Result<_, _> = self.row.cells().map(name).collect();
        names.map_err(|_| self.fault("the text is not UTF-8: save the file as UTF-8 CSV".into()))
    }

    pub(super) fn advance(&mut self, expected: usize) -> Result<bool> {
        if !std::mem::take(&mut self.held) && !self.read(None)? {
            return Ok(false);
        }
        let found = self.row.0.len();
        if found == expected {
            return Ok(true);
        }
        let between = match self.dialect.delimiter {
            b';' => "semicolons",
            b'\t' => "tabs",
            _ => "commas",
        };
        let advice = match between == "commas" && found > expected {
            true => "; numbers with decimal commas need semicolons or tabs between them",
            false => "",
        };
        Err(self.fault(format!(
            "{found} cells where the header has {expected}: give every row as many, separated by {between}{advice}"
        )))
    }

    pub(super) fn cell(&self, column: usize) -> &[u8] {
        self.row.0.get(column).unwrap_or_default().trim_ascii()
    }

    pub(super) fn row(&self) -> &Row {
        &self.row
    }

    pub(super) fn unit(&self, column: usize) -> Option<&str> {
        let unit = self.units.get(column).map(String::as_str);
        unit.filter(|unit| !unit.is_empty())
    }

    pub(super) fn line(&self) -> u64 {
        self.line
    }

    pub(super) fn bytes_read(&self) -> u64 {
        self.bytes
    }

    pub(super) fn sha256(self) -> Option<String> {
        self.lines.into_inner().into_inner().1.finish()
    }

    fn fault(&self, problem: String) -> Error {
        Error::Recording {
            path: Some(self.path.clone()),
            row: Some(Place::Line(self.line)),
            column: None,
            problem,
        }
    }
}

/// Gives the cells of a line to `push`, without quotes around them; false where a quote is not closed.
pub(super) fn split(line: &[u8], delimiter: u8, mut push: impl FnMut(&[u8])) -> bool {
    let end = line.iter().rposition(|byte| !matches!(byte, b'\r' | b'\n'));
    let line = &line[..end.map_or(0, |end| end + 1)];
    if !line.contains(&b'"') {
        line.split(|byte| *byte == delimiter).for_each(push);
        return true;
    }
    let mut cell = Vec::new();
    let mut rest = line.iter().copied().peekable();
    loop {
        cell.clear();
        if rest.next_if_eq(&b'"').is_some() {
            loop {
                match rest.next() {
                    // Two quotes are one that belongs to the text.
                    Some(b'"') if rest.next_if_eq(&b'"').is_some() => cell.push(b'"'),
                    Some(b'"') => break,
                    Some(byte) => cell.push(byte),
                    None => return false,
                }
            }
        }
        cell.extend(std::iter::from_fn(|| {
            rest.next_if(|byte| *byte != delimiter)
        }));
        push(&cell);
        if rest.next().is_none() {
            return true;
        }
    }
}

/// Hashes what passes through, where asked to: a file is read once only, and may be a pipe.
pub(super) struct Hashing {
    file: Box<dyn Read>,
    digest: Option<Sha256>,
}

impl Hashing {
    pub(super) fn new(file: Box<dyn Read>, hashed: bool) -> Self {
        Self {
            file,
            digest: hashed.then(Sha256::new),
        }
    }

    /// SHA-256 of a whole file.
    pub(super) fn file(path: &Path) -> std::io::Result<String> {
        let mut file = Self::new(Box::new(File::open(path)?), true);
        std::io::copy(&mut file, &mut std::io::sink())?;
        Ok(file.finish().unwrap_or_default())
    }

    fn finish(self) -> Option<String> {
        let bytes = self.digest?.finalize();
        Some(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
    }
}

impl Read for Hashing {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.file.read(buffer)?;
        if let Some(digest) = &mut self.digest {
            digest.update(&buffer[..count]);
        }
        Ok(count)
    }
}
