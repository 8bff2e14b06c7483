//! The names of the columns that make up a recording.

/// Names of the columns to read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Columns<'a> {
    /// The input.
    pub input: &'a str,
    /// The output.
    pub output: &'a str,
    /// The time, if wanted: in seconds, or in another unit that follows its name.
    pub time: Option<&'a str>,
    /// The load or stress, if wanted.
    pub load: Option<&'a str>,
}

impl<'a> Columns<'a> {
    /// An input and an output, without time and load.
    #[must_use]
    pub fn new(input: &'a str, output: &'a str) -> Self {
        Self {
            input,
            output,
            time: None,
            load: None,
        }
    }
}

/// Index of the time among the series.
pub(super) const TIME: usize = 2;
