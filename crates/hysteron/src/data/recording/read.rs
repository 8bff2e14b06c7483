//! Reads recordings from files.

use crate::data::log::HeldBack;
use crate::data::recording::columns::Columns;
use crate::data::recording::others::Others;
use crate::data::recording::repair::{Note, NoteKind, Repair};
use crate::data::recording::samples::Samples;
use crate::data::table::{Column, Memory, ReadOptions, TableReader};
use crate::error::{Error, Place, Result};
use crate::recording::{Quantity, Recording, Source};
use crate::remedy::{Remedy, Setting};
use crate::series::interpolate::interpolate;
use bytes::Bytes;
use std::path::Path;

impl Recording {
    /// Reads a recording from a CSV, Parquet, Arrow or MATLAB file. The path `-` is CSV from
    /// standard input.
    ///
    /// **CSV.** Cells are separated by commas, semicolons or tabs. Numbers have a decimal point, or
    /// a decimal comma if commas do not separate cells. A row of units may follow the header. Lines
    /// that begin with `#` or `%` are comments. Lines that a data logger or LabVIEW writes above
    /// the header are skipped. Without a header, columns are numbered from 1. The text is UTF-8,
    /// UTF-16 with a byte order mark, or otherwise Windows-1252.
    ///
    /// **MATLAB.** A vector has the name of its variable. Fields of structures are `name.field`.
    /// The columns of a matrix `M` are `M:1`, `M:2`. A matrix `[TimeValues DataValues]` can be
    /// asked for as `M`, which means its data; its times are then used unless another time is asked
    /// for.
    ///
    /// Columns are found as by [`TableReader::column`]. A time in ms, min or another unit, given by
    /// its name or by the row of units, is converted to seconds.
    ///
    /// Timestamps and seconds since 1970 become seconds from the first row.
    ///
    /// **Logs** of `hysteron run` and `track`: rows whose reading the loop did not believe
    /// (missing, a spike, stuck) are left out.
    ///
    /// The notes tell what was assumed and repaired, and where the time has gaps. A recording is
    /// one history: [`Recording::read_segments`] reads a table of several.
    ///
    /// # Errors
    /// - [`crate::Error::File`].
    /// - [`crate::Error::Recording`] with row and column: a missing column, a ragged row, no rows,
    ///   or more memory than [`ReadOptions::max_memory`].
    /// - Also [`crate::Error::Recording`], unless rows are to be repaired: a cell that is not a
    ///   finite number, a row with more or fewer cells than the header, times that go back or
    ///   repeat, or different times of input and output.
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
    pub fn read(
        path: &Path,
        columns: Columns<'_>,
        options: impl Into<ReadOptions>,
    ) -> Result<(Self, Vec<Note>)> {
        let ReadOptions { repair, max_memory } = options.into();
        let table = TableReader::open_recording(path, None, repair, &max_memory.into())?;
        only(table, columns, repair)
    }

    /// As [`Recording::read`], for a table that may hold several recordings of one experiment: its
    /// segments, in the order of the file. Another one begins where the clock goes back, if rows
    /// are to be repaired, and after a gap in which the input may have turned unseen. What the
    /// actuator remembers at its beginning is unknown.
    ///
    /// ```
    /// use hysteron::{Columns, Recording, Repair};
    /// # let path = std::env::temp_dir().join(format!("hysteron-seg-{}.csv", std::process::id()));
    /// std::fs::write(&path, "t,T,lift\n0,20,0\n1,50,2\n2,80,14\n0,20,0\n1,60,3\n")?;
    /// let columns = Columns { time: Some("t"), ..Columns::new("T", "lift") };
    /// let (segments, notes) = Recording::read_segments(&path, columns, Repair::Mend)?;
    /// assert_eq!(segments[0].recording.input, [20.0, 50.0, 80.0]);
    /// assert_eq!(segments[1].first.to_string(), "line 5");
    /// assert!(notes[0].to_string().starts_with("line 5 going back in time"));
    /// # std::fs::remove_file(&path)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Recording::read`].
    pub fn read_segments(
        path: &Path,
        columns: Columns<'_>,
        options: impl Into<ReadOptions>,
    ) -> Result<(Vec<Segment>, Vec<Note>)> {
        let ReadOptions { repair, max_memory } = options.into();
        let table = TableReader::open_recording(path, None, repair, &max_memory.into())?;
        let (segments, _, notes) = read_parts(table, columns, repair, (false, true))?;
        Ok((segments, notes))
    }

