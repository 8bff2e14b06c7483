//! The unit of a column of time, and its conversion to seconds.

use crate::recording::Quantity;

/// The known units: how they are written, and their length in seconds.
const UNITS: [(&[&str], f64); 6] = [
    (
        &[
            "s", "sec", "secs", "second", "seconds", "sekunde", "sekunden",
        ],
        1.0,
    ),
    (&["ms", "msec", "millisecond", "milliseconds"], 1e-3),
    (
        &["us", "µs", "μs", "usec", "microsecond", "microseconds"],
        1e-6,
    ),
    (&["ns", "nsec", "nanosecond", "nanoseconds"], 1e-9),
    (&["min", "mins", "minute", "minutes", "minuten"], 60.0),
    (
        &["h", "hr", "hrs", "hour", "hours", "std", "stunden"],
        3600.0,
    ),
];

/// The unit of a column of time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TimeUnit {
    /// As written in the file.
    pub(super) name: String,
    /// Length in seconds.
    seconds: f64,
}

impl TimeUnit {
    /// Finds the unit: in brackets after the name, in the row of units (`below`), or at the end of
    /// the name, as in `time_ms`. `None` if there is no known unit.
    pub(super) fn of(column: &str, below: Option<&str>) -> Option<Self> {
        let quantity = Quantity::from_column(column);
        match quantity.unit.as_deref().or(below) {
            Some(unit) => Self::named(unit),
            None => {
                let last = quantity.name.rsplit(['_', ' ']).next();
                last.filter(|last| *last != quantity.name)
                    .and_then(Self::named)
            }
        }
    }

    fn named(name: &str) -> Option<Self> {
        let known = name.trim().to_lowercase();
        let fits = |(names, _): &&(&[&str], f64)| names.contains(&known.as_str());
        UNITS.iter().find(fits).map(|(_, seconds)| Self {
            name: name.trim().to_owned(),
            seconds: *seconds,
        })
    }

    pub(super) fn is_second(&self) -> bool {
        self.seconds == 1.0
    }

    /// A name without the unit at its end.
    pub(super) fn removed_from<'n>(&self, name: &'n str) -> &'n str {
        let bare = name.strip_suffix(self.name.as_str());
        let bare = bare.and_then(|bare| bare.strip_suffix(['_', ' ']));
        bare.filter(|bare| !bare.is_empty()).unwrap_or(name)
    }

    /// Converts a time to seconds.
    pub(super) fn in_seconds(&self, time: f64) -> f64 {
        // Dividing by a whole number is exact, multiplying by its inverse is not.
        match self.seconds < 1.0 {
            true => time / (1.0 / self.seconds).round(),
            false => time * self.seconds,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_from_names() {
        let cases = [
            ("t [ms]", None, Some(1e-3)),
            ("time_min", None, Some(60.0)),
            ("Zeit (h)", None, Some(3600.0)),
            ("t", Some("µs"), Some(1e-6)),
            ("t [s]", Some("ms"), Some(1.0)),
            ("time ns", None, Some(1e-9)),
            ("Time [MS]", None, Some(1e-3)),
            // Words that are not units or not suffixes.
            ("time_index", None, None),
            ("s", None, None),
            ("t [samples]", None, None),
        ];
        for (column, below, seconds) in cases {
            let found = TimeUnit::of(column, below).map(|unit| unit.seconds);
            assert_eq!(found, seconds, "{column}");
        }
        let milliseconds = TimeUnit::named("ms");
        assert_eq!(milliseconds.map(|unit| unit.in_seconds(3.0)), Some(0.003));
    }
}
