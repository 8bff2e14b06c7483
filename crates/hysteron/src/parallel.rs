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

/// Calls `work` with each of the items, on all threads with the feature `parallel`. The items are
/// made on this thread, and only a few of them wait to be worked on.
#[cfg(feature = "parallel")]
pub(crate) fn each<T: Send>(items: impl Iterator<Item = T>, work: impl Fn(T) + Sync) {
    use std::sync::{Condvar, Mutex, PoisonError};
    let most = 2 * rayon::current_num_threads();
    let (running, ended) = (Mutex::new(0_usize), Condvar::new());
    let lock = || running.lock().unwrap_or_else(PoisonError::into_inner);
    rayon::in_place_scope(|scope| {
        for item in items {
            let mut count = lock();
            while *count >= most {
                count = ended.wait(count).unwrap_or_else(PoisonError::into_inner);
            }
            *count += 1;
            drop(count);
            scope.spawn(|_| {
                work(item);
                *lock() -= 1;
                ended.notify_one();
            });
        }
    });
}

/// Calls `work` with each of the items.
#[cfg(not(feature = "parallel"))]
pub(crate) fn each<T>(items: impl Iterator<Item = T>, work: impl Fn(T)) {
    items.for_each(work);
}

/// The results of `work` for each number from 0 to `count − 1`, in order. The first error ends the
/// work.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map<T>(count: usize, work: impl Fn(usize) -> Result<T>) -> Result<Vec<T>> {
    (0..count).map(work).collect()
}
