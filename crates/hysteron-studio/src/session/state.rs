//! What a session keeps: files, fits, work and models driven, each by its number.

use super::drive::Drive;
use super::fault::Fault;
use super::fitted::Fitted;
use super::id::{Id, LAST};
use super::job::{JobView, Watch};
use super::opened::Opened;
use hysteron::{Budget, Growing, Memory};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The most fits, and the most models driven, that a session keeps. The oldest drive goes first.
pub(super) const MOST: usize = 100;

/// What is open in the studio.
#[derive(Debug)]
pub struct Session {
    pub(super) files: Vec<Opened>,
    pub(super) fits: Vec<Fitted>,
    pub(super) running: BTreeMap<Id, Running>,
    pub(super) drives: BTreeMap<Id, Drive>,
    pub(super) last: Id,
    pub(super) memory: Memory,
}

/// A job under way, and what is taken for its recordings.
#[derive(Debug)]
pub(super) struct Running {
    pub(super) watch: Arc<Watch>,
    pub(super) _held: Budget,
}

impl Session {
    /// An empty session. Its files, what is computed from them, and what is under way take at most
    /// `budget` bytes of memory.
    ///
    /// ```
    /// use hysteron_studio::{Request, Response, Session};
    /// let mut session = Session::new(1 << 30);
    /// let file = session.open("run.csv", "T,lift\n20,0\n80,14\n20,1\n".into())?;
    /// let Response::Overview(seen) = session.handle(Request::Overview)?.response else { panic!() };
    /// assert_eq!(seen.files[0].id, file);
    /// assert_eq!(seen.files[0].roles.input.as_deref(), Some("T"));
    /// # Ok::<(), hysteron_studio::Fault>(())
    /// ```
    #[must_use]
    pub fn new(budget: u64) -> Self {
        Self::within(Memory::new(budget))
    }

    pub(super) fn within(memory: Memory) -> Self {
        Self {
            files: Vec::new(),
            fits: Vec::new(),
            running: BTreeMap::new(),
            drives: BTreeMap::new(),
            last: 0,
            memory,
        }
    }

    /// Room for a file that comes in parts. It is counted from its first part on.
    #[must_use]
    pub fn upload(&self) -> Growing {
        Growing::new(&self.memory)
    }

    /// Memory that is left for files, in bytes.
    #[must_use]
    pub fn room(&self) -> u64 {
        self.memory.left()
    }

    /// Refuses a file of so many bytes, before they are there, if it cannot have room.
    ///
    /// # Errors
    /// [`Fault`] 101.
    pub fn admits(&self, bytes: u64) -> Result<(), Fault> {
        let room = self.room();
        match bytes > room {
            true => Err(Fault::too_large("the file", room)),
            false => Ok(()),
        }
    }

    /// The work that is under way.
    #[must_use]
    pub fn jobs(&self) -> Vec<JobView> {
        let jobs = self.running.iter();
        jobs.map(|(id, job)| job.watch.view(*id)).collect()
    }

    /// Says how far a job is that runs elsewhere. One that is not there is passed over.
    pub fn told(&self, job: Id, stage: String, share: f64) {
        if let Some(running) = self.running.get(&job) {
            running.watch.at(stage.into(), share);
        }
    }

    /// Cancels all work. Its threads end at their next report.
    pub fn cancel_all(&self) {
        self.running.values().for_each(|job| job.watch.cancel());
    }

    /// The next number. A session file may hold the largest one.
    pub(super) fn next(&mut self) -> Result<Id, Fault> {
        if self.last >= LAST {
            let problem = "this session has given all its numbers";
            return Err(Fault::missing(
                problem,
                "begin a new one, and open the files there",
            ));
        }
        self.last += 1;
        Ok(self.last)
    }

    /// Keeps a model that is driven. The oldest one goes.
    pub(super) fn keep(&mut self, id: Id, drive: Drive) {
        if self.drives.len() >= MOST {
            self.drives.pop_first();
        }
        self.drives.insert(id, drive);
    }

    /// Takes memory for what is computed of a file.
    pub(super) fn held(&self, bytes: u64, what: &str) -> Result<Budget, Fault> {
        let mut held = Budget::of(&self.memory);
        let taken = held.resize(bytes, what);
        taken.map_err(|_| Fault::too_large(what, self.room()))?;
        Ok(held)
    }

    pub(super) fn file(&self, id: Id) -> Result<&Opened, Fault> {
        let file = self.files.iter().find(|file| file.id == id);
        file.ok_or_else(|| Fault::gone("file", id))
    }

    pub(super) fn file_mut(&mut self, id: Id) -> Result<&mut Opened, Fault> {
        let file = self.files.iter_mut().find(|file| file.id == id);
        file.ok_or_else(|| Fault::gone("file", id))
    }

    pub(super) fn fitted(&self, id: Id) -> Result<&Fitted, Fault> {
        let fit = self.fits.iter().find(|fit| fit.id == id);
        fit.ok_or_else(|| Fault::gone("fit", id))
    }

    /// A fit all of whose files are open, so that it can be made again.
    pub(super) fn fitted_to_open(&self, id: Id) -> Result<&Fitted, Fault> {
        let fit = self.fitted(id)?;
        for file in fit.files.iter().chain(&fit.validated) {
            let closed = || {
                let remedy = "open the file again and fit anew";
                Fault::missing("a file of this fit was closed", remedy)
            };
            self.file(*file).map_err(|_| closed())?;
        }
        Ok(fit)
    }

    /// What fits gave on a file that has changed is to be computed again.
    pub(super) fn forget_courses(&mut self, file: Id) {
        for fit in &mut self.fits {
            fit.courses.remove(&file);
            fit.bands.remove(&file);
            // Rows are counted through all files.
            fit.held.clear();
            fit.reached = None;
        }
    }
}
