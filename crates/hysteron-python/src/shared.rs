//! Values that several Python threads share: each use ends before the next one begins.

use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError, TryLockError};

/// A value that one thread uses at a time. Meanwhile no Python code runs and no exception is made:
/// either could run a callback, and that could use the value again.
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
