//! Tables that this program wrote itself: the log of `hysteron run`, and the course of a controller
//! of `hysteron track`. Their columns are known, and which readings their loop did not believe.

use crate::data::table::{Column, TableReader};

/// What the columns of such a table are.
pub(super) struct Log {
    pub(super) what: &'static str,
    pub(super) input: &'static str,
    pub(super) output: &'static str,
    pub(super) time: &'static str,
    /// The columns that tell it from other tables.
    others: &'static [&'static str],
    /// The columns of flags, and the words that say that a reading is none; no words for 1.
    flags: &'static [&'static str],
    words: &'static [&'static str],
}

const LOGS: [Log; 2] = [
    Log {
        what: "a log of `hysteron run`",
        // The one that acted up to the reading of its row.
        input: "drive",
        output: "output",
        time: "time",
        others: &["reference", "command", "output_model", "learner", "sample"],
        flags: &["status"],
        words: &["missing", "rejected", "stuck"],
    },
    Log {
        what: "a run of `hysteron track`",
        input: "input",
        output: "measured",
        time: "time_s",
        others: &["reference", "command", "drive", "prediction", "adapted"],
        flags: &["sensor_fault", "rejected", "stuck"],
        words: &[],
    },
];

impl Log {
    /// The log that a table with these columns is.
    pub(super) fn of<'n>(names: impl Iterator<Item = &'n str> + Clone) -> Option<&'static Self> {
        LOGS.iter().find(|log| {
            let own = [log.input, log.output, log.time];
            let all = own.iter().chain(log.others).chain(log.flags);
            all.into_iter()
                .all(|needed| names.clone().any(|name| name == *needed))
        })
    }

    /// Whether the columns that are known of input, output and time are those of the log.
    /// They are `None` where nothing is known.
    pub(super) fn agrees(&self, known: [Option<&str>; 3]) -> bool {
        let own = [self.input, self.output, self.time];
        let mut pairs = own.into_iter().zip(known);
        pairs.all(|(name, known)| known.is_none_or(|known| known == name))
    }
}

/// The columns that say which readings of a log are none.
pub(super) struct HeldBack {
    flags: Vec<Column>,
    words: &'static [&'static str],
}

impl HeldBack {
    /// `None` where `output` is not that of a log.
    pub(super) fn of(table: &mut TableReader, output: &str) -> Option<Self> {
        let log = Log::of(table.header().iter().map(String::as_str))?;
        let flags = log.flags.iter().map(|name| table.column(name));
        (output == log.output).then_some(Self {
            flags: flags.collect::<Result<_, _>>().ok()?,
            words: log.words,
        })
    }

    /// Whether the present row has a reading that the loop did not believe.
    pub(super) fn holds(&self, table: &TableReader) -> bool {
        self.flags.iter().any(|&column| match self.words {
            [] => table.value(column) == Some(1.0),
            words => {
                let said = table.text(column).unwrap_or_default();
                said.split('+').any(|word| words.contains(&word))
            }
        })
    }
}
