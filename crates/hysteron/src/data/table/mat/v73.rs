//! Reads MATLAB files of version 7.3, which are HDF5 files.

use super::variable::{DEEPEST, Variable};
use crate::data::table::budget::Budget;
use crate::data::table::quiet::caught;
use bytes::Bytes;
use hdf5_pure::{AttrValue, DType, Dataset, Error, File, FormatError, Group, Layout};
use std::path::Path;

/// Largest number of groups that are read. Links between groups can form circles.
const MOST_GROUPS: usize = 10_000;

/// The real numeric arrays of a file with at most two dimensions. A group is a MATLAB structure;
/// arrays in it are named `group.name`.
pub(in crate::data::table) fn read(
    path: &Path,
    held: Option<&Bytes>,
    budget: &mut Budget,
) -> Result<Vec<Variable>, String> {
    let size = match held {
        Some(bytes) => bytes.len() as u64,
        None => std::fs::metadata(path).map_or(0, |about| about.len()),
    };
    // The library keeps the file in memory, and the same amount again for what it finds in it.
    budget.take(2 * u128::from(size), "the file")?;
    let mut found = Found {
        variables: Vec::new(),
        groups: 0,
        budget,
    };
    let read = || {
        let file = match held {
            Some(bytes) => File::from_bytes(bytes.to_vec()),
            None => File::open(path),
        };
        let file = file.map_err(damaged)?;
        found.group(&file.root(), "", 0)
    };
    // The library panics if a damaged file contradicts itself.
    caught(read).ok_or_else(|| damaged("it contradicts itself"))??;
    found.budget.give_back(2 * u128::from(size));
    Ok(found.variables)
}

/// The library names a filter by its number in the registry of HDF5.
fn unread(filter: u16) -> String {
    let name = match filter {
        4 => "szip".into(),
        5 => "n-bit".into(),
        32_000 => "LZF".into(),
        32_001 => "Blosc".into(),
        32_004 => "LZ4".into(),
        32_008 => "bitshuffle".into(),
        32_015 => "Zstandard".into(),
        other => format!("filter {other}"),
    };
    format!("an array is packed with {name}, which is not read here: save the file with gzip")
}

fn read_failed(error: Error) -> String {
    match error {
        Error::Format(FormatError::UnsupportedFilter(filter)) => unread(filter),
        other => damaged(other),
    }
}

fn damaged(error: impl std::fmt::Display) -> String {
    format!("the MATLAB 7.3 file is damaged or cut off ({error}): save or copy it again")
}

/// The variables found so far, and the memory left.
struct Found<'f> {
    variables: Vec<Variable>,
    groups: usize,
    budget: &'f mut Budget,
}

impl Found<'_> {
    /// Reads the arrays of a group, with `prefix` before their names, and those of its subgroups.
    fn group(&mut self, group: &Group, prefix: &str, depth: usize) -> Result<(), String> {
        self.groups += 1;
        if self.groups > MOST_GROUPS {
            return Err(format!(
                "there are more than {MOST_GROUPS} structures in this file: save the arrays alone"
            ));
        }
        for (name, data) in group.iter_datasets().map_err(damaged)? {
            self.dataset(format!("{prefix}{name}"), &data)?;
        }
        if depth == DEEPEST {
            return Ok(());
        }
        for (name, inner) in group.iter_groups().map_err(damaged)? {
            // MATLAB stores cells and objects in groups whose names begin with `#`.
            if !name.starts_with('#') {
                self.group(&inner, &format!("{prefix}{name}."), depth + 1)?;
            }
        }
        Ok(())
    }

    fn dataset(&mut self, name: String, data: &Dataset) -> Result<(), String> {
        use DType::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
        let numeric = matches!(
            data.dtype().map_err(damaged)?,
            F32 | F64 | I8 | I16 | I32 | I64 | U8 | U16 | U32 | U64
        );
        if !numeric || is_text_or_empty(data).map_err(damaged)? {
            return Ok(());
        }
        // HDF5 lists dimensions in reverse order. The numbers are stored column by column all the
        // same.
        let shape = data.shape().map_err(damaged)?;
        let (rows, columns) = match shape[..] {
            [] => (1, 1),
            [rows] => (rows, 1),
            [columns, rows] => (rows, columns),
            _ => return Ok(()),
        };
        let count = u128::from(rows) * u128::from(columns);
        let held = 8 * count + name.len() as u128 + 100;
        let layout = data.layout().map_err(damaged)?;
        let element = data.element_size().map_err(damaged)?;
        let working = working_memory(&layout, element, &shape, count);
        self.budget
            .check(held + working, format_args!("`{name}`"))?;
        if data
            .chunks()
            .is_ok_and(|listed| listed.len() as u128 > chunks(&layout, &shape))
        {
            return Err(damaged("an array has more chunks than it claims"));
        }
        self.budget.take(held, format_args!("`{name}`"))?;
        let values = data.read_f64().map_err(read_failed)?;
        if values.len() as u128 != count {
            return Err(damaged("an array is not of the size that it claims"));
        }
        self.variables.push(Variable {
            name,
            rows: rows as usize,
            columns: columns as usize,
            values,
        });
        Ok(())
    }
}

/// An empty array stores its sizes instead of numbers.
fn is_text_or_empty(data: &Dataset) -> Result<bool, Error> {
    let attributes = data.attrs()?;
    let text = match attributes.get("MATLAB_class") {
        Some(
            AttrValue::String(value)
            | AttrValue::AsciiString(value)
            | AttrValue::StringSized { value, .. }
            | AttrValue::AsciiStringSized { value, .. },
        ) => value == "char",
        _ => false,
    };
    Ok(text || attributes.contains_key("MATLAB_empty"))
}

/// Number of chunks that cover an array; 1 for an array in one piece.
fn chunks(layout: &Layout, shape: &[u64]) -> u128 {
    let Layout::Chunked { chunk_shape, .. } = layout else {
        return 1;
    };
    shape
        .iter()
        .zip(chunk_shape)
        .fold(1, |chunks: u128, (side, chunk)| {
            chunks.saturating_mul(u128::from(side.div_ceil((*chunk).max(1))))
        })
}

/// The memory that the library needs to read `count` numbers, in addition to the numbers: their
/// bytes, and all chunks at once while they are unpacked.
fn working_memory(layout: &Layout, element: u64, shape: &[u64], count: u128) -> u128 {
    // A sum of a few numbers up to this does not overflow a u128.
    const MOST: u128 = u128::MAX >> 4;
    let bytes = count.saturating_mul(u128::from(element)).min(MOST);
    let Layout::Chunked { chunk_shape, .. } = layout else {
        return 2 * bytes;
    };
    let chunk = chunk_shape.iter().fold(u128::from(element), |bytes, side| {
        bytes.saturating_mul(u128::from(*side))
    });
    // An entry of the index takes some hundred bytes, and unpacking a chunk takes twice its size in
    // addition.
    const ENTRY: u128 = 256;
    let all = chunks(layout, shape).saturating_add(2);
    chunk.saturating_add(ENTRY).saturating_mul(all).min(MOST) + 2 * bytes
}
