//! Variables of a MATLAB file as the columns of a table.

use super::numbers::Numbers;

/// A numeric variable with its values column by column.
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) values: Vec<f64>,
}

/// A vector, lying or standing, as a column of its name; a matrix `M` as `M:1`, `M:2` and so on.
pub(super) fn table(variables: Vec<Variable>) -> Result<(Vec<String>, Numbers), String> {
    let (mut header, mut columns) = (Vec::new(), Vec::new());
    for variable in variables {
        if variable.values.is_empty() {
            continue;
        }
        if variable.rows == 1 || variable.columns == 1 {
            header.push(variable.name);
            columns.push(variable.values);
        } else {
            for (n, column) in variable.values.chunks(variable.rows).enumerate() {
                header.push(format!("{}:{}", variable.name, n + 1));
                columns.push(column.to_vec());
            }
        }
    }
    if header.is_empty() {
        return Err("there is no array of real numbers in this file: save vectors, not structures, cells or tables".into());
    }
    Ok((header, Numbers::held_whole(columns)))
}
