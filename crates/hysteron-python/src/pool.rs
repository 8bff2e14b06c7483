//! Threads for the work, in a forked process too.

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The process whose threads the usual pool has: the one that worked first.
static USUAL: OnceLock<u32> = OnceLock::new();

/// The pool of a process that was forked from that one, and which process that is.
static FORKED: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// Does `work` without the interpreter's lock, in such a pool.
pub(crate) fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
    py.detach(|| in_pool(work))
}

/// Does `work` in a pool whose threads are there. A fork copies the pool and not its threads: work
/// that is given to it would be waited for for ever.
pub(crate) fn in_pool<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let process = std::process::id();
    if *USUAL.get_or_init(|| process) == process {
        return work();
    }
    match forked(process) {
        Some(pool) => pool.install(work),
        // Without threads of its own there is nothing better to try.
        None => work(),
    }
}

fn forked(process: u32) -> Option<Arc<ThreadPool>> {
    let mut held = FORKED.lock().unwrap_or_else(PoisonError::into_inner);
    match &*held {
        Some((of, pool)) if *of == process => Some(pool.clone()),
        _ => {
            let pool = Arc::new(ThreadPoolBuilder::new().build().ok()?);
            // The parent's pool has no threads to end here: it is left as it is, not dropped.
            std::mem::forget(held.replace((process, pool.clone())));
            Some(pool)
        }
    }
}
