//! Reads a table that holds several recordings, told apart by a column of labels.

use crate::data::recording::columns::Columns;
use crate::data::recording::read::{quantity, refuse_one_column, refuse_one_name};
use crate::data::recording::repair::{Note, Repair};
use crate::data::recording::samples::Samples;
use crate::data::table::{Column, Label, ReadOptions, TableReader};
use crate::error::Result;
use crate::recording::{Origin, Quantity, Recording};
use std::collections::HashMap;
use std::path::Path;

/// The recordings of a table, one after the other.
pub(crate) struct Groups {
    table: TableReader,
    repair: Repair,
    label: Label,
    time_at: Option<Column>,
    asked: Vec<Column>,
    /// Input, output, load.
    quantities: [Quantity; 3],
    has_load: bool,
    /// Whether the current row of the table begins the next recording.
    held: bool,
}

/// A recording of a table: its label, and its samples or what is wrong with them.
pub(crate) struct Group {
    pub(crate) label: String,
    pub(crate) recording: Result<(Recording, Vec<Note>)>,
    /// Number of bytes of the table read up to its end.
    pub(crate) bytes: u64,
}

impl Groups {
    /// Opens a table whose column `by` tells which recording a row belongs to.
    ///
    /// # Errors
    /// As [`Recording::read`].
    pub(crate) fn open(
        path: &Path,
        by: &str,
        columns: Columns<'_>,
        options: ReadOptions,
    ) -> Result<Self> {
        let mut table = TableReader::open_labelled(path, options.max_memory, by)?;
        refuse_one_name(&table, columns)?;
        let input = table.column(columns.input)?;
        let output = table.column(columns.output)?;
        let time_at = columns
            .time
            .map(|name| table.time_column(name))
            .transpose()?;
        let load_at = columns.load.map(|name| table.column(name)).transpose()?;
        let found = [Some(input), Some(output), time_at, load_at];
        refuse_one_column(&table, columns, &found)?;
        let quantities = [
            quantity(&table, columns.input, input),
            quantity(&table, columns.output, output),
            match (columns.load, load_at) {
                (Some(name), Some(at)) => quantity(&table, name, at),
                _ => Quantity::named("load"),
            },
        ];
        let label = table.label(by)?;
        let asked: Vec<Column> = found.into_iter().flatten().collect();
        table.read_only(asked.iter().copied());
        Ok(Self {
            table,
            repair: options.repair,
            label,
            time_at,
            asked,
            quantities,
            has_load: load_at.is_some(),
            held: false,
        })
    }

    /// The next recording: all rows up to another label.
    ///
    /// # Errors
    /// [`crate::Error::File`] and [`crate::Error::Recording`] where the table cannot be read any
    /// further.
    pub(crate) fn next(&mut self) -> Result<Option<Group>> {
        if !std::mem::take(&mut self.held) && !self.table.advance()? {
            return Ok(None);
        }
        let label = self.table.label_text(self.label);
        let before = self.table.budget().left();
        let mut samples = Samples::none((self.asked.len(), self.time_at.is_some()), None);
        loop {
            self.take(&mut samples)?;
            if !self.table.advance()? {
                self.take_ragged(&mut samples);
                break;
            }
            if !self.table.has_label(self.label, &label) {
                self.held = true;
                break;
            }
        }
        let taken = before.saturating_sub(self.table.budget().left());
        self.table.budget().give_back(u128::from(taken));
        Ok(Some(self.group(label, samples)))
    }

    /// All recordings, whatever the order of the rows, in the order in which they begin. Their rows
    /// have to fit into the memory allowed.
    ///
    /// # Errors
    /// As [`Groups::next`], and [`crate::Error::Recording`] for too many rows.
    pub(crate) fn all(mut self) -> Result<Vec<Group>> {
        let mut places: HashMap<String, usize> = HashMap::new();
        let mut groups: Vec<(String, Samples)> = Vec::new();
        let mut last = 0;
        while self.table.advance()? {
            let here = groups.get(last);
            if !here.is_some_and(|(label, _)| self.table.has_label(self.label, label)) {
                let label = self.table.label_text(self.label);
                last = *places.entry(label.clone()).or_insert_with(|| {
                    groups.push((
                        label,
                        Samples::none((self.asked.len(), self.time_at.is_some()), None),
                    ));
                    groups.len() - 1
                });
            }
            self.take(&mut groups[last].1)?;
        }
        let groups = groups.into_iter();
        Ok(groups.map(|(label, s)| self.group(label, s)).collect())
    }

    /// Adds the table's current row.
    fn take(&mut self, samples: &mut Samples) -> Result<()> {
        self.take_ragged(samples);
        samples.push(&mut self.table, &self.asked, None)
    }

    /// The rows that were dropped before this one.
    fn take_ragged(&mut self, samples: &mut Samples) {
        let ragged = self.table.take_ragged();
        samples.drop_ragged(&ragged, || {
            let problem = "more or fewer cells than the header".to_owned();
            self.table
                .fault_at(ragged.first.first().copied(), None, problem)
        });
    }

    fn group(&self, label: String, samples: Samples) -> Group {
        Group {
            recording: self.recording(samples),
            bytes: self.table.bytes_read(),
            label,
        }
    }

    fn recording(&self, mut samples: Samples) -> Result<(Recording, Vec<Note>)> {
        let mended = samples.mend(&self.table, self.time_at, self.repair)?;
        if let Some(n) = mended.back.first() {
            let problem = "time goes back: this is more than one recording, so that it needs more \
                           than one label";
            let place = Some(samples.places.at(*n));
            return Err(self.table.fault_at(place, self.time_at, problem.into()));
        }
        let notes = mended.notes.into_iter();
        let notes = notes.map(|(kind, places)| Note::Rows { kind, places });
        let [input_quantity, output_quantity, load_quantity] = self.quantities.clone();
        let mut series = samples.series.into_iter();
        let mut next = || series.next().unwrap_or_default();
        let recording = Recording {
            input: next(),
            output: next(),
            time: self.time_at.map(|_| next()),
            load: self.has_load.then(next),
            input_quantity,
            output_quantity,
            load_quantity,
            origin: Origin::Measured,
            source: None,
            undone: None,
            rest: None,
        };
        recording.check()?;
        Ok((recording, notes.collect()))
    }

    /// Remarks on how the table was understood, complete at its end.
    pub(crate) fn remarks(&self) -> Vec<Note> {
        self.table.remarks().cloned().map(Note::File).collect()
    }
}
