//! Reads and writes tables, recordings and results (feature `data`), through `hysteron_files`.
//!
//! `table` reads CSV, Parquet, Arrow and MATLAB files. `recording` turns their columns into recordings.
//! `output` writes tables. `cells` writes cells as CSV.
//! `log` knows the tables that a loop wrote. `run` simulates and inverts tables, a block of rows at a time.
//! `design`, `adapted` and `trace` read and write what their names say. `columns` summarises
//! a table, `preview` shows it, and `roles` finds what its columns are.

mod adapted;
mod cells;
mod columns;
mod design;
mod log;
mod output;
mod preview;
mod recording;
mod roles;
mod run;
mod table;
mod trace;

pub use columns::{ColumnSummary, TableSummary, inspect_table};
pub use output::{Added, STANDARD_OUTPUT, TableWriter};
pub(crate) use output::{Entry, Kind, Partial, RecordWriter, Schema, Value, read_records};
pub use preview::{PICTURE, TablePreview, preview_table, preview_table_knowing};
pub use recording::{Columns, Note, NoteKind, Others, Places, Repair, Segment};
pub(crate) use recording::{Group, Groups};
pub use roles::{RoleDoubt, Roles};
pub use run::{Around, Counts, Invert, Simulate, invert_table, simulate_table};
pub use table::{Budget, Column, Growing, Memory, ReadOptions, Remark, Row, TableReader};
