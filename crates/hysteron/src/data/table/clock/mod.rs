//! A column of timestamps, read as seconds from the first one.
//!
//! `stamp` reads one text. This file reads a column of them: whether the day or the month comes
//! first, what midnight is to a time of day, and where the seconds begin.

mod stamp;

use stamp::{DAY, Stamp};

/// Whether a text is a date, a time of day, or both.
pub(crate) fn is_timestamp(text: &str) -> bool {
    Stamp::read(text).is_some()
}

/// What a column of timestamps has told so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Clock {
    /// Whether the day stands before the month, once that is known.
    pub(super) day_first: Option<bool>,
    /// The first timestamp and the last one, in nanoseconds, for both orders.
    first: Option<[i128; 2]>,
    last: [i128; 2],
    /// Midnights that a time of day has passed, in nanoseconds.
    midnights: i128,
}

/// Why a text is no time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unread {
    /// It is no timestamp, or not of the kind of those before.
    NoStamp,
    /// Day and month may be exchanged, and it matters now.
    Ambiguous,
}

impl Clock {
    /// Seconds from the first timestamp.
    pub(crate) fn read(&mut self, text: &str) -> Result<f64, Unread> {
        let stamp = Stamp::read(text).ok_or(Unread::NoStamp)?;
        let mut now = stamp.nanoseconds();
        if let Some(day_first) = self.day_first {
            let known = now[usize::from(!day_first)].ok_or(Unread::NoStamp)?;
            now = [Some(known); 2];
        } else if let [Some(_), None] | [None, Some(_)] = now {
            // All before have one date, which reads both ways: they have the same differences.
            let day_first = now[0].is_some();
            self.day_first = Some(day_first);
            let which = usize::from(!day_first);
            self.first = self.first.map(|first| [first[which]; 2]);
            self.last = [self.last[which]; 2];
            now = [now[which]; 2];
        }
        let [Some(a), Some(b)] = now else {
            return Err(Unread::NoStamp);
        };
        let mut now = [a, b];
        let Some(first) = self.first else {
            (self.first, self.last) = (Some(now), now);
            return Ok(0.0);
        };
        if stamp.is_time_of_day() {
            now = now.map(|now| now + self.midnights);
            if now[0] < self.last[0] - DAY / 2 {
                self.midnights += DAY;
                now = now.map(|now| now + DAY);
            }
        }
        if now[0] - first[0] != now[1] - first[1] {
            return Err(Unread::Ambiguous);
        }
        self.last = now;
        Ok((now[0] - first[0]) as f64 / 1e9)
    }

    /// As it is once the order of day and month is known.
    pub(super) fn decided(&mut self, day_first: bool) {
        let which = usize::from(!day_first);
        self.day_first = Some(day_first);
        self.first = self.first.map(|first| [first[which]; 2]);
        self.last = [self.last[which]; 2];
    }
}

/// Finds from a whole column whether the day or the month comes first.
#[derive(Debug, Clone, Default)]
pub(super) struct Order {
    /// For both orders: whether it is impossible, goes back, or has a step of more than a day.
    faults: [[bool; 3]; 2],
    last: [Option<i128>; 2],
    /// Whether hours are counted to twelve, as where the month comes first.
    halves: bool,
}

impl Order {
    pub(super) fn learn(&mut self, text: &str) {
        let Some(stamp) = Stamp::read(text) else {
            return;
        };
        self.halves |= stamp.is_of_half_a_day();
        for (n, now) in stamp.nanoseconds().into_iter().enumerate() {
            let [impossible, back, long] = &mut self.faults[n];
            *impossible |= now.is_none();
            if let (Some(last), Some(now)) = (self.last[n], now) {
                *back |= now < last;
                *long |= now - last > DAY;
            }
            self.last[n] = now;
        }
    }

