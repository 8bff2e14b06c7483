//! Finds the header of a table in a text file, below the lines that a measuring program writes
//! above it.

use super::dialect::{is_missing, is_number, rewritten};

/// The position of the header, and what is around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data::table) struct Header {
    /// Number of lines of the file above it.
    pub(super) above: u64,
    /// Whether some of the lines above hold text that is neither blank nor a comment.
    pub(super) preamble: bool,
    /// False if there is no header, so that this is the first row of numbers.
    pub(super) named: bool,
    /// Whether rows may omit the last column, as LabVIEW does with its column of comments.
    pub(super) last_is_optional: bool,
}

/// A line with its cells.
pub(super) struct Line {
    /// Number of lines of the file above it.
    at: usize,
    pub(super) cells: Vec<Vec<u8>>,
    /// Which cells are numbers.
    numbers: Vec<bool>,
}

impl Line {
    pub(super) fn new(at: usize, cells: Vec<Vec<u8>>, delimiter: u8) -> Self {
        let commas = delimiter != b',';
        let number = |cell: &Vec<u8>| {
            let is_rewritten = |decimal_comma| rewritten(cell, decimal_comma).is_some();
            is_number(cell) || is_rewritten(false) || commas && is_rewritten(true)
        };
        Self {
            numbers: cells.iter().map(number).collect(),
            at,
            cells,
        }
    }

    fn has_numbers(&self) -> bool {
        self.numbers.contains(&true)
    }

    /// Whether every cell can be a name.
    fn can_be_header(&self) -> bool {
        let name = |cell: &Vec<u8>| !cell.trim_ascii().is_empty() && !is_missing(cell);
        !self.has_numbers() && self.cells.iter().all(name)
    }

    fn can_be_units(&self) -> bool {
        !self.has_numbers()
            && !self.cells.iter().any(|cell| is_missing(cell))
            && !self.cells.iter().all(|cell| cell.trim_ascii().is_empty())
    }
}

/// Finds the header among the lines that are neither blank nor comments. Returns it, and the index
/// of the line below it.
///
/// The header is the first line that satisfies all of these: it has as many cells as most lines,
/// all its cells are names, and the rows below it look like most rows. A row of units may be
/// between. If there is no such line, the header is the first line, unless that line looks like most
/// rows, or is a text in a single cell above rows of numbers.
pub(super) fn find(lines: &[Line]) -> (Header, usize) {
    let labview = labview(lines);
    let found = labview.or_else(|| above_the_usual(lines));
    let first_row = || {
        let body = body(lines)?;
        let first = lines.iter().position(|line| body.has(line))?;
        let bare = lines[first].numbers.iter().all(|number| *number);
        let text_above = lines[..first].iter().all(|line| line.cells.len() == 1);
        // A first line that is as most rows are is one of them, words in it or not.
        (first == 0 || bare && text_above && body.width > 1).then_some(first)
    };
    let (index, named) = match found {
        Some(index) => (index, true),
        None => first_row().map_or((0, true), |first| (first, false)),
    };
    let last_is_optional = labview.is_some()
        && lines[index]
            .cells
            .last()
            .is_some_and(|cell| cell.trim_ascii() == b"Comment");
    let header = Header {
        above: lines.get(index).map_or(0, |line| line.at as u64),
        preamble: index > 0,
        named,
        last_is_optional,
    };
    (header, index + usize::from(named))
}

/// What most rows look like: the number of cells, and which of them are numbers.
struct Body<'l> {
    width: usize,
    numbers: &'l [bool],
}

impl Body<'_> {
    fn has(&self, line: &Line) -> bool {
        line.numbers == self.numbers
    }
}

fn body(lines: &[Line]) -> Option<Body<'_>> {
    let rows = || lines.iter().filter(|line| line.has_numbers());
    let (width, _) = usual(rows().map(|line| line.cells.len()))?;
    let of_width = rows().filter(|line| line.cells.len() == width);
    let (numbers, _) = usual(of_width.map(|line| &line.numbers[..]))?;
    Some(Body { width, numbers })
}

fn above_the_usual(lines: &[Line]) -> Option<usize> {
    let body = body(lines)?;
    let first = lines.iter().position(|line| body.has(line))?;
    let fits = |n: &usize| {
        let line = &lines[*n];
        let below = lines[n + 1..].iter().take(4);
        let mut below = below.take_while(|line| line.cells.len() == body.width);
        let mut next = below.next();
        if next.is_some_and(|line| line.can_be_units()) {
            next = below.next();
        }
        let row = next.filter(|line| line.has_numbers());
        line.cells.len() == body.width
            && line.can_be_header()
            && row.is_some_and(|row| body.has(row) || below.any(|line| body.has(line)))
    };
    (0..first).find(fits)
}

/// In a LabVIEW file (`.lvm`) the header follows the last of the end marks.
fn labview(lines: &[Line]) -> Option<usize> {
    let begins = |line: &Line, mark: &[u8]| line.cells.first().is_some_and(|c| c.starts_with(mark));
    begins(lines.first()?, b"LabVIEW Measurement").then_some(())?;
    let mark = lines
        .iter()
        .rposition(|line| begins(line, b"***End_of_Header***"))?;
    let header = lines.get(mark + 1)?;
    header.can_be_header().then_some(mark + 1)
}

/// Whether a row of units follows the first of these lines.
pub(super) fn has_units(lines: &[Line]) -> bool {
    match lines {
        [header, units, rest @ ..] => {
            header.cells.len() == units.cells.len()
                && !header.numbers.iter().all(|number| *number)
                && units.can_be_units()
                && rest.first().is_none_or(Line::has_numbers)
        }
        _ => false,
    }
}

/// The most frequent value and its count; the first one of several.
pub(super) fn usual<T: Ord + Copy>(values: impl Iterator<Item = T>) -> Option<(T, usize)> {
    let mut counts: std::collections::BTreeMap<T, (usize, usize)> = Default::default();
    for (n, value) in values.enumerate() {
        counts.entry(value).or_insert((0, n)).0 += 1;
    }
    let most = counts
        .into_iter()
        .max_by_key(|(_, (count, first))| (*count, std::cmp::Reverse(*first)))?;
    Some((most.0, most.1.0))
}
