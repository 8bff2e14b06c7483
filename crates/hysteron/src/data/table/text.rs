//! Reads text files line by line: CSV, and files written by measuring programs and data loggers.

mod commas;
mod dialect;
mod encoding;
mod header;
mod marks;
mod plain;
mod split;

pub(super) use dialect::head;
pub(in crate::data) use split::Splitter;

use super::budget::Budget;
use super::{Remark, Row, shortened};
use crate::data::recording::Places;
use crate::data::recording::Repair;
use crate::error::{Error, Place, Result};
use crate::remedy::{Remedy, Setting};
use commas::Commas;
use dialect::Dialect;
use marks::Marks;
use std::io::{BufRead, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

/// Largest number of bytes in a line or a quoted cell. A longer line is not part of a table of
/// numbers; a longer quoted cell has no closing quote.
const LONGEST: u64 = 1 << 22;

/// The rows of a text file.
pub(super) struct Text {
    path: PathBuf,
    lines: BufReader<Box<dyn Read>>,
    dialect: Dialect,
    units: Vec<String>,
    row: Row,
    /// A line as it stands in the file, and the number of bytes of the row before it.
    raw: Vec<u8>,
    before: u64,
    /// Memory for [`Text::plain_rows`].
    marks: Marks,
    splitter: Splitter,
    /// The line on which the row begins, and the number of its lines.
    line: u64,
    height: u64,
    bytes: u64,
    /// Whether the current row is still to be returned, because it was read in search of the
    /// header.
    held: bool,
    /// What to do with rows of another length than the header; `None` if rows are never repaired.
    repair: Option<Repair>,
    ragged: Places,
    /// The columns asked for, and what is known about commas in their numbers.
    asked: Vec<(usize, Commas)>,
    remarks: Vec<Remark>,
}

/// A text that begins with `head`. If `whole`, `head` is all of it.
pub(super) struct Source<R> {
    pub(super) head: Vec<u8>,
    pub(super) whole: bool,
    pub(super) rest: R,
}

impl Text {
    /// Opens a text. Returns the header and the rows below it.
    pub(super) fn open(
        path: &Path,
        source: Source<impl Read + 'static>,
        repair: Option<Repair>,
        budget: &mut Budget,
    ) -> Result<(Vec<String>, Self)> {
        let Source { head, whole, rest } = source;
        let encoding = encoding::of(&head, whole);
        let dialect = match encoding {
            None => Dialect::of(&head, whole),
            Some(encoding) => Dialect::of(encoding.decode(&head).0.as_bytes(), whole),
        };
        let bytes = Cursor::new(head).chain(rest);
        let decoded: Box<dyn Read> = match encoding {
            None => Box::new(bytes),
            Some(encoding) => encoding::decoded(encoding, bytes),
        };
        let mut text = Self {
            path: path.to_owned(),
            lines: BufReader::with_capacity(1 << 17, decoded),
            dialect,
            units: Vec::new(),
            row: Row::default(),
            raw: Vec::new(),
            before: 0,
            marks: Marks::default(),
            splitter: Splitter::default(),
            line: 1,
            height: 0,
            bytes: 0,
            held: false,
            repair,
            ragged: Places::default(),
            asked: Vec::new(),
            remarks: Vec::new(),
        };
        let encoding = encoding.map(|encoding| Remark::Encoding(encoding.name()));
        text.remarks.extend(encoding);
        let header = text.read_header()?;
        // Memory for a name, and for the ends of its cells in a row.
        let names: usize = header.iter().map(|name| name.len() + 64).sum();
        let held = budget.take(names as u128, "the header");
        held.map_err(|problem| text.fault(problem))?;
        Ok((header, text))
    }

    fn read_header(&mut self) -> Result<Vec<String>> {
        // Without a preamble these lines are comments. The last of them may be the header.
        let preamble = self.dialect.header.preamble;
        for _ in 0..self.dialect.header.above * u64::from(preamble) {
            self.raw.clear();
            self.read_line()?;
        }
        let mut comment = Vec::new();
        if !self.read(Some(&mut comment))? {
            return Err(self.empty());
        }
        if self.raw.contains(&0) {
            return Err(self.no_text());
        }
        let header = self.names()?;
        if header.iter().all(String::is_empty) {
            return Err(self.empty());
        }
        if !self.dialect.header.named || header.iter().all(|name| name.parse::<f64>().is_ok()) {
            self.held = true;
            return Ok(self.names_from(&comment, header.len()));
        }
        if preamble {
            let lines = self.line - 1;
            let header = shortened(&header.join(", "));
            self.remarks.push(Remark::Preamble { lines, header });
        }
        if self.dialect.units {
            self.read(None)?;
            self.units = self.names()?.into_iter().map(without_brackets).collect();
        }
        Ok(header)
    }

    /// Names for `columns` columns of numbers without a header row. NumPy writes the header as a
    /// comment just above the numbers; otherwise the columns are numbered.
    fn names_from(&mut self, comment: &[u8], columns: usize) -> Vec<String> {
        let cells = split::cells(comment, self.dialect.delimiter);
        let text = |cell: &Vec<u8>| String::from_utf8_lossy(cell).trim().to_owned();
        let names: Vec<String> = cells.iter().map(text).collect();
        if names.len() == columns && !names.iter().any(String::is_empty) {
            return names;
        }
        let above = self.line - 1;
        self.remarks.push(Remark::Unnamed { above, columns });
        (1..=columns).map(|n| n.to_string()).collect()
    }

    /// Reads the next row that is neither blank nor a comment. Returns false at the end. The last
    /// comment is stored in `comment`, without its mark.
    fn read(&mut self, mut comment: Option<&mut Vec<u8>>) -> Result<bool> {
        loop {
            self.line += self.height;
            self.height = 0;
            self.before = 0;
            self.raw.clear();
            if !self.read_line()? {
                self.line = self.line.saturating_sub(1).max(1);
                return Ok(false);
            }
            if self.line == 1 && self.raw.starts_with(b"\xef\xbb\xbf") {
                // A byte order mark would become part of the first column's name.
                self.raw.drain(..3);
            }
            if !dialect::is_skipped(&self.raw) {
                break;
            }
            if let (Some(comment), [_, rest @ ..]) = (&mut comment, self.raw.trim_ascii()) {
                rest.trim_ascii().clone_into(comment);
            }
        }
        self.row.0.clear();
        self.splitter.reset();
        while !self.split() {
            self.before += self.raw.len() as u64;
            self.raw.clear();
            if self.before > LONGEST || !self.read_line()? {
                return Err(self.fault("a quote is opened here and never closed".into()));
            }
        }
        Ok(true)
    }

    /// Reads a line into `raw`. Returns false at the end of the file.
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

    /// Splits the line in `raw` into `row`. Returns whether the row ends in it.
    fn split(&mut self) -> bool {
        let (row, decimal_comma) = (&mut self.row.0, self.dialect.decimal_comma);
        self.splitter
            .line(&self.raw, self.dialect.delimiter, |cell| {
                let rewritten = dialect::rewritten(cell, decimal_comma);
                row.push_field(rewritten.as_deref().unwrap_or(cell));
            })
    }

    /// The cells of the row as text.
    fn names(&self) -> Result<Vec<String>> {
        let name = |cell: &[u8]| std::str::from_utf8(cell).map(|name| name.trim().to_owned());
        let names: std::result::Result<_, _> = self.row.cells().map(name).collect();
        names.map_err(|_| self.no_text())
    }

    pub(super) fn advance(&mut self, header: &[String]) -> Result<bool> {
        loop {
            if !std::mem::take(&mut self.held) && !self.read(None)? {
                self.check_commas(header)?;
                return Ok(false);
            }
            let found = self.row.0.len();
            if self.dialect.header.last_is_optional && found + 1 == header.len() {
                self.row.0.push_field(b"");
            } else if found != header.len() {
                if self.repair == Some(Repair::Mend) {
                    self.ragged.push(Place::Line(self.line));
                    continue;
                }
                return Err(self.ragged_row(header.len()));
            }
            if self.dialect.decimal_comma {
                for (column, commas) in &mut self.asked {
                    let cell = self.row.0.get(*column).unwrap_or_default();
                    commas.learn(cell.trim_ascii(), self.line);
                }
            }
            return Ok(true);
        }
    }

    fn ragged_row(&self, expected: usize) -> Error {
        let found = self.row.0.len();
        let between = match self.dialect.delimiter {
            b';' => "semicolons",
            b'\t' => "tabs",
            _ => "commas",
        };
        let advice = match between == "commas" && found > expected {
            true => "; numbers with decimal commas need semicolons or tabs between them",
            false => "",
        };
        let problem = format!("{found} cells where the header has {expected}");
        let words = format!("give every row as many, separated by {between}{advice}");
        match self.repair {
            None => self.fault(format!("{problem}: {words}")),
            Some(_) => self.fault(problem).remedied(Remedy::new(
                words + ", or use {} to drop such rows",
                [Setting::on("repair")],
            )),
        }
    }

    /// At the end of the table, checks the commas that may separate thousands. They are no problem
    /// if any number shows that commas are decimal. Otherwise, refuses columns that look like
    /// thousands, and adds a remark about columns that could be.
    fn check_commas(&mut self, header: &[String]) -> Result<()> {
        let asked = std::mem::take(&mut self.asked);
        if asked.iter().any(|(_, commas)| commas.is_decimal()) {
            return Ok(());
        }
        for (column, commas) in asked {
            let Some((number, line)) = &commas.grouped else {
                continue;
            };
            let (column, number) = (header[column].clone(), number.clone());
            let place = Place::Line(*line);
            if commas.may_be_thousands() {
                let written = number.replace('.', ",");
                let whole = number.replace('.', "");
                return Err(Error::Recording {
                    path: Some(self.path.clone()),
                    row: Some(place),
                    column: Some(column),
                    problem: format!(
                        "`{written}` may be {number} or {whole}: write the numbers of this column \
                         with a decimal point, or without commas between thousands"
                    ),
                });
            }
            self.remarks.push(Remark::DecimalComma {
                number,
                column,
                place,
            });
        }
        Ok(())
    }

    /// Notes that a column is asked for.
    pub(super) fn ask(&mut self, column: usize) {
        self.asked.push((column, Commas::default()));
    }

    pub(super) fn remarks(&self) -> &[Remark] {
        &self.remarks
    }

    /// The rows that were dropped because of their length.
    pub(super) fn ragged(&self) -> &Places {
        &self.ragged
    }

    /// As [`Text::ragged`], and forgets them.
    pub(super) fn take_ragged(&mut self) -> Places {
        std::mem::take(&mut self.ragged)
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

    fn empty(&self) -> Error {
        self.fault("the file is empty: a header row with the columns' names is needed".into())
    }

    fn no_text(&self) -> Error {
        self.fault("this is no text: save the table as CSV in UTF-8".into())
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

/// A unit without brackets around it.
fn without_brackets(unit: String) -> String {
    let inner = [('[', ']'), ('(', ')')]
        .into_iter()
        .find_map(|(open, close)| unit.strip_prefix(open)?.strip_suffix(close).map(str::trim));
    inner.map(str::to_owned).unwrap_or(unit)
}
