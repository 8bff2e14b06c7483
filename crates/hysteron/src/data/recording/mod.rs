//! Makes recordings from tables, and tables from recordings.
//!
//! `columns` names the columns and `read` is the entry point; `groups` reads tables of several
//! recordings. `samples` collects the rows; `history` parts them where the clock says so; `repair`
//! says what is done about bad rows. `others` keeps the columns that a recording does not use, and
//! `write` writes recordings.

mod columns;
mod groups;
mod history;
mod others;
mod read;
mod repair;
mod samples;
mod write;

pub use columns::Columns;
pub(crate) use groups::{Group, Groups};
pub use others::Others;
pub use read::Segment;
pub(in crate::data) use read::quantity;
pub use repair::{Note, NoteKind, Places, Repair};
pub(crate) use write::write_all;
