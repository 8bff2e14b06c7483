//! One timestamp: a date, a time of day, or both, as people and programs write them.

use time::{Date, Month, Time};

/// Nanoseconds.
const SECOND: i128 = 1_000_000_000;
pub(super) const DAY: i128 = 86_400 * SECOND;

/// No timestamp is longer.
const LONGEST: usize = 64;

/// The first letters of the months: English, German, French and Spanish.
const MONTHS: [&[&str]; 12] = [
    &["jan", "ene"],
    &["feb", "fev", "fév"],
    &["mar", "mär", "mrz"],
    &["apr", "avr", "abr"],
    &["may", "mai"],
    &["jun", "juin"],
    &["jul", "juil"],
    &["aug", "aou", "aoû", "ago"],
    &["sep"],
    &["oct", "okt"],
    &["nov"],
    &["dec", "dez", "déc", "dic"],
];

#[derive(Debug, Clone, Copy)]
pub(super) struct Stamp {
    /// The date with the day first, and with the month first; `None` for a time of day alone.
    dates: Option<[Option<Date>; 2]>,
    /// Since midnight.
    clock: i128,
    /// What the zone is ahead of UTC.
    ahead: i128,
    /// Whether it has `AM` or `PM`.
    halves: bool,
}

impl Stamp {
    pub(super) fn read(text: &str) -> Option<Self> {
        let text = text.trim().trim_matches('"');
        if text.is_empty() || text.len() > LONGEST {
            return None;
        }
        let text = text.to_lowercase();
        if let Some((date, rest)) = basic(&text) {
            return Self::of(Some([Some(date); 2]), rest.as_deref());
        }
        let Some(colon) = text.find(':') else {
            return Self::of(Some(dates(&text)?), None);
        };
        let hours = text[..colon]
            .trim_end_matches(|c: char| c.is_ascii_digit())
            .len();
        let (date, clock) = text.split_at(hours);
        let date = date.trim_end_matches(['t', ',', ' ', '_']).trim();
        match date {
            "" => Self::of(None, Some(clock)),
            date => Self::of(Some(dates(date)?), Some(clock)),
        }
    }

    fn of(dates: Option<[Option<Date>; 2]>, clock: Option<&str>) -> Option<Self> {
        let (clock, ahead, halves) = match clock {
            None => (0, 0, false),
            Some(clock) => time_of_day(clock, dates.is_none())?,
        };
        Some(Self {
            dates,
            clock,
            ahead,
            halves,
        })
    }

    /// Since some moment, with the day first, and with the month first.
    pub(super) fn nanoseconds(&self) -> [Option<i128>; 2] {
        let dates = self.dates.unwrap_or([Some(Date::MIN); 2]);
        dates.map(|date| {
            let days = i128::from(date?.to_julian_day());
            Some(days * DAY + self.clock - self.ahead)
        })
    }

    pub(super) fn is_time_of_day(&self) -> bool {
        self.dates.is_none() && self.clock < DAY
    }

    pub(super) fn is_of_half_a_day(&self) -> bool {
        self.halves
    }
}

/// `20261123T140305.25`: the date, and the time with colons.
fn basic(text: &str) -> Option<(Date, Option<String>)> {
    let (date, clock) = text.split_once('t')?;
    if date.len() != 8 || clock.len() < 4 || !clock.is_char_boundary(4) || clock.contains(':') {
        return None;
    }
    let year = number(date.get(..4)?)?;
    let date = date_of(year, number(date.get(4..6)?)?, number(date.get(6..)?)?)?;
    let (hours, rest) = (clock.get(..2)?, clock.get(2..)?);
    let (minutes, rest) = (rest.get(..2)?, rest.get(2..)?);
    let seconds = match rest.get(..2) {
        Some(seconds) if number(seconds).is_some() => format!(":{rest}"),
        _ => rest.to_owned(),
    };
    Some((date, Some(format!("{hours}:{minutes}{seconds}"))))
}

/// Digits alone.
fn number(text: &str) -> Option<i32> {
    let digits = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    digits.then(|| text.parse().ok()).flatten()
}

fn date_of(year: i32, month: i32, day: i32) -> Option<Date> {
    let month = Month::try_from(u8::try_from(month).ok()?).ok()?;
    Date::from_calendar_date(year, month, u8::try_from(day).ok()?).ok()
}

