//! Writes Arrow files and streams, and copies those of a source with columns added.

use super::added::{Added, AddedCells};
use super::parquet::{Cells, Kind, PROGRAM};
use super::sink::Sink;
use super::writer::{RowWriter, Rows, distinct};
use crate::data::table::{Batches, Needs, arrow_caught};
use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray};
use arrow_ipc::reader::read_footer_length;
use arrow_ipc::root_as_footer;
use arrow_ipc::writer::{FileWriter, StreamWriter};
use arrow_schema::{ArrowError, DataType, Field, Schema, SchemaRef};
use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::Arc;

/// The key of the writer's name in the metadata at the end of a file.
const WRITER: &str = "created_by";

/// A file or a stream that is written.
pub(super) struct ArrowWriter {
    schema: SchemaRef,
    to: To,
}

enum To {
    File(FileWriter<BufWriter<Sink>>),
    Stream(StreamWriter<BufWriter<Sink>>),
}

impl ArrowWriter {
    fn start(out: Sink, is_stream: bool, schema: Schema) -> Result<Self, ArrowError> {
        let out = BufWriter::with_capacity(1 << 16, out);
        let to = match is_stream {
            true => To::Stream(StreamWriter::try_new(out, &schema)?),
            false => {
                let mut writer = FileWriter::try_new(out, &schema)?;
                writer.write_metadata(WRITER, format!("{PROGRAM}{}", env!("CARGO_PKG_VERSION")));
                To::File(writer)
            }
        };
        let schema = Arc::new(schema);
        Ok(Self { schema, to })
    }

    /// Starts a table with columns of these kinds.
    pub(super) fn with_columns(
        out: Sink,
        is_stream: bool,
        columns: &[(&str, Kind)],
    ) -> io::Result<Self> {
        Self::start(out, is_stream, schema_of(columns)).map_err(io_error)
    }

    fn write(&mut self, batch: &RecordBatch) -> Result<(), ArrowError> {
        match &mut self.to {
            To::File(file) => file.write(batch),
            To::Stream(stream) => stream.write(batch),
        }
    }

    /// Writes the cells of all columns as the next part, and clears them.
    pub(super) fn write_group(&mut self, columns: &mut [Cells]) -> io::Result<()> {
        let arrays = columns.iter_mut().map(Cells::take_array).collect();
        let batch = RecordBatch::try_new(self.schema.clone(), arrays);
        batch.and_then(|batch| self.write(&batch)).map_err(io_error)
    }

    pub(super) fn finish(self) -> io::Result<Sink> {
        let out = match self.to {
            To::File(file) => file.into_inner(),
            To::Stream(stream) => stream.into_inner(),
        };
        let out = out.map_err(io_error)?;
        out.into_inner().map_err(io::IntoInnerError::into_error)
    }
}

fn schema_of(columns: &[(&str, Kind)]) -> Schema {
    let field = |(name, kind): &(&str, Kind)| {
        let of = match kind {
            Kind::Numbers => DataType::Float64,
            Kind::Text => DataType::Utf8,
            Kind::Bytes => DataType::Binary,
        };
        Field::new(*name, of, true)
    };
    Schema::new(columns.iter().map(field).collect::<Vec<_>>())
}

/// An Arrow table that is copied part by part, with the new cells of the current part.
pub(super) struct ArrowCopy {
    source: Batches,
    /// The part whose new cells have not all come.
    part: Option<RecordBatch>,
    cells: AddedCells,
    writer: ArrowWriter,
}

impl ArrowCopy {
    pub(super) fn start(
        mut source: Batches,
        out: Sink,
        is_stream: bool,
        added: &[Added],
    ) -> io::Result<Self> {
        let of_source = source.schema().clone();
        let names = of_source.fields().iter().map(|field| field.name().clone());
        distinct(names.chain(added.iter().map(|column| column.name().to_owned())))?;
        let kinds = added.iter().map(|column| (column.name(), column.into()));
        let new = schema_of(&kinds.collect::<Vec<_>>());
        let fields = of_source.fields().iter().chain(new.fields()).cloned();
        let fields: Vec<_> = fields.collect();
        let schema = Schema::new_with_metadata(fields, of_source.metadata().clone());
        let writer = ArrowWriter::start(out, is_stream, schema).map_err(io_error)?;
        let part = source.next(None).map_err(io::Error::other)?;
        let mut copy = Self {
            source,
            part,
            cells: AddedCells::of(added),
            writer,
        };
        copy.end_parts()?;
        Ok(copy)
    }

