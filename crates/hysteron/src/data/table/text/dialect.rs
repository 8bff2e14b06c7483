//! Detects the dialect of a text file from its beginning.

use super::header::{self, Header};
use super::split::cells;
use std::io::Read;

/// Number of bytes of a file that are examined.
const HEAD: usize = 1 << 16;

/// How the cells of a text file are written, and where its table begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data::table) struct Dialect {
    /// Separator of cells: comma, semicolon or tab.
    pub(super) delimiter: u8,
    /// Whether a comma in a number is a decimal comma.
    pub(super) decimal_comma: bool,
    /// Whether a row of units follows the header.
    pub(super) units: bool,
    /// End of a line: a line feed, or a carriage return if there are no line feeds.
    pub(super) end: u8,
    /// Where the header is.
    pub(super) header: Header,
}

/// The beginning of a file, and whether it is the whole file.
///
/// From a pipe, only the bytes up to the header and two rows are read, because the rest may take
/// long to arrive.
pub(in crate::data::table) fn head(file: &mut impl Read) -> std::io::Result<(Vec<u8>, bool)> {
    let mut head = vec![0; HEAD];
    let mut length = 0;
    let mut lines = Lines::default();
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
        if lines.enough(&head[..length]) {
            break;
        }
    }
    head.truncate(length);
    Ok((head, false))
}

/// The lines of a head that is still growing. Each line is examined once.
#[derive(Default)]
struct Lines {
    /// Number of bytes already searched for line ends, and the start of the last line.
    searched: usize,
    start: usize,
    /// Number of lines that are neither blank nor comments, and how many of the last ones hold
    /// numbers.
    count: usize,
    rows: usize,
}

impl Lines {
    /// Whether the head contains a possible header and two rows of numbers.
    fn enough(&mut self, head: &[u8]) -> bool {
        while let Some(end) = head[self.searched..].iter().position(|byte| *byte == b'\n') {
            let line = &head[self.start..self.searched + end];
            self.searched += end + 1;
            self.start = self.searched;
            if is_skipped(line) {
                continue;
            }
            self.count += 1;
            let number = |cell: &[u8]| is_number(cell) || rewritten(cell, true).is_some();
            let delimited = |byte: &u8| matches!(byte, b'\t' | b';' | b',');
            self.rows = match line.split(delimited).any(number) {
                true => self.rows + 1,
                false => 0,
            };
        }
        self.searched = head.len();
        self.count >= 3 && self.rows >= 2
    }
}

/// Whether a line is blank or a comment.
pub(super) fn is_skipped(line: &[u8]) -> bool {
    matches!(line.trim_ascii().first(), None | Some(b'#' | b'%'))
}

impl Dialect {
    /// The dialect of a text with this beginning, in UTF-8.
    pub(super) fn of(head: &[u8], whole: bool) -> Self {
        let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
        // A very long first line may hold neither.
        let end = match head.contains(&b'\r') && !head.contains(&b'\n') {
            true => b'\r',
            false => b'\n',
        };
        let mut lines: Vec<(usize, &[u8])> = head.split(|byte| *byte == end).enumerate().collect();
        if !whole && lines.len() > 1 {
            // The last line continues beyond the head.
            lines.pop();
        }
        lines.retain(|(_, line)| !is_skipped(line));
        let texts: Vec<&[u8]> = lines.iter().map(|(_, line)| *line).collect();
        let delimiter = delimiter(&texts);
        let rows: Vec<header::Line> = lines
            .iter()
            .map(|&(at, line)| header::Line::new(at, cells(line, delimiter), delimiter))
            .collect();
        let (header, below) = header::find(&rows);
        // If numbers have decimal points, commas cannot be decimal. They may separate thousands.
        let pointed = |cell: &Vec<u8>| cell.contains(&b'.') && is_number(cell);
        let mut data = rows[below.min(rows.len())..].iter();
        let decimal_comma = delimiter != b',' && !data.any(|row| row.cells.iter().any(pointed));
        Self {
            delimiter,
            decimal_comma,
            units: header.named && header::has_units(&rows[below.saturating_sub(1)..]),
            end,
            header,
        }
    }
}

/// The delimiter that occurs equally often in every line, or otherwise the one that gives the most
/// lines the same number of cells.
fn delimiter(lines: &[&[u8]]) -> u8 {
    // A comma can also be a decimal comma, so it is tried last.
    let known = [b'\t', b';', b','].map(|delimiter| {
        let count = |line: &&[u8]| cells(line, delimiter).len();
        (delimiter, lines.iter().map(count).collect::<Vec<_>>())
    });
    let even = |counts: &[usize]| counts.iter().all(|n| *n > 1 && *n == counts[0]);
    let first = known
        .iter()
        .find(|(_, counts)| !counts.is_empty() && even(counts));
    if let Some((delimiter, _)) = first {
        return *delimiter;
    }
    let mut best = (b',', 0);
    for (delimiter, counts) in &known {
        let several = counts.iter().copied().filter(|n| *n > 1);
        let (_, lines) = header::usual(several).unwrap_or_default();
        if lines > best.1 {
            best = (*delimiter, lines);
        }
    }
    best.0
}

pub(super) fn is_number(cell: &[u8]) -> bool {
    std::str::from_utf8(cell).is_ok_and(|text| text.trim().parse::<f64>().is_ok())
}