    /// As [`Recording::read`], from the bytes of a file. The ending of `name` counts as that of a
    /// path. No file is touched.
    ///
    /// # Errors
    /// As [`Recording::read`].
    pub fn from_bytes(
        name: &str,
        bytes: impl Into<Bytes>,
        columns: Columns<'_>,
        options: impl Into<ReadOptions>,
    ) -> Result<(Self, Vec<Note>)> {
        let ReadOptions { repair, max_memory } = options.into();
        let held = Some(bytes.into());
        let table = TableReader::open_recording(Path::new(name), held, repair, &max_memory.into())?;
        only(table, columns, repair)
    }

    /// As [`Recording::read_segments`], from the bytes of a file, within an account of memory that
    /// others draw from, too. What is returned is no longer counted there.
    ///
    /// # Errors
    /// As [`Recording::read`].
    pub fn segments_within(
        name: &str,
        bytes: impl Into<Bytes>,
        columns: Columns<'_>,
        repair: Repair,
        memory: &Memory,
    ) -> Result<(Vec<Segment>, Vec<Note>)> {
        let held = Some(bytes.into());
        let table = TableReader::open_recording(Path::new(name), held, repair, memory)?;
        let (segments, _, notes) = read_parts(table, columns, repair, (false, true))?;
        Ok((segments, notes))
    }

    /// As [`Recording::read_segments`], and also returns the other columns of the file.
    ///
    /// # Errors
    /// As [`Recording::read`].
    pub fn read_with_others(
        path: &Path,
        columns: Columns<'_>,
        options: impl Into<ReadOptions>,
    ) -> Result<(Vec<Segment>, Others, Vec<Note>)> {
        let ReadOptions { repair, max_memory } = options.into();
        let table = TableReader::open_recording(path, None, repair, &max_memory.into())?;
        let (segments, others, notes) = read_parts(table, columns, repair, (true, true))?;
        Ok((segments, others.unwrap_or_default(), notes))
    }
}

/// The recording of a table that holds one.
fn only(
    table: TableReader,
    columns: Columns<'_>,
    repair: Repair,
) -> Result<(Recording, Vec<Note>)> {
    let path = table.path().to_owned();
    let (segments, _, notes) = read_parts(table, columns, repair, (false, false))?;
    match <[Segment; 1]>::try_from(segments) {
        Ok([segment]) => Ok((segment.recording, notes)),
        Err(segments) => Err(Error::Recording {
            path: Some(path),
            row: segments.get(1).map(|segment| segment.first),
            column: None,
            problem: format!(
                "time goes back: the table holds {} recordings, and one is needed here: write \
                 each to a file of its own, or leave out the time",
                segments.len()
            ),
        }),
    }
}

/// A part of a table that is one recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Its samples.
    pub recording: Recording,
    /// Position of its first row in the file.
    pub first: Place,
    /// Position of its last row.
    pub last: Place,
}

