//! Decides whether commas in numbers are decimal commas or separate thousands.

/// What the numbers of a column show about commas, after these were read as decimal points.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Commas {
    /// There is a number whose comma can only be decimal.
    decimal: bool,
    /// The first number whose comma could separate thousands, and its line.
    pub(super) grouped: Option<(String, u64)>,
    /// There is a number below 1000 without decimals, as in a column with thousands separators.
    small: bool,
    /// There is a number with several commas.
    several: bool,
}

impl Commas {
    /// Evaluates a cell, in which commas have been replaced by points.
    pub(super) fn learn(&mut self, cell: &[u8], line: u64) {
        if self.decimal {
            return;
        }
        let digits = cell
            .strip_prefix(b"-")
            .or(cell.strip_prefix(b"+"))
            .unwrap_or(cell);
        let all_digits = |part: &[u8]| !part.is_empty() && part.iter().all(u8::is_ascii_digit);
        let mut parts = digits.split(|byte| matches!(byte, b'.' | b','));
        let first = parts.next().unwrap_or_default();
        let rest: Vec<&[u8]> = parts.take(4).collect();
        if !all_digits(first) || rest.iter().any(|part| !all_digits(part)) {
            return;
        }
        let leading = first.len() <= 3 && first[0] != b'0';
        let groups = leading && rest.iter().all(|part| part.len() == 3);
        match rest.len() {
            0 if first.len() <= 3 => self.small = true,
            0 => self.decimal = true,
            1 if groups && self.grouped.is_none() => {
                self.grouped = Some((String::from_utf8_lossy(cell).into_owned(), line));
            }
            1 => self.decimal |= !groups,
            _ => self.several |= groups,
        }
    }

    /// Whether a number of the column excludes thousands separators.
    pub(super) fn is_decimal(&self) -> bool {
        self.decimal
    }

    /// Whether the column looks as if commas separate thousands.
    pub(super) fn may_be_thousands(&self) -> bool {
        !self.decimal && self.grouped.is_some() && (self.small || self.several)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_told_apart() {
        // Whether it is certainly decimal, can be either, looks like thousands.
        let cases: [(&[&str], bool, bool, bool); 7] = [
            (&["0.5", "1.234"], true, false, false),
            (&["1.234", "0.123"], true, true, false),
            (&["1.234", "20.125"], false, true, false),
            (&["950", "1.234"], false, true, true),
            (&["-1.234", "1,234,567"], false, true, true),
            (&["1234", "1.234"], true, false, false),
            (&["1.5e3", "no", ""], false, false, false),
        ];
        for (cells, decimal, grouped, thousands) in cases {
            let mut commas = Commas::default();
            for (n, cell) in cells.iter().enumerate() {
                commas.learn(cell.as_bytes(), n as u64);
            }
            assert_eq!(commas.is_decimal(), decimal, "{cells:?}");
            assert_eq!(commas.grouped.is_some(), grouped, "{cells:?}");
            assert_eq!(commas.may_be_thousands(), thousands, "{cells:?}");
        }
    }
}
