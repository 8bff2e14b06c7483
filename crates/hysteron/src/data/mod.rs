//! Files: tables in and out, and the recordings, models and results that are read from and written
//! to them. The only module that touches the file system; feature `data`.

mod adapted;
mod columns;
mod design;
mod model;
mod output;
mod printable;
mod recording;
mod run;
mod table;
mod trace;

pub use columns::{ColumnSummary, TableSummary, inspect_table};
pub use output::{
    Added, AtomicFile, AtomicFolder, Cell, Destination, Own, STANDARD_OUTPUT, TableWriter,
    discard_unfinished, refuse_one_file,
};
pub use printable::printable;
pub use recording::{Columns, Note, NoteKind, Others, Places, Repair};
pub use run::{Counts, Invert, Simulate, invert_table, simulate_table};
pub use table::{Column, ReadOptions, Remark, Row, TableReader};
