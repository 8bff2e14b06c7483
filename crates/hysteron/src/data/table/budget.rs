//! Limits the memory that files may take. A damaged file can claim any size, so each size is checked
//! before memory is allocated.

use crate::error::{Error, Result};
use std::fmt;
use std::io::{self, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// An account of memory: a limit that several readers and writers share. A clone is the same
/// account.
#[derive(Debug, Clone)]
pub struct Memory(Arc<Account>);

#[derive(Debug)]
struct Account {
    limit: u64,
    taken: AtomicU64,
}

/// Takes from this size on are tried on the system first.
const LARGE: u128 = 1 << 20;
/// What has to be free beside them, for what is too small to be counted.
const BESIDE: usize = 2 << 20;

impl Memory {
    /// An account with a limit in bytes.
    #[must_use]
    pub fn new(limit: u64) -> Self {
        let taken = AtomicU64::new(0);
        Self(Arc::new(Account { limit, taken }))
    }

    /// The limit in bytes.
    #[must_use]
    pub fn limit(&self) -> u64 {
        self.0.limit
    }

    /// The number of bytes left.
    #[must_use]
    pub fn left(&self) -> u64 {
        let taken = self.0.taken.load(Ordering::Relaxed);
        self.0.limit.saturating_sub(taken)
    }

    /// Whether so many bytes are left, also on the machine.
    #[must_use]
    pub fn has(&self, bytes: u64) -> bool {
        bytes <= self.left() && is_there(u128::from(bytes))
    }

    fn take(&self, bytes: u128) -> bool {
        let more = |taken: u64| {
            let all = u64::try_from(u128::from(taken).checked_add(bytes)?).ok()?;
            (all <= self.0.limit).then_some(all)
        };
        let taken = &self.0.taken;
        let order = Ordering::Relaxed;
        taken.fetch_update(order, order, more).is_ok()
    }
}

impl From<u64> for Memory {
    fn from(limit: u64) -> Self {
        Self::new(limit)
    }
}

/// What one reader, writer or holder has taken of a [`Memory`]. It is given back when this is
/// dropped.
#[derive(Debug)]
pub struct Budget {
    memory: Memory,
    taken: u64,
}

impl Budget {
    /// Nothing yet of an account.
    #[must_use]
    pub fn of(memory: &Memory) -> Self {
        let memory = memory.clone();
        Self { memory, taken: 0 }
    }

    /// The account.
    #[must_use]
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// Nothing yet of the same account.
    pub(crate) fn another(&self) -> Self {
        Self::of(&self.memory)
    }

    /// The number of bytes left in the account.
    pub(crate) fn left(&self) -> u64 {
        self.memory.left()
    }

    /// The number of bytes taken.
    #[must_use]
    pub fn taken(&self) -> u64 {
        self.taken
    }

    /// Takes or gives back, until `bytes` are taken for `what`.
    ///
    /// # Errors
    /// [`Error::Recording`] if there is not enough left. What was taken before then stays.
    pub fn resize(&mut self, bytes: u64, what: &str) -> Result<()> {
        match bytes.checked_sub(self.taken) {
            None => self.give_back(u128::from(self.taken - bytes)),
            Some(more) => {
                let taken = self.take(u128::from(more), what);
                taken.map_err(|problem| Error::Recording {
                    path: None,
                    row: None,
                    column: None,
                    problem,
                })?;
            }
        }
        Ok(())
    }

    /// Takes `bytes` for `what`.
    ///
    /// # Errors
    /// The problem, if there is not enough left: what is too large, and what to do.
    pub(crate) fn take(
        &mut self,
        bytes: u128,
        what: impl fmt::Display,
    ) -> std::result::Result<(), String> {
        if !self.memory.take(bytes) {
            return Err(self.refusal(bytes, what));
        }
        // No more than the limit.
        self.taken += bytes as u64;
        if !is_there(bytes) {
            self.give_back(bytes);
            return Err(not_there(bytes, what));
        }
        Ok(())
    }

    /// As [`Budget::take`], for memory that is released at once.
    pub(crate) fn check(
        &self,
        bytes: u128,
        what: impl fmt::Display,
    ) -> std::result::Result<(), String> {
        if bytes > u128::from(self.left()) {
            return Err(self.refusal(bytes, what));
        }
        match is_there(bytes) {
            true => Ok(()),
            false => Err(not_there(bytes, what)),
        }
    }

    fn refusal(&self, bytes: u128, what: impl fmt::Display) -> String {
        format!(
            "{what} needs {} of memory and {} of {} are left: if the file is not damaged, \
             allow more with the option `max memory`",
            Size(bytes),
            Size(u128::from(self.left())),
            Size(u128::from(self.memory.limit()))
        )
    }

    /// Releases memory that was taken.
    pub(crate) fn give_back(&mut self, bytes: u128) {
        let bytes = u64::try_from(bytes).unwrap_or(u64::MAX).min(self.taken);
        self.taken -= bytes;
        self.memory.0.taken.fetch_sub(bytes, Ordering::Relaxed);
    }
}

impl Drop for Budget {
    fn drop(&mut self) {
        self.give_back(u128::from(self.taken));
    }
}

/// Whether the system has so many bytes. An allocation that fails ends the program, also one in a
/// library for a format. So a large one is tried first, in a way that may fail.
fn is_there(bytes: u128) -> bool {
    if bytes < LARGE {
        return true;
    }
    let mut tried = Vec::<u8>::new();
    let bytes = usize::try_from(bytes).ok();
    let bytes = bytes.and_then(|bytes| bytes.checked_add(BESIDE));
    let there = bytes.is_some_and(|bytes| tried.try_reserve_exact(bytes).is_ok());
    // Otherwise the compiler may leave out an allocation that nobody uses.
    std::hint::black_box(&tried);
    there
}

fn not_there(bytes: u128, what: impl fmt::Display) -> String {
    format!(
        "{what} needs {} of memory, which the machine does not have free: close other programs, \
         or read fewer columns",
        Size(bytes)
    )
}

/// Bytes in memory that grow within an account.
#[derive(Debug)]
pub struct Growing {
    bytes: Vec<u8>,
    budget: Budget,
}

impl Growing {
    /// No bytes yet.
    #[must_use]
    pub fn new(memory: &Memory) -> Self {
        let budget = Budget::of(memory);
        let bytes = Vec::new();
        Self { bytes, budget }
    }

    /// Takes room for so many bytes more.
    ///
    /// # Errors
    /// [`io::ErrorKind::OutOfMemory`].
    pub fn reserve(&mut self, more: usize) -> io::Result<()> {
        let lacks = |problem: String| io::Error::new(io::ErrorKind::OutOfMemory, problem);
        // While it grows, there is a copy.
        let whole = self.bytes.len() as u128 + more as u128;
        self.budget.check(whole, "the table").map_err(lacks)?;
        self.budget.take(more as u128, "the table").map_err(lacks)?;
        let grown = self.bytes.try_reserve_exact(more);
        grown.map_err(|error| lacks(error.to_string()))
    }

    /// The bytes, which are no longer counted.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    /// The bytes, and what is taken for them.
    #[must_use]
    pub fn into_parts(self) -> (Vec<u8>, Budget) {
        (self.bytes, self.budget)
    }

    /// The bytes from the first one on. They are counted until the reader is dropped.
    pub(crate) fn read(self) -> impl io::Read + use<> {
        Held {
            bytes: io::Cursor::new(self.bytes),
            _budget: self.budget,
        }
    }
}

/// Bytes that are read, and what was taken for them.
struct Held {
    bytes: io::Cursor<Vec<u8>>,
    _budget: Budget,
}

impl io::Read for Held {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.bytes.read(buffer)
    }
}

