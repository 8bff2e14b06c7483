//! Reads and writes files: tables, recordings, models and results. This is the only module that
//! uses the file system (feature `data`).
//!
//! `table` reads CSV, Parquet, Arrow and MATLAB files. `recording` turns their columns into recordings.
//! `output` writes files so that they appear complete or not at all. `cells` writes cells as CSV.
//! `positions` keeps where rows are. `run` simulates and inverts tables, a block of rows at a time.
//! `model`, `design`, `adapted` and `trace` read and write what their names say. `columns` summarises
//! a table, `preview` shows it, `roles` finds what its columns are, and `printable` makes text safe to show and to
//! paste.

mod adapted;
mod cells;
mod columns;
mod design;
mod model;
mod output;
mod positions;
mod preview;
mod printable;
mod recording;
mod roles;
mod run;
mod table;
mod trace;

pub use columns::{ColumnSummary, TableSummary, inspect_table};
pub use output::{
    Added, AtomicFile, AtomicFolder, Destination, Locked, Own, STANDARD_OUTPUT, TableWriter,
    discard_unfinished, refuse_one_file,
};
pub(crate) use output::{Entry, Kind, Partial, RecordWriter, Schema, Value, read_records};
pub use preview::{PICTURE, TablePreview, preview_table, preview_table_knowing};
pub use printable::{printable, python_literal, shell_word};
pub use recording::{Columns, Note, NoteKind, Others, Places, Repair, Segment};
pub(crate) use recording::{Group, Groups};
pub use roles::{RoleDoubt, Roles};
pub use run::{Around, Counts, Invert, Simulate, invert_table, simulate_table};
pub use table::{Budget, Column, Growing, Memory, ReadOptions, Remark, Row, TableReader};
