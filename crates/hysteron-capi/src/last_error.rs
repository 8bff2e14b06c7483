//! The text of the last error.

use crate::fault::with_last;
use crate::pointer::Arguments;
use std::ffi::c_char;

/// The text of the last error in this thread, up to 1023 bytes.
///
/// Copies as much of it as fits into the `size` bytes of `text`, with a zero byte at the end.
/// Returns the size of the whole text in bytes, with the zero byte. `text` may be null to ask for
/// the size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_last_error(text: *mut c_char, size: usize) -> usize {
    let size = if text.is_null() { 0 } else { size };
    // SAFETY: `text` has `size` bytes by contract.
    match unsafe { Arguments::default().array_out(text, size, "text") } {
        Ok(text) => with_last(|last| text.write_text(last)).unwrap_or(0),
        Err(_) => 0,
    }
}
