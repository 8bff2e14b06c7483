//! Reads Parquet files, one row group at a time.

mod claims;
mod pages;
mod thrift;

use super::budget::Budget;
use super::labels::Labels;
use super::numbers::{Group, Numbers};
use super::quiet;
use super::stored::{Asked, Format, Opened, ReadSeek, Stored};
use claims::{Claims, Refusal};
pub(in crate::data) use pages::Pages;
use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{DataType, Int96};
use parquet::errors::ParquetError;
use parquet::file::metadata::RowGroupMetaData;
use parquet::file::reader::{ChunkReader, FileReader, RowGroupReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;
use std::fmt::Display;
use std::fs::File;

/// The first bytes of a Parquet file.
pub(in crate::data) const MARK: &[u8; 4] = b"PAR1";

/// Parquet, read one row group at a time.
pub(super) struct Parquet;

impl Format for Parquet {
    fn begins(&self, head: &[u8]) -> bool {
        head.starts_with(MARK)
    }

    fn endings(&self) -> &'static [&'static str] {
        &["parquet"]
    }

    fn misnamed(&self) -> &'static str {
        "this is no Parquet file, for all its name: it does not begin with `PAR1`"
    }

    fn open(
        &self,
        file: Stored<'_>,
        asked: Asked<'_>,
        budget: &mut Budget,
    ) -> Result<Opened, String> {
        let budget = budget.another();
        if let Some(held) = file.held {
            let (second, bytes) = file.open()?;
            return open(held.clone(), second, bytes, (asked, budget));
        }
        // Opened once: what is checked is what is read, also if the name is given to another file.
        let text = |error: std::io::Error| error.to_string();
        let file = File::open(file.path).map_err(text)?;
        let bytes = file.metadata().map_err(text)?.len();
        let second = Box::new(file.try_clone().map_err(text)?);
        open(file, second, bytes, (asked, budget))
    }
}

