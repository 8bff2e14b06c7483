//! Makes recordings from tables, and tables from recordings.
//!
//! `columns` names the columns and `read` is the entry point. `samples` collects the rows; `repair`
//! says what is done about bad rows. `others` keeps the columns that a recording does not use, and
//! `write` writes recordings.

mod columns;
mod others;
mod read;
mod repair;
mod samples;
mod write;

pub use columns::Columns;
pub use others::Others;
pub use repair::{Note, NoteKind, Places, Repair};
