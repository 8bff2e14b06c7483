//! MATLAB files of versions 5 and 7 ("Level 5 MAT-file format", The MathWorks).

use super::mat::Variable;
use std::io::Read;

const DAMAGED: &str = "the MATLAB file is damaged or cut off: save or copy it again";

/// Types of data elements.
const INT32: u32 = 5;
const UINT32: u32 = 6;
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// The real numeric arrays of a file with at most two dimensions.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Variable>, String> {
    let (Some(mark), Some(elements)) = (bytes.get(126..128), bytes.get(128..)) else {
        return Err(DAMAGED.into());
    };
    let mut elements = Elements {
        bytes: elements,
        big: mark == b"MI",
    };
    let mut variables = Vec::new();
    while !elements.bytes.is_empty() {
        let (kind, body) = elements.next().ok_or(DAMAGED)?;
        let variable = if kind == COMPRESSED {
            let mut unpacked = Vec::new();
            let mut decoder = flate2::read::ZlibDecoder::new(body);
            decoder.read_to_end(&mut unpacked).map_err(|_| DAMAGED)?;
            let mut inner = Elements {
                bytes: &unpacked,
                ..elements
            };
            let (kind, body) = inner.next().ok_or(DAMAGED)?;
            matrix(
                kind,
                Elements {
                    bytes: body,
                    ..elements
                },
            )
        } else {
            matrix(
                kind,
                Elements {
                    bytes: body,
                    ..elements
                },
            )
        };
        variables.extend(variable.ok_or(DAMAGED)?);
    }
    Ok(variables)
}

/// The variable in an element; `Some(None)` for one that is no real numeric array.
fn matrix(kind: u32, mut parts: Elements<'_>) -> Option<Option<Variable>> {
    if kind != MATRIX || parts.bytes.is_empty() {
        return Some(None);
    }
    let (kind, flags) = parts.next()?;
    let flags = match kind {
        UINT32 => parts.number::<4>(flags).map(u32::from_le_bytes)?,
        _ => return None,
    };
    let (class, complex) = (flags & 0xff, flags & 0x0800 != 0);
    // The classes of full numeric arrays; those of text, cells and the like come below and above them.
    if !(6..=15).contains(&class) || complex {
        return Some(None);
    }
    let (kind, sizes) = parts.next()?;
    if kind != INT32 {
        return None;
    }
    let sizes = parts.values(INT32, sizes)?;
    let (_, name) = parts.next()?;
    let &[rows, columns] = &sizes[..] else {
        return Some(None);
    };
    let (kind, values) = parts.next()?;
    let values = parts.values(kind, values)?;
    if rows * columns != values.len() as f64 {
        return None;
    }
    Some(Some(Variable {
        name: String::from_utf8_lossy(name).into_owned(),
        rows: rows as usize,
        columns: columns as usize,
        values,
    }))
}

/// Data elements one after another: a tag with type and size, and that many bytes.
#[derive(Clone, Copy)]
struct Elements<'b> {
    bytes: &'b [u8],
    /// Whether the first byte of a number is the most significant one.
    big: bool,
}

impl<'b> Elements<'b> {
    fn next(&mut self) -> Option<(u32, &'b [u8])> {
        let tag = u32::from_le_bytes(self.number(self.bytes)?);
        // A small element has its size in the upper half of the tag and its data within it.
        let (kind, start, size, padded) = match tag >> 16 {
            0 => {
                let size = u32::from_le_bytes(self.number(self.bytes.get(4..)?)?) as usize;
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
        // The last one may come without what would fill it up.
        self.bytes = body.get(padded..).unwrap_or_default();
        Some((kind, data))
    }

    /// The first number of some bytes, least significant byte first.
    fn number<const N: usize>(&self, bytes: &[u8]) -> Option<[u8; N]> {
        let mut number = *bytes.first_chunk::<N>()?;
        if self.big {
            number.reverse();
        }
        Some(number)
    }

    /// The numbers of an element; `None` for a type that is none of numbers.
    fn values(&self, kind: u32, data: &[u8]) -> Option<Vec<f64>> {
        macro_rules! numbers {
            ($type:ty) => {{
                let size = size_of::<$type>();
                let number = |b| self.number(b).map(<$type>::from_le_bytes);
                data.chunks_exact(size)
                    .map(|b| Some(number(b)? as f64))
                    .collect()
            }};
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
            _ => None,
        }
    }
}
