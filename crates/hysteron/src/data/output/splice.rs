//! Copies a Parquet file and adds columns. The stored columns of the source are copied as bytes,
//! whatever their type, once their pages have been read: a damaged file is refused, not copied.

use super::added::{Added, AddedCells};
use super::parquet::{Cells, Kind, field, io_error, properties};
use super::sink::Sink;
use super::writer::{RowWriter, Rows, distinct};
use crate::data::table::{Needs, Pages, caught};
use parquet::column::writer::ColumnCloseResult;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::fs::File;
use std::io;
use std::sync::Arc;

/// Metadata of Apache Arrow about the columns. It would no longer describe all of them, so it is
/// not copied.
const ARROW_SCHEMA: &str = "ARROW:schema";

/// A Parquet file that is copied column by column.
struct Original {
    file: File,
    pages: Pages,
}

impl Original {
    fn rows(&self, group: usize) -> Option<u64> {
        let group = self.pages.about().row_groups().get(group)?;
        Some(group.num_rows().max(0) as u64)
    }
}

/// The copy while it is written, with the new cells of the current row group.
pub(super) struct Splice {
    original: Original,
    writer: SerializedFileWriter<Sink>,
    added: Vec<Cells>,
    group: usize,
    rows: u64,
}

impl Splice {
    /// Starts the copy of a file whose pages are read on the way.
    pub(super) fn start(
        (file, pages): (File, Pages),
        out: Sink,
        added: &[Added],
    ) -> io::Result<Self> {
        let original = Original { file, pages };
        let about = original.pages.about().file_metadata();
        let root = about.schema_descr().root_schema();
        let there = root.get_fields().iter();
        let names: Vec<String> = there.map(|field| field.name().to_owned()).collect();
        let new = added.iter().map(|column| column.name().to_owned());
        distinct(names.into_iter().chain(new))?;
        let kinds: Vec<Kind> = added.iter().map(Kind::from).collect();
        let new = added
            .iter()
            .zip(&kinds)
            .map(|(column, kind)| field(column.name(), *kind));
        let fields = root.get_fields().iter().cloned().map(Ok).chain(new);
        let schema = fields.collect::<Result<_, _>>().and_then(|fields| {
            Type::group_type_builder(root.name())
                .with_fields(fields)
                .build()
        });
        let schema = Arc::new(schema.map_err(io_error)?);
        let computed = added
            .iter()
            .filter(|column| matches!(column, Added::Numbers(_)));
        let computed: Vec<&str> = computed.map(Added::name).collect();
        let properties = properties(&computed);
        let mut writer = SerializedFileWriter::new(out, schema, properties).map_err(io_error)?;
        let kept = about.key_value_metadata().into_iter().flatten();
        for KeyValue { key, value } in kept.filter(|pair| pair.key != ARROW_SCHEMA) {
            writer.append_key_value_metadata(KeyValue::new(key.clone(), value.clone()));
        }
        let mut splice = Self {
            original,
            writer,
            added: kinds.into_iter().map(Cells::new).collect(),
            group: 0,
            rows: 0,
        };
        splice.end_groups()?;
        Ok(splice)
    }

    /// Adds the new cells of the next rows.
    fn rows(&mut self, (cells, mut from): (&AddedCells, usize), count: usize) -> io::Result<()> {
        let end = from + count;
        while from < end {
            // The cells go into one row group after the other.
            let rows = self.original.rows(self.group).unwrap_or(u64::MAX);
            let left = usize::try_from(rows - self.rows).unwrap_or(usize::MAX);
            let to = end.min(from.saturating_add(left));
            let (numbers, words) = self.added.split_at_mut(cells.numbers.len());
            for (column, series) in numbers.iter_mut().zip(&cells.numbers) {
                column.push_numbers(&series[from..to]);
            }
            for column in words {
                for word in &cells.words[from..to] {
                    column.push_text(Some(word.as_bytes()));
                }
            }
            self.rows += (to - from) as u64;
            from = to;
            self.end_groups()?;
        }
        Ok(())
    }

    /// Writes the row groups that are complete. A row group without rows is always complete.
    fn end_groups(&mut self) -> io::Result<()> {
        while self.original.rows(self.group) == Some(self.rows) {
            let checked = self.original.pages.check(self.group);
            checked.map_err(io::Error::other)?;
            caught(|| self.write_group()).map_err(io::Error::other)?;
            (self.group, self.rows) = (self.group + 1, 0);
        }
        Ok(())
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let about = self.original.pages.about().row_group(self.group);
        let mut group = self.writer.next_row_group()?;
        for column in about.columns() {
            let stored = ColumnCloseResult {
                bytes_written: column.compressed_size().max(0) as u64,
                rows_written: self.rows,
                metadata: column.clone(),
                bloom_filter: None,
                column_index: None,
                offset_index: None,
            };
            group.append_column(&self.original.file, stored)?;
        }
        for column in &mut self.added {
            column.write(&mut group)?;
        }
        group.close().map(|_| ())
    }
}

impl RowWriter for Splice {
    fn needs(&self) -> Needs {
        Needs::Nothing
    }

    fn extended(&mut self, rows: &Rows<'_>) -> io::Result<()> {
        self.rows(rows.cells, rows.count)
    }

    fn finish(self: Box<Self>) -> io::Result<Option<Sink>> {
        match self.original.rows(self.group) {
            None => self.writer.into_inner().map(Some).map_err(io_error),
            Some(_) => Err(io::Error::other(
                "the input file has changed while it was read",
            )),
        }
    }
}
