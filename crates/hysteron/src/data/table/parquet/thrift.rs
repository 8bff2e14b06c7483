//! A small part of Thrift's compact protocol: enough to read the sizes that a Parquet file claims,
//! before the library allocates memory for them.

/// Largest depth of structures and lists.
const DEEPEST: usize = 32;

/// Types of fields.
const BOOLEANS: [u8; 2] = [1, 2];
const BYTE: u8 = 3;
const INTEGERS: [u8; 3] = [4, 5, 6];
const DOUBLE: u8 = 7;
const BINARY: u8 = 8;
const LISTS: [u8; 2] = [9, 10];
const MAP: u8 = 11;
const STRUCT: u8 = 12;
const UUID: u8 = 13;

/// Bytes in the compact protocol. Functions return `None` if the bytes end or are invalid.
pub(super) struct Compact<'b>(pub(super) &'b [u8]);

impl Compact<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (byte, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*byte)
    }

    fn unsigned(&mut self) -> Option<u64> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    }

    /// Reads an integer field.
    pub(super) fn integer(&mut self) -> Option<i64> {
        let value = self.unsigned()?;
        Some((value >> 1) as i64 ^ -((value & 1) as i64))
    }

    fn pass(&mut self, count: u64) -> Option<()> {
        self.0 = self.0.get(usize::try_from(count).ok()?..)?;
        Some(())
    }

    /// Calls `field` with the number and type of each field of a structure. `field` must read or
    /// skip the field.
    pub(super) fn fields(
        &mut self,
        mut field: impl FnMut(&mut Self, i64, u8) -> Option<()>,
    ) -> Option<()> {
        let mut id = 0;
        loop {
            let head = self.byte()?;
            let (step, kind) = (i64::from(head >> 4), head & 0xf);
            if kind == 0 {
                return Some(());
            }
            id = match step {
                0 => self.integer()?,
                _ => id + step,
            };
            field(self, id, kind)?;
        }
    }

    /// The length of the list that begins here, and the type of its elements.
    pub(super) fn list(&mut self) -> Option<(u64, u8)> {
        let head = self.byte()?;
        let count = match head >> 4 {
            15 => self.unsigned()?,
            few => u64::from(few),
        };
        Some((count, head & 0xf))
    }

    /// Skips a field.
    pub(super) fn skip(&mut self, kind: u8) -> Option<()> {
        self.skip_within(kind, DEEPEST)
    }

    fn skip_within(&mut self, kind: u8, depth: usize) -> Option<()> {
        let depth = depth.checked_sub(1)?;
        match kind {
            kind if BOOLEANS.contains(&kind) => Some(()),
            BYTE => self.pass(1),
            kind if INTEGERS.contains(&kind) => self.unsigned().map(|_| ()),
            DOUBLE => self.pass(8),
            BINARY => {
                let length = self.unsigned()?;
                self.pass(length)
            }
            kind if LISTS.contains(&kind) => {
                let (count, kind) = self.list()?;
                self.elements(count, &[kind], depth)
            }
            MAP => {
                let count = self.unsigned()?;
                if count == 0 {
                    return Some(());
                }
                let kinds = self.byte()?;
                self.elements(count, &[kinds >> 4, kinds & 0xf], depth)
            }
            STRUCT => self.fields(|rest, _, kind| rest.skip_within(kind, depth)),
            UUID => self.pass(16),
            _ => None,
        }
    }

    fn elements(&mut self, count: u64, kinds: &[u8], depth: usize) -> Option<()> {
        for _ in 0..count {
            for kind in kinds {
                match BOOLEANS.contains(kind) {
                    // In a list, booleans have a byte of their own.
                    true => self.pass(1)?,
                    false => self.skip_within(*kind, depth)?,
                }
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn fields_of_every_type_are_passed_over() {
        // 1: true, 2: i32 -1, 3: double, 4: "ab", 5: [1, 2], 6: {7: map of "a" to 1}, 20: i64 300.
        let mut bytes = vec![0x11, 0x15, 0x01, 0x17];
        bytes.extend([0; 8]);
        bytes.extend([0x18, 2, b'a', b'b', 0x19, 0x25, 2, 4]);
        bytes.extend([0x1c, 0x7b, 1, 0x85, 1, b'a', 2, 0, 0x06, 40, 0xd8, 0x04, 0]);
        let (mut ids, mut last) = (Vec::new(), 0);
        let mut compact = Compact(&bytes);
        let read = compact.fields(|rest, id, kind| {
            ids.push(id);
            if id == 20 {
                last = rest.integer()?;
                return Some(());
            }
            rest.skip(kind)
        });
        assert_eq!(
            (read, ids, last),
            (Some(()), vec![1, 2, 3, 4, 5, 6, 20], 300)
        );
        assert!(compact.0.is_empty());
        for cut in 0..bytes.len() {
            let mut cut = Compact(&bytes[..cut]);
            assert_eq!(cut.fields(|rest, _, kind| rest.skip(kind)), None);
        }
    }
}
