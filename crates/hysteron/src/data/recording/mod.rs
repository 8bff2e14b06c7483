//! Recordings from tables and into tables.

mod columns;
mod others;
mod read;
mod repair;
mod samples;
mod write;

pub use columns::Columns;
pub use others::Others;
pub use repair::{Note, NoteKind, Places, Repair};
