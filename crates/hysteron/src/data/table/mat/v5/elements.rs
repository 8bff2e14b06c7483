//! Data elements, the building blocks of MATLAB files of versions 5 and 7.

/// Types of data elements.
pub(super) const INT32: u32 = 5;
pub(super) const UINT32: u32 = 6;
pub(super) const MATRIX: u32 = 14;
pub(super) const COMPRESSED: u32 = 15;

/// A sequence of data elements. Each is a tag with type and size, followed by that many bytes.
#[derive(Clone, Copy)]
pub(super) struct Elements<'b> {
    pub(super) bytes: &'b [u8],
    /// Whether the first byte of a number is the most significant one.
    pub(super) big: bool,
}

impl<'b> Elements<'b> {
    /// A sequence of elements inside the same file.
    pub(super) fn of<'c>(&self, bytes: &'c [u8]) -> Elements<'c> {
        Elements {
            bytes,
            big: self.big,
        }
    }

    pub(super) fn next(&mut self) -> Option<(u32, &'b [u8])> {
        let tag = u32::from_le_bytes(self.number(self.bytes)?);
        // A small element has its size in the upper half of the tag, and its data within the tag.
        let (kind, start, size, padded) = match tag >> 16 {
            0 => {
                let size = self.size()?;
                let padded = match tag {
                    COMPRESSED => size,
                    _ => size.checked_next_multiple_of(8)?,
                };
                (tag, 8, size, padded)
            }
            size => (tag & 0xffff, 4, size as usize, 4),
        };
        let body = self.bytes.get(start..)?;
        let data = body.get(..size)?;
        // The last element may lack its padding.
        self.bytes = body.get(padded..).unwrap_or_default();
        Some((kind, data))
    }

    /// The size in the tag of the first element.
    pub(super) fn size(&self) -> Option<usize> {
        let size = u32::from_le_bytes(self.number(self.bytes.get(4..)?)?);
        Some(size as usize)
    }

    /// The first number in some bytes, converted to least significant byte first.
    pub(super) fn number<const N: usize>(&self, bytes: &[u8]) -> Option<[u8; N]> {
        let mut number = *bytes.first_chunk::<N>()?;
        if self.big {
            number.reverse();
        }
        Some(number)
    }

    /// The sizes of an array; `None` if one is negative.
    pub(super) fn sizes(&self, data: &[u8]) -> Option<Vec<usize>> {
        let size = |bytes| usize::try_from(i32::from_le_bytes(self.number(bytes)?)).ok();
        data.chunks_exact(4).map(size).collect()
    }

    /// Number of numbers in an element; `None` for a type that is not numeric.
    pub(super) fn count(&self, kind: u32, data: &[u8]) -> Option<usize> {
        let size = match kind {
            1 | 2 => 1,
            3 | 4 => 2,
            INT32 | UINT32 | 7 => 4,
            9 | 12 | 13 => 8,
            _ => return None,
        };
        Some(data.len() / size)
    }

    /// The numbers of an element. `count` is the result of [`Elements::count`].
    pub(super) fn values(&self, kind: u32, data: &[u8], count: usize) -> Option<Vec<f64>> {
        let mut values = Vec::new();
        values.try_reserve_exact(count).ok()?;
        macro_rules! numbers {
            ($type:ty) => {
                for bytes in data.chunks_exact(size_of::<$type>()) {
                    values.push(<$type>::from_le_bytes(self.number(bytes)?) as f64);
                }
            };
        }
        match kind {
            1 => numbers!(i8),
            2 => numbers!(u8),
            3 => numbers!(i16),
            4 => numbers!(u16),
            INT32 => numbers!(i32),
            UINT32 => numbers!(u32),
            7 => numbers!(f32),
            9 => numbers!(f64),
            12 => numbers!(i64),
            13 => numbers!(u64),
            _ => return None,
        }
        Some(values)
    }
}

/// A text up to its first zero byte.
pub(super) fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0);
    String::from_utf8_lossy(&bytes[..end.unwrap_or(bytes.len())]).into_owned()
}
