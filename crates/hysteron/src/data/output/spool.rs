//! Stores the rows of a table until they can be written by columns, as Parquet or Arrow.
//!
//! The type of a column is known only after its last cell. So the rows are stored in a file without
//! a name, which the system removes when the program ends. Memory does not grow with the number of
//! rows. The rows of a table in memory are stored in memory.

use super::columnar::{Columnar, ColumnsWriter};
use super::csv::Csv;
use super::parquet::Kind;
use super::sink::Sink;
use super::writer::{RowWriter, Rows, distinct};
use crate::data::table::{Growing, Memory, Needs, Splitter};
use hysteron_files::bare;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, Write};
use std::path::Path;

/// The stored rows. The first one is the header.
pub(super) struct Spool {
    rows: Csv<Store>,
    /// The kinds of the columns; none before the header.
    kinds: Vec<Kind>,
    splitter: Splitter,
    /// Where the table is written in the end, and how.
    out: Sink,
    format: Columnar,
}

enum Store {
    File(File),
    Memory(Growing),
}

impl Store {
    /// The rows, from the first one on.
    fn read(self) -> io::Result<Box<dyn Read>> {
        Ok(match self {
            Store::File(mut file) => {
                file.rewind()?;
                Box::new(BufReader::new(file))
            }
            Store::Memory(held) => Box::new(held.read()),
        })
    }
}

impl Write for Store {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Store::File(file) => file.write(bytes),
            Store::Memory(held) => held.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Store::File(file) => file.flush(),
            Store::Memory(_) => Ok(()),
        }
    }
}

impl Spool {
    /// A table whose rows are stored in a folder that has enough space.
    pub(super) fn create_in(folder: &Path, out: Sink, format: Columnar) -> io::Result<Self> {
        let file = tempfile::tempfile_in(folder).map_err(bare)?;
        Ok(Self::over(Store::File(file), out, format))
    }

    /// A table whose rows are stored in memory.
    pub(super) fn in_memory(account: &Memory, out: Sink, format: Columnar) -> Self {
        Self::over(Store::Memory(Growing::new(account)), out, format)
    }

    fn over(store: Store, out: Sink, format: Columnar) -> Self {
        Self {
            rows: Csv::new(store),
            kinds: Vec::new(),
            splitter: Splitter::default(),
            out,
            format,
        }
    }

    pub(super) fn format(&self) -> Columnar {
        self.format
    }

    /// Where the table is written, of a store without rows.
    pub(super) fn unused(self) -> Sink {
        self.out
    }

    /// Notes what the cells of a row need.
    fn note(&mut self, row: &[u8]) {
        let mut kinds = self.kinds.iter_mut();
        self.splitter.line(row, b',', |cell| {
            if let Some(kind) = kinds.next() {
                *kind = kind.with(cell);
            }
        });
    }
}

impl RowWriter for Spool {
    fn needs(&self) -> Needs {
        Needs::Text
    }

    fn row(&mut self, row: &[u8]) -> io::Result<()> {
        match self.kinds.is_empty() {
            true => {
                let mut columns = 0;
                self.splitter.line(row, b',', |_| columns += 1);
                self.kinds = vec![Kind::Numbers; columns];
            }
            false => self.note(row),
        }
        self.rows.copied(row)
    }

    fn extended(&mut self, rows: &Rows<'_>) -> io::Result<()> {
        let (block, first) = rows.block;
        for n in 0..rows.count {
            self.note(block.row(first + n));
        }
        if !rows.cells.0.words.is_empty()
            && let Some(last) = self.kinds.last_mut()
        {
            *last = Kind::Text;
        }
        self.rows.extended(rows)
    }

    /// Writes all rows by columns.
    fn finish(self: Box<Self>) -> io::Result<Option<Sink>> {
        let Some(stored) = self.rows.finish()? else {
            return Ok(None);
        };
        let mut rows = csv::ReaderBuilder::new()
            .has_headers(false)
            .from_reader(stored.read()?);
        let mut header = csv::ByteRecord::new();
        rows.read_byte_record(&mut header)?;
        let names: Vec<_> = header.iter().map(String::from_utf8_lossy).collect();
        distinct(names.iter())?;
        let columns = names.iter().map(AsRef::as_ref);
        let columns: Vec<(&str, Kind)> = columns.zip(self.kinds.iter().copied()).collect();
        let mut writer = ColumnsWriter::start(self.out, self.format, &columns, &[])?;
        write(&mut writer, rows)?;
        writer.finish().map(Some)
    }
}

/// Writes the rows below the header.
fn write(writer: &mut ColumnsWriter, mut rows: csv::Reader<impl Read>) -> io::Result<()> {
    let mut row = csv::ByteRecord::new();
    while rows.read_byte_record(&mut row)? {
        for (column, cell) in writer.columns.iter_mut().zip(&row) {
            let cell = Some(cell).filter(|cell| !cell.is_empty());
            match column.kind() {
                Kind::Numbers => column.push_number(cell.and_then(number)),
                Kind::Text | Kind::Bytes => column.push_text(cell),
            }
        }
        writer.end_rows(row.as_slice().len() + row.len() * size_of::<f64>())?;
    }
    Ok(())
}

impl Kind {
    /// The type of a column after this cell is added. An empty cell has no value.
    fn with(self, cell: &[u8]) -> Self {
        match self {
            Self::Numbers if cell.is_empty() || number(cell).is_some() => Self::Numbers,
            Self::Numbers | Self::Text if std::str::from_utf8(cell).is_ok() => Self::Text,
            _ => Self::Bytes,
        }
    }
}

/// The number in a cell, if an `f64` can hold exactly what is written. Texts such as `007`, and
/// whole numbers beyond 2⁵³ that would be rounded, are not numbers.
fn number(cell: &[u8]) -> Option<f64> {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let text = std::str::from_utf8(cell).ok()?.trim();
    let value: f64 = text.parse().ok()?;
    let digits = text.trim_start_matches(['+', '-']);
    let whole = digits.bytes().all(|byte| byte.is_ascii_digit());
    let padded = digits.len() > 1 && digits.starts_with('0') && !digits.starts_with("0.");
    let exact = !whole || value.abs() < EXACT || value.abs().to_string() == digits;
    (exact && !padded).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_that_lose_nothing() {
        for cell in [
            "0",
            "-0",
            "0.5",
            "-0.25",
            "1e-9",
            "NaN",
            "inf",
            "+3",
            " 7 ",
            "9007199254740992",
            "-10000000000000000",
            "0.10",
        ] {
            assert!(number(cell.as_bytes()).is_some(), "{cell}");
        }
        for cell in [
            "",
            "007",
            "-01",
            "00",
            "9007199254740993",
            "18446744073709551615",
            "ok",
            "1,5",
            "2026-01-01",
            "0x10",
        ] {
            assert!(number(cell.as_bytes()).is_none(), "{cell}");
        }
    }

    #[test]
    fn a_column_is_of_the_kind_that_holds_all_its_cells() {
        let cases: [(&[&[u8]], Kind); 5] = [
            (&[b"1", b"", b"2"], Kind::Numbers),
            (&[b"", b""], Kind::Numbers),
            (&[b"1", b"on"], Kind::Text),
            (&[b"1", b"\xff"], Kind::Bytes),
            (&[b"\xff", b"1", b"on"], Kind::Bytes),
        ];
        for (cells, kind) in cases {
            let found = cells
                .iter()
                .fold(Kind::Numbers, |kind, cell| kind.with(cell));
            assert_eq!(found, kind, "{cells:?}");
        }
    }
}
