//! Options for reading a file.

use super::machine::half_of_what_is_free;
use crate::data::recording::Repair;

/// Options for reading a recording or a table from a file.
///
/// | field | default | range | purpose |
/// | --- | --- | --- | --- |
/// | `repair` | refuse | refuse, mend | what to do with rows that cannot be used |
/// | `max_memory` | half of what is free | any | largest memory for the contents of the file, bytes |
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
    /// Default of `max_memory`: half of the memory that was free when this process first asked.
    /// That is the least of what Linux says to be available, what the control groups of the
    /// process may take, and what its limit of addresses leaves. On other systems: 2 GiB.
    #[must_use]
    pub fn usual_memory() -> u64 {
        half_of_what_is_free()
    }
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            repair: Repair::default(),
            max_memory: Self::usual_memory(),
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