/// The segments of a table. `with_others` also keeps whole rows; without `parted`, a long gap
/// begins no segment.
fn read_parts(
    mut table: TableReader,
    columns: Columns<'_>,
    repair: Repair,
    (with_others, parted): (bool, bool),
) -> Result<(Vec<Segment>, Option<Others>, Vec<Note>)> {
    let path = table.path().to_owned();
    refuse_one_name(&table, columns)?;
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
        // The output comes from elsewhere, so this column is not used. But there has to be one.
        Some(_) => input_at,
        None => table.column(columns.output)?,
    };
    let time_at = time.map(|name| table.time_column(&name)).transpose()?;
    let load_at = columns.load.map(|name| table.column(name)).transpose()?;
    let all = [Some(input_at), Some(output_at), time_at, load_at];
    if interpolated.is_none() {
        refuse_one_column(&table, columns, &all)?;
    }
    let asked: Vec<Column> = all.into_iter().flatten().collect();
    let input_quantity = quantity(&table, columns.input, input_at);
    let output_quantity = match interpolated {
        Some(_) => Quantity::from_column(columns.output),
        None => quantity(&table, columns.output, output_at),
    };
    let load_quantity = match (columns.load, load_at) {
        (Some(name), Some(at)) => quantity(&table, name, at),
        _ => Quantity::named("load"),
    };
    let others = with_others.then(|| Others::new(&table, all));
    let held = HeldBack::of(&mut table, columns.output);
    let mut samples = Samples::gather(
        &mut table,
        (&asked, time_at.is_some()),
        interpolated.as_deref(),
        (held.as_ref(), others),
    )?;
    let mut mended = samples.mend(&table, time_at, repair)?;
    let starts = match parted {
        true => samples.starts(&mut mended),
        false => mended.back,
    };
    let mut of_rows = mended.notes;
    if interpolated.is_some() {
        let places = samples.places.iter().collect();
        of_rows.push((NoteKind::Interpolated, places));
    }
    if let (Some(at), Some(time)) = (time_at, samples.time()) {
        table.check_time_unit(at, time);
    }
    let remarks = table.remarks().cloned().map(Note::File);
    let of_rows = of_rows
        .into_iter()
        .map(|(kind, places)| Note::Rows { kind, places });
    let notes = remarks.chain(of_rows).collect();
    let others = samples.others.take();
    let origin = samples.origin();
    let source = table.sha256()?.map(|sha256| Source::new(path, sha256));
    // Samples count as the rows of the file do: nothing is to be told.
    let plain = samples.places.count_from_one() && starts.is_empty();
    let ends = starts.iter().skip(1).copied().chain([samples.places.len()]);
    let mut begin = 0;
    let mut segments = Vec::new();
    for end in starts.first().copied().into_iter().chain(ends) {
        if end <= begin {
            continue;
        }
        let mut series = samples
            .series
            .iter()
            .map(|values| values[begin..end].to_vec());
        let mut next = || series.next().unwrap_or_default();
        let recording = Recording {
            input: next(),
            output: next(),
            time: time_at.map(|_| next()),
            load: load_at.map(|_| next()),
            input_quantity: input_quantity.clone(),
            output_quantity: output_quantity.clone(),
            load_quantity: load_quantity.clone(),
            origin,
            undone: None,
            rest: None,
            source: source.clone().map(|source| Source {
                places: (!plain).then(|| samples.places.part(begin..end)),
                ..source
            }),
        };
        recording.check()?;
        segments.push(Segment {
            recording,
            first: samples.places.at(begin),
            last: samples.places.at(end - 1),
        });
        begin = end;
    }
    Ok((segments, others, notes))
}

/// Refuses one name for two series.
pub(super) fn refuse_one_name(table: &TableReader, columns: Columns<'_>) -> Result<()> {
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
    Ok(())
}

/// Refuses two names of one column.
pub(super) fn refuse_one_column(
    table: &TableReader,
    columns: Columns<'_>,
    found: &[Option<Column>; 4],
) -> Result<()> {
    for (n, at) in found.iter().enumerate() {
        if at.is_some() && found[..n].contains(at) {
            let names = [columns.input, columns.output, "the time", "the load"];
            let problem = format!(
                "the column meant by `{}` is that of another series: \
                 input, output, time and load are four things",
                names[n]
            );
            return Err(table.fault(*at, problem));
        }
    }
    Ok(())
}

/// Name and unit of a column that was asked for.
pub(in crate::data) fn quantity(table: &TableReader, asked: &str, at: Column) -> Quantity {
    // The data of a matrix `[TimeValues DataValues]` have the name of the matrix.
    let own = match table.name(at) {
        own if own.strip_suffix(":2") == Some(asked) => asked,
        own => own,
    };
    let mut quantity = Quantity::from_column(own);
    quantity.unit = quantity.unit.or(table.unit(at).map(str::to_owned));
    quantity
}

/// Whether times are equal. NaN equals NaN here.
fn same(a: &[f64], b: &[f64]) -> bool {
    a.iter()
        .map(|t| t.to_bits())
        .eq(b.iter().map(|t| t.to_bits()))
}
