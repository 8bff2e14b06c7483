//! Guesses which column of a table is the input, the output, the time and the load, for users who
//! have just opened a file. A guess is a suggestion, with its reason; nothing else uses it.

use crate::data::table::TableReader;
use crate::data::{ColumnSummary, TableSummary};
use crate::error::Result;
use crate::recording::Quantity;
use serde::Serialize;

/// A table as a user sees it first: its columns with a small picture each, and a guess of their
/// roles.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TablePreview {
    /// Rows and columns.
    #[serde(flatten)]
    pub table: TableSummary,
    /// For each column its course: the smallest and the largest number in each of at most
    /// [`PICTURE`] equal parts of the rows. A part without a number is `None`.
    pub pictures: Vec<Vec<Option<(f64, f64)>>>,
    /// The guess.
    pub roles: Roles,
}

/// Parts of the rows in a picture of a column.
pub const PICTURE: usize = 96;

/// The columns guessed, by name; `None` where nothing fits.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Roles {
    /// The input.
    pub input: Option<String>,
    /// The output.
    pub output: Option<String>,
    /// The time.
    pub time: Option<String>,
    /// The load, if it changes.
    pub load: Option<String>,
    /// Why, one sentence for each role.
    pub reasons: Vec<String>,
}

const TIME: [&str; 5] = ["time", "zeit", "timestamp", "seconds", "t"];
const LOAD: [&str; 5] = ["load", "stress", "force", "last", "weight"];
/// From the most to the least telling.
const INPUT: [&str; 13] = [
    "input",
    "drive",
    "duty",
    "temperature",
    "temp",
    "voltage",
    "power",
    "current",
    "field",
    "h",
    "pressure",
    "u",
    "x",
];
const OUTPUT: [&str; 18] = [
    "output",
    "displacement",
    "strain",
    "extension",
    "stroke",
    "lift",
    "deflection",
    "position",
    "angle",
    "elongation",
    "polarization",
    "magnetization",
    "flux",
    "length",
    "bl",
    "b",
    "p",
    "y",
];
/// Columns about other columns.
const ABOUT: [&str; 8] = [
    "sigma",
    "std",
    "error",
    "err",
    "sensor",
    "copied",
    "simulated",
    "model",
];

/// A load that changes by less than this share of its size is constant.
const CHANGES: f64 = 0.2;

/// Reads `table` to its end, keeps a picture of each column, and guesses the roles.
///
/// ```
/// let text = "time [s],T [degC],lift [mm]\n0,20,0\n1,50,3\n2,80,14\n3,50,9\n";
/// let mut table = hysteron::TableReader::from_bytes("run.csv", text, 1 << 20)?;
/// let roles = hysteron::preview_table(&mut table)?.roles;
/// assert_eq!(roles.time.as_deref(), Some("time [s]"));
/// assert_eq!(roles.input.as_deref(), Some("T [degC]"));
/// assert_eq!(roles.output.as_deref(), Some("lift [mm]"));
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// As [`crate::inspect_table`].
pub fn preview_table(table: &mut TableReader) -> Result<TablePreview> {
    let count = table.header().len();
    // Each is there twice: while the rows pass, and for the one who asked.
    take(table, 2 * count * size_of::<Course>())?;
    let mut columns: Vec<Course> = table.header().iter().map(|_| Course::default()).collect();
    let places: Vec<_> = table.columns().collect();
    let mut rows = 0;
    while table.advance()? {
        if rows < 2 * PICTURE as u64 {
            take(table, 2 * count * size_of::<Option<(f64, f64)>>())?;
        }
        rows += 1;
        for (course, &place) in columns.iter_mut().zip(&places) {
            course.push(table.value(place));
        }
    }
    let named = table.header().iter().zip(&columns);
    let summaries = named.map(|(name, course)| ColumnSummary {
        name: name.clone(),
        min: course.numbers().then_some(course.min),
        max: course.numbers().then_some(course.max),
        not_numbers: course.missing,
    });
    let summaries = summaries.collect();
    let roles = guess(table.header(), &columns);
    Ok(TablePreview {
        table: TableSummary {
            rows,
            columns: summaries,
        },
        pictures: columns.iter().map(Course::picture).collect(),
        roles,
    })
}

