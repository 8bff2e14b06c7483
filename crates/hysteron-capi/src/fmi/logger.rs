//! Messages to the tool that runs the FMU.

use super::Status;
use std::ffi::{CStr, CString, c_char, c_void};
use std::sync::atomic::{AtomicBool, Ordering};

/// The one category of messages.
pub(crate) const CATEGORY: &CStr = c"logStatusError";

/// `fmi2CallbackLogger`: the message is a format as of `printf`.
pub type Fmi2Logger =
    unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char, ...);
/// `fmi3LogMessageCallback`
pub type Fmi3Logger = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

#[derive(Clone, Copy)]
pub(crate) enum Callback {
    None,
    Fmi2(Fmi2Logger),
    Fmi3(Fmi3Logger),
}

pub(crate) struct Logger {
    instance: CString,
    environment: *mut c_void,
    callback: Callback,
    on: AtomicBool,
}

// SAFETY: `environment` is only ever handed back to the callback of the same caller, which the
// standards ask to be callable from the thread that calls the function.
unsafe impl Send for Logger {}
// SAFETY: as above.
unsafe impl Sync for Logger {}

impl Logger {
    /// Errors are told until somebody turns them off: they are no debug messages.
    pub(crate) fn new(instance: &str, environment: *mut c_void, callback: Callback) -> Self {
        Self {
            instance: c_text(instance),
            environment,
            callback,
            on: AtomicBool::new(true),
        }
    }

    pub(crate) fn turn(&self, on: bool) {
        self.on.store(on, Ordering::Relaxed);
    }

    pub(crate) fn tell(&self, status: Status, text: &str) {
        if !self.on.load(Ordering::Relaxed) {
            return;
        }
        let category = CATEGORY.as_ptr();
        match self.callback {
            Callback::None => (),
            Callback::Fmi2(logger) => {
                // `%` begins a conversion and `#` a value reference there.
                let text = c_text(&text.replace('%', "%%").replace('#', "##"));
                let name = self.instance.as_ptr();
                // SAFETY: the caller's own function, with texts that live during the call and a
                // format without conversions.
                unsafe { logger(self.environment, name, status, category, text.as_ptr()) }
            }
            Callback::Fmi3(logger) => {
                let text = c_text(text);
                // SAFETY: as above.
                unsafe { logger(self.environment, status, category, text.as_ptr()) }
            }
        }
    }
}

fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}
