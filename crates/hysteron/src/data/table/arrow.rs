//! Reads Arrow files (Feather of version 2) and streams, one part at a time.

mod batches;
mod numbers;

pub(in crate::data) use batches::{Batches, FILE, caught};

use super::TableReader;
use super::budget::Budget;
use super::numbers::Numbers;
use super::stored::{Asked, Format, Opened, Stored};
use arrow_array::cast::AsArray;
use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::{ArrowError, DataType, Fields};

/// Arrow files and streams, read one part at a time.
pub(super) struct Arrow;

impl Format for Arrow {
    fn begins(&self, head: &[u8]) -> bool {
        head.starts_with(FILE) || head.starts_with(batches::STREAM)
    }

    fn endings(&self) -> &'static [&'static str] {
        &["arrow", "arrows", "feather"]
    }

    fn misnamed(&self) -> &'static str {
        "this is no Arrow file or stream, for all its name"
    }

    fn open(
        &self,
        file: Stored<'_>,
        asked: Asked<'_>,
        budget: &mut Budget,
    ) -> Result<Opened, String> {
        let (input, bytes) = file.open()?;
        open(Batches::open(input, bytes, budget.another())?, bytes, asked)
    }
}

/// A column within the fields of records: its name, and the place of the field at each depth.
struct Leaf {
    name: String,
    path: Vec<usize>,
    of: DataType,
}

/// The numeric columns of a table: their names and rows. Times are converted to seconds. A column
/// of labels, if asked for, comes last, as codes.
fn open(
    mut batches: Batches,
    bytes: u64,
    Asked { labels, wanted }: Asked<'_>,
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

impl TableReader {
    /// The parts of an Arrow table, read once more from the first one on; `None` for another format.
    ///
    /// # Errors
    /// The problem of the file.
    pub(in crate::data) fn batches(&self) -> Result<Option<Batches>, String> {
        let file = self.stored();
        if !file.is(&Arrow)? {
            return Ok(None);
        }
        let (input, bytes) = file.open()?;
        Batches::open(input, bytes, self.budget.another()).map(Some)
    }
}
