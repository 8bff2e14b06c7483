//! What long work tells of its progress.

use crate::error::Result;

/// Told, now and then, what is being done and how far it is from 0 to 1, NaN where that is not known; an error it returns ends the work.
pub type Watch<'a> = &'a (dyn Fn(&'static str, f64) -> Result<()> + Sync);

/// How many samples a loop takes between two words to its [`Watch`]: a few milliseconds.
pub(crate) const SAMPLES_BETWEEN: usize = 1024;
