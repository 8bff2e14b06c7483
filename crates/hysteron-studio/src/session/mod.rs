//! The session: what is open, without a transport. A request in, a response out.
//!
//! `request` defines both, `fault` what is wrong. `opened` is a file, `prepare` its preparation,
//! `design` the experiment that is missing. `fitting` asks for a fit, `job` is its work, `fitted` what
//! it found; `carried` has these as bytes. `look` and `plane` make the pictures, from what `thinned`
//! leaves. `drive` is a model moved by hand, `take_home` what can be taken away, `commands` the same
//! work as text, `saved` the session as a file.

mod carried;
mod commands;
mod design;
mod drive;
mod fault;
mod fitted;
mod fitting;
mod job;
mod look;
mod opened;
mod plane;
mod prepare;
mod request;
mod saved;
mod take_home;
mod thinned;

pub use design::{DesignView, Wish};
pub use drive::{DriveView, Pull, RivalView};
pub use fault::Fault;
pub use fitted::FitView;
pub use fitting::Held;
pub use job::{Finished, Job, JobView};
pub use look::{Area, Curves, Line, Picture, View};
pub use opened::{ColumnView, FileView, Part, RepairView};
pub use plane::{PlaneKind, PlaneView, SampleView};
pub use prepare::Steps;
pub use request::{Id, Overview, Purpose, Request, Response, Told};
pub use take_home::{Download, Take};

use drive::Drive;
use fitted::Fitted;
use hysteron::{Budget, Growing, Memory};
use job::Watch;
use opened::Opened;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The most fits, and the most models driven, that a session keeps. The oldest drive goes first.
const MOST: usize = 100;

/// The largest number that is given: JavaScript holds no larger one exactly.
const LAST: Id = (1 << 53) - 1;

/// What is open in the studio.
#[derive(Debug)]
pub struct Session {
    files: Vec<Opened>,
    fits: Vec<Fitted>,
    running: BTreeMap<Id, Running>,
    drives: BTreeMap<Id, Drive>,
    last: Id,
    memory: Memory,
}

/// A job under way, and what is taken for its recordings.
#[derive(Debug)]
struct Running {
    watch: Arc<Watch>,
    _held: Budget,
}

/// What a request leads to: a response, and a job where there is long work to do. The transport runs
/// the job, on another thread if it can, and hands what it finished to [`Session::finish`].
#[derive(Debug)]
pub struct Answer {
    /// The response.
    pub response: Response,
    /// The work.
    pub job: Option<Job>,
}

impl From<Response> for Answer {
    fn from(response: Response) -> Self {
        Self {
            response,
            job: None,
        }
    }
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

    /// The session in a file that was saved.
    ///
    /// # Errors
    /// [`Fault`] for bytes that are no session, or that take more than `budget` bytes of memory.
    pub fn from_file(bytes: &[u8], budget: u64) -> Result<Self, Fault> {
        let mut session = Self::new(budget);
        session.restore(bytes)?;
        Ok(session)
    }

    fn within(memory: Memory) -> Self {
        Self {
            files: Vec::new(),
            fits: Vec::new(),
            running: BTreeMap::new(),
            drives: BTreeMap::new(),
            last: 0,
            memory,
        }
    }

    /// Opens the bytes of a file: a recording, or a session that was saved, which replaces this one.
    /// A file with the name of one that is open is its new version, and keeps its columns.
    ///
    /// # Errors
    /// [`Fault`] for a file that is no table, or that takes more memory than is left.
    pub fn open(&mut self, name: &str, bytes: Vec<u8>) -> Result<Id, Fault> {
        let mut held = Budget::of(&self.memory);
        let name = opened::plain_name(name);
        let taken = held.resize(bytes.len() as u64, &name);
        taken.map_err(|_| Fault::too_large(&name, self.room()))?;
        self.open_held(&name, bytes, held)
    }

    /// As [`Session::open`], for bytes that grew within the account of [`Session::upload`].
    ///
    /// # Errors
    /// As [`Session::open`].
    pub fn open_upload(&mut self, name: &str, upload: Growing) -> Result<Id, Fault> {
        let (bytes, held) = upload.into_parts();
        self.open_held(&opened::plain_name(name), bytes, held)
    }

    /// Room for a file that comes in parts. It is counted from its first part on.
    #[must_use]
    pub fn upload(&self) -> Growing {
        Growing::new(&self.memory)
    }

