//! The line protocol, version 1: ASCII lines that end with `*` and a CRC-16/CCITT-FALSE in hex.
//!
//! ```
//! use hysteron_bench::protocol::{FromDevice, ToDevice, opened};
//! let line = ToDevice::Drive { sample: 1, text: "0.0420".into() }.line();
//! assert_eq!(line, "D 1 0.0420*7EAB\n");
//! assert_eq!(opened(line.trim_end().as_bytes()), Some("D 1 0.0420"));
//! assert_eq!(opened(b"D 1 0.0421*7EAB"), None);
//! let end = FromDevice::parse("E watchdog");
//! assert_eq!(end, Some(FromDevice::End("watchdog".into())));
//! ```

use hysteron::Quantity;

/// Most bytes of a line, without its end.
pub const LONGEST: usize = 200;

/// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF, nothing reflected.
///
/// ```
/// assert_eq!(hysteron_bench::protocol::crc(b"123456789"), 0x29B1); // the catalogue's check value
/// ```
#[must_use]
pub fn crc(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xFFFF, |crc, byte| {
        (0..8).fold(crc ^ (u16::from(*byte) << 8), |crc, _| {
            let shifted = crc << 1;
            if crc & 0x8000 == 0 {
                shifted
            } else {
                shifted ^ 0x1021
            }
        })
    })
}

/// A line with its check and its end.
#[must_use]
pub fn closed(text: &str) -> String {
    format!("{text}*{:04X}\n", crc(text.as_bytes()))
}

/// What stands before the check of a line without its end; `None` for a line that is not there:
/// with a wrong check, too long, or not in ASCII.
#[must_use]
pub fn opened(line: &[u8]) -> Option<&str> {
    let line = line.strip_suffix(b"\r").unwrap_or(line);
    let line = std::str::from_utf8(line).ok()?;
    if line.len() > LONGEST || !line.is_ascii() {
        return None;
    }
    let (text, check) = line.rsplit_once('*')?;
    let hex = check.len() == 4 && check.bytes().all(|byte| byte.is_ascii_hexdigit());
    let right = hex && u16::from_str_radix(check, 16) == Ok(crc(text.as_bytes()));
    right.then_some(text)
}

/// What the host says.
#[derive(Debug, Clone, PartialEq)]
pub enum ToDevice {
    /// Who are you?
    Who,
    /// Begin to sample.
    Go,
    /// The drive for a sample that was read.
    Drive {
        /// Its number.
        sample: u64,
        /// The drive, in the unit of the header.
        text: String,
    },
    /// Go to the safe drive, and end.
    Quit,
}

impl ToDevice {
    /// The line that says it.
    #[must_use]
    pub fn line(&self) -> String {
        match self {
            Self::Who => closed("?"),
            Self::Go => closed("G"),
            Self::Drive { sample, text } => closed(&format!("D {sample} {text}")),
            Self::Quit => closed("Q"),
        }
    }
}

/// What a device says of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// Its name; empty if it has none.
    pub name: String,
    /// Time between its samples, s.
    pub dt: f64,
    /// Lowest and highest drive.
    pub drive: (f64, f64),
    /// Unit of the drive.
    pub unit: Option<String>,
    /// The drive that is safe.
    pub safe: f64,
    /// Time without a valid line after which it goes to the safe drive itself, s; `None` if it says
    /// nothing of it.
    pub watchdog: Option<f64>,
    /// What it reads; one is `output`.
    pub columns: Vec<Quantity>,
}

impl Header {
    /// Place of a column by its name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }
}

/// A sample that a device has read.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Its number.
    pub number: u64,
    /// The device's time, s.
    pub time: f64,
    /// The number of the sample whose drive acts; 0 for none yet.
    pub applied: u64,
    /// The columns of the header. NaN for a missing reading.
    pub readings: Vec<f64>,
}

/// What a device says.
#[derive(Debug, Clone, PartialEq)]
pub enum FromDevice {
    /// Who it is, or what is wrong with its header.
    Header(std::result::Result<Header, String>),
    /// A sample.
    Sample(Sample),
    /// It has ended, and why.
    End(String),
}

impl FromDevice {
    /// What the text of a line says; `None` for what is no line of the protocol.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let mut words = text.split_ascii_whitespace();
        match words.next()? {
            "H" => Some(Self::Header(header(words))),
            "S" => sample(words).map(Self::Sample),
            "E" => Some(Self::End(words.collect::<Vec<_>>().join(" "))),
            _ => None,
        }
    }
}

