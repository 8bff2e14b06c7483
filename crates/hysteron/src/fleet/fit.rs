//! The fit of a whole fleet: reads one actuator after the other, fits them on all threads, keeps
//! what is done, and writes the table.

use super::each::each;
use super::one::{self, digest};
use super::options::FleetOptions;
use super::row::COLUMNS;
use super::sources::{self, Source};
use crate::data::{Entry, Group, Groups, Note, Partial, RecordWriter, Value};
use crate::error::{Error, Result};
use crate::files::Destination;
use crate::progress::Progress;
use crate::recording::Recording;
use sha2::{Digest, Sha256};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// An actuator without a model.
#[derive(Debug)]
pub struct FleetFailure {
    /// The actuator, or the file that could not be read.
    pub id: String,
    /// Why.
    pub error: Error,
}

/// What became of a fleet.
#[derive(Debug, Default)]
pub struct FleetFitted {
    /// Number of actuators in the table.
    pub fitted: usize,
    /// How many of them had been fitted by an earlier run that did not end.
    pub resumed: usize,
    /// How many of them have warnings, which are in the table.
    pub with_warnings: usize,
    /// Those that are not in the table, in the order of the data.
    pub failed: Vec<FleetFailure>,
    /// What was assumed about the files, each with its path.
    pub notes: Vec<String>,
}

/// Fits a model to each actuator of the data, and writes a table with a row for each.
///
/// `data` are tables, or folders of tables. With [`FleetOptions::by`] the rows of one actuator
/// stand next to each other in one table; a table in another order is read whole, if the limit of
/// memory allows it. Otherwise each file is an actuator. The rows of the result are in the order of
/// the data. They have the same bits whatever the number of threads.
///
/// An actuator that cannot be fitted is named in the result and does not end the work. Where some
/// can be fitted, the table is written.
///
/// What is done is kept in a file beside the target, `NAME.partial`. After a run that was ended,
/// the next one takes from there what was fitted to the same samples with the same options.
///
/// Memory grows by the recordings that are being fitted, and by about 200 bytes an actuator.
///
/// # Errors
/// - [`Error::File`] for a path that is missing, a target that cannot be written, or a full disk.
/// - The error that `progress` returns.
pub fn fit_fleet(
    data: &[PathBuf],
    options: &FleetOptions<'_>,
    target: Destination<'_>,
    progress: Progress<'_>,
) -> Result<FleetFitted> {
    let sources = sources::find(data, target.path())?;
    let mut table = RecordWriter::create(target, COLUMNS)?;
    let key = hex(&Sha256::digest(options.described()));
    let work = Work {
        options,
        progress,
        whole: sources.iter().map(|source| source.bytes).sum(),
        ended: AtomicBool::new(false),
        done: Mutex::new(Done::new(Partial::beside(target.path(), &key)?)),
    };
    let mut reading = Reading::new(&sources, options, &work);
    each(std::iter::from_fn(|| reading.next()), |job| work.on(job));
    let twice = reading.twice;
    let done = work.done.into_inner();
    let done = done.unwrap_or_else(PoisonError::into_inner);
    done.write(&mut table, twice)?.finish(table)
}

/// An actuator to be fitted.
struct Job {
    /// Its place in the order of the data.
    place: usize,
    id: String,
    path: PathBuf,
    recording: Result<(Recording, Vec<Note>)>,
    /// Bytes of all data up to its end.
    bytes: u64,
}

/// Hands out the actuators in the order of the data.
struct Reading<'a> {
    sources: std::slice::Iter<'a, Source>,
    options: &'a FleetOptions<'a>,
    work: &'a Work<'a>,
    table: Option<Table<'a>>,
    /// Bytes of the files before this one.
    before: u64,
    place: usize,
    /// The place of each actuator that was found.
    known: HashMap<String, usize>,
    /// Places that count no more.
    twice: HashSet<usize>,
}

/// A table of several actuators.
struct Table<'a> {
    source: &'a Source,
    rest: Rest,
    /// Those that were found in it.
    seen: HashSet<String>,
}

enum Rest {
    InOrder(Box<Groups>),
    Held(std::vec::IntoIter<Group>),
}

impl<'a> Reading<'a> {
    fn new(sources: &'a [Source], options: &'a FleetOptions<'a>, work: &'a Work<'a>) -> Self {
        Self {
            sources: sources.iter(),
            options,
            work,
            table: None,
            before: 0,
            place: 0,
            known: HashMap::new(),
            twice: HashSet::new(),
        }
    }

