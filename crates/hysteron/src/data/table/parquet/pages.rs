//! Reads all pages of a Parquet file whose columns are copied as they are stored.

use super::claims::Claims;
use super::{Parquet, caught, check_claims, refused};
use crate::data::table::TableReader;
use crate::data::table::budget::Budget;
use crate::data::table::stored::ReadSeek;
use parquet::basic::ConvertedType as C;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;
use parquet::file::metadata::ParquetMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use std::fs::File;

/// So many records are read at once.
const RECORDS: usize = 1 << 14;

/// A file, and what it claims.
pub(in crate::data) struct Pages {
    reader: SerializedFileReader<File>,
    claims: Claims,
}

impl TableReader {
    /// The file of a Parquet table and all its pages; `None` for another format, and for a table in
    /// memory.
    ///
    /// # Errors
    /// The problem of the file.
    pub(in crate::data) fn pages(&self) -> Result<Option<(File, Pages)>, String> {
        let file = self.stored();
        if file.held.is_some() || !file.is(&Parquet)? {
            return Ok(None);
        }
        let file = File::open(file.path).map_err(|error| error.to_string())?;
        let pages = Pages::open(&file, self.budget.another())?;
        Ok(Some((file, pages)))
    }
}

impl Pages {
    /// # Errors
    /// The problem of the file.
    pub(in crate::data) fn open(file: &File, budget: Budget) -> Result<Self, String> {
        let text = |error: std::io::Error| error.to_string();
        let length = file.metadata().map_err(text)?.len();
        let again = || file.try_clone().map_err(text);
        let second: Box<dyn ReadSeek> = Box::new(again()?);
        let mut claims = Claims::new(second, length, budget);
        claims.check_footer().map_err(refused)?;
        let file = again()?;
        let reader = caught(|| SerializedFileReader::new(file))?;
        Ok(Self { reader, claims })
    }

    pub(in crate::data) fn about(&self) -> &ParquetMetaData {
        self.reader.metadata()
    }

    /// Reads every value of a row group, so that a copy of its bytes can be read too.
    ///
    /// # Errors
    /// The problem of the file.
    pub(in crate::data) fn check(&mut self, group: usize) -> Result<(), String> {
        let about = self.reader.metadata().row_group(group);
        let columns: Vec<usize> = (0..about.num_columns()).collect();
        check_claims(&mut self.claims, about, &columns)?;
        let rows = usize::try_from(about.num_rows()).unwrap_or_default();
        caught(|| {
            let group = self.reader.get_row_group(group)?;
            for column in columns {
                use ColumnReader as R;
                let converted = group
                    .metadata()
                    .column(column)
                    .column_descr()
                    .converted_type();
                let is_text = matches!(converted, C::UTF8 | C::ENUM | C::JSON);
                match group.get_column_reader(column)? {
                    R::BoolColumnReader(reader) => read(reader, rows),
                    R::Int32ColumnReader(reader) => read(reader, rows),
                    R::Int64ColumnReader(reader) => read(reader, rows),
                    R::Int96ColumnReader(reader) => read(reader, rows),
                    R::FloatColumnReader(reader) => read(reader, rows),
                    R::DoubleColumnReader(reader) => read(reader, rows),
                    R::ByteArrayColumnReader(reader) if is_text => read_as(reader, rows, text),
                    R::ByteArrayColumnReader(reader) => read(reader, rows),
                    R::FixedLenByteArrayColumnReader(reader) => read(reader, rows),
                }?;
            }
            Ok(())
        })
    }
}

/// Reads the records of a column, and forgets them. There have to be as many as rows.
fn read<T: DataType>(reader: ColumnReaderImpl<T>, rows: usize) -> Result<(), ParquetError> {
    read_as(reader, rows, |_| Ok(()))
}

/// Text has to be UTF-8.
fn text(value: &ByteArray) -> Result<(), ParquetError> {
    value.as_utf8().map(|_| ())
}

fn read_as<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    rows: usize,
    check: impl Fn(&T::T) -> Result<(), ParquetError>,
) -> Result<(), ParquetError> {
    let (mut values, mut defined, mut repeated) = (Vec::new(), Vec::new(), Vec::new());
    let mut found = 0;
    loop {
        let levels = (Some(&mut defined), Some(&mut repeated));
        let (records, ..) = reader.read_records(RECORDS, levels.0, levels.1, &mut values)?;
        values.iter().try_for_each(&check)?;
        found += records;
        if records == 0 {
            break;
        }
        values.clear();
        defined.clear();
        repeated.clear();
    }
    match found == rows {
        true => Ok(()),
        false => Err(ParquetError::EOF(format!("{found} of {rows} rows"))),
    }
}
