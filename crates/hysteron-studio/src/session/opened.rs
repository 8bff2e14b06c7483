//! A file that is open: its bytes, its columns, and the recordings that they make.

use super::fault::Fault;
use super::id::Id;
use super::parts::{Parts, number};
use super::prepare::Steps;
use super::thinned::when;
use bytes::Bytes;
use hysteron::{
    Budget, Columns, Memory, PICTURE, Preparation, Progress, Recording, Repair, Step, TablePreview,
    TableReader, branches, prepare, preview_table, usual_tolerance,
};
use serde::{Deserialize, Serialize};
use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;

/// What a file is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Purpose {
    /// It is fitted.
    #[default]
    Fit,
    /// It tests the fits.
    Validate,
    /// It is only looked at.
    Look,
    /// A drive follows one of its columns. It need not be a recording.
    Path,
}

/// Columns by their names.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Part {
    /// The input.
    pub input: Option<String>,
    /// The output.
    pub output: Option<String>,
    /// The time.
    pub time: Option<String>,
    /// The load.
    pub load: Option<String>,
}

/// A file that is open.
#[derive(Debug)]
pub(super) struct Opened {
    pub(super) id: Id,
    pub(super) name: String,
    pub(super) bytes: Bytes,
    pub(super) digest: u64,
    pub(super) preview: TablePreview,
    /// What was assumed about the table as a whole.
    remarks: Vec<String>,
    pub(super) roles: Part,
    pub(super) mend: bool,
    pub(super) purpose: Purpose,
    pub(super) marked: Vec<(usize, usize)>,
    pub(super) steps: Option<Steps>,
    /// As it was read.
    raw: Option<Parts>,
    /// After the preparation.
    pub(super) parts: Result<Parts, Fault>,
    /// What the preparation did, for each recording.
    pub(super) preparation: Vec<Preparation>,
    /// Branches of its input. They are counted once: a page asks often.
    pub(super) branches: usize,
    /// A number for its samples, the same for the same samples; 0 without any.
    pub(super) samples: u64,
    pub(super) repair: Option<RepairView>,
    pub(super) notes: Vec<String>,
    /// What is taken of the memory of the session.
    held: Budget,
}

/// What a repair of the rows would do.
#[derive(Debug, Clone, Serialize)]
pub struct RepairView {
    /// The rows, and what would become of them.
    pub notes: Vec<String>,
    /// Samples that there would be.
    pub samples: usize,
}

impl Opened {
    /// Opens bytes that are already counted in `held`.
    pub(super) fn new(id: Id, name: String, bytes: Vec<u8>, held: Budget) -> Result<Self, Fault> {
        let bytes = Bytes::from(bytes);
        let mut table = TableReader::from_bytes(&name, bytes.clone(), held.memory().clone())?;
        let preview = preview_table(&mut table)?;
        let remarks = table.remarks().map(ToString::to_string).collect();
        let guess = preview.roles.clone();
        let mut opened = Self {
            id,
            name,
            digest: digest(&bytes),
            bytes,
            preview,
            remarks,
            roles: Part {
                input: guess.input,
                output: guess.output,
                time: guess.time,
                load: guess.load,
            },
            mend: false,
            purpose: Purpose::Fit,
            marked: Vec::new(),
            steps: None,
            raw: None,
            parts: Err(Fault::defect("not read yet")),
            preparation: Vec::new(),
            branches: 0,
            samples: 0,
            repair: None,
            notes: Vec::new(),
            held,
        };
        drop(table);
        opened.hold()?;
        opened.read();
        Ok(opened)
    }

    /// The file in a new version.
    pub(super) fn again(&self, bytes: Vec<u8>, held: Budget) -> Result<Self, Fault> {
        let mut new = Self::new(self.id, self.name.clone(), bytes, held)?;
        (new.mend, new.purpose, new.marked) = (self.mend, self.purpose, self.marked.clone());
        let same = |columns: &TablePreview| {
            let names = columns.table.columns.iter();
            names.map(|column| column.name.clone()).collect::<Vec<_>>()
        };
        new.steps.clone_from(&self.steps);
        if same(&new.preview) == same(&self.preview) {
            new.roles = self.roles.clone();
        }
        new.read();
        Ok(new)
    }

