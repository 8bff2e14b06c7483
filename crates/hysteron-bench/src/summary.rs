//! What a run is told beside its file, and what it tells.

use crate::config::Config;
use crate::end::End;
use crate::error::Result;
use std::path::PathBuf;

/// What the command adds to a file.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The log, in place of the file's.
    pub log: Option<PathBuf>,
    /// Whether any file there is replaced.
    pub force: bool,
    /// Whether to go on with the log that is there.
    pub resume: bool,
}

/// What somebody at a terminal sees of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen<'a> {
    /// Time of the run, s.
    pub elapsed_s: f64,
    /// When the run will end, s; `None` where nobody knows.
    pub end_s: Option<f64>,
    /// What is due; NaN in mode monitor.
    pub reference: f64,
    /// What was read.
    pub output: f64,
    /// The drive that was sent.
    pub drive: f64,
    /// What learns, or that the fixed model is used; empty without a learner.
    pub learner: &'a str,
    /// Root mean square jitter of the intervals, s; `None` for a device that keeps no clock.
    pub jitter_s: Option<f64>,
}

/// What a run came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// How it ended.
    pub end: End,
    /// Samples in the log of this run.
    pub samples: u64,
    /// Samples whose numbers never came.
    pub lost: u64,
    /// Samples that came again, or late.
    pub old: u64,
    /// Lines with a wrong check, too long, or of no meaning.
    pub bad: u64,
    /// The last of these lines, as far as it can be read.
    pub bad_line: Option<String>,
    /// Samples without a reading.
    pub missing: u64,
    /// Readings that were taken for spikes.
    pub rejected: u64,
    /// Root mean square of reference less output, in mode control, over the readings that were
    /// believed.
    pub rmse: Option<f64>,
    /// Share of the samples that the learner was used for; `None` without one.
    pub learned: Option<f64>,
    /// Root mean square jitter of the intervals, s, by the host's clock; `None` for a device that
    /// keeps none.
    pub jitter_s: Option<f64>,
    /// The slowest answer, s.
    pub slowest_s: f64,
    /// The gains found from the model and their margin.
    pub tuned: Option<(hysteron::control::Gains, f64)>,
    /// The log.
    pub log: PathBuf,
}

/// Where the log goes.
pub(crate) fn log_path(config: &Config, options: &Options) -> Result<PathBuf> {
    let own = config.log.as_ref().map(|path| config.at(path));
    let path = options.log.clone().or(own);
    path.ok_or_else(|| config.refused("log", "no log is named: here, or with -o"))
}