    fn open_held(&mut self, name: &str, bytes: Vec<u8>, held: Budget) -> Result<Id, Fault> {
        if saved::is_session(&bytes) {
            return self.restore(&bytes);
        }
        let old = self.files.iter().position(|file| file.name == name);
        match old {
            Some(n) => {
                let again = self.files[n].again(bytes, held)?;
                let id = again.id;
                self.files[n] = again;
                self.forget_courses(id);
                Ok(id)
            }
            None => {
                let id = self.next()?;
                let name = name.to_owned();
                self.files.push(Opened::new(id, name, bytes, held)?);
                Ok(id)
            }
        }
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

    /// Answers a request.
    ///
    /// # Errors
    /// [`Fault`], with a code for each kind. The session is then as before.
    pub fn handle(&mut self, request: Request) -> Result<Answer, Fault> {
        match request {
            Request::Overview => {}
            Request::Close { file } => {
                self.file(file)?;
                self.files.retain(|other| other.id != file);
                self.forget_courses(file);
            }
            Request::Columns { file, roles } => {
                self.file_mut(file)?.set_roles(roles);
                self.forget_courses(file);
            }
            Request::Mend { file, on } => {
                self.file_mut(file)?.set_mend(on);
                self.forget_courses(file);
            }
            Request::Prepare { file, steps } => {
                self.file_mut(file)?.set_steps(steps)?;
                self.forget_courses(file);
            }
            Request::Use { file, purpose } => self.file_mut(file)?.purpose = purpose,
            Request::Mark { file, rows } => self.file_mut(file)?.mark(rows)?,
            Request::MarkSpan { file, from, to } => {
                let rows = self.file(file)?.rows_in(from, to)?;
                self.file_mut(file)?.mark(Some(rows))?;
            }
            Request::Fit { options, hold_out } => return self.fit(options, hold_out),
            Request::Cancel { job } => {
                let running = self.running.get(&job);
                let running = running.ok_or_else(|| Fault::gone("work", job))?;
                running.watch.cancel();
            }
            Request::Forget { fit } => {
                self.fitted(fit)?;
                self.fits.retain(|other| other.id != fit);
                self.drives.retain(|_, drive| drive.fit != fit);
            }
            Request::Curves(view) => return Ok(Response::Curves(self.curves(&view)?).into()),
            Request::Plane { fit, kind, at } => {
                return Ok(Response::Plane(self.plane(fit, kind, at)?).into());
            }
            Request::Sample { file, fits, at } => {
                return Ok(Response::Sample(self.sample(file, &fits, at)?).into());
            }
            Request::Drive { fit } => return Ok(Response::Driven(self.drive(fit)?).into()),
            Request::Pull(pull) => return Ok(Response::Driven(self.pull(&pull)?).into()),
            Request::Design(wish) => {
                return Ok(Response::Designed(Box::new(self.design(&wish)?)).into());
            }
            Request::Take(take) => return Ok(Response::Taken(self.take(&take)?).into()),
        }
        Ok(Response::Overview(Box::new(self.overview())).into())
    }

    /// All that is open.
    #[must_use]
    pub fn overview(&self) -> Overview {
        let (best, best_by) = fitted::best(&self.fits);
        Overview {
            files: self.files.iter().map(Opened::view).collect(),
            fits: self.fits.iter().map(Fitted::view).collect(),
            jobs: self.jobs(),
            best,
            best_by,
            options: &hysteron::FIT_OPTIONS,
            memory: (self.memory.limit() - self.room(), self.memory.limit()),
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
    fn next(&mut self) -> Result<Id, Fault> {
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

    /// Takes memory for what is computed of a file.
    fn held(&self, bytes: u64, what: &str) -> Result<Budget, Fault> {
        let mut held = Budget::of(&self.memory);
        let taken = held.resize(bytes, what);
        taken.map_err(|_| Fault::too_large(what, self.room()))?;
        Ok(held)
    }

    fn file(&self, id: Id) -> Result<&Opened, Fault> {
        let file = self.files.iter().find(|file| file.id == id);
        file.ok_or_else(|| Fault::gone("file", id))
    }

    fn file_mut(&mut self, id: Id) -> Result<&mut Opened, Fault> {
        let file = self.files.iter_mut().find(|file| file.id == id);
        file.ok_or_else(|| Fault::gone("file", id))
    }

    fn fitted(&self, id: Id) -> Result<&Fitted, Fault> {
        let fit = self.fits.iter().find(|fit| fit.id == id);
        fit.ok_or_else(|| Fault::gone("fit", id))
    }

    /// What fits gave on a file that has changed is to be computed again.
    fn forget_courses(&mut self, file: Id) {
        for fit in &mut self.fits {
            fit.courses.remove(&file);
            fit.reached = None;
        }
    }
}
