//! Reads MATLAB files of versions 5 and 7 ("Level 5 MAT-file format", The MathWorks).

mod elements;

use super::variable::{DEEPEST, Variable};
use crate::data::table::budget::Budget;
use elements::{COMPRESSED, Elements, INT32, MATRIX, UINT32};
use std::io::Read;

const DAMAGED: &str = "the MATLAB file is damaged or cut off: save or copy it again";

/// The class of structures, and the first and last class of full numeric arrays.
const STRUCTURE: u32 = 2;
const NUMERIC: std::ops::RangeInclusive<u32> = 6..=15;

/// The real numeric arrays of a file with at most two dimensions, including those in structures.
pub(in crate::data::table) fn read(
    bytes: &[u8],
    budget: &mut Budget,
) -> Result<Vec<Variable>, String> {
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
        let mut found = Found {
            variables: &mut variables,
            budget,
        };
        if kind == COMPRESSED {
            let unpacked = unpacked(elements.of(body), found.budget)?;
            let (kind, body) = elements.of(&unpacked).next().ok_or(DAMAGED)?;
            found.matrix(None, kind, elements.of(body), 0)?;
            found.budget.give_back(unpacked.capacity() as u128);
        } else {
            found.matrix(None, kind, elements.of(body), 0)?;
        }
    }
    Ok(variables)
}

/// Unpacks a compressed element, up to the size in its own tag. The budget pays for it.
fn unpacked(compressed: Elements<'_>, budget: &mut Budget) -> Result<Vec<u8>, String> {
    const TAG: usize = 8;
    let mut decoder = flate2::read::ZlibDecoder::new(compressed.bytes);
    let mut tag = [0; TAG];
    decoder.read_exact(&mut tag).map_err(|_| DAMAGED)?;
    let size = compressed.of(&tag).size().ok_or(DAMAGED)?;
    // The largest size that deflate can expand this many bytes to. A claim beyond it is false.
    let most = compressed.bytes.len().saturating_mul(1032) + TAG;
    let length = TAG + size;
    if length > most {
        return Err(DAMAGED.into());
    }
    budget.take(length as u128, "a compressed variable")?;
    let mut unpacked = Vec::new();
    unpacked
        .try_reserve_exact(length)
        .map_err(|error| error.to_string())?;
    unpacked.extend_from_slice(&tag);
    let mut rest = decoder.take(size as u64);
    rest.read_to_end(&mut unpacked).map_err(|_| DAMAGED)?;
    Ok(unpacked)
}

/// The variables found so far, and the memory left.
struct Found<'f> {
    variables: &'f mut Vec<Variable>,
    budget: &'f mut Budget,
}

impl Found<'_> {
    /// Adds the variable in an element, or those in its fields; anything else is ignored. `name` is
    /// the name of a field, which the element itself does not contain.
    fn matrix(
        &mut self,
        name: Option<String>,
        kind: u32,
        mut parts: Elements<'_>,
        depth: usize,
    ) -> Result<(), String> {
        if kind != MATRIX || parts.bytes.is_empty() {
            return Ok(());
        }
        let flags = match parts.next().ok_or(DAMAGED)? {
            (UINT32, flags) => parts.number::<4>(flags).map(u32::from_le_bytes),
            _ => None,
        };
        let flags = flags.ok_or(DAMAGED)?;
        let (class, complex) = (flags & 0xff, flags & 0x0800 != 0);
        if class != STRUCTURE && !NUMERIC.contains(&class) || complex {
            return Ok(());
        }
        let sizes = match parts.next().ok_or(DAMAGED)? {
            (INT32, sizes) => parts.sizes(sizes),
            _ => None,
        };
        let sizes = sizes.ok_or(DAMAGED)?;
        let (_, own) = parts.next().ok_or(DAMAGED)?;
        let name = name.unwrap_or_else(|| String::from_utf8_lossy(own).into_owned());
        if class == STRUCTURE {
            return self.structure(&name, &sizes, parts, depth);
        }
        let &[rows, columns] = &sizes[..] else {
            return Ok(());
        };
        let (kind, data) = parts.next().ok_or(DAMAGED)?;
        let count = parts.count(kind, data).ok_or(DAMAGED)?;
        if rows.checked_mul(columns) != Some(count) {
            return Err(DAMAGED.into());
        }
        self.budget
            .take(8 * count as u128, format_args!("`{name}`"))?;
        let values = parts.values(kind, data, count).ok_or(DAMAGED)?;
        self.variables.push(Variable {
            name,
            rows,
            columns,
            values,
        });
        Ok(())
    }

    /// The fields of a structure are named `name.field`, those of an array of structures
    /// `name(1).field`.
    fn structure(
        &mut self,
        name: &str,
        sizes: &[usize],
        mut parts: Elements<'_>,
        depth: usize,
    ) -> Result<(), String> {
        if depth == DEEPEST {
            return Ok(());
        }
        let (_, length) = parts.next().ok_or(DAMAGED)?;
        let length = parts.number::<4>(length).map(u32::from_le_bytes);
        let length = length.filter(|length| *length > 0).ok_or(DAMAGED)? as usize;
        let (_, names) = parts.next().ok_or(DAMAGED)?;
        let fields: Vec<String> = names.chunks(length).map(elements::text).collect();
        let single = sizes.iter().all(|size| *size == 1);
        for element in 1.. {
            if parts.bytes.is_empty() || fields.is_empty() {
                return Ok(());
            }
            for field in &fields {
                let Some((kind, body)) = parts.next() else {
                    return Ok(());
                };
                let name = match single {
                    true => format!("{name}.{field}"),
                    false => format!("{name}({element}).{field}"),
                };
                self.budget
                    .take(name.len() as u128 + 100, "the names of fields")?;
                self.matrix(Some(name), kind, parts.of(body), depth + 1)?;
            }
        }
        Ok(())
    }
}
