//! Status codes from results, and the text of the last error.

use crate::codes::{HYSTERON_INTERNAL, HYSTERON_OK, hysteron_error_message};
#[cfg(feature = "handles")]
use hysteron::Error;
#[cfg(not(feature = "handles"))]
use hysteron_core::Error;
use std::cell::RefCell;
use std::ffi::CStr;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Why a call failed.
pub(crate) enum Fault {
    /// The call itself is wrong: the code, and the argument.
    Call(i32, &'static str),
    /// The library refused.
    Library(Error),
}

pub(crate) type Result<T> = std::result::Result<T, Fault>;

impl Fault {
    fn code(&self) -> i32 {
        match self {
            Fault::Call(code, _) => *code,
            Fault::Library(error) => error.code(),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::Call(code, argument) => {
                // SAFETY: the function returns a constant text that ends with a zero byte.
                let text = unsafe { CStr::from_ptr(hysteron_error_message(*code)) };
                write!(f, "`{argument}`: {}", text.to_string_lossy())
            }
            Fault::Library(error) => error.fmt(f),
        }
    }
}

impl<E: Into<Error>> From<E> for Fault {
    fn from(error: E) -> Self {
        Fault::Library(error.into())
    }
}

thread_local! {
    static LAST: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Runs a function of the form with handles. It may allocate, and an error leaves its text.
pub(crate) fn guard(work: impl FnOnce() -> Result<()>) -> i32 {
    let (code, text) = match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => return HYSTERON_OK,
        Ok(Err(fault)) => (fault.code(), fault.to_string()),
        Err(_) => (HYSTERON_INTERNAL, "the library panicked".into()),
    };
    // While a thread ends, the text cannot be kept any more.
    let _ = LAST.try_with(|last| last.replace(text));
    code
}

/// Runs a function of the form without allocation. An error leaves its code only.
pub(crate) fn guard_plain(work: impl FnOnce() -> Result<()>) -> i32 {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => HYSTERON_OK,
        Ok(Err(fault)) => fault.code(),
        Err(_) => HYSTERON_INTERNAL,
    }
}

/// Calls `read` with the text of the last error of this thread. `None` while the thread ends.
pub(crate) fn with_last<T>(read: impl FnOnce(&str) -> T) -> Option<T> {
    LAST.try_with(|last| read(&last.borrow())).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_status() {
        #[allow(clippy::panic)]
        let code = guard(|| panic!("meant to be"));
        assert_eq!(code, HYSTERON_INTERNAL);
    }
}
