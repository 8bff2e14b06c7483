//! Long work on its own thread, while this one handles Ctrl-C and reports progress.

use crate::choices::another_kind;
use crate::error::Raise;
use crate::pool::in_pool;
use hysteron::{Error, Progress};
use pyo3::prelude::*;
use pyo3::types::PyBool;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// How often signals are checked and progress is reported.
const PAUSE: Duration = Duration::from_millis(50);

/// Does `work` without the interpreter's lock. What a signal or the callback raises ends the work
/// and is raised here.
///
/// `progress` is `None`, `True` for tqdm, or called with the stage and the share done, `None` where
/// unknown.
///
/// The working threads never take the interpreter's lock. Only the calling thread runs Python.
pub(crate) fn with_progress<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Progress<'_>) -> hysteron::Result<T> + Send,
) -> PyResult<T> {
    let bar = callback(py, progress)?;
    let stop = AtomicBool::new(false);
    let news = Mutex::new(None);
    let callback = |what: &'static str, share: f64| {
        *news.lock().unwrap_or_else(PoisonError::into_inner) = Some((what, share));
        match stop.load(Relaxed) {
            true => Err(Error::Fit("interrupted".into())),
            false => Ok(()),
        }
    };
    let report = || -> PyResult<()> {
        py.check_signals()?;
        let news = news.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let (Some(call), Some((what, share))) = (&bar, news) {
            call.call1((what, (!share.is_nan()).then_some(share)))?;
        }
        Ok(())
    };
    let (done, finished) = channel::<()>();
    let (result, raised) = std::thread::scope(|scope| {
        let worker = scope.spawn(|| {
            // Dropped in a panic too, which ends the waiting.
            let done = done;
            let result = in_pool(|| work(Progress::new(&callback)));
            drop(done);
            result
        });
        let mut raised = None;
        // Others may not use a receiver, which letting go of the interpreter's lock asks for.
        let finished = Mutex::new(finished);
        let pause = || {
            let finished = finished.lock().unwrap_or_else(PoisonError::into_inner);
            finished.recv_timeout(PAUSE)
        };
        while py.detach(pause) == Err(RecvTimeoutError::Timeout) {
            if raised.is_none() {
                raised = report().err();
                stop.store(raised.is_some(), Relaxed);
            }
        }
        (py.detach(|| worker.join()), raised)
    });
    let raised = raised.or_else(|| py.check_signals().err());
    if let (Some(bar), Some(true)) = (&bar, progress.map(|p| p.is_instance_of::<PyBool>())) {
        bar.call_method0("close")?;
    }
    match (raised, result) {
        (Some(error), _) => Err(error),
        (None, Ok(result)) => result.raise(),
        (None, Err(panic)) => resume_unwind(panic),
    }
}

fn callback<'py>(
    py: Python<'py>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    match progress {
        None => Ok(None),
        Some(flag) if flag.is_instance_of::<PyBool>() => match flag.extract()? {
            true => py
                .import("pyhysteron.progress")?
                .call_method0("Bar")
                .map(Some),
            false => Ok(None),
        },
        Some(call) if call.is_callable() => Ok(Some(call.clone())),
        Some(other) => Err(another_kind("progress", "a callable, True or None", other)),
    }
}
