//! The fit of a whole fleet: reads one actuator after the other, fits them on all threads, keeps
//! what is done, and writes the table.

use super::choice::{FleetAlone, FleetShared};
use super::each::each;
use super::one::{self, digest};
use super::options::FleetOptions;
use super::pilots;
use super::reading::{Job, Reading};
use super::row::COLUMNS;
use super::sources;
use crate::data::{Entry, Note, Partial, RecordWriter, Value};
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::recording::Recording;
use hysteron_files::Destination;
use sha2::{Digest, Sha256};
use std::collections::HashSet;
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
    /// What the pilots chose for all; `None` where each actuator chose for itself, or nothing was
    /// left to the data.
    pub shared: Option<FleetShared>,
    /// Those that the choice of the pilots does not serve, in the order of the data.
    pub alone: Vec<FleetAlone>,
}

/// Fits a model to each actuator of the data, and writes a table with a row for each.
///
/// `data` are tables, or folders of tables. With [`FleetOptions::by`] the rows of one actuator
/// stand next to each other in one table; a table in another order is read whole, if the limit of
/// memory allows it. Otherwise each file is an actuator. The rows of the result are in the order of
/// the data. They have the same bits whatever the number of threads.
///
/// With [`FleetChoice::Pilots`](super::FleetChoice::Pilots), what the fit leaves to the data is
/// chosen once, by pilots that are spread over the data, and each actuator is fitted with that. One
/// that is predicted unusually badly or well, or whose loop is unusual, is fitted by itself as well;
/// so is, in a fleet of several kinds, one that at most 20 levels serve best.
/// Where its own choice has an error on what is left out that is smaller by more than a factor of
/// 1.3, it keeps that, and is named. A fleet of fewer than 24 has no pilots.
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
    let ended = AtomicBool::new(false);
    let shared = pilots::choose(&sources, options, &ended, progress)?;
    let key = hex(&Sha256::digest(options.described(shared.as_ref())));
    let work = Work {
        options,
        shared: shared.as_ref(),
        progress,
        whole: sources.iter().map(|source| source.bytes).sum(),
        ended: &ended,
        done: Mutex::new(Done::new(Partial::beside(target.path(), &key)?)),
    };
    let mut reading = Reading::new(&sources, options, &ended);
    each(std::iter::from_fn(|| reading.next()), |job| work.on(job));
    let Reading { twice, notes, .. } = reading;
    let done = work.done.into_inner();
    let done = done.unwrap_or_else(PoisonError::into_inner);
    let found = done.write(&mut table, twice)?.finish(table)?;
    Ok(FleetFitted {
        notes,
        shared,
        ..found
    })
}

/// What the threads share.
struct Work<'a> {
    options: &'a FleetOptions<'a>,
    shared: Option<&'a FleetShared>,
    progress: Progress<'a>,
    /// Bytes of all data.
    whole: u64,
    ended: &'a AtomicBool,
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
    alone: Vec<FleetAlone>,
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
        let how = (self.options, self.shared);
        let row = one::fit(id, file, digest, (recording, notes), how, progress)?;
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
            alone: Vec::new(),
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
            let named = |wanted: &str| {
                let place = COLUMNS.iter().position(|(name, _)| *name == wanted);
                place.and_then(|place| values.get(place))
            };
            let warned = named("warnings").is_some_and(|value| *value != Value::None);
            self.with_warnings += usize::from(warned);
            if let (Some(Value::Text(id)), Some(Value::Text(model))) = (named("id"), named("model"))
            {
                self.alone.extend(FleetAlone::from_record(id, model));
            }
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
            alone: self.alone,
            ..FleetFitted::default()
        })
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
