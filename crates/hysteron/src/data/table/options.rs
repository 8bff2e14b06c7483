//! How a file is read.

use crate::data::recording::Repair;

/// How a recording or a table is read from a file.
///
/// | field | default | range | purpose |
/// | --- | --- | --- | --- |
/// | `repair` | refuse | | what becomes of rows that cannot be used as they are |
/// | `max_memory` | [`ReadOptions::MAX_MEMORY`], 4 GiB | any | most memory that the file's contents may take, in bytes |
///
/// A [`Repair`] alone stands for the options that differ in nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadOptions {
    /// What becomes of rows that cannot be used as they are.
    pub repair: Repair,
    /// Most memory in bytes that the file's contents may take. A file that claims more is refused
    /// before anything is allocated. Buffers of fixed size, some 10 MiB, come on top.
    pub max_memory: u64,
}

impl ReadOptions {
    /// Default of `max_memory`: 4 GiB.
    pub const MAX_MEMORY: u64 = 4 << 30;
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            repair: Repair::default(),
            max_memory: Self::MAX_MEMORY,
        }
    }
}

impl From<Repair> for ReadOptions {
    fn from(repair: Repair) -> Self {
        Self {
            repair,
            ..Self::default()
        }
    }
}
