//! Calls of libraries that panic where a damaged file contradicts itself.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Whether a panic of this thread is caught and becomes an error.
    static EXPECTED: Cell<bool> = const { Cell::new(false) };
}

/// What `use_it` gives; `None` where it panics. The error that follows says it, so the panic prints
/// nothing. Panics of other threads and other places are told as before.
pub(super) fn caught<T>(use_it: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    // Where a panic aborts, it is not caught.
    if cfg!(panic = "unwind") {
        HOOK.call_once(|| {
            let usual = take_hook();
            set_hook(Box::new(move |about| {
                if !EXPECTED.try_with(Cell::get).unwrap_or(false) {
                    usual(about);
                }
            }));
        });
    }
    let outer = EXPECTED.replace(true);
    let found = catch_unwind(AssertUnwindSafe(use_it)).ok();
    EXPECTED.set(outer);
    found
}
