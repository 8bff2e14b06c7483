//! Status codes from results, and the text of the last error.

use crate::codes::{HYSTERON_INTERNAL, HYSTERON_OK, hysteron_error_message};
#[cfg(feature = "handles")]
use hysteron::Error;
#[cfg(not(feature = "handles"))]
use hysteron_core::Error;
use std::cell::RefCell;
use std::ffi::CStr;
use std::fmt::{self, Write};
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

/// The text of an error, in memory that is always there: an error allocates nothing for it. What is
/// longer is cut off.
struct Text {
    bytes: [u8; 1024],
    length: usize,
}

impl Write for Text {
    fn write_str(&mut self, more: &str) -> fmt::Result {
        let free = &mut self.bytes[self.length..];
        let mut length = more.len().min(free.len());
        while !more.is_char_boundary(length) {
            length -= 1;
        }
        free[..length].copy_from_slice(&more.as_bytes()[..length]);
        self.length += length;
        match length == more.len() {
            true => Ok(()),
            false => Err(fmt::Error),
        }
    }
}

thread_local! {
    static LAST: RefCell<Text> = const { RefCell::new(Text { bytes: [0; 1024], length: 0 }) };
}

/// Runs a function of the interface. An error leaves its text.
pub(crate) fn guard(work: impl FnOnce() -> Result<()>) -> i32 {
    let fault = match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => return HYSTERON_OK,
        Ok(Err(fault)) => fault,
        Err(_) => Fault::Call(HYSTERON_INTERNAL, "call"),
    };
    // While a thread ends, the text cannot be kept any more.
    let _ = LAST.try_with(|last| {
        let mut last = last.borrow_mut();
        last.length = 0;
        write!(last, "{fault}")
    });
    fault.code()
}

/// Calls `read` with the text of the last error of this thread. `None` while the thread ends.
pub(crate) fn with_last<T>(read: impl FnOnce(&str) -> T) -> Option<T> {
    let text = |last: &Text| str::from_utf8(&last.bytes[..last.length]).map(read);
    LAST.try_with(|last| text(&last.borrow()).ok()).ok()?
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