    /// Adds the new cells of the next rows.
    fn rows(&mut self, (cells, mut from): (&AddedCells, usize), count: usize) -> io::Result<()> {
        let end = from + count;
        while from < end {
            // The cells go into one part after the other.
            let rows = self.part.as_ref().map_or(usize::MAX, RecordBatch::num_rows);
            let to = end.min(from.saturating_add(rows - self.cells.len()));
            self.cells.extend(cells, from..to);
            from = to;
            self.end_parts()?;
        }
        Ok(())
    }

    /// Writes the parts that are complete. A part without rows is always complete.
    fn end_parts(&mut self) -> io::Result<()> {
        while let Some(part) = self
            .part
            .take_if(|part| part.num_rows() == self.cells.len())
        {
            let new = self.cells.numbers.iter_mut();
            let new = new.map(|series| Arc::new(Float64Array::from(std::mem::take(series))) as _);
            let mut columns: Vec<ArrayRef> = part.columns().iter().cloned().chain(new).collect();
            if columns.len() < self.writer.schema.fields().len() {
                let words = std::mem::take(&mut self.cells.words);
                columns.push(Arc::new(StringArray::from_iter_values(words)));
            }
            let (schema, writer) = (self.writer.schema.clone(), &mut self.writer);
            let written = arrow_caught(|| {
                let batch = RecordBatch::try_new(schema, columns)?;
                Ok(writer.write(&batch).map_err(io_error))
            });
            written.map_err(io::Error::other)??;
            self.part = self.source.next(None).map_err(io::Error::other)?;
        }
        Ok(())
    }
}

impl RowWriter for ArrowCopy {
    fn needs(&self) -> Needs {
        Needs::Nothing
    }

    fn extended(&mut self, rows: &Rows<'_>) -> io::Result<()> {
        self.rows(rows.cells, rows.count)
    }

    fn finish(self: Box<Self>) -> io::Result<Option<Sink>> {
        match self.part {
            None => self.writer.finish().map(Some),
            Some(_) => Err(io::Error::other(
                "the input file has changed while it was read",
            )),
        }
    }
}

/// Whether the metadata at the end of a file name this library as the writer.
pub(super) fn is_ours(path: &Path) -> io::Result<bool> {
    const TAIL: u64 = 10;
    /// No footer of ours is longer.
    const LONGEST: u64 = 1 << 26;
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut tail = [0; TAIL as usize];
    let Some(end) = length.checked_sub(TAIL) else {
        return Ok(false);
    };
    file.seek(SeekFrom::Start(end))?;
    file.read_exact(&mut tail)?;
    let size = read_footer_length(tail).ok();
    let size = size
        .map(|size| size as u64)
        .filter(|size| *size <= end.min(LONGEST));
    let Some(size) = size else {
        return Ok(false);
    };
    let mut footer = vec![0; size as usize];
    file.seek(SeekFrom::Start(end - size))?;
    file.read_exact(&mut footer)?;
    let Ok(footer) = root_as_footer(&footer) else {
        return Ok(false);
    };
    let mut pairs = footer.custom_metadata().into_iter().flatten();
    Ok(pairs.any(|pair| {
        pair.key() == Some(WRITER) && pair.value().is_some_and(|name| name.starts_with(PROGRAM))
    }))
}

/// The error of the operating system, if that was the cause.
fn io_error(error: ArrowError) -> io::Error {
    match error {
        ArrowError::IoError(_, error) => error,
        ArrowError::IpcError(problem) | ArrowError::InvalidArgumentError(problem)
            if problem.contains("Dictionary replacement") =>
        {
            io::Error::other(
                "its dictionaries change on the way, which an Arrow file cannot hold: let the name \
                 end with .arrows",
            )
        }
        other => io::Error::other(other),
    }
}