/// Takes memory for the pictures of all columns.
fn take(table: &mut TableReader, bytes: usize) -> Result<()> {
    let taken = table
        .budget()
        .take(bytes as u128, "a preview of its columns");
    taken.map_err(|problem| table.fault_at(None, None, problem))
}

/// What is kept of a column while its rows pass.
#[derive(Debug, Clone)]
struct Course {
    min: f64,
    max: f64,
    count: u64,
    missing: u64,
    last: f64,
    /// Whether no number was below the one before.
    ascends: bool,
    parts: Vec<Option<(f64, f64)>>,
    /// Rows in each part, and in the last one so far.
    size: u64,
    filled: u64,
}

impl Default for Course {
    fn default() -> Self {
        Self {
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
            count: 0,
            missing: 0,
            last: f64::NEG_INFINITY,
            ascends: true,
            parts: Vec::new(),
            size: 1,
            filled: 1,
        }
    }
}

impl Course {
    fn push(&mut self, value: Option<f64>) {
        if self.filled == self.size {
            if self.parts.len() == 2 * PICTURE {
                // Two parts become one, so that the number of rows need not be known.
                let pairs = self.parts.chunks(2);
                self.parts = pairs
                    .map(|pair| pair.iter().copied().fold(None, joined))
                    .collect();
                self.size *= 2;
            }
            self.parts.push(None);
            self.filled = 0;
        }
        self.filled += 1;
        let Some(value) = value else {
            self.missing += 1;
            return;
        };
        if let Some(part) = self.parts.last_mut() {
            *part = joined(*part, Some((value, value)));
        }
        self.ascends &= value >= self.last;
        self.last = value;
        self.count += 1;
        (self.min, self.max) = (self.min.min(value), self.max.max(value));
    }

    fn numbers(&self) -> bool {
        self.count > 0
    }

    fn moves(&self) -> bool {
        self.numbers() && self.max > self.min
    }

    fn picture(&self) -> Vec<Option<(f64, f64)>> {
        let each = self.parts.len().div_ceil(PICTURE).max(1);
        let parts = self.parts.chunks(each);
        parts
            .map(|part| part.iter().copied().fold(None, joined))
            .collect()
    }
}

fn joined(a: Option<(f64, f64)>, b: Option<(f64, f64)>) -> Option<(f64, f64)> {
    match (a, b) {
        (Some(a), Some(b)) => Some((a.0.min(b.0), a.1.max(b.1))),
        (a, b) => a.or(b),
    }
}

fn guess(header: &[String], columns: &[Course]) -> Roles {
    let words: Vec<Vec<String>> = header.iter().map(|name| words(name)).collect();
    let mut roles = Roles::default();
    let mut free: Vec<usize> = (0..header.len())
        .filter(|&n| columns[n].moves() && rank(&words[n], &ABOUT).is_none())
        .collect();
    let mut reason = |role: &str, n: usize, why: &str| {
        roles
            .reasons
            .push(format!("{role}: `{}`, {why}", header[n]));
        Some(header[n].clone())
    };

    // `T` that goes up and down is a temperature.
    let time = best(&free, &words, &TIME).filter(|&n| columns[n].ascends);
    roles.time = time.and_then(|n| reason("time", n, "which never goes back"));
    free.retain(|n| Some(*n) != time);

    let load = best(&free, &words, &LOAD);
    // With two columns left, they are input and output, whatever their names are.
    let load = load.filter(|_| free.len() > 2);
    roles.load = load.and_then(|n| {
        let (low, high) = (columns[n].min, columns[n].max);
        let changes = high - low > CHANGES * low.abs().max(high.abs());
        changes.then(|| reason("load", n, "which changes"))?
    });
    free.retain(|n| Some(*n) != load);

    let output = best(&free, &words, &OUTPUT);
    let others: Vec<usize> = free
        .iter()
        .copied()
        .filter(|n| Some(*n) != output)
        .collect();
    let input = best(&others, &words, &INPUT);
    // The first column that is left is the input, the next one the output.
    let next = |not: Option<usize>| free.iter().copied().find(|n| Some(*n) != not);
    let why = |named: Option<usize>| match named {
        Some(_) => "by its name",
        None => "by its place",
    };
    let input_at = input.or_else(|| next(output));
    let output_at = output.or_else(|| next(input_at));
    roles.input = input_at.and_then(|n| reason("input", n, why(input)));
    roles.output = output_at.and_then(|n| reason("output", n, why(output)));
    roles
}

