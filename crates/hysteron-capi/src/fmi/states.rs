//! The functions for saved states. They are the same in FMI 2.0 and 3.0 but for their names.

use super::calls::{call, handle_of, pointer_of};
use super::{Problem, Status};
use crate::pointer::Arguments;
use std::ffi::c_void;

/// # Safety
/// `state` is null or valid; so for the others here.
pub(crate) unsafe fn save(c: *mut c_void, name: &str, state: *mut *mut c_void) -> Status {
    call(c, name, |instance| {
        // SAFETY: the caller's promise; not null as checked.
        let (out, older) = unsafe { (Arguments::default().out(state, "FMUstate")?, state.read()) };
        out.set(pointer_of(instance.save(handle_of(older))?));
        Ok(())
    })
}

pub(crate) fn restore(c: *mut c_void, name: &str, state: *mut c_void) -> Status {
    call(c, name, |instance| instance.restore(handle_of(state)))
}

pub(crate) unsafe fn forget(c: *mut c_void, name: &str, state: *mut *mut c_void) -> Status {
    call(c, name, |instance| {
        // SAFETY: the caller's promise; not null as checked.
        let (out, handle) = unsafe {
            (
                Arguments::default().out(state, "FMUstate")?,
                handle_of(state.read()),
            )
        };
        if handle != 0 {
            instance.forget(handle)?;
            out.set(std::ptr::null_mut());
        }
        Ok(())
    })
}

pub(crate) unsafe fn size(
    c: *mut c_void,
    name: &str,
    state: *mut c_void,
    size: *mut usize,
) -> Status {
    call(c, name, |instance| {
        // SAFETY: the caller's promise.
        let size = unsafe { Arguments::default().out(size, "size")? };
        size.set(instance.serialised(handle_of(state))?.len());
        Ok(())
    })
}

/// `to` has `size` bytes.
pub(crate) unsafe fn serialise(
    c: *mut c_void,
    name: &str,
    state: *mut c_void,
    (to, size): (*mut u8, usize),
) -> Status {
    call(c, name, |instance| {
        let bytes = instance.serialised(handle_of(state))?;
        if size < bytes.len() {
            return Err(Problem(format!(
                "room for {size} bytes where {} are needed",
                bytes.len()
            )));
        }
        // SAFETY: the caller's promise.
        let to = unsafe { Arguments::default().array_out(to, size, "serializedState")? };
        to.write(bytes.iter().copied());
        Ok(())
    })
}

/// `from` has `size` bytes; what `state` points to is not read.
pub(crate) unsafe fn deserialise(
    c: *mut c_void,
    name: &str,
    (from, size): (*const u8, usize),
    state: *mut *mut c_void,
) -> Status {
    call(c, name, |instance| {
        let mut arguments = Arguments::default();
        // SAFETY: the caller's promise.
        let (bytes, out) = unsafe {
            (
                arguments.array(from, size, "serializedState")?,
                arguments.out(state, "FMUstate")?,
            )
        };
        out.set(pointer_of(instance.deserialise(bytes)?));
        Ok(())
    })
}
