//! Writes tables and records, into files that appear complete or not at all (`hysteron_files`).
//!
//! `table` writes tables to a `sink`, through a `writer` for each format; `added` is what commands
//! add to them. `csv` writes them as text; `columnar` writes columns as Parquet (`parquet`) or Arrow
//! (`arrow`), `spool` keeps rows until their types are known, and `splice` copies Parquet. `sign`
//! recognises tables of ours. `records` writes and reads tables of typed columns, `partial` keeps
//! records while a long work makes them.

mod added;
mod arrow;
mod columnar;
mod csv;
mod parquet;
mod partial;
mod records;
mod sign;
mod sink;
mod splice;
mod spool;
mod table;
mod writer;

pub use added::Added;
pub(crate) use added::AddedCells;
pub(crate) use partial::{Entry, Partial};
pub(crate) use records::{Kind, RecordWriter, Schema, Value, read_records};
pub use table::{STANDARD_OUTPUT, TableWriter};
