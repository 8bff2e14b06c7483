//! Recordings from files.

use super::repair::{Note, NoteKind, Repair};
use super::samples::{Samples, interpolate};
use super::{Columns, Origin, Quantity, Recording, Source};
use crate::table::{Column, TableReader};
use crate::{Remedy, Result, Setting};
use std::path::Path;

impl Recording {
    /// Reads a recording from a CSV, Parquet or MATLAB file; `-` is CSV from standard input.
    ///
    /// CSV has a header row; its cells stand between commas, semicolons or tabs, with a decimal point
    /// or, where commas do not separate them, a decimal comma; a row of units may stand below the
    /// header, and lines beginning with `#` or `%` are comments. In a MATLAB file vectors have their
    /// variable's name, and the columns of a matrix `M` are `M:1`, `M:2`; a matrix `[TimeValues
    /// DataValues]` asked for as `M` is its data, and its times are used where no time is asked for.
    ///
    /// The notes tell what was mended, and of gaps in time.
    ///
    /// # Errors
    /// [`crate::Error::File`]; [`crate::Error::Recording`] with row and column where a column is missing, a row is
    /// ragged, or there are no rows; and, to be refused and not mended, where a cell is no finite
    /// number, times go back or are repeated, or input and output have different times.
    ///
    /// ```
    /// use hysteron::{Columns, Recording, Repair};
    /// # let path = std::env::temp_dir().join(format!("hysteron-doc-{}.csv", std::process::id()));
    /// std::fs::write(&path, "T;lift\ndegC;mm\n20,5;0\n;0,1\n80;14\n")?;
    /// let columns = Columns::new("T", "lift");
    /// let refusal = Recording::read(&path, columns, Repair::Refuse).unwrap_err();
    /// assert!(refusal.to_string().contains("line 4, column `T`: an empty cell"));
    /// let (recording, notes) = Recording::read(&path, columns, Repair::Mend)?;
    /// assert_eq!(recording.input, [20.5, 80.0]);
    /// assert_eq!(recording.input_quantity.unit.as_deref(), Some("degC"));
    /// assert_eq!(notes[0].to_string(), "line 4 without a number: dropped");
    /// # std::fs::remove_file(&path)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn read(path: &Path, columns: Columns<'_>, repair: Repair) -> Result<(Self, Vec<Note>)> {
        let mut table = TableReader::open_hashed(path)?;
        let named = [
            Some(columns.input),
            Some(columns.output),
            columns.time,
            columns.load,
        ];
        for (n, name) in named.iter().enumerate() {
            if let (Some(name), true) = (name, named[..n].contains(name)) {
                let problem = format!(
                    "the column `{name}` is named twice: input, output, time and load are four things"
                );
                return Err(table.fault(None, problem));
            }
        }
        let pairs = [columns.input, columns.output].map(|name| table.pair(name));
        let time = match (columns.time, &pairs) {
            (Some(time), _) => Some(time.to_owned()),
            (None, [Some(_), _]) => Some(format!("{}:1", columns.input)),
            (None, [None, Some(_)]) => Some(format!("{}:1", columns.output)),
            (None, [None, None]) => None,
        };
        let interpolated = match &pairs {
            [Some([wanted, _]), Some([times, output])]
                if columns.time.is_none() && !same(wanted, times) =>
            {
                if repair == Repair::Refuse {
                    let problem = format!(
                        "the times of `{}` are not those of `{}`",
                        columns.output, columns.input
                    );
                    let words = "use {} to interpolate it onto them";
                    let remedy = Remedy::new(words, [Setting::on("repair")]);
                    return Err(table.fault(None, problem).remedied(remedy));
                }
                Some(interpolate(times, output, wanted))
            }
            _ => None,
        };
        let input_at = table.column(columns.input)?;
        let output_at = match interpolated {
            // Of no use, as the output stands elsewhere, but it has to be one.
            Some(_) => input_at,
            None => table.column(columns.output)?,
        };
        let mut asked = vec![input_at, output_at];
        let time_at = time.map(|name| table.column(&name)).transpose()?;
        let load_at = columns.load.map(|name| table.column(name)).transpose()?;
        asked.extend(time_at.into_iter().chain(load_at));
        let quantity = |name: &str, at: Column| {
            let mut quantity = Quantity::from_column(name);
            quantity.unit = quantity.unit.or(table.unit(at).map(str::to_owned));
            quantity
        };
        let input_quantity = quantity(columns.input, input_at);
        let output_quantity = quantity(columns.output, output_at);
        let load_quantity = match (columns.load, load_at) {
            (Some(name), Some(at)) => quantity(name, at),
            _ => Quantity::named("load"),
        };
        let mut samples = Samples::gather(&mut table, &asked, interpolated.as_deref())?;
        let mut notes = samples.mend(&table, time_at, repair)?;
        if interpolated.is_some() {
            let kind = NoteKind::Interpolated;
            let places = samples.places.iter().copied().collect();
            notes.push(Note { kind, places });
        }
        let mut series = samples.series.into_iter();
        let mut next = || series.next().unwrap_or_default();
        let recording = Self {
            input: next(),
            output: next(),
            time: time_at.map(|_| next()),
            load: load_at.map(|_| next()),
            input_quantity,
            output_quantity,
            load_quantity,
            origin: Origin::Measured,
            source: table.sha256()?.map(|sha256| Source {
                path: path.to_owned(),
                sha256,
            }),
        };
        recording.check()?;
        Ok((recording, notes))
    }
}

/// Whether times are the same, those that are no numbers as well.
fn same(a: &[f64], b: &[f64]) -> bool {
    a.iter()
        .map(|t| t.to_bits())
        .eq(b.iter().map(|t| t.to_bits()))
}
