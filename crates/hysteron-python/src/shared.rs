//! What several Python threads may use at once: each use is done before the next begins.

use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError, TryLockError};

/// A value that one thread has at a time. No Python runs while it is had, nor is an exception made:
/// either could run anything (the collector, a callback of its), and with that come back here.
pub(crate) struct Shared<T>(Mutex<T>);

impl<T: Send> Shared<T> {
    pub(crate) fn new(value: T) -> Self {
        Self(Mutex::new(value))
    }

    /// `work` on it, from Python. While it is waited for, other Python threads go on.
    pub(crate) fn with<R>(&self, py: Python<'_>, work: impl FnOnce(&mut T) -> R) -> R {
        loop {
            match self.0.try_lock() {
                Ok(mut value) => return work(&mut value),
                Err(TryLockError::Poisoned(value)) => return work(&mut value.into_inner()),
                Err(TryLockError::WouldBlock) => py.detach(|| self.with_detached(|_| ())),
            }
        }
    }

    /// `work` on it, from a thread without the interpreter's lock.
    pub(crate) fn with_detached<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        work(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
