//! Reads the actuators of a fleet, one after the other, in the order of the data.

use super::options::FleetOptions;
use super::sources::Source;
use crate::data::{Group, Groups, Note};
use crate::error::{Error, Result};
use crate::recording::Recording;
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// An actuator to be fitted.
pub(super) struct Job {
    /// Its place in the order of the data.
    pub(super) place: usize,
    pub(super) id: String,
    pub(super) path: PathBuf,
    pub(super) recording: Result<(Recording, Vec<Note>)>,
    /// Bytes of all data up to its end.
    pub(super) bytes: u64,
}

/// Hands out the actuators in the order of the data.
pub(super) struct Reading<'a> {
    sources: std::slice::Iter<'a, Source>,
    options: &'a FleetOptions<'a>,
    /// Whether the work ends before its end.
    ended: &'a AtomicBool,
    table: Option<Table<'a>>,
    /// Bytes of the files before this one.
    before: u64,
    place: usize,
    /// The place of each actuator that was found.
    known: HashMap<String, usize>,
    /// Places that count no more.
    pub(super) twice: HashSet<usize>,
    /// What was assumed about the files, each with its path.
    pub(super) notes: Vec<String>,
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
    pub(super) fn new(
        sources: &'a [Source],
        options: &'a FleetOptions<'a>,
        ended: &'a AtomicBool,
    ) -> Self {
        Self {
            sources: sources.iter(),
            options,
            ended,
            table: None,
            before: 0,
            place: 0,
            known: HashMap::new(),
            twice: HashSet::new(),
            notes: Vec::new(),
        }
    }

    pub(super) fn next(&mut self) -> Option<Job> {
        loop {
            if self.ended.load(Ordering::Relaxed) {
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
                    self.notes.extend(notes);
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
                self.notes.push(note);
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
