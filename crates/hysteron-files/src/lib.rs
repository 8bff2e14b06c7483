//! Files and folders that appear complete or not at all, and what they may replace.
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
//! | folder | each file matches its digest in the list (`manifest`) |
//! | exported C | the digest in its first line matches the lines below |
//! | FMU | its description names this program, and no file was added or replaced |
//! | anything else | it already holds the bytes that are to be written |
//!
//! A CSV file has no room for a mark. So changes in its other columns are not detected. A CSV table
//! without added columns, such as a prepared recording, may be replaced by the same bytes only.
//!
//! `destination` holds the rule; `manifest` recognises a folder of ours. `atomic` and `folder` write
//! files and folders under temporary names (`unfinished`) and move them to their place (`moves`).
//! `lock` is a file that one process writes. `hashing` is the digest of a file. `text` makes the
//! names of files and columns safe to show, and to paste into a shell or a program.

mod atomic;
mod destination;
mod error;
mod folder;
mod hashing;
mod lock;
mod manifest;
mod moves;
mod text;
mod unfinished;

pub use atomic::AtomicFile;
pub use destination::{Destination, Own, folder_of, refuse_one_file};
pub use error::{Error, OfFile, Result};
pub use folder::AtomicFolder;
pub use hashing::{Hash, Hashing};
pub use lock::Locked;
pub use text::{printable, python_literal, shell_word};
pub use unfinished::{bare, discard_unfinished};
