//! MATLAB files of version 7.3, which are HDF5 files.

use super::mat::Variable;
use hdf5_pure::{AttrValue, DType, File};
use std::path::Path;

/// The real numeric arrays of a file with at most two dimensions.
pub(super) fn read(path: &Path) -> Result<Vec<Variable>, String> {
    let damaged = |error: hdf5_pure::Error| {
        format!("the MATLAB 7.3 file is damaged or cut off ({error}): save or copy it again")
    };
    let file = File::open(path).map_err(damaged)?;
    let mut variables = Vec::new();
    for (name, data) in file.root().iter_datasets().map_err(damaged)? {
        use DType::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
        let numeric = matches!(
            data.dtype().map_err(damaged)?,
            F32 | F64 | I8 | I16 | I32 | I64 | U8 | U16 | U32 | U64
        );
        let attributes = data.attrs().map_err(damaged)?;
        let text = match attributes.get("MATLAB_class") {
            Some(
                AttrValue::String(value)
                | AttrValue::AsciiString(value)
                | AttrValue::StringSized { value, .. }
                | AttrValue::AsciiStringSized { value, .. },
            ) => value == "char",
            _ => false,
        };
        // The stored numbers of an empty array are its sizes.
        if !numeric || text || attributes.contains_key("MATLAB_empty") {
            continue;
        }
        // HDF5 counts dimensions the other way round; the numbers lie column by column all the same.
        let (rows, columns) = match data.shape().map_err(damaged)?[..] {
            [] => (1, 1),
            [rows] => (rows, 1),
            [columns, rows] => (rows, columns),
            _ => continue,
        };
        let values = data.read_f64().map_err(damaged)?;
        variables.push(Variable {
            name,
            rows: rows as usize,
            columns: columns as usize,
            values,
        });
    }
    Ok(variables)
}
