//! Reads Arrow files (Feather of version 2) and streams, one part at a time.

mod batches;
mod numbers;

pub(in crate::data) use batches::{Batches, FILE, STREAM, caught};

use super::TableReader;
use super::budget::Budget;
use super::labels::Labels;
use super::numbers::Numbers;
use super::parquet::{Opened, ReadSeek};
use super::wanted::Wanted;
use arrow_array::cast::AsArray;
use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::{ArrowError, DataType, Fields};
use bytes::Bytes;
use std::fs::File;
use std::io::Cursor;
use std::path::Path;

/// A column within the fields of records: its name, and the place of the field at each depth.
struct Leaf {
    name: String,
    path: Vec<usize>,
    of: DataType,
}

/// The numeric columns of a table: their names and rows. Times are converted to seconds. A column
/// of labels, if asked for, comes last, as codes.
pub(super) fn open(
    mut batches: Batches,
    bytes: u64,
    (labels, wanted): (Option<&Labels>, &Wanted),
) -> Result<Opened, String> {
    let mut leaves = Vec::new();
    add_leaves(batches.schema().fields(), &mut Vec::new(), "", &mut leaves);
    let label = match labels {
        None => None,
        Some(labels) => {
            let names: Vec<String> = leaves.iter().map(|leaf| leaf.name.clone()).collect();
            let found = labels.find(&names)?;
            let Leaf { name, path, of } = &leaves[found];
            if of.is_nested() && !matches!(of, DataType::Dictionary(..)) {
                return Err(format!("`{name}` holds lists, which are no labels"));
            }
            Some((name.clone(), path.clone(), labels.clone()))
        }
    };
    leaves.retain(|leaf| numbers::is_number(&leaf.of));
    if leaves.is_empty() {
        return Err("there is no column of numbers in this file".into());
    }
    let is_time = |n: &usize| numbers::is_time(&leaves[*n].of);
    let times = (0..leaves.len()).filter(is_time).collect();
    let names = leaves.iter().map(|leaf| leaf.name.clone());
    let header = names
        .chain(label.iter().map(|(name, ..)| name.clone()))
        .collect();
    let rows = batches.rows();
    let wanted = wanted.clone();
    let groups = std::iter::from_fn(move || {
        let read = |(n, leaf): (usize, &Leaf)| wanted.contains(n).then(|| leaf.path[0]);
        let read = leaves.iter().enumerate().filter_map(read);
        let mut fields: Vec<usize> = read
            .chain(label.iter().map(|(_, path, _)| path[0]))
            .collect();
        fields.sort_unstable();
        fields.dedup();
        let batch = batches.next(Some(&fields)).transpose()?;
        Some(batch.and_then(|batch| {
            caught(|| {
                let columns = leaves
                    .iter()
                    .enumerate()
                    .map(|(n, leaf)| match wanted.contains(n) {
                        true => numbers::numbers(column(&batch, &fields, &leaf.path)?.as_ref()),
                        false => Ok(Vec::new()),
                    });
                let mut columns = columns.collect::<Result<Vec<_>, _>>()?;
                if let Some((_, path, labels)) = &label {
                    let array = column(&batch, &fields, path)?;
                    columns.push(numbers::codes(array.as_ref(), labels)?);
                }
                Ok(columns)
            })
        }))
    });
    Ok(Opened {
        header,
        times,
        numbers: Numbers::in_groups(groups, rows, bytes),
    })
}

/// Adds the columns without parts of their own, in order. The name of a part is `record.part`.
fn add_leaves(fields: &Fields, path: &mut Vec<usize>, above: &str, leaves: &mut Vec<Leaf>) {
    for (n, field) in fields.iter().enumerate() {
        path.push(n);
        let name = format!("{above}{}", field.name());
        match field.data_type() {
            DataType::Struct(parts) => add_leaves(parts, path, &format!("{name}."), leaves),
            of => leaves.push(Leaf {
                name,
                path: path.clone(),
                of: of.clone(),
            }),
        }
        path.pop();
    }
}

/// A column of a part of which these `fields` were read. Where a record is null, so are its parts.
fn column(batch: &RecordBatch, fields: &[usize], path: &[usize]) -> Result<ArrayRef, ArrowError> {
    let missing = || ArrowError::SchemaError("a column is missing".into());
    let (first, rest) = path.split_first().ok_or_else(missing)?;
    let place = fields.binary_search(first).map_err(|_| missing())?;
    let mut array = batch.column(place).clone();
    for part in rest {
        let record = array.as_struct();
        let inner = record.column(*part);
        array = match record.nulls() {
            None => inner.clone(),
            Some(nulls)
                if matches!(inner.data_type(), DataType::Null) || nulls.null_count() == 0 =>
            {
                inner.clone()
            }
            Some(nulls) => {
                let both = arrow_buffer::NullBuffer::union(Some(nulls), inner.nulls());
                let data = inner.to_data().into_builder().nulls(both);
                arrow_array::make_array(data.build()?)
            }
        };
    }
    Ok(array)
}

/// The parts of a file, or of its bytes.
pub(super) fn batches(
    path: &Path,
    held: Option<&Bytes>,
    budget: Budget,
) -> Result<(Batches, u64), String> {
    let text = |error: std::io::Error| error.to_string();
    let (input, length): (Box<dyn ReadSeek>, u64) = match held {
        Some(bytes) => (Box::new(Cursor::new(bytes.clone())), bytes.len() as u64),
        None => {
            let file = File::open(path).map_err(text)?;
            let length = file.metadata().map_err(text)?.len();
            (Box::new(file), length)
        }
    };
    Ok((Batches::open(input, length, budget)?, length))
}

impl TableReader {
    /// The parts of an Arrow table, read once more from the first one on; `None` for another format.
    ///
    /// # Errors
    /// The problem of the file.
    pub(in crate::data) fn batches(&self) -> Result<Option<Batches>, String> {
        match self.is_arrow {
            false => Ok(None),
            true => batches(&self.path, self.held.as_ref(), self.budget.another())
                .map(|(found, _)| Some(found)),
        }
    }
}
