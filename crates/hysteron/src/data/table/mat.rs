//! MATLAB files: the variables of a file are the columns of a table.

mod v5;
#[cfg(feature = "hdf5")]
mod v73;
mod variable;

use super::budget::Budget;
use super::numbers::Numbers;
use super::stored::{Asked, Format, Opened, Stored};
use variable::Variable;

/// MATLAB files of versions 5 and 7.
pub(super) struct MatV5;
/// MATLAB files of version 7.3.
pub(super) struct MatV73;

impl Format for MatV5 {
    fn begins(&self, head: &[u8]) -> bool {
        head.starts_with(b"MATLAB 5.0")
    }

    fn endings(&self) -> &'static [&'static str] {
        &["mat"]
    }

    fn misnamed(&self) -> &'static str {
        "this is no MATLAB file of version 5, 7 or 7.3: save it in MATLAB with `-v7`"
    }

    fn open(&self, file: Stored<'_>, _: Asked<'_>, budget: &mut Budget) -> Result<Opened, String> {
        // Bytes that are there already are their holder's.
        if let Some(bytes) = file.held {
            return table(v5::read(bytes, budget)?, budget);
        }
        let text = |error: std::io::Error| error.to_string();
        let length = std::fs::metadata(file.path).map_err(text)?.len();
        budget.take(u128::from(length), "the file")?;
        let variables = v5::read(&std::fs::read(file.path).map_err(text)?, budget)?;
        budget.give_back(u128::from(length));
        table(variables, budget)
    }
}

impl Format for MatV73 {
    fn begins(&self, head: &[u8]) -> bool {
        head.starts_with(b"MATLAB 7.3") || head.starts_with(b"\x89HDF\r\n\x1a\n")
    }

    fn endings(&self) -> &'static [&'static str] {
        MatV5.endings()
    }

    fn misnamed(&self) -> &'static str {
        MatV5.misnamed()
    }

    #[cfg(feature = "hdf5")]
    fn open(&self, file: Stored<'_>, _: Asked<'_>, budget: &mut Budget) -> Result<Opened, String> {
        table(v73::read(file.path, file.held, budget)?, budget)
    }

    #[cfg(not(feature = "hdf5"))]
    fn open(&self, _: Stored<'_>, _: Asked<'_>, _: &mut Budget) -> Result<Opened, String> {
        Err("this build does not read MATLAB 7.3: save the file in MATLAB with `-v7`".into())
    }
}

/// The columns of the variables. A row or column vector is a column under its own name. A matrix
/// `M` gives `M:1`, `M:2` and so on.
fn table(variables: Vec<Variable>, budget: &mut Budget) -> Result<Opened, String> {
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
    Ok(Opened {
        header,
        times: Vec::new(),
        numbers: Numbers::held_whole(columns),
    })
}