    /// Whether the day comes first; `None` if nothing tells.
    pub(super) fn day_first(&self) -> Option<bool> {
        let [day, month] = self.faults;
        let differs = day.into_iter().zip(month).find(|(day, month)| day != month);
        match differs {
            Some((day, _)) => Some(!day),
            None => self.halves.then_some(false),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn read(texts: &[&str]) -> Vec<Result<f64, Unread>> {
        let mut clock = Clock::default();
        texts.iter().map(|text| clock.read(text)).collect()
    }

    #[test]
    fn a_column_counts_from_its_first_timestamp() {
        let cases: [(&[&str], f64); 14] = [
            (
                &["2026-11-23T14:03:05.250Z", "2026-11-23T15:03:05.5+01:00"],
                0.25,
            ),
            (&["2026-11-23 23:59:59,5", "2026-11-24 00:00:01"], 1.5),
            (&["20261123T140305", "20261123T140306.125"], 1.125),
            (
                &["23.11.2026 14:03:05,250", "23.11.2026 14:03:05,500"],
                0.25,
            ),
            (&["23.11.26 14:03:05", "1.12.26 14:03:05"], 8.0 * 86_400.0),
            (&["11/23/2026 11:59:59 AM", "11/23/2026 12:00:00 PM"], 1.0),
            (
                &["11/23/2026 11:59:59 p.m.", "11/24/2026 12:00:00 a.m."],
                1.0,
            ),
            (&["03/04/2026 10:00:00", "03/04/2026 10:00:01"], 1.0),
            // The second one tells what comes first.
            (
                &["03/04/2026 10:00:00", "13/04/2026 10:00:00"],
                10.0 * 86_400.0,
            ),
            (&["23:59:59.5", "00:00:00.25"], 0.75),
            (&["23:59:59", "24:00:03"], 4.0),
            (&["14:03", "14:04"], 60.0),
            (&["23-Nov-2026 14:03:05", "Nov 24 2026 14:03:05"], 86_400.0),
            (&["28/02/2024 00:00", "01/03/2024 00:00"], 2.0 * 86_400.0),
        ];
        for (texts, seconds) in cases {
            assert_eq!(read(texts), [Ok(0.0), Ok(seconds)], "{texts:?}");
        }
        // A clock that is set back stays so: only half a day is midnight.
        assert_eq!(read(&["14:03:05", "13:58:05"])[1], Ok(-300.0));
    }

    #[test]
    fn what_is_no_timestamp_is_not_read() {
        let none = [
            "",
            "1",
            "20.5",
            "-3e5",
            "1:2:3:4",
            "25.13.2026",
            "2026-02-30",
            "14:60:00",
            "14:03:61",
            "12:00 am pm",
            "13:00 PM",
            "2026-11-23T",
            "temperature",
            "1-2",
            "::",
            "24 °C",
            "1/2",
            "2026-11-23 10:00 +99:00",
            "é:é",
            "00:00:00,",
            "5:3:2",
        ];
        for text in none {
            assert_eq!(read(&[text]), [Err(Unread::NoStamp)], "{text}");
        }
    }

    #[test]
    fn day_and_month_are_asked_for_where_nothing_tells() {
        let texts = ["03/04/2026 10:00", "05/04/2026 10:00"];
        assert_eq!(read(&texts)[1], Err(Unread::Ambiguous));
        let order = |texts: &[&str]| {
            let mut order = Order::default();
            texts.iter().for_each(|text| order.learn(text));
            order.day_first()
        };
        assert_eq!(order(&texts), None);
        assert_eq!(order(&["03/04/2026 23:00", "04/04/2026 01:00"]), Some(true));
        assert_eq!(
            order(&["03/31/2026 23:00", "04/01/2026 01:00"]),
            Some(false)
        );
        assert_eq!(
            order(&["03/04/2026 1:00 PM", "05/04/2026 1:00 PM"]),
            Some(false)
        );
        assert_eq!(
            order(&["03/04/2026 10:00", "05/03/2026 10:00"]),
            Some(false)
        );
    }
}