fn sample<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<Sample> {
    let number = words.next()?.parse().ok()?;
    let time: f64 = words.next()?.parse().ok()?;
    let applied = words.next()?.parse().ok()?;
    let readings: Option<Vec<f64>> = words
        .map(|word| {
            let value: f64 = word.parse().ok()?;
            Some(if value.is_finite() { value } else { f64::NAN })
        })
        .collect();
    time.is_finite().then_some(Sample {
        number,
        time,
        applied,
        readings: readings?,
    })
}

fn header<'a>(mut words: impl Iterator<Item = &'a str>) -> std::result::Result<Header, String> {
    match words.next() {
        Some("1") => {}
        other => {
            return Err(format!(
                "it speaks version `{}` of the protocol, and only version 1 is known here",
                other.unwrap_or("")
            ));
        }
    }
    let entries: Vec<(&str, &str)> = words.filter_map(|word| word.split_once('=')).collect();
    let find = |name: &str| {
        let found = entries.iter().find(|(key, _)| *key == name);
        found.map(|(_, value)| *value)
    };
    let needed = |name: &str| find(name).ok_or_else(|| format!("its header has no `{name}=`"));
    let number = |name: &str, text: &str| {
        let value = text.parse().ok().filter(|value: &f64| value.is_finite());
        value.ok_or_else(|| format!("`{name}={text}` in its header: a number is needed"))
    };
    let dt = number("dt", needed("dt")?)?;
    let drive = needed("drive")?;
    let (range, unit) = unit_of(drive);
    let (low, high) = range
        .split_once(':')
        .ok_or_else(|| format!("`drive={drive}` in its header: as 0:0.12[A2] is needed"))?;
    let (low, high) = (number("drive", low)?, number("drive", high)?);
    let safe = number("safe", needed("safe")?)?;
    let watchdog = find("watchdog")
        .map(|text| number("watchdog", text))
        .transpose()?;
    let columns: Vec<Quantity> = needed("columns")?
        .split(',')
        .map(|column| match unit_of(column) {
            (name, Some(unit)) => Quantity::with_unit(name, unit),
            (name, None) => Quantity::named(name),
        })
        .collect();
    let header = Header {
        name: find("name").unwrap_or_default().to_owned(),
        dt,
        drive: (low, high),
        unit: unit.map(str::to_owned),
        safe,
        watchdog: watchdog.filter(|time| *time > 0.0),
        columns,
    };
    fault(&header).map_or(Ok(header.clone()), Err)
}

/// What no device can be.
fn fault(header: &Header) -> Option<String> {
    let (low, high) = header.drive;
    let names: Vec<&str> = header.columns.iter().map(|one| one.name.as_str()).collect();
    let twice = (1..names.len()).find(|n| names[..*n].contains(&names[*n]));
    if header.dt <= 0.0 {
        Some(format!(
            "`dt={}` in its header: a time above zero is needed",
            header.dt
        ))
    } else if low >= high {
        Some(format!(
            "`drive={low}:{high}` in its header: the lower one comes first"
        ))
    } else if !(low..=high).contains(&header.safe) {
        Some(format!(
            "its safe drive {} is outside its drives {low} to {high}",
            header.safe
        ))
    } else if !names.contains(&"output") {
        Some(format!(
            "none of its columns ({}) is `output`",
            names.join(", ")
        ))
    } else {
        twice.map(|n| format!("its header has two columns `{}`", names[n]))
    }
}

/// `output[mm]`: the name, and the unit if there is one.
fn unit_of(text: &str) -> (&str, Option<&str>) {
    match text.strip_suffix(']').and_then(|text| text.split_once('[')) {
        Some((name, unit)) => (name, Some(unit)),
        None => (text, None),
    }
}

/// A drive as it is sent: at most nine digits behind the leading one of the range, within the
/// limits, and the number that this text says.
#[must_use]
pub fn drive_text(drive: f64, (low, high): (f64, f64)) -> (String, f64) {
    let leading = (high - low).abs().log10().floor();
    let digits = (9.0 - leading).clamp(0.0, 30.0) as usize;
    let text = format!("{drive:.digits$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    };
    let text = if text == "-0" { "0".to_owned() } else { text };
    match text.parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => (text, value),
        // Rounding has left the limits, or the range has no such digits.
        _ => {
            let drive = drive.max(low).min(high);
            (format!("{drive}"), drive)
        }
    }
}
