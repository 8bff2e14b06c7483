//! Which columns of a table make a recording.

/// Names of the columns to read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Columns<'a> {
    /// The input.
    pub input: &'a str,
    /// The output.
    pub output: &'a str,
    /// Time, if wanted: in seconds, or with another unit behind its name.
    pub time: Option<&'a str>,
    /// The load or stress, if wanted.
    pub load: Option<&'a str>,
}

impl<'a> Columns<'a> {
    /// An input and an output, and nothing else.
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
