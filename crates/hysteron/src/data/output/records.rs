//! Writes and reads Parquet tables of records whose columns are known: texts, numbers, integers and
//! lists of numbers.

use super::parquet::{io_error, properties};
use crate::data::output::sign::is_our_table;
use crate::data::table::{PARQUET_FILE, caught};
use crate::error::{Error, Result};
use hysteron_files::{AtomicFile, Destination, Own};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result as Written};
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Type of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Text,
    Number,
    Integer,
    Numbers,
}

/// The columns of a table: names and types.
pub(crate) type Schema = [(&'static str, Kind)];

/// A cell.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    None,
    Text(String),
    Number(f64),
    Integer(i64),
    Numbers(Vec<f64>),
}

/// A row group is written when its cells take this many bytes.
const GROUP: usize = 1 << 24;

/// Writes a table of records. It appears when it is complete.
pub(crate) struct RecordWriter {
    path: PathBuf,
    writer: SerializedFileWriter<AtomicFile>,
    columns: Vec<Cells>,
    bytes: usize,
}

/// The cells of a column in a row group.
struct Cells {
    kind: Kind,
    texts: Vec<ByteArray>,
    numbers: Vec<f64>,
    integers: Vec<i64>,
    /// Definition and repetition levels of the Parquet format.
    defined: Vec<i16>,
    repeated: Vec<i16>,
}

impl RecordWriter {
    /// Begins a table. So a path that cannot be written is refused before the work.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn create(target: Destination<'_>, schema: &Schema) -> Result<Self> {
        let path = target.path().to_owned();
        let ending = path.extension();
        if !ending.is_some_and(|ending| ending.eq_ignore_ascii_case("parquet")) {
            let source = io::Error::other("this table is Parquet: let its name end with .parquet");
            return Err(Error::File { path, source });
        }
        let file = AtomicFile::create(target, Own::Marked(is_our_table))?;
        match Self::start(path.clone(), file, schema) {
            Ok(writer) => Ok(writer),
            Err(error) => Err(Error::File {
                path,
                source: io_error(error),
            }),
        }
    }

    fn start(path: PathBuf, file: AtomicFile, schema: &Schema) -> Written<Self> {
        let fields = schema.iter().map(|(name, kind)| field(name, *kind));
        let fields = fields.collect::<Written<_>>()?;
        let about = Type::group_type_builder("table").with_fields(fields);
        let writer = SerializedFileWriter::new(file, Arc::new(about.build()?), properties(&[]))?;
        Ok(Self {
            path,
            writer,
            columns: schema.iter().map(|(_, kind)| Cells::new(*kind)).collect(),
            bytes: 0,
        })
    }

    /// Adds a record: a value for each column.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn push(&mut self, record: Vec<Value>) -> Result<()> {
        debug_assert_eq!(record.len(), self.columns.len());
        for (cells, value) in self.columns.iter_mut().zip(record) {
            self.bytes += cells.push(value);
        }
        match self.bytes > GROUP {
            true => self.end_group(),
            false => Ok(()),
        }
    }

    fn end_group(&mut self) -> Result<()> {
        self.bytes = 0;
        let columns = &mut self.columns;
        let written = self.writer.next_row_group().and_then(|mut group| {
            for cells in columns {
                cells.write(&mut group)?;
            }
            group.close().map(|_| ())
        });
        written.map_err(|error| Error::File {
            path: self.path.clone(),
            source: io_error(error),
        })
    }

    /// Ends the table and gives the file its name.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn finish(mut self) -> Result<()> {
        if self.bytes > 0 {
            self.end_group()?;
        }
        match self.writer.into_inner() {
            Ok(file) => Ok(file.commit()?),
            Err(error) => Err(Error::File {
                path: self.path,
                source: io_error(error),
            }),
        }
    }
}

/// A column: optional cells, or lists of numbers in the form that Parquet gives them.
fn field(name: &str, kind: Kind) -> Written<TypePtr> {
    let (physical, logical) = match kind {
        Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        Kind::Integer => (Physical::INT64, None),
        Kind::Number => (Physical::DOUBLE, None),
        Kind::Numbers => {
            let element = Type::primitive_type_builder("element", Physical::DOUBLE)
                .with_repetition(Repetition::REQUIRED);
            let list = Type::group_type_builder("list")
                .with_repetition(Repetition::REPEATED)
                .with_fields(vec![Arc::new(element.build()?)]);
            let field = Type::group_type_builder(name)
                .with_repetition(Repetition::OPTIONAL)
                .with_logical_type(Some(LogicalType::List))
                .with_fields(vec![Arc::new(list.build()?)]);
            return Ok(Arc::new(field.build()?));
        }
    };
    let field = Type::primitive_type_builder(name, physical)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(logical);
    Ok(Arc::new(field.build()?))
}

