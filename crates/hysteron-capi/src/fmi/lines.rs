//! The lines of the text in which an FMU carries its model.

use std::str::FromStr;

#[derive(Debug)]
pub(crate) struct Fault {
    pub(super) line: usize,
    pub(super) problem: String,
}

pub(crate) type Parsed<T> = std::result::Result<T, Fault>;

/// Lines with their numbers.
pub(crate) struct Lines<'a> {
    lines: std::str::Split<'a, char>,
    line: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self {
            lines: text.split('\n'),
            line: 0,
        }
    }

    pub(crate) fn fault<T>(&self, problem: impl Into<String>) -> Parsed<T> {
        Err(Fault {
            line: self.line,
            problem: problem.into(),
        })
    }

    pub(super) fn next(&mut self) -> Parsed<&'a str> {
        self.line += 1;
        match self.lines.next() {
            Some(line) => Ok(line),
            None => self.fault("the file ends here"),
        }
    }

    /// The words after `key` on the next line, which has to have this number of them.
    pub(super) fn entry<const N: usize>(&mut self, key: &str) -> Parsed<[&'a str; N]> {
        let line = self.next()?;
        let words: Option<Vec<&str>> = line
            .strip_prefix(key)
            .and_then(|rest| rest.strip_prefix(' '))
            .map(|rest| rest.split(' ').collect());
        match words.and_then(|words| words.try_into().ok()) {
            Some(words) => Ok(words),
            None => self.fault(format!("`{key}` and {N} value(s) are expected")),
        }
    }

    /// The numbers after `key` on the next line, as many as there are.
    pub(crate) fn numbers(&mut self, key: &str) -> Parsed<Vec<f64>> {
        let line = self.next()?;
        let Some(rest) = line.strip_prefix(key) else {
            return self.fault(format!("`{key}` is expected"));
        };
        let mut words = rest.split(' ');
        match words.next() {
            Some("") => words.map(|word| self.finite(word)).collect(),
            _ => self.fault(format!("`{key}` is expected")),
        }
    }

    pub(super) fn number<T: FromStr>(&self, word: &str) -> Parsed<T> {
        word.parse()
            .or_else(|_| self.fault(format!("`{word}` is no number that can stand here")))
    }

    pub(super) fn finite(&self, word: &str) -> Parsed<f64> {
        let number: f64 = self.number(word)?;
        match number.is_finite() {
            true => Ok(number),
            false => self.fault(format!("{number} is not a finite number")),
        }
    }
}