    fn next(&mut self) -> Option<Job> {
        loop {
            if self.work.ended.load(Ordering::Relaxed) {
                return None;
            }
            if let Some(table) = self.table.take() {
                if let Some(job) = self.of_table(table) {
                    return Some(job);
                }
                continue;
            }
            let source = self.sources.next()?;
            let Some(by) = self.options.by else {
                self.before += source.bytes;
                let FleetOptions { columns, read, .. } = *self.options;
                let recording = Recording::read(&source.path, columns, read);
                return Some(self.job(source.name.clone(), source, recording, 0));
            };
            let FleetOptions { columns, read, .. } = *self.options;
            match Groups::open(&source.path, by, columns, read) {
                Ok(groups) => {
                    self.table = Some(Table {
                        source,
                        rest: Rest::InOrder(Box::new(groups)),
                        seen: HashSet::new(),
                    });
                }
                Err(error) => return Some(self.broken(source, error)),
            }
        }
    }

    /// The next actuator of a table; none at its end.
    fn of_table(&mut self, mut table: Table<'a>) -> Option<Job> {
        let source = table.source;
        let group = match &mut table.rest {
            Rest::Held(groups) => Ok(groups.next()),
            Rest::InOrder(groups) => groups.next(),
        };
        match group {
            Err(error) => Some(self.broken(source, error)),
            Ok(None) => {
                if let Rest::InOrder(groups) = table.rest {
                    let path = source.path.display();
                    let remarks = groups.remarks();
                    let notes = remarks.iter().map(|note| format!("{path}: {note}"));
                    self.work.done().notes.extend(notes);
                }
                self.before += source.bytes;
                None
            }
            Ok(Some(group)) if table.seen.contains(&group.label) => self.held(table),
            Ok(Some(group)) => {
                table.seen.insert(group.label.clone());
                self.table = Some(table);
                let recording = match group.label.is_empty() {
                    false => group.recording,
                    true => Err(Error::Recording {
                        path: Some(source.path.clone()),
                        row: None,
                        column: self.options.by.map(str::to_owned),
                        problem: "rows without a label belong to no actuator".into(),
                    }),
                };
                Some(self.job(group.label, source, recording, group.bytes))
            }
        }
    }

    /// Reads a table whole, because rows of an actuator are not next to each other. What was found
    /// in it counts no more.
    fn held(&mut self, table: Table<'a>) -> Option<Job> {
        let source = table.source;
        for label in &table.seen {
            self.twice.extend(self.known.remove(label));
        }
        let by = self.options.by.unwrap_or_default();
        let FleetOptions { columns, read, .. } = *self.options;
        let groups = Groups::open(&source.path, by, columns, read).and_then(Groups::all);
        let path = source.path.display();
        match groups {
            Ok(groups) => {
                let note = format!(
                    "{path}: the rows of an actuator are not next to each other, so it was read \
                     whole; sorted by `{by}` it is read in blocks"
                );
                self.work.done().notes.push(note);
                self.table = Some(Table {
                    source,
                    rest: Rest::Held(groups.into_iter()),
                    seen: HashSet::new(),
                });
                let table = self.table.take()?;
                self.of_table(table)
            }
            Err(Error::Recording {
                path,
                row,
                column,
                problem,
            }) => {
                let problem = format!(
                    "the rows of an actuator are not next to each other, and the table cannot be \
                     read whole ({problem}): sort its rows by `{by}`"
                );
                let error = Error::Recording {
                    path,
                    row,
                    column,
                    problem,
                };
                Some(self.broken(source, error))
            }
            Err(error) => Some(self.broken(source, error)),
        }
    }

    /// A file that cannot be read any further.
    fn broken(&mut self, source: &Source, error: Error) -> Job {
        self.before += source.bytes;
        let id = source.name.clone();
        self.place += 1;
        self.numbered(id, source, Err(error), 0)
    }

    fn job(
        &mut self,
        id: String,
        source: &Source,
        recording: Result<(Recording, Vec<Note>)>,
        bytes: u64,
    ) -> Job {
        self.place += 1;
        let recording = match self.known.insert(id.clone(), self.place) {
            None => recording,
            Some(other) => {
                self.twice.insert(other);
                let problem = format!(
                    "the actuator `{id}` is in other data too: name files and labels so that each \
                     actuator has its own"
                );
                Err(Error::Recording {
                    path: Some(source.path.clone()),
                    row: None,
                    column: None,
                    problem,
                })
            }
        };
        self.numbered(id, source, recording, bytes)
    }