impl Cells {
    fn new(kind: Kind) -> Self {
        Self {
            kind,
            texts: Vec::new(),
            numbers: Vec::new(),
            integers: Vec::new(),
            defined: Vec::new(),
            repeated: Vec::new(),
        }
    }

    /// Adds a cell; returns about how many bytes it takes. A value of another type is none.
    fn push(&mut self, value: Value) -> usize {
        let is_list = self.kind == Kind::Numbers;
        match (self.kind, value) {
            (Kind::Text, Value::Text(text)) => self.texts.push(text.into_bytes().into()),
            (Kind::Number, Value::Number(number)) => self.numbers.push(number),
            (Kind::Integer, Value::Integer(integer)) => self.integers.push(integer),
            (Kind::Numbers, Value::Numbers(numbers)) if !numbers.is_empty() => {
                self.defined.extend(numbers.iter().map(|_| 2));
                self.repeated.push(0);
                self.repeated.extend(numbers.iter().skip(1).map(|_| 1));
                self.numbers.extend(&numbers);
                return numbers.len() * size_of::<f64>();
            }
            (kind, value) => {
                let empty = kind == Kind::Numbers && matches!(value, Value::Numbers(_));
                self.defined.push(empty.into());
                self.repeated.extend(is_list.then_some(0));
                return 1;
            }
        }
        self.defined.push(1);
        self.texts.last().map_or(8, ByteArray::len)
    }

    /// Writes the cells as the next column of a row group, and clears them.
    fn write(&mut self, group: &mut SerializedRowGroupWriter<'_, AtomicFile>) -> Written<()> {
        let column = group.next_column()?;
        let mut column = column.ok_or_else(|| ParquetError::General("no column is left".into()))?;
        let defined = Some(&self.defined[..]);
        match self.kind {
            Kind::Text => {
                let texts = column.typed::<ByteArrayType>();
                texts.write_batch(&self.texts, defined, None)?
            }
            Kind::Integer => {
                let integers = column.typed::<Int64Type>();
                integers.write_batch(&self.integers, defined, None)?
            }
            Kind::Number | Kind::Numbers => {
                let repeated = (self.kind == Kind::Numbers).then_some(&self.repeated[..]);
                let numbers = column.typed::<DoubleType>();
                numbers.write_batch(&self.numbers, defined, repeated)?
            }
        };
        *self = Self::new(self.kind);
        column.close()
    }
}

/// Reads the records of a table and hands each to `take`, until that returns false. Columns that
/// the file lacks are none; others than those of `schema` are not read.
///
/// # Errors
/// [`Error::File`]; [`Error::Recording`] for a file that is damaged or holds other types; the error
/// of `take`.
pub(crate) fn read_records(
    path: &Path,
    schema: &Schema,
    mut take: impl FnMut(Vec<Value>) -> Result<bool>,
) -> Result<()> {
    let damaged = |problem: String| Error::Recording {
        path: Some(path.to_owned()),
        row: None,
        column: None,
        problem,
    };
    let file = File::open(path).map_err(|source| Error::File {
        path: path.to_owned(),
        source,
    })?;
    let mut mark = [0; 4];
    let is_parquet = (&file).read_exact(&mut mark).is_ok() && mark == *PARQUET_FILE;
    if !is_parquet {
        let problem =
            "this is no table of models, which is a Parquet file: a fit of a fleet makes one";
        return Err(damaged(problem.into()));
    }
    let reader = caught(|| SerializedFileReader::new(file)).map_err(damaged)?;
    let about = reader.metadata().file_metadata().schema_descr_ptr();
    let place = |name: &str| {
        (0..about.num_columns())
            .find(|&n| about.column(n).path().parts().first().map(String::as_str) == Some(name))
    };
    let places: Vec<Option<usize>> = schema.iter().map(|(name, _)| place(name)).collect();
    for n in 0..reader.num_row_groups() {
        let columns = caught(|| {
            let group = reader.get_row_group(n)?;
            let columns = schema.iter().zip(&places);
            let columns = columns.map(|((_, kind), place)| column(group.as_ref(), *place, *kind));
            columns.collect::<Written<Vec<Vec<Value>>>>()
        });
        let columns = columns.map_err(damaged)?;
        let rows = columns.iter().map(Vec::len).max().unwrap_or(0);
        let mut columns: Vec<_> = columns.into_iter().map(Vec::into_iter).collect();
        for _ in 0..rows {
            let record = columns.iter_mut();
            let record = record.map(|cells| cells.next().unwrap_or(Value::None));
            if !take(record.collect())? {
                return Ok(());
            }
        }
    }
    Ok(())
}

