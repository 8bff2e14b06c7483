//! Takes the plain rows of a text many at a time: no quotes, no decimal commas, nothing to mend.
//! Their bytes are copied as they are. Any other row is left to the reader of single rows.

use super::Text;
use super::marks::Marks;
use crate::data::table::block::Block;
use memchr::memchr;
use std::io::BufRead;

impl Text {
    /// Adds the plain rows that come next and are in memory to `block`. `asked` are the columns
    /// asked for and their slots in the block, in the order of the columns. `in_unit` turns the
    /// number of a column into the unit that is wanted.
    pub(in crate::data::table) fn plain_rows(
        &mut self,
        columns: usize,
        asked: &[(usize, usize)],
        in_unit: impl Fn(usize, f64) -> f64,
        block: &mut Block,
    ) {
        if self.dialect.decimal_comma || self.dialect.end != b'\n' {
            return;
        }
        let delimiter = self.dialect.delimiter;
        let buffer = self.lines.buffer();
        let (mut taken, mut line) = (0, self.line + self.height);
        // The next cell: its number and its beginning. What follows in the row of what is asked.
        let (mut cell, mut start, mut to_find) = (0, 0, asked);
        let text = block.text_len();
        for end in Marks::new(buffer, [delimiter, b'\n', b'\r', b'"']) {
            if start == taken && cell == 0 && is_no_row(&buffer[start..]) {
                break;
            }
            match buffer[end] {
                b'"' => break,
                b'\r' if buffer.get(end + 1) == Some(&b'\n') => continue,
                b'\r' => break,
                _ => {}
            }
            let mut numbers = true;
            while let [(column, slot), rest @ ..] = to_find
                && *column == cell
            {
                let value = number(&buffer[start..end]).map(|value| in_unit(*column, value));
                let Some(value) = value.filter(|value| value.is_finite()) else {
                    numbers = false;
                    break;
                };
                block.push_number(*slot, value);
                to_find = rest;
            }
            if !numbers {
                break;
            }
            (cell, start) = (cell + 1, end + 1);
            if buffer[end] != b'\n' {
                continue;
            }
            let row = taken..end - usize::from(end > taken && buffer[end - 1] == b'\r');
            let has = |byte| memchr(byte, &buffer[row.clone()]).is_some();
            // With another delimiter, a cell with a comma must be quoted.
            if cell != columns || delimiter != b',' && has(b',') {
                break;
            }
            block.push_row_at(line, text + row.start..text + row.end);
            (taken, line) = (end + 1, line + 1);
            (cell, to_find) = (0, asked);
        }
        block.drop_numbers();
        block.push_text(&buffer[..taken], delimiter);
        self.lines.consume(taken);
        self.bytes += taken as u64;
        if taken > 0 {
            (self.line, self.height) = (line - 1, 1);
        }
    }

    /// Whether all bytes that have arrived are used.
    pub(in crate::data::table) fn is_drained(&self) -> bool {
        self.lines.buffer().is_empty()
    }
}

/// Whether the first line of a text is blank or a comment.
fn is_no_row(text: &[u8]) -> bool {
    let blank = |byte: &&u8| matches!(byte, b' ' | b'\t' | b'\x0c');
    let first = text.iter().find(|byte| !blank(byte));
    matches!(first, None | Some(b'#' | b'%' | b'\n' | b'\r'))
}

fn number(cell: &[u8]) -> Option<f64> {
    let cell = cell.strip_suffix(b"\r").unwrap_or(cell);
    short_decimal(cell).or_else(|| std::str::from_utf8(cell.trim_ascii()).ok()?.parse().ok())
}

/// A number of at most 15 digits without exponent; `None` for any other text. Both whole numbers of
/// the fraction are exact, so that the quotient is the nearest number to the text (Clinger 1990).
fn short_decimal(cell: &[u8]) -> Option<f64> {
    const POWERS: [f64; 16] = [
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
    ];
    let (negative, digits) = match cell {
        [b'-', digits @ ..] => (true, digits),
        digits => (false, digits),
    };
    if !(1..=16).contains(&digits.len()) {
        return None;
    }
    let (mut whole, mut point, mut decimals) = (0_u64, false, 0);
    for byte in digits {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            whole = 10 * whole + u64::from(digit);
            decimals += usize::from(point);
        } else if *byte == b'.' && !point {
            point = true;
        } else {
            return None;
        }
    }
    let count = digits.len() - usize::from(point);
    if !(1..=15).contains(&count) {
        return None;
    }
    let value = whole as f64 / POWERS[decimals];
    Some(if negative { -value } else { value })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    #[test]
    fn short_decimals_are_those_of_the_standard_library() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut taken = 0;
        for _ in 0..200_000 {
            let length = 1 + random.next_u32() % 18;
            let byte = |_| b"0123456789012345.-+e "[(random.next_u32() % 21) as usize];
            let text: Vec<u8> = (0..length).map(byte).collect();
            if let Some(value) = short_decimal(&text) {
                let expected: f64 = std::str::from_utf8(&text).unwrap().parse().unwrap();
                assert_eq!(value.to_bits(), expected.to_bits(), "{text:?}");
                taken += 1;
            }
        }
        assert!(taken > 20_000, "{taken}");
        let longest = [
            "999999999999999",
            "-0.99999999999999",
            ".000000000000001",
            "5.",
            "-0",
        ];
        for text in longest {
            let value = short_decimal(text.as_bytes()).unwrap();
            assert_eq!(
                value.to_bits(),
                text.parse::<f64>().unwrap().to_bits(),
                "{text}"
            );
        }
        for text in [
            "",
            "-",
            ".",
            "-.",
            "1..2",
            "1e5",
            "+1",
            "9999999999999999",
            "nan",
        ] {
            assert_eq!(short_decimal(text.as_bytes()), None, "{text}");
        }
    }
}