    pub(super) fn set_roles(&mut self, roles: Part) {
        self.roles = roles;
        self.read();
    }

    pub(super) fn set_mend(&mut self, on: bool) {
        self.mend = on;
        self.read();
    }

    /// Prepares the recording, or takes it as it is. A refusal leaves it as it was.
    pub(super) fn set_steps(&mut self, steps: Option<Steps>) -> Result<(), Fault> {
        let raw = self.raw.clone();
        let raw = raw.ok_or_else(|| match &self.parts {
            Err(fault) => fault.clone(),
            Ok(_) => Fault::defect("not read yet"),
        })?;
        let steps = steps.map(Steps::checked).transpose()?;
        let before = (
            self.parts.clone(),
            self.preparation.clone(),
            self.steps.clone(),
        );
        let (parts, preparation) = prepared(&raw, steps.as_ref(), self.held.memory())?;
        (self.parts, self.preparation, self.steps) = (Ok(parts), preparation, steps);
        if let Err(fault) = self.hold() {
            (self.parts, self.preparation, self.steps) = before;
            return Err(fault);
        }
        self.keep_marked();
        Ok(())
    }

    /// The recordings before their preparation.
    pub(super) fn raw(&self) -> Option<&Parts> {
        self.raw.as_ref().filter(|_| self.steps.is_some())
    }

    /// Marks one span of rows more, or none at all.
    pub(super) fn mark(&mut self, rows: Option<(usize, usize)>) -> Result<(), Fault> {
        let Some((first, last)) = rows else {
            self.marked.clear();
            return Ok(());
        };
        let count = self.recording()?.len();
        let mut spans = self.marked.clone();
        spans.push((first, last));
        spans.sort_unstable();
        // Spans that meet are one.
        let mut joined: Vec<(usize, usize)> = Vec::new();
        for (first, last) in spans {
            match joined.last_mut() {
                Some((_, end)) if first <= end.saturating_add(1) => *end = last.max(*end),
                _ => joined.push((first, last)),
            }
        }
        if first < 1 || last < first || last > count || joined == [(1, count)] {
            return Err(Fault::missing(
                &format!("samples {first} to {last} of {count} cannot be marked"),
                "mark parts of the recording, and leave some",
            ));
        }
        self.marked = joined;
        Ok(())
    }

    /// The first and the last row in a span of the time, counted from 1.
    pub(super) fn rows_in(&self, from: f64, to: f64) -> Result<(usize, usize), Fault> {
        let recording = self.recording()?;
        let inside = |n: &usize| (from..=to).contains(&when(recording, *n));
        let mut rows = (0..recording.len()).filter(inside);
        let first = rows.next();
        first
            .map(|first| (first + 1, rows.next_back().unwrap_or(first) + 1))
            .ok_or_else(|| Fault::missing("there is no sample in this span", "mark a longer one"))
    }

    /// The recordings one after the other, to be shown.
    pub(super) fn recording(&self) -> Result<&Arc<Recording>, Fault> {
        Ok(&self.parts()?.shown)
    }

    /// The recordings, for a model to run over.
    pub(super) fn parts(&self) -> Result<&Parts, Fault> {
        self.parts.as_ref().map_err(Clone::clone)
    }

    /// Whether it holds several recordings.
    pub(super) fn has_several(&self) -> bool {
        self.parts.as_ref().is_ok_and(|parts| parts.all().len() > 1)
    }

    /// The memory of the session.
    pub(super) fn memory(&self) -> &Memory {
        self.held.memory()
    }

    /// Takes memory for the bytes, their preview, and the numbers read from them.
    fn hold(&mut self) -> Result<(), Fault> {
        let size = self.size();
        let taken = self.held.resize(size, &self.name);
        taken.map_err(|_| Fault::too_large(&self.name, self.held.memory().left()))
    }

    fn size(&self) -> u64 {
        /// Of a column in the preview: its picture and what is summed up.
        const COLUMN: usize = PICTURE * size_of::<Option<(f64, f64)>>() + 200;
        let columns = self.preview.table.columns.iter();
        let preview: usize = columns.map(|column| column.name.len() + COLUMN).sum();
        let samples = self.parts.as_ref().map_or(0, Parts::size);
        let raw = self.raw().map_or(0, Parts::size);
        (self.bytes.len() + preview) as u64 + samples + raw
    }