/// A column of a row group.
fn column(group: &dyn RowGroupReader, place: Option<usize>, kind: Kind) -> Written<Vec<Value>> {
    let rows = group.metadata().num_rows().max(0) as usize;
    let Some(place) = place else {
        return Ok(Vec::new());
    };
    let text = |bytes: &[u8]| Value::Text(String::from_utf8_lossy(bytes).into_owned());
    use ColumnReader as R;
    // Other programs may store whole numbers as doubles, if some are missing.
    let number = |value: f64| match kind {
        Kind::Integer => Value::Integer(value as i64),
        _ => Value::Number(value),
    };
    match (group.get_column_reader(place)?, kind) {
        (R::DoubleColumnReader(reader), Kind::Numbers) => lists(reader, rows),
        (R::DoubleColumnReader(reader), Kind::Number | Kind::Integer) => {
            cells(reader, rows, |v| number(*v))
        }
        (R::Int64ColumnReader(reader), Kind::Integer) => {
            cells(reader, rows, |v| Value::Integer(*v))
        }
        (R::Int32ColumnReader(reader), Kind::Integer) => {
            cells(reader, rows, |v| Value::Integer((*v).into()))
        }
        (R::ByteArrayColumnReader(reader), Kind::Text) => cells(reader, rows, |v| text(v.data())),
        _ => {
            let name = group.metadata().column(place).column_path().string();
            Err(ParquetError::General(format!(
                "the column `{name}` has another type"
            )))
        }
    }
}

/// Values and levels of a column.
type Stored<T> = (Vec<<T as DataType>::T>, Vec<i16>, Vec<i16>);

fn stored<T: DataType>(mut reader: ColumnReaderImpl<T>, rows: usize) -> Written<Stored<T>> {
    let (mut values, mut defined, mut repeated) = (Vec::new(), Vec::new(), Vec::new());
    let mut read = 0;
    while read < rows {
        let left = rows - read;
        let (records, _, _) =
            reader.read_records(left, Some(&mut defined), Some(&mut repeated), &mut values)?;
        if records == 0 {
            return Err(ParquetError::EOF(format!("{read} of {rows} rows")));
        }
        read += records;
    }
    Ok((values, defined, repeated))
}

fn cells<T: DataType>(
    reader: ColumnReaderImpl<T>,
    rows: usize,
    value: impl Fn(&T::T) -> Value,
) -> Written<Vec<Value>> {
    let (values, defined, _) = stored(reader, rows)?;
    let mut values = values.iter().map(value);
    if defined.is_empty() {
        return Ok(values.collect());
    }
    let cell = |level: &i16| match level {
        0 => Value::None,
        _ => values.next().unwrap_or(Value::None),
    };
    Ok(defined.iter().map(cell).collect())
}

/// Lists of numbers: a repetition level of 0 begins one.
fn lists(
    reader: ColumnReaderImpl<parquet::data_type::DoubleType>,
    rows: usize,
) -> Written<Vec<Value>> {
    let (values, defined, repeated) = stored(reader, rows)?;
    let largest = defined.iter().copied().max().unwrap_or(0);
    let mut values = values.into_iter();
    let mut lists: Vec<Value> = Vec::with_capacity(rows);
    for (level, again) in defined.iter().zip(&repeated) {
        if *again == 0 {
            lists.push(match level {
                0 => Value::None,
                _ => Value::Numbers(Vec::new()),
            });
        }
        if *level == largest
            && largest > 1
            && let (Some(Value::Numbers(list)), Some(value)) = (lists.last_mut(), values.next())
        {
            list.push(value);
        }
    }
    Ok(lists)
}
