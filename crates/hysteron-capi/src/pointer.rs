//! Pointers from C: checked as far as they can be, once, here.

use crate::codes::{
    HYSTERON_ALIGNMENT, HYSTERON_NULL, HYSTERON_OVERLAP, HYSTERON_TEXT, HYSTERON_VALUE,
};
use crate::fault::{Fault, Result};
use std::ffi::{CStr, c_char};

/// A place for a result: not null, aligned.
pub(crate) struct Out<T>(*mut T);

impl<T> Out<T> {
    /// # Safety
    /// `place` is null or valid for a write while the `Out` is used.
    pub(crate) unsafe fn new(place: *mut T, name: &'static str) -> Result<Self> {
        check(place, name)?;
        Ok(Self(place))
    }

    pub(crate) fn set(&self, value: T) {
        // SAFETY: valid for a write by the contract of `new`, not null and aligned as checked there.
        unsafe { self.0.write(value) }
    }
}

/// As [`Out::new`], of a result that nobody needs to want.
///
/// # Safety
/// As [`Out::new`].
pub(crate) unsafe fn optional<T>(place: *mut T, name: &'static str) -> Result<Option<Out<T>>> {
    if place.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    unsafe { Out::new(place, name).map(Some) }
}

pub(crate) fn check<T>(pointer: *const T, name: &'static str) -> Result<()> {
    if pointer.is_null() {
        return Err(Fault::Call(HYSTERON_NULL, name));
    }
    if !pointer.is_aligned() {
        return Err(Fault::Call(HYSTERON_ALIGNMENT, name));
    }
    Ok(())
}

pub(crate) fn check_array<T>(pointer: *const T, count: usize, name: &'static str) -> Result<()> {
    check(pointer, name)?;
    if count > isize::MAX as usize / size_of::<T>() {
        return Err(Fault::Call(HYSTERON_VALUE, name));
    }
    Ok(())
}

/// An array to read; an empty one may be null.
///
/// # Safety
/// `pointer` is null or valid for reads of `count` elements, which nobody writes during `'a`.
pub(crate) unsafe fn array<'a, T>(
    pointer: *const T,
    count: usize,
    name: &'static str,
) -> Result<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    check_array(pointer, count, name)?;
    // SAFETY: the caller's promise; not null, aligned and of a possible size as checked.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// A number of which zero bytes are a value.
pub(crate) trait Number: Copy {}
impl Number for f64 {}
impl Number for i32 {}

/// An array to write, of numbers that were written before or not.
///
/// # Safety
/// `pointer` is null or valid for writes of `count` elements, which nobody else uses during `'a`.
pub(crate) unsafe fn array_out<'a, T: Number>(
    pointer: *mut T,
    count: usize,
    name: &'static str,
) -> Result<&'a mut [T]> {
    if count == 0 {
        return Ok(&mut []);
    }
    check_array(pointer, count, name)?;
    // SAFETY: as for `array`; the zeros make numbers of memory that was never written.
    unsafe {
        pointer.write_bytes(0, count);
        Ok(std::slice::from_raw_parts_mut(pointer, count))
    }
}

/// Refuses arrays of `count` elements each of which a part is the same memory; null is no array.
pub(crate) fn apart<A, B>(
    a: *const A,
    b: *const B,
    count: usize,
    name: &'static str,
) -> Result<()> {
    let end = |start: usize, size: usize| start.saturating_add(count.saturating_mul(size));
    let (a_end, b_end) = (end(a.addr(), size_of::<A>()), end(b.addr(), size_of::<B>()));
    if !a.is_null() && !b.is_null() && a.addr() < b_end && b.addr() < a_end {
        return Err(Fault::Call(HYSTERON_OVERLAP, name));
    }
    Ok(())
}

/// A text.
///
/// # Safety
/// `pointer` is null or a text that ends with a zero byte, which nobody writes during `'a`.
pub(crate) unsafe fn text<'a>(pointer: *const c_char, name: &'static str) -> Result<&'a str> {
    check(pointer, name)?;
    // SAFETY: the caller's promise, and not null.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| Fault::Call(HYSTERON_TEXT, name))
}

/// Copies all of `values`, or tells by `count` how much room that takes.
///
/// # Safety
/// `to` is null or valid for writes of `capacity` numbers.
pub(crate) unsafe fn copy_out(
    values: impl Iterator<Item = f64> + Clone,
    (to, capacity): (*mut f64, usize),
    count: &Out<usize>,
) -> Result<()> {
    let needed = values.clone().count();
    count.set(needed);
    if capacity < needed {
        return Err(hysteron_core::Error::MemoryTooSmall {
            needed,
            found: capacity,
        }
        .into());
    }
    // SAFETY: the caller's promise, and `needed` is no more than that.
    let to = unsafe { array_out(to, needed, "values")? };
    to.iter_mut()
        .zip(values)
        .for_each(|(to, value)| *to = value);
    Ok(())
}

/// Copies as much of `from` as fits into `size` bytes with a zero byte at the end; gives the bytes that the whole takes.
///
/// # Safety
/// `to` is null or valid for writes of `size` bytes.
pub(crate) unsafe fn copy_text(from: &str, to: *mut c_char, size: usize) -> usize {
    if !to.is_null() && size > 0 {
        let mut length = from.len().min(size - 1);
        while !from.is_char_boundary(length) {
            length -= 1;
        }
        // SAFETY: `to` has `size` bytes by contract, more than `length`, and does not lie in a string of ours.
        unsafe {
            from.as_ptr()
                .cast::<c_char>()
                .copy_to_nonoverlapping(to, length);
            to.add(length).write(0);
        }
    }
    from.len() + 1
}
