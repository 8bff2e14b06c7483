//! The same work for several numbers: on all threads with the feature `parallel`, else one by one.

use crate::error::Result;

/// `work` of each number from 0 to `count`, in order; the first error ends it.
#[cfg(feature = "parallel")]
pub(crate) fn map<T: Send>(
    count: usize,
    work: impl Fn(usize) -> Result<T> + Sync + Send,
) -> Result<Vec<T>> {
    use rayon::prelude::*;
    (0..count).into_par_iter().map(work).collect()
}

/// `work` of each number from 0 to `count`, in order; the first error ends it.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map<T>(count: usize, work: impl Fn(usize) -> Result<T>) -> Result<Vec<T>> {
    (0..count).map(work).collect()
}
