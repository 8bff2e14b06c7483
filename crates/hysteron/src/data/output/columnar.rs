//! Writes tables by columns, as Parquet or Arrow, from cells of known kinds.

use super::added::Added;
use super::arrow::ArrowWriter;
use super::parquet::{Cells, Kind, field, io_error, properties};
use super::sink::Sink;
use super::writer::{RowWriter, Rows, distinct};
use crate::data::table::Needs;
use parquet::errors::Result;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::io;
use std::sync::Arc;

/// A format that stores columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Columnar {
    Parquet,
    Arrow,
    ArrowStream,
}

/// Cells are written when they take this many bytes.
const GROUP: usize = 1 << 24;

/// A table by columns, with the cells that are not written yet.
pub(super) struct ColumnsWriter {
    to: To,
    pub(super) columns: Vec<Cells>,
    bytes: usize,
}

enum To {
    Parquet(Box<SerializedFileWriter<Sink>>),
    Arrow(Box<ArrowWriter>),
}

impl ColumnsWriter {
    /// Starts a table. The columns `computed` hold numbers that hardly repeat.
    pub(super) fn start(
        out: Sink,
        format: Columnar,
        columns: &[(&str, Kind)],
        computed: &[&str],
    ) -> io::Result<Self> {
        distinct(columns.iter().map(|(name, _)| *name))?;
        let to = match format {
            Columnar::Parquet => {
                let fields = columns.iter().map(|(name, kind)| field(name, *kind));
                let schema = fields.collect::<Result<_>>().and_then(|fields| {
                    Type::group_type_builder("table")
                        .with_fields(fields)
                        .build()
                });
                let schema = Arc::new(schema.map_err(io_error)?);
                let writer = SerializedFileWriter::new(out, schema, properties(computed));
                To::Parquet(Box::new(writer.map_err(io_error)?))
            }
            Columnar::Arrow | Columnar::ArrowStream => {
                let is_stream = format == Columnar::ArrowStream;
                let writer = ArrowWriter::with_columns(out, is_stream, columns)?;
                To::Arrow(Box::new(writer))
            }
        };
        Ok(Self {
            to,
            columns: columns.iter().map(|(_, kind)| Cells::new(*kind)).collect(),
            bytes: 0,
        })
    }

    /// Starts a table with the columns of numbers of a source, and columns that are added.
    pub(super) fn of_numbers(
        out: Sink,
        format: Columnar,
        header: &[String],
        added: &[Added],
    ) -> io::Result<Self> {
        let copied = header.iter().map(|name| (name.as_str(), Kind::Numbers));
        let new = added.iter().map(|column| (column.name(), column.into()));
        let columns: Vec<(&str, Kind)> = copied.chain(new).collect();
        let computed: Vec<&str> = added.iter().map(Added::name).collect();
        Self::start(out, format, &columns, &computed)
    }

    /// Counts the bytes of rows that were added, and writes the cells if they are many.
    pub(super) fn end_rows(&mut self, bytes: usize) -> io::Result<()> {
        self.bytes += bytes;
        match self.bytes > GROUP {
            true => self.write_group(),
            false => Ok(()),
        }
    }

    fn write_group(&mut self) -> io::Result<()> {
        self.bytes = 0;
        match &mut self.to {
            To::Arrow(writer) => writer.write_group(&mut self.columns),
            To::Parquet(writer) => {
                let written = writer.next_row_group().and_then(|mut group| {
                    for column in &mut self.columns {
                        column.write(&mut group)?;
                    }
                    group.close().map(|_| ())
                });
                written.map_err(io_error)
            }
        }
    }

    pub(super) fn finish(mut self) -> io::Result<Sink> {
        if self.bytes > 0 {
            self.write_group()?;
        }
        match self.to {
            To::Parquet(writer) => writer.into_inner().map_err(io_error),
            To::Arrow(writer) => writer.finish(),
        }
    }
}

impl RowWriter for ColumnsWriter {
    fn needs(&self) -> Needs {
        Needs::Numbers
    }

    fn extended(&mut self, rows: &Rows<'_>) -> io::Result<()> {
        let ((block, first), (cells, from), count) = (rows.block, rows.cells, rows.count);
        let source = block.copied();
        let (copied, added) = self.columns.split_at_mut(source.len());
        for (column, series) in copied.iter_mut().zip(source) {
            // A column that is shorter than others has no cells below its end.
            for row in first..first + count {
                let number = series.get(row).copied();
                column.push_number(number.filter(|number| !number.is_nan()));
            }
        }
        let (numbers, words) = added.split_at_mut(cells.numbers.len());
        for (column, series) in numbers.iter_mut().zip(&cells.numbers) {
            column.push_numbers(&series[from..from + count]);
        }
        for column in words {
            for word in &cells.words[from..from + count] {
                column.push_text(Some(word.as_bytes()));
            }
        }
        self.end_rows(count * self.columns.len() * size_of::<f64>())
    }

    fn finish(self: Box<Self>) -> io::Result<Option<Sink>> {
        (*self).finish().map(Some)
    }
}
