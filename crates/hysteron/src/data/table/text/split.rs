//! Splits a row of text into cells, line by line, so that no line is examined twice.

/// Splits a row, which continues on the next line if a quote is open at the end of a line.
#[derive(Default)]
pub(in crate::data) struct Splitter {
    cell: Vec<u8>,
    /// Whether the row continues within a quoted cell.
    open: bool,
}

impl Splitter {
    /// Passes the cells of the next line to `push`, without quotes around them. Returns false if
    /// the row continues in the next line because a quote is open. Then its last cell is not passed
    /// yet.
    pub(in crate::data) fn line(
        &mut self,
        line: &[u8],
        delimiter: u8,
        mut push: impl FnMut(&[u8]),
    ) -> bool {
        let end = line.iter().rposition(|byte| !matches!(byte, b'\r' | b'\n'));
        let (text, ending) = line.split_at(end.map_or(0, |end| end + 1));
        if !self.open && !text.contains(&b'"') {
            text.split(|byte| *byte == delimiter).for_each(push);
            return true;
        }
        let mut rest = text;
        loop {
            if !self.open {
                self.cell.clear();
                if let [b'"', after @ ..] = rest {
                    (self.open, rest) = (true, after);
                }
            }
            if self.open {
                rest = match self.quoted(rest) {
                    Some(after) => after,
                    None => {
                        self.cell.extend_from_slice(ending);
                        return false;
                    }
                };
            }
            let length = rest.iter().position(|byte| *byte == delimiter);
            let (plain, after) = rest.split_at(length.unwrap_or(rest.len()));
            self.cell.extend_from_slice(plain);
            push(&self.cell);
            match after {
                [_, after @ ..] => rest = after,
                [] => return true,
            }
        }
    }

    /// Continues within a quoted cell. Returns the text after the closing quote, or `None` if this
    /// line does not contain it.
    fn quoted<'t>(&mut self, mut rest: &'t [u8]) -> Option<&'t [u8]> {
        loop {
            let quote = rest.iter().position(|byte| *byte == b'"');
            let (text, after) = rest.split_at(quote.unwrap_or(rest.len()));
            self.cell.extend_from_slice(text);
            match after {
                // Two quotes stand for one quote in the text.
                [b'"', b'"', after @ ..] => {
                    self.cell.push(b'"');
                    rest = after;
                }
                [_, after @ ..] => {
                    self.open = false;
                    return Some(after);
                }
                [] => return None,
            }
        }
    }

    /// Discards a row that is not complete.
    pub(super) fn reset(&mut self) {
        self.open = false;
    }
}

/// The cells of one line, without quotes around them.
pub(super) fn cells(line: &[u8], delimiter: u8) -> Vec<Vec<u8>> {
    let mut cells = Vec::new();
    Splitter::default().line(line, delimiter, |cell| cells.push(cell.to_vec()));
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row by the definition: character by character, over all of its lines at once.
    fn by_definition(text: &str) -> Option<Vec<String>> {
        let mut rest = text.trim_end_matches(['\r', '\n']).chars().peekable();
        let mut row = Vec::new();
        loop {
            let mut cell = String::new();
            if rest.next_if_eq(&'"').is_some() {
                loop {
                    match rest.next()? {
                        '"' if rest.next_if_eq(&'"').is_some() => cell.push('"'),
                        '"' => break,
                        other => cell.push(other),
                    }
                }
            }
            cell.extend(std::iter::from_fn(|| rest.next_if(|c| *c != ',')));
            row.push(cell);
            if rest.next().is_none() {
                return Some(row);
            }
        }
    }

    /// Tests every text of up to seven of these characters: 97,656 texts.
    #[test]
    fn lines_give_the_cells_of_the_definition() {
        let alphabet = ['"', ',', 'a', '\n', '\r'];
        for length in 0..=7 {
            for n in 0..5_usize.pow(length) {
                let text: String = (0..length)
                    .map(|k| alphabet[n / 5_usize.pow(k) % 5])
                    .collect();
                let (mut splitter, mut row) = (Splitter::default(), Vec::new());
                let mut closed = false;
                let mut read = 0;
                for line in text.split_inclusive('\n') {
                    read += line.len();
                    closed = splitter.line(line.as_bytes(), b',', |cell| {
                        row.push(String::from_utf8_lossy(cell).into_owned());
                    });
                    if closed {
                        break;
                    }
                }
                if length == 0 {
                    continue;
                }
                // A complete row ends with its line. The rest of the text is the next row.
                let expected = by_definition(if closed { &text[..read] } else { &text });
                assert_eq!(closed.then_some(row), expected, "{text:?}");
            }
        }
    }
}
