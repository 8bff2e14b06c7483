//! How a report is made: the command as it was typed, and the day.

use hysteron_report::Made;
use time::OffsetDateTime;

pub(crate) struct Typed {
    command: String,
    date: String,
}

impl Typed {
    /// This command, today. `SOURCE_DATE_EPOCH`, seconds since 1970, is another day: with it the
    /// same command writes the same bytes (reproducible-builds.org).
    pub(crate) fn now() -> Self {
        let words = std::env::args_os().skip(1);
        let words = words.map(|word| hysteron::shell_word(&word.to_string_lossy()));
        let command: Vec<String> = std::iter::once("hysteron".to_owned())
            .chain(words)
            .collect();
        let given = std::env::var("SOURCE_DATE_EPOCH").ok();
        let given = given.and_then(|seconds| seconds.parse().ok());
        let given = given.and_then(|seconds| OffsetDateTime::from_unix_timestamp(seconds).ok());
        Self {
            command: command.join(" "),
            date: given
                .unwrap_or_else(OffsetDateTime::now_utc)
                .date()
                .to_string(),
        }
    }

    pub(crate) fn made(&self) -> Made<'_> {
        Made {
            command: Some(&self.command),
            date: Some(&self.date),
        }
    }
}
