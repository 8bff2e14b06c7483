//! Writes columns of Parquet files: types, and the cells of a row group.

use super::added::Added;
use arrow_array::{ArrayRef, BinaryArray, Float64Array, StringArray};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::{ParquetError, Result};
use parquet::file::properties::{WriterProperties, WriterPropertiesPtr};
use parquet::file::writer::SerializedRowGroupWriter;
use parquet::schema::types::{ColumnPath, Type, TypePtr};
use std::io;
use std::io::Write;
use std::sync::Arc;

/// Beginning of the writer's name in the metadata of our files.
pub(super) const PROGRAM: &str = "hysteron ";

/// The properties of our files. The columns `computed` hold numbers that hardly repeat, so that no
/// dictionary is tried.
pub(super) fn properties(computed: &[&str]) -> WriterPropertiesPtr {
    let properties = WriterProperties::builder()
        .set_created_by(format!("{PROGRAM}{}", env!("CARGO_PKG_VERSION")))
        .set_compression(Compression::SNAPPY);
    let properties = computed.iter().fold(properties, |properties, name| {
        properties.set_column_dictionary_enabled(ColumnPath::from(*name), false)
    });
    Arc::new(properties.build())
}

/// Type of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Numbers,
    Text,
    /// Bytes that are not UTF-8, stored unchanged.
    Bytes,
}

impl From<&Added> for Kind {
    fn from(column: &Added) -> Self {
        match column {
            Added::Numbers(_) => Self::Numbers,
            Added::Words(_) => Self::Text,
        }
    }
}

/// A column with optional cells.
pub(super) fn field(name: &str, kind: Kind) -> Result<TypePtr> {
    let (physical, logical) = match kind {
        Kind::Numbers => (Physical::DOUBLE, None),
        Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        Kind::Bytes => (Physical::BYTE_ARRAY, None),
    };
    let field = Type::primitive_type_builder(name, physical)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(logical);
    Ok(Arc::new(field.build()?))
}

/// The cells of a column in a row group.
pub(super) struct Cells {
    kind: Kind,
    numbers: Vec<f64>,
    texts: Vec<ByteArray>,
    /// 1 for each cell with a value, 0 for each empty cell.
    defined: Vec<i16>,
}

impl Cells {
    pub(super) fn new(kind: Kind) -> Self {
        Self {
            kind,
            numbers: Vec::new(),
            texts: Vec::new(),
            defined: Vec::new(),
        }
    }

    pub(super) fn kind(&self) -> Kind {
        self.kind
    }

    pub(super) fn push_number(&mut self, number: Option<f64>) {
        self.defined.push(number.is_some().into());
        self.numbers.extend(number);
    }

    /// Adds cells that all hold a number.
    pub(super) fn push_numbers(&mut self, numbers: &[f64]) {
        self.defined.resize(self.defined.len() + numbers.len(), 1);
        self.numbers.extend_from_slice(numbers);
    }

    pub(super) fn push_text(&mut self, text: Option<&[u8]>) {
        self.defined.push(text.is_some().into());
        // Words such as a status come many times in a row.
        let text = text.map(|text| match self.texts.last() {
            Some(last) if last.data() == text => last.clone(),
            _ => ByteArray::from(text.to_vec()),
        });
        self.texts.extend(text);
    }

    /// The cells as a column of Arrow; clears them.
    pub(super) fn take_array(&mut self) -> ArrayRef {
        let Self {
            kind,
            numbers,
            texts,
            defined,
        } = std::mem::replace(self, Self::new(self.kind));
        let (mut numbers, mut texts) = (numbers.into_iter(), texts.iter().map(ByteArray::data));
        let defined = defined.iter().map(|level| *level > 0);
        match kind {
            Kind::Numbers => {
                let cells = defined.map(|there| there.then(|| numbers.next()).flatten());
                Arc::new(Float64Array::from_iter(cells))
            }
            Kind::Text => {
                let text = |bytes| String::from_utf8_lossy(bytes);
                let cells = defined.map(|there| there.then(|| texts.next().map(text)).flatten());
                Arc::new(StringArray::from_iter(cells))
            }
            Kind::Bytes => {
                let cells = defined.map(|there| there.then(|| texts.next()).flatten());
                Arc::new(BinaryArray::from_iter(cells))
            }
        }
    }

    /// Writes the cells as the next column of a row group, and clears them.
    pub(super) fn write<W: Write + Send>(
        &mut self,
        group: &mut SerializedRowGroupWriter<'_, W>,
    ) -> Result<()> {
        let column = group.next_column()?;
        let mut column = column.ok_or_else(|| ParquetError::General("no column is left".into()))?;
        let defined = Some(&self.defined[..]);
        match self.kind {
            Kind::Numbers => {
                column
                    .typed::<DoubleType>()
                    .write_batch(&self.numbers, defined, None)?
            }
            Kind::Text | Kind::Bytes => {
                column
                    .typed::<ByteArrayType>()
                    .write_batch(&self.texts, defined, None)?
            }
        };
        *self = Self::new(self.kind);
        column.close()
    }
}

/// The error of the operating system, if that was the cause.
pub(super) fn io_error(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(inner) => *inner,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}
