//! Presents the variables of a MATLAB file as the columns of a table.

pub(super) mod v5;
#[cfg(feature = "hdf5")]
pub(super) mod v73;

use super::budget::Budget;
use super::numbers::Numbers;

/// Largest depth of nested structures that is read.
const DEEPEST: usize = 16;

/// A numeric variable, with its values column by column. A field of a structure is named
/// `structure.field`.
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) values: Vec<f64>,
}

/// The columns of the variables. A row or column vector is a column under its own name. A matrix
/// `M` gives `M:1`, `M:2` and so on.
pub(super) fn table(
    variables: Vec<Variable>,
    budget: &mut Budget,
) -> Result<(Vec<String>, Numbers), String> {
    let (mut header, mut columns) = (Vec::new(), Vec::new());
    for variable in variables {
        if variable.values.is_empty() {
            continue;
        }
        if variable.rows == 1 || variable.columns == 1 {
            header.push(variable.name);
            columns.push(variable.values);
            continue;
        }
        // The columns and the matrix are in memory at the same time.
        let copy = 8 * variable.values.len() as u128;
        let name = (variable.name.len() as u128 + 100) * variable.columns as u128;
        budget.take(copy + name, format_args!("`{}`", variable.name))?;
        for (n, column) in variable.values.chunks(variable.rows).enumerate() {
            header.push(format!("{}:{}", variable.name, n + 1));
            columns.push(column.to_vec());
        }
        budget.give_back(copy);
    }
    if header.is_empty() {
        return Err(
            "there is no array of real numbers in this file: save vectors, not cells or tables"
                .into(),
        );
    }
    Ok((header, Numbers::held_whole(columns)))
}
