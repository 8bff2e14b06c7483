//! The file beside a log: by it a later run knows the log, and goes on where it ended.

use crate::at::{self, At};
use crate::config::{Config, Mode};
use crate::error::{Result, of_file};
use hysteron::Model;
use hysteron_files::{AtomicFile, Own};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io;
use std::path::{Path, PathBuf};

/// A run is over where so little of it is left, as a share of it.
const EARLY: f64 = 1e-9;
const FORMAT: &str = "hysteron-run";
const VERSION: u32 = 1;

/// What a log does not say itself. The rest of the state follows from its rows: the model and its
/// learner run through them again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Companion {
    format: String,
    version: u32,
    /// Name of the device.
    pub(crate) device: String,
    /// The columns of the log.
    pub(crate) columns: Vec<String>,
    /// Time of the log at which the run's time is zero, s.
    pub(crate) origin_s: f64,
    /// What to add to the device's numbers and times for those of the log.
    pub(crate) shift: (u64, f64),
    /// The last sample's number and time in the log; as of the beginning where the run was killed.
    pub(crate) last: (u64, f64),
    /// Length of the log, bytes; `None` while it is written.
    pub(crate) bytes: Option<u64>,
    /// How the run ended; `None` while it runs.
    pub(crate) end: Option<String>,
    /// What the drive followed; `None` in files of earlier versions.
    #[serde(default)]
    pub(crate) follows: Option<Follows>,
    /// What learned, and the model as it was at the end; `None` where nothing learned.
    pub(crate) learner: Option<String>,
    /// The learned model, as a model file has it.
    pub(crate) model: Option<serde_json::Value>,
}

/// What the drive of a run follows. A log of two of them would be a run of neither.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Follows {
    pub(crate) mode: Mode,
    pub(crate) controller: Option<String>,
    /// SHA-256 of the model.
    pub(crate) model: Option<String>,
}

impl Follows {
    /// What another one has that is not of this one. Profiles and references may go on otherwise.
    fn differs(&self, other: &Self) -> Option<&'static str> {
        [
            (self.mode != other.mode, "mode"),
            (self.controller != other.controller, "controller"),
            (self.model != other.model, "model"),
        ]
        .into_iter()
        .find_map(|(differs, what)| differs.then_some(what))
    }

    pub(crate) fn of(config: &Config, model: Option<&Model>) -> Self {
        let controller = config.controller.as_ref();
        let controller = controller.filter(|_| config.mode == Mode::Control);
        let digest = |model: &Model| {
            let digest = Sha256::digest(model.to_json());
            digest.iter().map(|byte| format!("{byte:02x}")).collect()
        };
        Self {
            mode: config.mode,
            controller: controller.map(|options| options.kind.name().into()),
            model: model.filter(|_| controller.is_some()).map(digest),
        }
    }
}

/// The path of the file beside a log.
fn beside(log: &Path) -> PathBuf {
    let mut name = log.as_os_str().to_owned();
    name.push(".json");
    name.into()
}

impl Companion {
    pub(crate) fn new(device: &str, columns: Vec<String>) -> Self {
        Self {
            format: FORMAT.into(),
            version: VERSION,
            device: device.into(),
            columns,
            origin_s: 0.0,
            shift: (0, 0.0),
            last: (0, 0.0),
            bytes: None,
            end: None,
            follows: None,
            learner: None,
            model: None,
        }
    }

    /// Refuses to go on with this log where the run is another one, or nothing is left of it until
    /// `end_s`. Otherwise the last of its `rows`; `None` for a log without any.
    ///
    /// # Errors
    /// [`crate::Error::Config`], and [`hysteron::Error::File`].
    pub(crate) fn refuse(
        &self,
        config: &Config,
        follows: &Follows,
        end_s: Option<f64>,
        rows: &Path,
    ) -> Result<Option<At>> {
        let other = self.follows.as_ref().and_then(|own| own.differs(follows));
        if let Some(what) = other {
            let what = format!("the log is one of another {what}: name another log");
            return Err(config.refused("log", what));
        }
        let last = at::last(rows)?;
        let over = |end: &f64| {
            last.is_some_and(|last| last.time - self.origin_s >= end - EARLY * end.abs())
        };
        match end_s.filter(over) {
            None => Ok(last),
            Some(end) => {
                let what = format!("nothing is left to run: the log goes to the end, {end} s");
                Err(config.refused("log", what))
            }
        }
    }

    /// Whether the file at `log` is one of ours that nobody has changed.
    pub(crate) fn knows(log: &Path) -> bool {
        let Ok(found) = Self::read(log) else {
            return false;
        };
        let length = std::fs::metadata(log).map(|file| file.len()).ok();
        found.bytes.is_none() || found.bytes == length
    }

    /// The file beside a log that a run goes on with.
    ///
    /// # Errors
    /// As [`Companion::read`].
    pub(crate) fn of(log: &Path) -> Result<Self> {
        if !beside(log).exists() {
            let what =
                "there is no file beside this log to go on from, so that nothing can be resumed";
            return Err(of_file(log, io::Error::other(what)));
        }
        Self::read(log)
    }

    /// Reads the file beside a log.
    ///
    /// # Errors
    /// [`hysteron::Error::File`].
    pub(crate) fn read(log: &Path) -> Result<Self> {
        let path = beside(log);
        let failed = |source| of_file(&path, source);
        let text = std::fs::read(&path).map_err(failed)?;
        let found: Self = serde_json::from_slice(&text).map_err(|error| {
            failed(io::Error::other(format!(
                "this is no companion of a log: {error}"
            )))
        })?;
        if found.format != FORMAT || found.version != VERSION {
            let what = format!(
                "this is `{}` in version {}: `{FORMAT}` in version {VERSION} is needed",
                found.format, found.version
            );
            return Err(failed(io::Error::other(what)));
        }
        Ok(found)
    }

    /// Writes the file beside a log.
    ///
    /// # Errors
    /// [`hysteron::Error::File`].
    pub(crate) fn write(&self, log: &Path) -> Result<()> {
        let path = beside(log);
        let text = serde_json::to_vec_pretty(self)
            .map_err(|error| of_file(&path, io::Error::other(error)))?;
        AtomicFile::create(path.as_path(), Own::SAME_BYTES)?.commit_with(&text)?;
        Ok(())
    }
}