/// The date with the day first, and with the month first; `None` if it is neither.
fn dates(text: &str) -> Option<[Option<Date>; 2]> {
    let separator = text
        .find(['-', '/', '.', ' '])
        .map(|at| text.as_bytes()[at]);
    let mut parts = text
        .split(['-', '/', '.', ' ', ','])
        .filter(|part| !part.is_empty());
    let [a, b, c] = [parts.next()?, parts.next()?, parts.next()?];
    if parts.next().is_some() {
        return None;
    }
    let month = |text: &str| {
        let known = |names: &&[&str]| names.iter().any(|name| text.starts_with(name));
        MONTHS.iter().position(known).map(|n| n as i32 + 1)
    };
    let year = |text: &str| match (text.len(), number(text)?) {
        (4, year) => Some(year),
        (2, year) => Some(2000 + year),
        _ => None,
    };
    let both = |date: Option<Date>| date.map(|date| [Some(date); 2]);
    if let Some(month) = month(b) {
        return match a.len() {
            4 => both(date_of(number(a)?, month, number(c)?)),
            _ => both(date_of(year(c)?, month, number(a)?)),
        };
    }
    if let Some(month) = month(a) {
        return both(date_of(year(c)?, month, number(b)?));
    }
    let [first, second] = [number(a)?, number(b)?];
    if a.len() == 4 {
        return both(date_of(first, second, number(c)?));
    }
    let year = year(c)?;
    let day_first = date_of(year, second, first);
    match separator {
        Some(b'.') => both(day_first),
        _ => {
            let month_first = date_of(year, first, second);
            day_first.or(month_first)?;
            Some([day_first, month_first])
        }
    }
}

/// `14:03:05,250`, with `AM` or `PM`, and a zone: since midnight, ahead of UTC, and whether hours
/// are counted to twelve. Hours `alone`, without a date, may go on beyond a day.
fn time_of_day(text: &str, alone: bool) -> Option<(i128, i128, bool)> {
    let digits = |c: char| c.is_ascii_digit() || matches!(c, ':' | '.' | ',');
    let end = text.find(|c| !digits(c)).unwrap_or(text.len());
    let (clock, rest) = text.split_at(end);
    let mut parts = clock.split(':');
    let (hours, minutes) = (parts.next()?, parts.next()?);
    let (seconds, fraction) = match parts.next() {
        None => ("00", ""),
        Some(seconds) => match seconds.split_once(['.', ',']) {
            None => (seconds, ""),
            Some((_, "")) => return None,
            Some(parts) => parts,
        },
    };
    let two = |text: &str| (text.len() == 2).then(|| number(text)).flatten();
    let (mut hours, minutes, seconds) = (number(hours)?, two(minutes)?, two(seconds)?);
    let fraction_digits = fraction.bytes().all(|byte| byte.is_ascii_digit());
    if parts.next().is_some() || !fraction_digits {
        return None;
    }
    let (half, zone) = half_of_day(rest.trim());
    if let Some(after_noon) = half {
        if !(1..=12).contains(&hours) {
            return None;
        }
        hours = hours % 12 + if after_noon { 12 } else { 0 };
    }
    let days = match (alone, hours) {
        (true, 24..) => hours / 24,
        _ => 0,
    };
    let [hour, minute, second] = [hours - 24 * days, minutes, seconds].map(u8::try_from);
    // A leap second is the first one of the next minute.
    let second = second.ok()?;
    let leap = second == 60;
    let time = Time::from_hms(hour.ok()?, minute.ok()?, second - u8::from(leap)).ok()?;
    let (hour, minute, second) = time.as_hms();
    let whole = i128::from(hour) * 3600 + i128::from(minute) * 60 + i128::from(second);
    let fraction = &fraction[..fraction.len().min(9)];
    let nanoseconds = match number(fraction) {
        Some(digits) => i128::from(digits) * 10_i128.pow(9 - fraction.len() as u32),
        None => 0,
    };
    let clock = i128::from(days) * DAY + (whole + i128::from(leap)) * SECOND + nanoseconds;
    Some((clock, ahead(zone)?, half.is_some()))
}

/// Whether it is after noon, if the text says so, and the text behind.
fn half_of_day(text: &str) -> (Option<bool>, &str) {
    for (mark, after_noon) in [("am", false), ("a.m.", false), ("pm", true), ("p.m.", true)] {
        if let Some(rest) = text.strip_prefix(mark) {
            return (Some(after_noon), rest.trim());
        }
    }
    (None, text)
}

/// What a zone is ahead of UTC; zero for none.
fn ahead(zone: &str) -> Option<i128> {
    let zone = zone.trim_start_matches(['z']);
    let zone = zone
        .strip_prefix("utc")
        .or(zone.strip_prefix("gmt"))
        .unwrap_or(zone);
    let (sign, digits) = match zone.strip_prefix('+') {
        Some(digits) => (1, digits),
        None => match zone.strip_prefix(['-', '\u{2212}']) {
            Some(digits) => (-1, digits),
            None => return zone.is_empty().then_some(0),
        },
    };
    let (hours, minutes) = match digits.split_once(':') {
        Some(parts) => parts,
        None => digits.split_at_checked(2)?,
    };
    let minutes = if minutes.is_empty() { "0" } else { minutes };
    let (hours, minutes) = (number(hours)?, number(minutes)?);
    let possible = hours <= 15 && minutes < 60;
    possible.then(|| sign * i128::from(60 * hours + minutes) * 60 * SECOND)
}