impl Write for Growing {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.bytes.capacity() - self.bytes.len() < bytes.len() {
            self.reserve(bytes.len().max(self.bytes.len()))?;
        }
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A number of bytes, shown in the largest unit in which it is at least one.
struct Size(u128);

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let units = ["TiB", "GiB", "MiB", "KiB"];
        let sizes = [40, 30, 20, 10].map(|power| 1_u128 << power);
        for (unit, size) in units.into_iter().zip(sizes) {
            if self.0 >= size {
                return write!(f, "{:.1} {unit}", self.0 as f64 / size as f64);
            }
        }
        write!(f, "{} bytes", self.0)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn no_more_is_given_than_there_is() {
        let memory = Memory::new(1 << 20);
        let mut budget = Budget::of(&memory);
        budget.take(1 << 19, "`x`").unwrap();
        let refused = budget.take((1 << 19) + 1, "`y`").unwrap_err();
        assert!(
            refused.starts_with("`y` needs 512.0 KiB of memory and 512.0 KiB of 1.0 MiB are left"),
            "{refused}"
        );
        assert!(budget.check(u128::MAX, "`y`").is_err());
        assert!(budget.take(u128::MAX, "`y`").is_err());
        let mut other = budget.another();
        other.take(1 << 19, "`z`").unwrap();
        assert_eq!((budget.left(), memory.left()), (0, 0));
        drop(other);
        budget.give_back(u128::from(u64::MAX));
        assert_eq!(memory.left(), 1 << 20);
        budget.resize(1 << 18, "`x`").unwrap();
        assert_eq!((budget.taken(), memory.left()), (1 << 18, 3 << 18));
        drop(budget);
        assert_eq!(memory.left(), 1 << 20);
    }

    #[test]
    fn what_the_machine_does_not_have_is_refused_and_given_back() {
        // No process has so many addresses.
        let memory = Memory::new(u64::MAX);
        let mut budget = Budget::of(&memory);
        let refused = budget.take(1 << 60, "`x`").unwrap_err();
        assert!(
            refused.contains("the machine does not have free"),
            "{refused}"
        );
        assert_eq!(memory.left(), u64::MAX);
        assert!(!memory.has(1 << 60));
    }

    #[test]
    fn bytes_grow_within_the_account() {
        let memory = Memory::new(1000);
        let mut growing = Growing::new(&memory);
        growing.write_all(&[1; 400]).unwrap();
        let error = growing.write_all(&[2; 400]).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::OutOfMemory);
        assert_eq!(memory.left(), 600);
        assert_eq!(growing.into_bytes(), [1; 400]);
        assert_eq!(memory.left(), 1000);
    }
}
