//! What all calls of the page share.

use super::kept::Kept;
use crate::{Fault, Session};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tokio::sync::watch;

#[derive(Debug)]
pub(super) struct Shared {
    pub(super) session: Mutex<Session>,
    /// The files that were named on the command line. Only these are read from the disk again.
    pub(super) named: Mutex<Vec<PathBuf>>,
    /// What ended without a fit, for the page.
    pub(super) failed: Mutex<Option<Fault>>,
    /// Held by the fit that runs. The others wait: each takes all cores, and memory that grows with
    /// the fourth power of its levels.
    pub(super) turn: Mutex<()>,
    /// Counts what changed, for the events.
    pub(super) changes: watch::Sender<u64>,
}

impl Shared {
    pub(super) fn session(&self) -> MutexGuard<'_, Session> {
        // A panic inside leaves the session as it was before the request, or closes a job.
        self.session.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn changed(&self) {
        self.changes.send_modify(|count| *count += 1);
    }

    /// Writes the session to its file. What is wrong is told to the page.
    pub(super) fn save(&self, kept: &mut Kept) -> Result<(), Fault> {
        let saved = kept.save(&self.session());
        if let Err(fault) = &saved {
            let mut failed = self.failed.lock().unwrap_or_else(PoisonError::into_inner);
            *failed = Some(fault.clone());
        }
        saved
    }

    pub(super) fn open_named(&self, path: &Path) -> Result<(), Fault> {
        let failed = |source| hysteron::Error::File {
            path: path.to_owned(),
            source,
        };
        let mut session = self.session();
        let room = session.room();
        let mut file = std::fs::File::open(path).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let lacks = |_| Fault::too_large(&name, room);
        let mut upload = session.upload();
        upload
            .reserve(usize::try_from(length).unwrap_or(usize::MAX))
            .map_err(lacks)?;
        let mut part = vec![0; 1 << 16];
        loop {
            let count = file.read(&mut part).map_err(failed)?;
            if count == 0 {
                break;
            }
            upload.write_all(&part[..count]).map_err(lacks)?;
        }
        session.open_upload(&name, upload)?;
        Ok(())
    }
}