/// The columns of a file of which `second` checks the claims before the library reads them.
fn open(
    file: impl ChunkReader + 'static,
    second: Box<dyn ReadSeek>,
    bytes: u64,
    (Asked { labels, wanted }, budget): (Asked<'_>, Budget),
) -> Result<Opened, String> {
    let mut claims = Claims::new(second, bytes, budget);
    claims.check_footer().map_err(refused)?;
    let reader = caught(|| SerializedFileReader::new(file))?;
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let numeric: Vec<(usize, Scale)> = (0..schema.num_columns())
        .filter_map(|n| Some((n, Scale::of(&schema.column(n))?)))
        .collect();
    let name = |(n, _): &(usize, Scale)| schema.column(*n).path().string();
    let mut header: Vec<String> = numeric.iter().map(name).collect();
    if header.is_empty() {
        return Err("there is no column of numbers in this file".into());
    }
    let times = (0..numeric.len())
        .filter(|n| numeric[*n].1.is_time)
        .collect();
    let rows = reader.metadata().file_metadata().num_rows();
    let names: Vec<String> = (0..schema.num_columns())
        .map(|n| schema.column(n).path().string())
        .collect();
    let labels = match labels {
        None => None,
        Some(labels) => {
            let column = labels.find(&names)?;
            if schema.column(column).max_rep_level() > 0 {
                return Err(format!(
                    "`{}` holds lists, which are no labels",
                    names[column]
                ));
            }
            header.push(names[column].clone());
            Some((column, labels.clone()))
        }
    };
    let wanted = wanted.clone();
    let groups = (0..reader.num_row_groups()).map(move |n| {
        let about = &reader.metadata().row_groups()[n];
        let read_here = numeric.iter().enumerate();
        let read_here = read_here.filter(|(n, _)| wanted.contains(*n));
        let read_here = read_here.map(|(_, (column, _))| *column);
        let columns: Vec<usize> = read_here.chain(labels.iter().map(|(n, _)| *n)).collect();
        check_claims(&mut claims, about, &columns)?;
        caught(|| {
            let group = reader.get_row_group(n)?;
            let columns = numeric.iter().enumerate();
            let columns = columns.map(|(n, (column, scale))| match wanted.contains(n) {
                true => read(group.as_ref(), *column, *scale),
                false => Ok(Vec::new()),
            });
            let mut columns = columns.collect::<Result<Group, _>>()?;
            if let Some((column, labels)) = &labels {
                columns.push(read_labels(group.as_ref(), *column, labels)?);
            }
            Ok(columns)
        })
    });
    Ok(Opened {
        header,
        times,
        numbers: Numbers::in_groups(groups, rows.max(0) as u64, bytes),
    })
}

fn refused(refusal: Refusal) -> String {
    match refusal {
        Refusal::Damaged(problem) => damaged(problem),
        Refusal::Unread(problem) | Refusal::TooLarge(problem) => problem,
    }
}

/// Calls the Parquet library. It panics if a damaged file contradicts itself; the panic becomes an
/// error.
pub(crate) fn caught<T>(use_it: impl FnOnce() -> Result<T, ParquetError>) -> Result<T, String> {
    quiet::caught(use_it)
        .ok_or_else(contradiction)?
        .map_err(damaged)
}

/// Checks what a row group claims of these columns. Negative sizes make the library panic here too.
fn check_claims(
    claims: &mut Claims,
    group: &RowGroupMetaData,
    columns: &[usize],
) -> Result<(), String> {
    quiet::caught(|| claims.check_group(group, columns))
        .ok_or_else(contradiction)?
        .map_err(refused)
}

fn contradiction() -> String {
    damaged("it contradicts itself")
}

fn damaged(error: impl Display) -> String {
    format!("the Parquet file is damaged or cut off ({error}): write or copy it again")
}

/// The conversion of a stored number to its meaning.
#[derive(Clone, Copy)]
struct Scale {
    factor: f64,
    unsigned: bool,
    is_time: bool,
}

impl Scale {
    /// `None` for a column that does not have a single number per row.
    fn of(column: &ColumnDescriptor) -> Option<Self> {
        let stored = column.physical_type();
        if column.max_rep_level() > 0
            || matches!(stored, Type::BYTE_ARRAY | Type::FIXED_LEN_BYTE_ARRAY)
        {
            return None;
        }
        use ConvertedType::{
            DATE, DECIMAL, TIME_MICROS, TIME_MILLIS, TIMESTAMP_MICROS, TIMESTAMP_MILLIS, UINT_8,
            UINT_16, UINT_32, UINT_64,
        };
        let converted = column.converted_type();
        let nanoseconds = matches!(
            column.logical_type_ref(),
            Some(LogicalType::Timestamp(time) | LogicalType::Time(time))
                if time.unit == TimeUnit::NANOS
        );
        let factor = match converted {
            _ if nanoseconds || stored == Type::INT96 => 1e-9,
            TIME_MICROS | TIMESTAMP_MICROS => 1e-6,
            TIME_MILLIS | TIMESTAMP_MILLIS => 1e-3,
            DATE => 86_400.0,
            DECIMAL => 10_f64.powi(-column.type_scale()),
            _ => 1.0,
        };
        Some(Self {
            factor,
            unsigned: matches!(converted, UINT_8 | UINT_16 | UINT_32 | UINT_64),
            is_time: factor != 1.0 && converted != DECIMAL,
        })
    }

    fn apply(self, stored: f64) -> f64 {
        // Dividing by a whole number is exact, multiplying by its inverse is not.
        match self.factor < 1.0 {
            true => stored / (1.0 / self.factor).round(),
            false => stored * self.factor,
        }
    }
}

/// A column of a row group.
fn read(group: &dyn RowGroupReader, column: usize, scale: Scale) -> Result<Vec<f64>, ParquetError> {
    let rows = group.metadata().num_rows().max(0) as usize;
    let defined = group
        .metadata()
        .column(column)
        .column_descr()
        .max_def_level();
    use ColumnReader as R;
    match group.get_column_reader(column)? {
        R::BoolColumnReader(reader) => numbers(reader, rows, defined, |v| f64::from(u8::from(*v))),
        R::Int32ColumnReader(reader) if scale.unsigned => {
            numbers(reader, rows, defined, |v| f64::from(*v as u32))
        }
        R::Int32ColumnReader(reader) => {
            numbers(reader, rows, defined, |v| scale.apply(f64::from(*v)))
        }
        R::Int64ColumnReader(reader) if scale.unsigned => {
            numbers(reader, rows, defined, |v| *v as u64 as f64)
        }
        R::Int64ColumnReader(reader) => numbers(reader, rows, defined, |v| scale.apply(*v as f64)),
        R::Int96ColumnReader(reader) => numbers(reader, rows, defined, |v: &Int96| {
            scale.apply(v.to_nanos() as f64)
        }),
        R::FloatColumnReader(reader) => numbers(reader, rows, defined, |v| f64::from(*v)),
        R::DoubleColumnReader(reader) => numbers(reader, rows, defined, |v| *v),
        // `Scale::of` accepts none of these types.
        R::ByteArrayColumnReader(_) | R::FixedLenByteArrayColumnReader(_) => {
            Ok(vec![f64::NAN; rows])
        }
    }
}

/// A column of labels, as codes.
fn read_labels(
    group: &dyn RowGroupReader,
    column: usize,
    labels: &Labels,
) -> Result<Vec<f64>, ParquetError> {
    let about = group.metadata();
    let rows = about.num_rows().max(0) as usize;
    let of_column = about.column(column).column_descr();
    let defined = of_column.max_def_level();
    let unsigned = Scale::of(of_column).is_some_and(|scale| scale.unsigned);
    use ColumnReader as R;
    let as_text = |text: String| labels.code(text.as_bytes());
    let codes = match group.get_column_reader(column)? {
        R::ByteArrayColumnReader(reader) => {
            numbers(reader, rows, defined, |v| labels.code(v.data()))
        }
        R::FixedLenByteArrayColumnReader(reader) => {
            numbers(reader, rows, defined, |v| labels.code(v.data()))
        }
        R::BoolColumnReader(reader) => numbers(reader, rows, defined, |v| as_text(v.to_string())),
        R::Int32ColumnReader(reader) if unsigned => {
            numbers(reader, rows, defined, |v| as_text((*v as u32).to_string()))
        }
        R::Int32ColumnReader(reader) => numbers(reader, rows, defined, |v| as_text(v.to_string())),
        R::Int64ColumnReader(reader) if unsigned => {
            numbers(reader, rows, defined, |v| as_text((*v as u64).to_string()))
        }
        R::Int64ColumnReader(reader) => numbers(reader, rows, defined, |v| as_text(v.to_string())),
        R::Int96ColumnReader(reader) => {
            numbers(reader, rows, defined, |v| as_text(v.to_nanos().to_string()))
        }
        R::FloatColumnReader(reader) => numbers(reader, rows, defined, |v| as_text(v.to_string())),
        R::DoubleColumnReader(reader) => numbers(reader, rows, defined, |v| as_text(v.to_string())),
    }?;
    Ok(codes)
}

/// All values of a column, NaN for null.
fn numbers<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    rows: usize,
    defined: i16,
    number: impl Fn(&T::T) -> f64,
) -> Result<Vec<f64>, ParquetError> {
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    let mut read = 0;
    while read < rows {
        let (records, _, _) =
            reader.read_records(rows - read, Some(&mut levels), None, &mut values)?;
        if records == 0 {
            return Err(ParquetError::EOF(format!("{read} of {rows} rows")));
        }
        read += records;
    }
    let mut values = values.iter().map(number);
    if defined == 0 {
        return Ok(values.collect());
    }
    let cell = |level: &i16| match *level == defined {
        true => values.next().unwrap_or(f64::NAN),
        false => f64::NAN,
    };
    Ok(levels.iter().map(cell).collect())
}
