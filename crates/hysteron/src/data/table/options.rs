//! Options for reading a file.

use crate::data::recording::Repair;

/// Options for reading a recording or a table from a file.
///
/// | field | default | range | purpose |
/// | --- | --- | --- | --- |
/// | `repair` | refuse | refuse, mend | what to do with rows that cannot be used |
/// | `max_memory` | 4 GiB | any | largest memory for the contents of the file, bytes |
///
/// A [`Repair`] converts into options with the defaults for all other fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadOptions {
    /// What to do with rows that cannot be used as they are.
    pub repair: Repair,
    /// Largest memory in bytes for the contents of the file. A file that claims more is refused
    /// before memory is allocated. Buffers of fixed size, about 10 MiB, are not counted.
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
