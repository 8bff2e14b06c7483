//! Where a table is written to.

use crate::data::table::Growing;
use hysteron_files::AtomicFile;
use std::io::{self, Write};

/// Standard output, a file or memory.
pub(super) enum Sink {
    Stdout(io::Stdout),
    File(AtomicFile),
    Memory(Growing),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Sink::Stdout(out) => out.write(bytes),
            Sink::File(out) => out.write(bytes),
            Sink::Memory(out) => out.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Sink::Stdout(out) => out.flush(),
            Sink::File(out) => out.flush(),
            Sink::Memory(_) => Ok(()),
        }
    }
}