    /// The job of the present number.
    fn numbered(
        &self,
        id: String,
        source: &Source,
        recording: Result<(Recording, Vec<Note>)>,
        bytes: u64,
    ) -> Job {
        Job {
            place: self.place,
            id,
            path: source.path.clone(),
            recording,
            bytes: self.before + bytes,
        }
    }
}

/// What the threads share.
struct Work<'a> {
    options: &'a FleetOptions<'a>,
    progress: Progress<'a>,
    /// Bytes of all data.
    whole: u64,
    ended: AtomicBool,
    done: Mutex<Done>,
}

/// What is done.
struct Done {
    partial: Partial,
    /// Places and records.
    fitted: Vec<(usize, Entry)>,
    failed: Vec<(usize, FleetFailure)>,
    resumed: HashSet<usize>,
    with_warnings: usize,
    notes: Vec<String>,
    bytes: u64,
    /// Why the work ends before its end.
    ended: Option<Error>,
}

impl Work<'_> {
    fn done(&self) -> MutexGuard<'_, Done> {
        self.done.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Fits an actuator and keeps the result.
    fn on(&self, job: Job) {
        let Job {
            place, id, bytes, ..
        } = job;
        if self.ended.load(Ordering::Relaxed) {
            return;
        }
        if let Err(error) = self.row(place, &id, &job.path, job.recording) {
            self.done().failed.push((place, FleetFailure { id, error }));
        }
        let mut done = self.done();
        done.bytes = done.bytes.max(bytes);
        let share = done.bytes as f64 / self.whole.max(1) as f64;
        if let Err(error) = self.progress.tell("fits", share.min(1.0)) {
            self.end(&mut done, error);
        }
    }

    fn row(
        &self,
        place: usize,
        id: &str,
        path: &Path,
        recording: Result<(Recording, Vec<Note>)>,
    ) -> Result<()> {
        let (recording, notes) = recording?;
        let digest = digest(&recording);
        let file = path.display().to_string();
        let key = Sha256::new()
            .chain_update(digest)
            .chain_update(format!("{id:?} {file:?} {notes:?}"));
        let key = key.finalize().into();
        let known = self.done().partial.known(&key);
        if let Some(entry) = known {
            let mut done = self.done();
            done.fitted.push((place, entry));
            done.resumed.insert(place);
            return Ok(());
        }
        let report = |_: &'static str, _: f64| match self.ended.load(Ordering::Relaxed) {
            false => Ok(()),
            true => Err(Error::Fit("ended".into())),
        };
        let progress = Progress::new(&report);
        let row = one::fit(id, file, digest, recording, notes, self.options, progress)?;
        let values = row.values();
        let mut done = self.done();
        match done.partial.add(&key, &values) {
            Ok(entry) => done.fitted.push((place, entry)),
            Err(error) => self.end(&mut done, error),
        }
        Ok(())
    }

    fn end(&self, done: &mut Done, error: Error) {
        self.ended.store(true, Ordering::Relaxed);
        done.ended.get_or_insert(error);
    }
}

impl Done {
    fn new(partial: Partial) -> Self {
        Self {
            partial,
            fitted: Vec::new(),
            failed: Vec::new(),
            resumed: HashSet::new(),
            with_warnings: 0,
            notes: Vec::new(),
            bytes: 0,
            ended: None,
        }
    }

    /// Writes the rows, in the order of the data.
    fn write(mut self, table: &mut RecordWriter, twice: HashSet<usize>) -> Result<Self> {
        if let Some(error) = self.ended {
            return Err(error);
        }
        self.fitted.retain(|(place, _)| !twice.contains(place));
        self.fitted.sort_unstable_by_key(|(place, _)| *place);
        self.failed.retain(|(place, _)| !twice.contains(place));
        self.failed.sort_by_key(|(place, _)| *place);
        for (_, entry) in &self.fitted {
            let values = self.partial.read(*entry)?;
            let mut named = COLUMNS.iter().zip(&values);
            let warned =
                named.any(|((name, _), value)| *name == "warnings" && *value != Value::None);
            self.with_warnings += usize::from(warned);
            table.push(values)?;
        }
        Ok(self)
    }

    fn finish(self, table: RecordWriter) -> Result<FleetFitted> {
        if !self.fitted.is_empty() {
            table.finish()?;
        }
        self.partial.remove()?;
        let places = self.fitted.iter().map(|(place, _)| place);
        Ok(FleetFitted {
            fitted: self.fitted.len(),
            resumed: places
                .clone()
                .filter(|place| self.resumed.contains(place))
                .count(),
            with_warnings: self.with_warnings,
            failed: self
                .failed
                .into_iter()
                .map(|(_, failure)| failure)
                .collect(),
            notes: self.notes,
        })
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
