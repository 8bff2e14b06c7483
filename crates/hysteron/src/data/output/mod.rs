//! Writes files and folders that appear complete or not at all, and decides what they may replace.
//!
//! All commands use the same rule. A file is *ours* if hysteron wrote it as a result and nobody has
//! changed it since. Such a file is replaced by a new result. Any other file is kept, unless the
//! user forces it. A file that is an input is never replaced. This is how a file of ours is
//! recognised:
//!
//! | result | it is ours if |
//! | --- | --- |
//! | model | it records a fit and has exactly the bytes that this library would write |
//! | table, CSV | its last columns are those that a command adds, written as we write them |
//! | table, Parquet or Arrow file | its metadata name this library as the writer |
//! | folder | each file matches its digest in the list ([`manifest`]) |
//! | exported C | the digest in its first line matches the lines below |
//! | FMU | its description names this program, and no file was added or replaced |
//! | anything else | it already holds the bytes that are to be written |
//!
//! A CSV file has no room for a mark. So changes in its other columns are not detected. A CSV table
//! without added columns, such as a prepared recording, may be replaced by the same bytes only.
//!
//! `destination` holds the rule; `sign` and `manifest` recognise our results. `atomic` and `folder`
//! write files and folders under temporary names (`unfinished`) and move them to their place
//! (`moves`). `table` writes tables, `added` is what commands add to them; `csv` writes them as text;
//! `columnar` writes columns as Parquet (`parquet`) or Arrow (`arrow`), `spool` keeps rows until
//! their types are known, and `splice` copies Parquet.
//! `records` writes and reads tables of typed columns, `partial` keeps records while a long work
//! makes them, in a file with a `lock`.

mod added;
mod arrow;
mod atomic;
mod columnar;
mod csv;
mod destination;
mod folder;
mod lock;
mod manifest;
mod moves;
mod parquet;
mod partial;
mod records;
mod sign;
mod splice;
mod spool;
mod table;
mod unfinished;

pub use added::Added;
pub(crate) use added::AddedCells;
pub use atomic::AtomicFile;
pub use destination::{Destination, Own, refuse_one_file};
pub use folder::AtomicFolder;
pub use lock::Locked;
pub(crate) use partial::{Entry, Partial};
pub(crate) use records::{Kind, RecordWriter, Schema, Value, read_records};
pub(crate) use sign::is_our_model;
pub(crate) use table::Needs;
pub use table::{STANDARD_OUTPUT, TableWriter};
pub use unfinished::discard_unfinished;
