//! Takes the plain rows of a text many at a time: no quotes, no decimal commas, nothing to mend.
//! Their bytes are copied as they are. Any other row is left to the reader of single rows.

use super::Text;
use crate::data::table::block::Block;
use crate::error::Place;
use memchr::memchr;
use std::io::BufRead;

impl Text {
    /// Adds the plain rows that come next and are in memory to `block`. `asked` are the columns
    /// asked for and their slots in the block. `in_unit` turns the number of a column into the unit
    /// that is wanted.
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
        let text = block.text_len();
        let (mut taken, mut line) = (0, self.line + self.height);
        let ends_of_cells = [delimiter, b'\n', b'\r', b'"'];
        self.marks.begin();
        'rows: while !is_no_row(&buffer[taken..]) {
            // One more than there are cells, because a line may end with two bytes.
            let marks = self.marks.ahead(buffer, ends_of_cells, columns + 1);
            let Some((cells, rest)) = marks.split_at_checked(columns) else {
                break;
            };
            let ends = |cell: usize| cells[cell] as usize;
            let last = ends(columns - 1);
            let end = match (buffer[last], rest) {
                (b'\n', _) => last,
                (b'\r', [_, ..]) if buffer[last + 1] == b'\n' => last + 1,
                _ => break,
            };
            if (0..columns - 1).any(|cell| buffer[ends(cell)] != delimiter) {
                break;
            }
            let row = taken..last;
            // With another delimiter, a cell with a comma must be quoted.
            if delimiter != b',' && memchr(b',', &buffer[row.clone()]).is_some() {
                break;
            }
            for (column, slot) in asked {
                let start = column.checked_sub(1).map_or(taken, |cell| ends(cell) + 1);
                let value = number(&buffer[start..ends(*column)]);
                let value = value.map(|value| in_unit(*column, value));
                let Some(value) = value.filter(|value| value.is_finite()) else {
                    break 'rows;
                };
                block.push_number(*slot, value);
            }
            block.push_row_at(Place::Line(line), text + row.start..text + row.end);
            self.marks.pass(columns + (end - last));
            (taken, line) = (end + 1, line + 1);
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
    let (whole, rest) = leading(digits, 0);
    let (whole, point, decimals) = match rest {
        [] => (whole, 0, 0),
        [b'.', decimals @ ..] => match leading(decimals, whole) {
            (whole, []) => (whole, 1, decimals.len()),
            _ => return None,
        },
        _ => return None,
    };
    if !(1..=15).contains(&(digits.len() - point)) {
        return None;
    }
    // The conversion of a signed number is faster, and this one is less than 2⁵³.
    let value = whole as i64 as f64 / POWERS[decimals];
    Some(if negative { -value } else { value })
}

/// `whole`, followed by the digits with which a text begins, and the rest of the text.
#[inline]
fn leading(text: &[u8], mut whole: u64) -> (u64, &[u8]) {
    let mut rest = text;
    while let [byte, after @ ..] = rest
        && byte.is_ascii_digit()
    {
        whole = 10 * whole + u64::from(byte - b'0');
        rest = after;
    }
    (whole, rest)
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
