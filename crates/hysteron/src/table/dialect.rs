//! Which of its dialects a CSV file is written in, from its beginning.

use std::io::Read;

/// How much of a file is looked at.
const HEAD: usize = 1 << 16;

/// How the cells of a CSV file are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Dialect {
    /// Between cells: comma, semicolon or tab.
    pub(super) delimiter: u8,
    /// Whether a comma in a number is its decimal point.
    pub(super) decimal_comma: bool,
    /// Whether a row of units stands below the header.
    pub(super) units: bool,
    /// At the end of a line: a line feed, or a carriage return where there is none.
    pub(super) end: u8,
}

/// The beginning of a file, and whether that is all of it.
///
/// Of a pipe it is what has come once the header and two rows are there: the rest may be long in coming.
pub(super) fn head(file: &mut impl Read) -> std::io::Result<(Vec<u8>, bool)> {
    let mut head = vec![0; HEAD];
    let mut length = 0;
    while length < HEAD {
        match file.read(&mut head[length..]) {
            Ok(0) => {
                head.truncate(length);
                return Ok((head, true));
            }
            Ok(count) => length += count,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
        let lines = head[..length].split_inclusive(|byte| *byte == b'\n');
        let complete = lines.filter(|line| line.ends_with(b"\n") && !is_skipped(line));
        if complete.take(3).count() == 3 {
            break;
        }
    }
    head.truncate(length);
    Ok((head, false))
}

/// Whether a line is blank or a comment.
pub(super) fn is_skipped(line: &[u8]) -> bool {
    matches!(line.trim_ascii().first(), None | Some(b'#' | b'%'))
}

impl Dialect {
    pub(super) fn of(head: &[u8], whole: bool) -> Self {
        // A first line longer than the head has neither.
        let end = match head.contains(&b'\r') && !head.contains(&b'\n') {
            true => b'\r',
            false => b'\n',
        };
        let mut lines: Vec<&[u8]> = head.split(|byte| *byte == end).collect();
        if !whole && lines.len() > 1 {
            // The last line goes on beyond the head.
            lines.pop();
        }
        lines.retain(|line| !is_skipped(line));
        let delimiter = delimiter(&lines);
        let cells = |line: &&'_ [u8]| -> Vec<Vec<u8>> { cells(line, delimiter) };
        let rows: Vec<Vec<Vec<u8>>> = lines.iter().map(cells).collect();
        // Where points stand in numbers, commas do not: they may stand between thousands.
        let pointed = |cell: &Vec<u8>| cell.contains(&b'.') && is_number(cell);
        let decimal_comma = delimiter != b',' && !rows.iter().skip(1).flatten().any(pointed);
        let number =
            |cell: &Vec<u8>| is_number(cell) || decimal_comma && with_point(cell).is_some();
        let units = match &rows[..] {
            [header, units, rest @ ..] => {
                header.len() == units.len()
                    && !header.iter().all(number)
                    && units.iter().any(|cell| !cell.trim_ascii().is_empty())
                    && !units.iter().any(|cell| number(cell) || is_missing(cell))
                    && rest.first().is_none_or(|row| row.iter().any(number))
            }
            _ => false,
        };
        Self {
            delimiter,
            decimal_comma,
            units,
            end,
        }
    }
}

/// The delimiter that is there as often in every line, or else most often in the header.
fn delimiter(lines: &[&[u8]]) -> u8 {
    let count = |line: &[u8], delimiter| cells(line, delimiter).len() - 1;
    let [header, ..] = lines else {
        return b',';
    };
    // A comma may stand for a decimal point as well: it is asked last.
    let known = [b'\t', b';', b','].into_iter();
    let there: Vec<u8> = known.filter(|&d| count(header, d) > 0).collect();
    let even = |d: &&u8| {
        lines
            .iter()
            .all(|line| count(line, **d) == count(header, **d))
    };
    let most = there.iter().max_by_key(|d| count(header, **d));
    there.iter().find(even).or(most).copied().unwrap_or(b',')
}

/// The cells of a line, without their quotes.
fn cells(line: &[u8], delimiter: u8) -> Vec<Vec<u8>> {
    let mut row = csv::ByteRecord::new();
    super::text::split(line, delimiter, |cell| row.push_field(cell));
    row.iter().map(<[u8]>::to_vec).collect()
}

fn is_number(cell: &[u8]) -> bool {
    std::str::from_utf8(cell).is_ok_and(|text| text.trim().parse::<f64>().is_ok())
}

/// A word for a number that is not there, which is no unit.
fn is_missing(cell: &[u8]) -> bool {
    let words: [&[u8]; 5] = [b"na", b"n/a", b"null", b"none", b"missing"];
    words
        .iter()
        .any(|word| cell.trim_ascii().eq_ignore_ascii_case(word))
}

/// A number written with a decimal comma, with a point instead.
pub(super) fn with_point(cell: &[u8]) -> Option<Vec<u8>> {
    let comma = cell.iter().position(|byte| *byte == b',')?;
    let mut cell = cell.to_vec();
    cell[comma] = b'.';
    is_number(&cell).then_some(cell)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dialects_are_told_apart() {
        let cases: [(&str, u8, bool, bool); 12] = [
            ("x,y\n1,2\n", b',', false, false),
            ("x;y\n1;2\n", b';', true, false),
            ("x;y\n1,5;2,5\n", b';', true, false),
            ("x\ty\n1.5\t2\n", b'\t', false, false),
            // A comma in the header alone.
            ("load, axial;y\n1,5;2\n", b';', true, false),
            ("x,note\n1,ok; fine\n", b',', false, false),
            // Points stand in numbers, so that commas cannot be decimal.
            ("x;y\n1,234;2.5\n", b';', false, false),
            ("x,y\ndegC,[mm]\n1,2\n", b',', false, true),
            ("x,y\ndegC,\n1,2\n", b',', false, true),
            ("x,y\ndegC,mm\n", b',', false, true),
            // Numbers that are not there are no units.
            ("x,y\nNA,NA\n1,2\n", b',', false, false),
            ("x\n1\n2\n", b',', false, false),
        ];
        for (text, delimiter, decimal_comma, units) in cases {
            let expected = Dialect {
                delimiter,
                decimal_comma,
                units,
                end: b'\n',
            };
            assert_eq!(Dialect::of(text.as_bytes(), true), expected, "{text:?}");
        }
        assert_eq!(Dialect::of(b"x,y\r1,2\r", true).end, b'\r');
        assert_eq!(Dialect::of(b"", true).delimiter, b',');
    }
}