/// The column whose name has the most telling word.
fn best(columns: &[usize], words: &[Vec<String>], telling: &[&str]) -> Option<usize> {
    let ranked = columns
        .iter()
        .filter_map(|&n| Some((rank(&words[n], telling)?, n)));
    ranked.min().map(|(_, n)| n)
}

fn rank(words: &[String], telling: &[&str]) -> Option<usize> {
    telling.iter().position(|known| {
        words.iter().enumerate().any(|(n, word)| match known.len() {
            // A letter counts only at the beginning: `H_A_per_m`, not `time_h`.
            1 => n == 0 && word == known,
            2 => word == known,
            _ => word.starts_with(known),
        })
    })
}

/// The words of a name in lower case, without its unit. `T` alone is a temperature.
fn words(name: &str) -> Vec<String> {
    let name = Quantity::from_column(name).name;
    if name == "T" {
        return vec!["temperature".to_owned()];
    }
    let words = name.split(|c: char| !c.is_alphanumeric());
    let words = words.filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn roles(text: &str) -> [Option<String>; 4] {
        let mut table = TableReader::from_bytes("t.csv", text.to_owned(), 1 << 20).unwrap();
        let Roles {
            input,
            output,
            time,
            load,
            ..
        } = preview_table(&mut table).unwrap().roles;
        [input, output, time, load]
    }

    #[test]
    fn columns_of_open_recordings_are_found() {
        let rows = "0,1,2,300\n1,5,4,300\n2,2,9,301\n";
        let found =
            |header: &str| roles(&format!("{header}\n{rows}")).map(|name| name.unwrap_or_default());
        let all = [
            (
                "time_s,duty,position_m,sensor_voltage_V",
                ["duty", "position_m", "time_s", ""],
            ),
            (
                "time_s,temperature_C,extension_mm,load_N",
                ["temperature_C", "extension_mm", "time_s", ""],
            ),
            (
                "time_min,current_A,BL_T,BL_sigma",
                ["current_A", "BL_T", "time_min", ""],
            ),
            (
                "time_s,voltage_V,polarization_uC_cm2,current_A",
                ["voltage_V", "polarization_uC_cm2", "time_s", ""],
            ),
            ("a,H_A_per_m,B_T,copied", ["H_A_per_m", "B_T", "", ""]),
        ];
        for (header, expected) in all {
            assert_eq!(found(header), expected, "{header}");
        }
    }

    #[test]
    fn a_load_counts_where_it_changes() {
        let text = "temperature_C,strain,stress_MPa\n30,0,50\n80,1,51\n30,0,150\n";
        assert_eq!(roles(text)[3].as_deref(), Some("stress_MPa"));
        let [input, output, ..] = roles("voltage,force\n0,0\n2,1\n1,3\n");
        assert_eq!(
            (input.as_deref(), output.as_deref()),
            (Some("voltage"), Some("force"))
        );
    }

    #[test]
    fn a_picture_is_small_and_keeps_every_peak() {
        let mut course = Course::default();
        for n in 0..100_003 {
            course.push((n % 7 != 0).then_some(if n == 54_321 { 9.0 } else { 0.0 }));
        }
        let picture = course.picture();
        assert!(picture.len() <= PICTURE, "{}", picture.len());
        assert_eq!(
            picture
                .iter()
                .flatten()
                .filter(|part| part.1 == 9.0)
                .count(),
            1
        );
    }
}
