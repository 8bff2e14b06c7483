//! Progress reports of long calls, and the way to cancel them.

use crate::error::{Error, Result};
use std::sync::{Mutex, PoisonError};

/// A callback for the progress of long work. It may cancel the work by returning an error.
///
/// ```
/// use hysteron::{Fit, Progress, Recording};
/// let told = |what: &'static str, share: f64| {
///     eprintln!("{what}: {share:.2}"); // from 0 to 1; NaN where that is not known
///     Ok(()) // an error ends the work, and is what it returns
/// };
/// let input: Vec<f64> = (0..200).map(|n| (1.0 - (f64::from(n) * 0.1).cos()) * 30.0).collect();
/// let recording = Recording::new(input.clone(), input)?;
/// let model = Fit::new().progress(Progress::new(&told)).run(&recording)?;
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Clone, Copy, Default)]
pub struct Progress<'a>(Option<Told<'a>>);

type Told<'a> = &'a (dyn Fn(&'static str, f64) -> Result<()> + Sync);

impl<'a> Progress<'a> {
    /// No callback.
    pub const NONE: Progress<'static> = Progress(None);

    /// Calls `report` now and then, with the name of the current step and the share of it that is
    /// done. The share is from 0 to 1, or NaN if it is not known. Any worker thread may call
    /// `report`. If it returns an error, the work ends with this error.
    pub fn new(report: &'a (dyn Fn(&'static str, f64) -> Result<()> + Sync)) -> Self {
        Self(Some(report))
    }

    /// Reports progress.
    ///
    /// # Errors
    /// The error that the callback returns.
    pub fn tell(&self, what: &'static str, share: f64) -> Result<()> {
        self.0.map_or(Ok(()), |report| report(what, share))
    }
}

/// Does `work` of which parts may fail. What the callback of `progress` returned ends all of it,
/// and is not taken for a part that fails.
///
/// # Errors
/// That of the callback, or else that of `work`.
pub(crate) fn ended_by_callback<T>(
    progress: Progress<'_>,
    work: impl FnOnce(Progress<'_>) -> Result<T>,
) -> Result<T> {
    let ended_by = Mutex::new(None);
    let slot = || ended_by.lock().unwrap_or_else(PoisonError::into_inner);
    let report = |what: &'static str, share: f64| {
        progress.tell(what, share).map_err(|error| {
            slot().get_or_insert(error);
            Error::Fit("ended".into())
        })
    };
    let found = work(Progress::new(&report));
    match slot().take() {
        Some(error) => Err(error),
        None => found,
    }
}

impl std::fmt::Debug for Progress<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let kind = if self.0.is_some() { "new" } else { "NONE" };
        write!(f, "Progress::{kind}")
    }
}

/// Samples that a loop processes between two reports: a few milliseconds of work.
pub(crate) const SAMPLES_BETWEEN: usize = 1024;