/// Whether a cell is a word for a missing number. Such a word is not a unit and not a name.
pub(super) fn is_missing(cell: &[u8]) -> bool {
    let words: [&[u8]; 5] = [b"na", b"n/a", b"null", b"none", b"missing"];
    words
        .iter()
        .any(|word| cell.trim_ascii().eq_ignore_ascii_case(word))
}

/// A number with a decimal comma, or with thousands set apart, rewritten as Rust reads it. `None`
/// for any other cell.
pub(super) fn rewritten(cell: &[u8], decimal_comma: bool) -> Option<Vec<u8>> {
    if !decimal_comma {
        return cell.contains(&b'.').then(|| in_one(cell, '.')).flatten();
    }
    let comma = cell.iter().position(|byte| *byte == b',')?;
    let mut pointed = cell.to_vec();
    pointed[comma] = b'.';
    match is_number(&pointed) {
        true => Some(pointed),
        false => in_one(cell, ','),
    }
}

/// A number whose thousands are set apart, as in `1.234,5`, `1'234,5` and `1,234.5`, in one. It
/// needs decimals: `1.234` may be a small number.
fn in_one(cell: &[u8], decimal: char) -> Option<Vec<u8>> {
    let text = std::str::from_utf8(cell).ok()?.trim();
    let (whole, decimals) = text.split_once(decimal)?;
    let (sign, digits) = match whole.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", whole.strip_prefix('+').unwrap_or(whole)),
    };
    let apart = digits.chars().find(|c| !c.is_ascii_digit())?;
    let may_be = ['.', ',', '\'', '\u{2019}', ' ', '\u{a0}', '\u{202f}'];
    let all_digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let mut groups = digits.split(apart);
    let leading = groups
        .next()
        .filter(|first| (1..=3).contains(&first.len()))?;
    let are_groups = groups.all(|group| group.len() == 3 && all_digits(group));
    if !may_be.contains(&apart) || !all_digits(leading) || !are_groups {
        return None;
    }
    let number = format!("{sign}{}.{decimals}", digits.replace(apart, ""));
    is_number(number.as_bytes()).then(|| number.into_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_that_are_set_apart_are_read() {
        for (cell, decimal_comma, read) in [
            ("1.234,56", true, Some("1234.56")),
            (" -12.345.678,5", true, Some("-12345678.5")),
            ("1'020,50", true, Some("1020.50")),
            ("1 020,50", true, Some("1020.50")),
            ("1\u{a0}020,50", true, Some("1020.50")),
            ("20,5", true, Some("20.5")),
            ("1,5e3", true, Some("1.5e3")),
            ("1,234.56", false, Some("1234.56")),
            ("1\u{2019}234.5e-2", false, Some("1234.5e-2")),
            // What may be a small number, or is none.
            ("1.234", true, None),
            ("1,234", false, None),
            ("12.34,5", true, None),
            ("1234.567,8", true, None),
            (".234,5", true, None),
            ("1.234.56,7", true, None),
            ("1.2 34,5", true, None),
            ("24.11.2026", true, None),
            ("14:03:05.250", false, None),
            ("10.0.0.1, up", true, None),
            ("1,234.5.6", false, None),
            ("a, b.", false, None),
            ("", true, None),
        ] {
            let found = rewritten(cell.as_bytes(), decimal_comma);
            let found = found.as_deref().map(<[u8]>::trim_ascii);
            assert_eq!(found, read.map(str::as_bytes), "{cell}");
        }
    }

    #[test]
    fn dialects_are_told_apart() {
        let cases: [(&str, u8, bool, bool); 14] = [
            ("x,y\n1,2\n", b',', false, false),
            ("x;y\n1;2\n", b';', true, false),
            ("x;y\n1,5;2,5\n", b';', true, false),
            ("x\ty\n1.5\t2\n", b'\t', false, false),
            // A comma in the header only.
            ("load, axial;y\n1,5;2\n", b';', true, false),
            ("x,note\n1,ok; fine\n", b',', false, false),
            // Numbers have decimal points, so commas cannot be decimal.
            ("x;y\n1,234;2.5\n", b';', false, false),
            ("x,y\ndegC,[mm]\n1,2\n", b',', false, true),
            ("x,y\ndegC,\n1,2\n", b',', false, true),
            ("x,y\ndegC,mm\n", b',', false, true),
            // Words for missing numbers are not units.
            ("x,y\nNA,NA\n1,2\n", b',', false, false),
            ("x\n1\n2\n", b',', false, false),
            ("Run 7\nx;y\n1,5;2,5\n3,5;4,5\n", b';', true, false),
            (
                "Run 7\nv 1.5\nx;y\nmm;N\n1,5;2,5\n3,5;4,5\n",
                b';',
                true,
                true,
            ),
        ];
        for (text, delimiter, decimal_comma, units) in cases {
            let found = Dialect::of(text.as_bytes(), true);
            let expected = Dialect {
                delimiter,
                decimal_comma,
                units,
                end: b'\n',
                header: found.header,
            };
            assert_eq!(found, expected, "{text:?}");
        }
        assert_eq!(Dialect::of(b"x,y\r1,2\r", true).end, b'\r');
        assert_eq!(Dialect::of(b"", true).delimiter, b',');
    }
}
