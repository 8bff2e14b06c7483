//! Files and folders that appear whole or not at all, and what they may replace.
//!
//! One policy for every command. What a command made itself is replaced. Anything else is kept,
//! unless the user says otherwise. A file that is read is never replaced. How a command knows its
//! own results:
//!
//! | result | it is ours where |
//! | --- | --- |
//! | model | it is, byte for byte, what this library writes for the model in it, and tells of a fit |
//! | table, CSV | its last columns are those that a command adds, and their numbers are written as here |
//! | table, Parquet | its metadata name this library as the writer |
//! | folder | each file is as its list of digests says ([`manifest`]) |
//! | exported C | the digest in its first line is that of the lines below |
//! | FMU | its description names this program, and no file was added or exchanged |
//! | anything else | it holds the very bytes that are to be written |
//!
//! A CSV file has no room for a mark. So an edit of other columns is not seen, and a table without
//! columns of its own, such as a prepared recording, is replaced by the same bytes only.

mod atomic;
mod destination;
mod folder;
mod manifest;
mod moves;
mod parquet;
mod sign;
mod splice;
mod spool;
mod table;
mod unfinished;

pub use atomic::AtomicFile;
pub use destination::{Destination, Own, refuse_one_file};
pub use folder::AtomicFolder;
pub(crate) use sign::is_our_model;
pub use table::{Added, Cell, STANDARD_OUTPUT, TableWriter};
pub use unfinished::discard_unfinished;
