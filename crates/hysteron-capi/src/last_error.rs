//! The text of the last failure.

use crate::fault::with_last;
use crate::pointer::Arguments;
use std::ffi::c_char;

/// What was wrong with the last call that failed in this thread (functions `hysteron_core_…` leave no text).
///
/// Copies as much as fits into `text`, of `size` bytes, with a zero byte at the end, and returns the bytes that the whole
/// takes with that zero. With a null pointer it only tells the size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_last_error(text: *mut c_char, size: usize) -> usize {
    let size = if text.is_null() { 0 } else { size };
    // SAFETY: `text` has `size` bytes by contract.
    match unsafe { Arguments::default().array_out(text, size, "text") } {
        Ok(text) => with_last(|last| text.write_text(last)).unwrap_or(0),
        Err(_) => 0,
    }
}