    /// Makes the recording of the columns.
    fn read(&mut self) {
        (self.raw, self.preparation, self.repair) = (None, Vec::new(), None);
        match self.try_read(self.mend) {
            Ok((raw, notes)) => {
                let found = prepared(&raw, self.steps.as_ref(), self.held.memory());
                self.parts = found.map(|(parts, preparation)| {
                    self.preparation = preparation;
                    parts
                });
                (self.raw, self.notes) = (Some(raw), notes);
            }
            Err(fault) => {
                if !self.mend {
                    let would = self.try_read(true).ok();
                    self.repair = would.map(|(parts, notes)| RepairView {
                        notes,
                        samples: parts.shown.len(),
                    });
                }
                (self.parts, self.notes) = (Err(fault), self.remarks.clone());
            }
        }
        if let Err(fault) = self.hold() {
            (self.parts, self.raw, self.preparation) = (Err(fault), None, Vec::new());
            // It is less than before.
            let _ = self.hold();
        }
        self.keep_marked();
    }

    /// What hangs on the number of samples, after the recording has changed.
    fn keep_marked(&mut self) {
        let of = |recording: &Recording| {
            let input = &recording.input;
            let of_samples = branches(input, usual_tolerance(input));
            of_samples.last().map_or(0, |last| last + 1)
        };
        let parts = self.parts.as_ref();
        self.branches = parts.map_or(0, |parts| parts.all().iter().map(of).sum());
        self.samples = parts.map_or(0, |parts| number(parts.all().iter()));
        let count = parts.map_or(0, |parts| parts.shown.len());
        self.marked.retain(|(_, last)| *last <= count);
        // Of a recording that is shorter now, all may be marked.
        if self.marked == [(1, count)] {
            self.marked.clear();
        }
    }

    fn try_read(&self, mend: bool) -> Result<(Parts, Vec<String>), Fault> {
        let Part {
            input,
            output,
            time,
            load,
        } = &self.roles;
        let (Some(input), Some(output)) = (input, output) else {
            let problem = format!("{}: input or output is not chosen", self.name);
            return Err(Fault::missing(&problem, "choose a column for each"));
        };
        let columns = Columns {
            time: time.as_deref(),
            load: load.as_deref(),
            ..Columns::new(input, output)
        };
        let repair = if mend { Repair::Mend } else { Repair::Refuse };
        let (bytes, memory) = (self.bytes.clone(), self.held.memory());
        let read = Recording::segments_within(&self.name, bytes, columns, repair, memory);
        let (segments, notes) = read?;
        let notes = notes.iter().map(ToString::to_string).collect();
        Ok((Parts::of_segments(segments)?, notes))
    }
}

/// A number of the bytes that JavaScript holds exactly.
fn digest(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write(bytes);
    hasher.finish() >> 11
}

/// Recordings after these steps, and what they did.
fn prepared(
    raw: &Parts,
    steps: Option<&Steps>,
    memory: &Memory,
) -> Result<(Parts, Vec<Preparation>), Fault> {
    let Some(steps) = steps else {
        return Ok((raw.clone(), Vec::new()));
    };
    let options = steps.options()?;
    let (mut recordings, mut reports) = (Vec::new(), Vec::new());
    for raw in raw.all() {
        // Equal steps may be many.
        if let (Step::Value(step), Some([first, .., last])) =
            (options.resample, raw.time.as_deref())
        {
            let most = memory.left() as f64 / (8 * size_of::<f64>()) as f64;
            if (last - first) / step > most {
                return Err(Fault::too_large("a recording in such steps", memory.left()));
            }
        }
        let (recording, report) = prepare(raw, &options, Progress::NONE)?;
        recordings.push(recording);
        reports.push(report);
    }
    Ok((raw.prepared(recordings)?, reports))
}

/// The last part of a path, safe to show.
pub(super) fn plain_name(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let last: String = hysteron_files::printable(last).chars().take(200).collect();
    match last.trim() {
        "" | "-" => "recording.csv".into(),
        name => name.into(),
    }
}
