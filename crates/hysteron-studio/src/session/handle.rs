//! A request is answered, a file is opened.

use super::drive::Drive;
use super::fault::Fault;
use super::fitted;
use super::id::Id;
use super::job::Job;
use super::opened::{self, Opened};
use super::request::{Overview, Request, Response};
use super::saved;
use super::state::Session;
use hysteron::{Budget, Growing};

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
    /// The session in a file that was saved.
    ///
    /// # Errors
    /// [`Fault`] for bytes that are no session, or that take more than `budget` bytes of memory.
    pub fn from_file(bytes: &[u8], budget: u64) -> Result<Self, Fault> {
        let mut session = Self::new(budget);
        session.restore(bytes)?;
        Ok(session)
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

    /// Answers a request.
    ///
    /// # Errors
    /// [`Fault`], with a code for each kind. The session is then as before.
    pub fn handle(&mut self, request: Request) -> Result<Answer, Fault> {
        let draws = request.draws();
        match self.answer(request) {
            Err(fault) if draws && fault.is_gone() => Ok(Response::Gone.into()),
            answer => answer,
        }
    }

    fn answer(&mut self, request: Request) -> Result<Answer, Fault> {
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
            Request::Fit { options, hold_out } => {
                let (started, job) = self.fit(options, hold_out)?;
                return Ok(Answer {
                    response: Response::Started(started),
                    job: Some(job),
                });
            }
            Request::JudgeAnew { fit } => self.judge_anew(fit)?,
            Request::Cancel { job } => {
                // One that waits would stay until its turn.
                let running = self.running.remove(&job);
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
            Request::Nearest { view, at } => {
                let at = at.into();
                return Ok(Response::Sample(self.nearest(&view, at)?).into());
            }
            Request::Switch {
                fit,
                file,
                operator,
                after,
            } => {
                let found = self.switch(fit, file, operator, after)?;
                return Ok(found.map_or(Response::Never, Response::Sample).into());
            }
            Request::Worst { fit } => return Ok(Response::Worst(self.worst(fit)?).into()),
            Request::Drive { fit } => {
                let drive = Drive::new(self.fitted(fit)?)?;
                let id = self.next()?;
                let view = drive.view(id);
                self.keep(id, drive);
                return Ok(Response::Driven(view).into());
            }
            Request::Pull(pull) => {
                let drive = self.drives.get_mut(&pull.drive);
                let drive = drive.ok_or_else(|| Fault::gone("drive", pull.drive))?;
                drive.moved(&pull)?;
                return Ok(Response::Driven(drive.view(pull.drive)).into());
            }
            Request::Follow(wish) => {
                self.follow(&wish)?;
                let drive = self.drives.get(&wish.drive);
                let drive = drive.ok_or_else(|| Fault::gone("drive", wish.drive))?;
                return Ok(Response::Driven(drive.view(wish.drive)).into());
            }
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
        let fits = self.fits.iter().map(|fit| fit.view(&self.files));
        Overview {
            files: self.files.iter().map(Opened::view).collect(),
            fits: fits.collect(),
            jobs: self.jobs(),
            best,
            best_by,
            options: &hysteron::FIT_OPTIONS,
            memory: (self.memory.limit() - self.room(), self.memory.limit()),
        }
    }
}
