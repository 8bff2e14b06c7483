//! A map over numbers that uses all threads with the feature `parallel`, and one thread without it.

use crate::error::Result;

/// The results of `work` for each number from 0 to `count − 1`, in order. The first error ends the
/// work.
#[cfg(feature = "parallel")]
pub(crate) fn map<T: Send>(
    count: usize,
    work: impl Fn(usize) -> Result<T> + Sync + Send,
) -> Result<Vec<T>> {
    use rayon::prelude::*;
    (0..count).into_par_iter().map(work).collect()
}

/// The results of `work` for each number from 0 to `count − 1`, in order. The first error ends the
/// work.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map<T>(count: usize, work: impl Fn(usize) -> Result<T>) -> Result<Vec<T>> {
    (0..count).map(work).collect()
}

/// The results of `work` for each of `items`, in order. A thread takes `least` items or more, so
/// that little work stays on the present one.
#[cfg(feature = "parallel")]
pub(crate) fn map_mut<I: Send, T: Send>(
    items: &mut [I],
    least: usize,
    work: impl Fn(&mut I) -> T + Sync + Send,
) -> Vec<T> {
    use rayon::prelude::*;
    if items.len() <= least {
        return items.iter_mut().map(work).collect();
    }
    let items = items.par_iter_mut().with_min_len(least);
    items.map(work).collect()
}

/// The results of `work` for each of `items`, in order.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map_mut<I, T>(items: &mut [I], _least: usize, work: impl Fn(&mut I) -> T) -> Vec<T> {
    items.iter_mut().map(work).collect()
}
