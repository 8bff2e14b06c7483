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
    ///
    /// # Errors
    /// It is no such number.
    pub(crate) fn now() -> Result<Self, String> {
        let words = std::env::args_os().skip(1);
        let words = words.map(|word| hysteron_files::shell_word(&word.to_string_lossy()));
        let command: Vec<String> = std::iter::once("hysteron".to_owned())
            .chain(words)
            .collect();
        let now = match std::env::var_os("SOURCE_DATE_EPOCH") {
            Some(seconds) => day(&seconds.to_string_lossy())?,
            None => OffsetDateTime::now_utc(),
        };
        Ok(Self {
            command: command.join(" "),
            date: now.date().to_string(),
        })
    }

    pub(crate) fn made(&self) -> Made<'_> {
        Made {
            command: Some(&self.command),
            date: Some(&self.date),
        }
    }
}

/// The time so many seconds after the beginning of 1970.
fn day(seconds: &str) -> Result<OffsetDateTime, String> {
    let found = seconds.trim().parse().ok();
    let found = found.and_then(|seconds| OffsetDateTime::from_unix_timestamp(seconds).ok());
    found.ok_or_else(|| {
        format!("SOURCE_DATE_EPOCH is `{seconds}`: a number of seconds since 1970 is needed")
    })
}

#[cfg(test)]
mod tests {
    use super::day;

    #[test]
    fn a_day_is_told_in_seconds() {
        let told = |seconds| day(seconds).map(|now| now.date().to_string());
        assert_eq!(told("1763856000").as_deref(), Ok("2025-11-23"));
        assert_eq!(told("-1").as_deref(), Ok("1969-12-31"));
        for wrong in [
            "",
            "today",
            "1e9",
            "9223372036854775807",
            "99999999999999999999",
        ] {
            assert!(told(wrong).is_err_and(|error| error.contains("SOURCE_DATE_EPOCH")));
        }
    }
}
