//! The file that keeps the session: one studio at a time, and nothing of others is replaced.

use crate::{Fault, Session};
use hysteron::Error;
use hysteron_files::{AtomicFile, Locked, Own};
use std::fs::{File, Metadata};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// A session file, held by this studio.
#[derive(Debug)]
pub(super) struct Kept {
    path: PathBuf,
    /// The file as this studio left it; `None` if there was none.
    left: Option<Stamp>,
    /// Beside the session, because that is replaced as a whole.
    _lock: Locked,
}

/// Changes with the length and the time of a file.
type Stamp = (u64, Option<SystemTime>);

fn stamp(about: &Metadata) -> Stamp {
    (about.len(), about.modified().ok())
}

impl Kept {
    /// Takes the file for this studio, and reads the session in it.
    ///
    /// # Errors
    /// [`Fault`] for a file that another studio holds, that is no session, or that cannot be
    /// written.
    pub(super) fn open(path: &Path, session: &mut Session) -> Result<Self, Fault> {
        let failed = |source| Error::File {
            path: path.to_owned(),
            source,
        };
        if std::fs::metadata(path).is_ok_and(|about| !about.is_file()) {
            let problem = format!("{} is not a regular file", path.display());
            return Err(Fault::not_kept(&problem));
        }
        // A link is followed, so that two names of one file have one lock.
        let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(".lock");
        let lock = File::options()
            .append(true)
            .create(true)
            .open(path.with_file_name(name));
        // Some file systems have no locks. Then changes of the file are all that is seen.
        let lock = Locked::new(lock.map_err(failed)?).map_err(|_| {
            let problem = format!("another studio keeps its session in {}", path.display());
            Fault::not_kept(&problem)
        })?;
        let left = match std::fs::metadata(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
            about => {
                let about = about.map_err(failed)?;
                if about.len() > session.room() {
                    return Err(Fault::too_large("the session", session.room()));
                }
                session.restore(&std::fs::read(&path).map_err(failed)?)?;
                Some(stamp(&about))
            }
        };
        let mut kept = Self {
            path,
            left,
            _lock: lock,
        };
        // What cannot be written is said now, not when there is something to lose.
        kept.save(session)?;
        Ok(kept)
    }

    /// Writes the session, whole or not at all, unless the file is no longer as it was left.
    pub(super) fn save(&mut self, session: &Session) -> Result<(), Fault> {
        let there = std::fs::metadata(&self.path).ok();
        if there.as_ref().map(stamp) != self.left {
            let problem = format!("{} was changed by another program", self.path.display());
            return Err(Fault::not_kept(&problem));
        }
        let failed = |source| Error::File {
            path: self.path.clone(),
            source,
        };
        let mut out = BufWriter::new(AtomicFile::create(self.path.as_path(), Own::SAME_BYTES)?);
        session.write_to(&mut out).map_err(failed)?;
        out.flush().map_err(failed)?;
        out.into_inner()
            .map_err(|error| failed(error.into_error()))?
            .commit()?;
        self.left = std::fs::metadata(&self.path).ok().as_ref().map(stamp);
        Ok(())
    }
}
