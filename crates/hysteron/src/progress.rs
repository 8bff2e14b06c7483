//! What long work tells of its progress.

use crate::error::Result;

/// Told, now and then, what is being done and how far it is; may end the work.
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
    /// Nobody is told.
    pub const NONE: Progress<'static> = Progress(None);

    /// Calls `told` with what is being done and the share of it that is done, from 0 to 1, or NaN
    /// where that is not known. It is called from any thread that works. An error that it returns
    /// ends the work.
    pub fn new(told: &'a (dyn Fn(&'static str, f64) -> Result<()> + Sync)) -> Self {
        Self(Some(told))
    }

    /// Tells of the progress.
    ///
    /// # Errors
    /// What the one who is told returns.
    pub fn tell(&self, what: &'static str, share: f64) -> Result<()> {
        self.0.map_or(Ok(()), |told| told(what, share))
    }
}

impl std::fmt::Debug for Progress<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let told = if self.0.is_some() { "told" } else { "NONE" };
        write!(f, "Progress::{told}")
    }
}

/// How many samples a loop takes between two words of its progress: a few milliseconds.
pub(crate) const SAMPLES_BETWEEN: usize = 1024;
