//! A column of time, and its conversion to seconds: numbers in a unit, seconds since 1970, or
//! timestamps.

use super::clock::{Clock, Unread};
use crate::recording::Quantity;

/// A column of time, as far as it has been read.
#[derive(Debug, Clone)]
pub(super) enum Time {
    /// No number and no timestamp has come yet; the unit, if it is known.
    Unknown(Option<TimeUnit>),
    /// Numbers in this unit.
    Numbers(Option<TimeUnit>),
    /// Numbers in this unit since 1970, and the first of them.
    Epoch(TimeUnit, f64),
    /// Timestamps, and that of the current row in seconds.
    Stamps(Clock, Option<f64>),
}

/// From 2001 to 2103, in seconds since 1970. Nobody records for so long.
const EPOCH: std::ops::Range<f64> = 1e9..4.2e9;

impl Time {
    /// What the first number of the column tells of all.
    pub(super) fn learn(&mut self, number: f64) {
        let Self::Unknown(unit) = self else { return };
        let unit = unit.take();
        let known = unit.is_some();
        let units = unit
            .iter()
            .cloned()
            .chain((!known).then(TimeUnit::all).into_iter().flatten());
        let epoch = units
            .into_iter()
            .find(|unit| EPOCH.contains(&unit.in_seconds(number)));
        *self = match epoch {
            Some(unit) => Self::Epoch(unit, number),
            None => Self::Numbers(unit),
        };
    }

    /// Reads the cell of a row. A column whose first cell is a timestamp is one of timestamps.
    pub(super) fn read(&mut self, cell: &str) -> Result<(), Unread> {
        if let Self::Unknown(_) = self {
            match cell.parse::<f64>() {
                Ok(number) if number.is_finite() => self.learn(number),
                _ => {
                    let mut clock = Clock::default();
                    if let Ok(now) = clock.read(cell) {
                        *self = Self::Stamps(clock, Some(now));
                    }
                    return Ok(());
                }
            }
        }
        if let Self::Stamps(clock, now) = self {
            let read = clock.read(cell);
            *now = read.ok();
            if read == Err(Unread::Ambiguous) {
                return Err(Unread::Ambiguous);
            }
        }
        Ok(())
    }

    /// A number of the column in seconds; for timestamps, those of the current row.
    pub(super) fn in_seconds(&self, number: Option<f64>) -> Option<f64> {
        match self {
            Self::Stamps(_, now) => *now,
            // Seconds among milliseconds are no times of this column.
            Self::Epoch(unit, first) => number
                .filter(|number| EPOCH.contains(&unit.in_seconds(*number)))
                .map(|number| unit.in_seconds(number - first)),
            Self::Unknown(unit) | Self::Numbers(unit) => number.map(|number| match unit {
                Some(unit) => unit.in_seconds(number),
                None => number,
            }),
        }
    }

    /// The unit, if it is not the second.
    pub(super) fn other_unit(&self) -> Option<&TimeUnit> {
        match self {
            Self::Stamps(..) => None,
            Self::Epoch(unit, _) => Some(unit),
            Self::Unknown(unit) | Self::Numbers(unit) => unit.as_ref(),
        }
        .filter(|unit| !unit.is_second())
    }

    /// Whether its numbers are others than those of the file.
    pub(super) fn is_converted(&self) -> bool {
        self.is_dated() || self.other_unit().is_some()
    }

    /// Whether seconds are counted from the first sample.
    pub(super) fn is_dated(&self) -> bool {
        matches!(self, Self::Epoch(..) | Self::Stamps(..))
    }
}

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

    /// Units in which seconds since 1970 may be counted.
    fn all() -> impl Iterator<Item = Self> {
        ["s", "ms", "us", "ns"].into_iter().filter_map(Self::named)
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
