//! Summarises the columns of a table, for users who do not know their names yet.

use crate::data::table::TableReader;
use crate::error::Result;
use serde::Serialize;

/// Summary of a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TableSummary {
    /// Number of rows below the header.
    pub rows: u64,
    /// The columns, in their order.
    pub columns: Vec<ColumnSummary>,
}

/// Summary of a column.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ColumnSummary {
    /// Its name.
    pub name: String,
    /// Smallest number; `None` if the column has no numbers.
    pub min: Option<f64>,
    /// Largest number; `None` if the column has no numbers.
    pub max: Option<f64>,
    /// Number of cells that are not numbers.
    pub not_numbers: u64,
}

/// Reads `table` to its end and summarises its columns.
///
/// # Errors
/// [`crate::Error::File`]; [`crate::Error::Recording`] for a row with more or fewer cells than the
/// header.
pub fn inspect_table(table: &mut TableReader) -> Result<TableSummary> {
    let empty = |name: &String| ColumnSummary {
        name: name.clone(),
        min: None,
        max: None,
        not_numbers: 0,
    };
    let mut columns: Vec<ColumnSummary> = table.header().iter().map(empty).collect();
    let places: Vec<_> = table.columns().collect();
    let mut rows = 0;
    while table.advance()? {
        rows += 1;
        for (column, &place) in columns.iter_mut().zip(&places) {
            match table.value(place) {
                Some(value) => {
                    column.min = Some(column.min.map_or(value, |min| min.min(value)));
                    column.max = Some(column.max.map_or(value, |max| max.max(value)));
                }
                None => column.not_numbers += 1,
            }
        }
    }
    Ok(TableSummary { rows, columns })
}
