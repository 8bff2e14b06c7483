//! Limits the memory that reading a file may take. A damaged file can claim any size, so each size
//! is checked before memory is allocated.

use std::fmt;

/// The memory in bytes that a read may still take.
///
/// Readers ask before they allocate. Buffers of fixed size, about 10 MiB in all, are not counted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Budget {
    left: u128,
    whole: u64,
}

impl Budget {
    pub(crate) fn new(bytes: u64) -> Self {
        Self {
            left: u128::from(bytes),
            whole: bytes,
        }
    }

    /// The number of bytes left.
    pub(crate) fn left(&self) -> u64 {
        u64::try_from(self.left).unwrap_or(u64::MAX)
    }

    /// Takes `bytes` for `what`.
    ///
    /// # Errors
    /// The problem, if there is not enough left: what is too large, and what to do.
    pub(crate) fn take(&mut self, bytes: u128, what: impl fmt::Display) -> Result<(), String> {
        self.check(bytes, what)?;
        self.left -= bytes;
        Ok(())
    }

    /// As [`Budget::take`], for memory that is released at once.
    pub(crate) fn check(&self, bytes: u128, what: impl fmt::Display) -> Result<(), String> {
        if bytes <= self.left {
            return Ok(());
        }
        Err(format!(
            "{what} needs {} of memory and {} of {} are left: if the file is not damaged, \
             allow more with the option `max memory`",
            Size(bytes),
            Size(self.left),
            Size(u128::from(self.whole))
        ))
    }

    /// Releases memory that was taken.
    pub(crate) fn give_back(&mut self, bytes: u128) {
        self.left = (self.left + bytes).min(u128::from(self.whole));
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
        let mut budget = Budget::new(1 << 20);
        budget.take(1 << 19, "`x`").unwrap();
        let refused = budget.take((1 << 19) + 1, "`y`").unwrap_err();
        assert!(
            refused.starts_with("`y` needs 512.0 KiB of memory and 512.0 KiB of 1.0 MiB are left"),
            "{refused}"
        );
        assert!(budget.check(u128::MAX, "`y`").is_err());
        budget.take(1 << 19, "`z`").unwrap();
        assert_eq!(budget.left(), 0);
        budget.give_back(u128::from(u64::MAX));
        assert_eq!(budget.left(), 1 << 20);
    }
}
