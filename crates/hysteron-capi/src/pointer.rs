//! Pointers from C, checked as far as possible.

use crate::codes::{
    HYSTERON_ALIGNMENT, HYSTERON_INTERNAL, HYSTERON_NULL, HYSTERON_OVERLAP, HYSTERON_TEXT,
    HYSTERON_VALUE,
};
use crate::fault::{Fault, Result};
use std::ffi::{CStr, c_char};
use std::ops::Range;

/// The pointers of one call. Each is checked, and refused if it shares memory with one before it.
///
/// Memory behind a pointer is reached in this way only, so that no function can forget a pair. A
/// function takes all its pointers before it writes.
#[derive(Default)]
pub(crate) struct Arguments {
    taken: [Range<usize>; 14],
    count: usize,
}

impl Arguments {
    /// Notes that an argument uses `bytes` bytes from `start` on.
    pub(crate) fn claim(&mut self, start: usize, bytes: usize, name: &'static str) -> Result<()> {
        let end = start.saturating_add(bytes);
        let shares = |other: &Range<usize>| start < other.end && other.start < end;
        if self.taken[..self.count].iter().any(shares) {
            return Err(Fault::Call(HYSTERON_OVERLAP, name));
        }
        let Some(free) = self.taken.get_mut(self.count) else {
            return Err(Fault::Call(HYSTERON_INTERNAL, name));
        };
        *free = start..end;
        self.count += 1;
        Ok(())
    }

    fn elements<T>(&mut self, pointer: *const T, count: usize, name: &'static str) -> Result<()> {
        check(pointer, name)?;
        if count > isize::MAX as usize / size_of::<T>() {
            return Err(Fault::Call(HYSTERON_VALUE, name));
        }
        self.claim(pointer.addr(), count * size_of::<T>(), name)
    }

    /// A value, copied.
    ///
    /// # Safety
    /// `pointer` is null or valid for a read; every bit pattern is a value of `T`.
    pub(crate) unsafe fn value<T: Copy>(
        &mut self,
        pointer: *const T,
        name: &'static str,
    ) -> Result<T> {
        self.elements(pointer, 1, name)?;
        // SAFETY: the caller's promise, not null and aligned as checked.
        Ok(unsafe { pointer.read() })
    }

    /// A place for a result.
    ///
    /// # Safety
    /// `place` is null or valid for a write while the `Out` is used.
    pub(crate) unsafe fn out<T>(&mut self, place: *mut T, name: &'static str) -> Result<Out<T>> {
        self.elements(place, 1, name)?;
        Ok(Out(place))
    }

    /// As [`Arguments::out`], for a result whose pointer may be null.
    ///
    /// # Safety
    /// As [`Arguments::out`].
    pub(crate) unsafe fn optional<T>(
        &mut self,
        place: *mut T,
        name: &'static str,
    ) -> Result<Option<Out<T>>> {
        if place.is_null() {
            return Ok(None);
        }
        // SAFETY: the caller's promise.
        unsafe { self.out(place, name).map(Some) }
    }

    /// An array to read; an empty one may be null.
    ///
    /// # Safety
    /// `pointer` is null or valid for reads of `count` elements, which nobody writes during `'a`.
    pub(crate) unsafe fn array<'a, T>(
        &mut self,
        pointer: *const T,
        count: usize,
        name: &'static str,
    ) -> Result<&'a [T]> {
        if count == 0 {
            return Ok(&[]);
        }
        self.elements(pointer, count, name)?;
        // SAFETY: the caller's promise; not null, aligned and of a possible size as checked.
        Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
    }

    /// An array to write; an empty one may be null.
    ///
    /// # Safety
    /// `pointer` is null or valid for writes of `count` elements, which nobody else uses while the
    /// `ArrayOut` is used.
    pub(crate) unsafe fn array_out<T>(
        &mut self,
        pointer: *mut T,
        count: usize,
        name: &'static str,
    ) -> Result<ArrayOut<T>> {
        if count > 0 {
            self.elements(pointer, count, name)?;
        }
        Ok(ArrayOut { pointer, count })
    }

    /// A text.
    ///
    /// # Safety
    /// `pointer` is null or a text that ends with a zero byte, which nobody writes during `'a`.
    pub(crate) unsafe fn text<'a>(
        &mut self,
        pointer: *const c_char,
        name: &'static str,
    ) -> Result<&'a str> {
        check(pointer, name)?;
        // SAFETY: the caller's promise, and not null.
        let text = unsafe { CStr::from_ptr(pointer) };
        self.claim(pointer.addr(), text.count_bytes() + 1, name)?;
        text.to_str().map_err(|_| Fault::Call(HYSTERON_TEXT, name))
    }
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

/// A place for a result: not null, aligned.
pub(crate) struct Out<T>(*mut T);

impl<T> Out<T> {
    pub(crate) fn set(&self, value: T) {
        // SAFETY: valid for a write by the contract of `Arguments::out`, not null and aligned as
        // checked there.
        unsafe { self.0.write(value) }
    }
}

/// Places for results: not null where there are any, aligned.
pub(crate) struct ArrayOut<T> {
    pointer: *mut T,
    count: usize,
}

/// A number of which zero bytes are a value.
pub(crate) trait Number: Copy {}
impl Number for f64 {}
impl Number for i32 {}

impl<T> ArrayOut<T> {
    /// Writes one element. An index from the count on is ignored.
    pub(crate) fn set(&self, n: usize, value: T) {
        if n < self.count {
            // SAFETY: valid for a write by the contract of `Arguments::array_out`, not null and
            // aligned as checked there.
            unsafe { self.pointer.add(n).write(value) }
        }
    }

    /// Writes as many of `values` as there is room for.
    pub(crate) fn write(&self, values: impl Iterator<Item = T>) {
        let values = values.take(self.count).enumerate();
        values.for_each(|(n, value)| self.set(n, value));
    }

    /// Writes all of `values`, whose number is `needed`. `count` gets that number even without
    /// room.
    pub(crate) fn write_all(
        &self,
        values: impl Iterator<Item = T>,
        needed: usize,
        count: &Out<usize>,
    ) -> Result<()> {
        count.set(needed);
        if self.count < needed {
            let found = self.count;
            return Err(hysteron_core::Error::MemoryTooSmall { needed, found }.into());
        }
        self.write(values);
        Ok(())
    }
}

impl<T: Number> ArrayOut<T> {
    /// The array itself, filled with zeros, because it may never have been written.
    pub(crate) fn zeros(&mut self) -> &mut [T] {
        if self.count == 0 {
            return &mut [];
        }
        // SAFETY: as for `write`, and nobody else uses it; the zeros make numbers of memory that
        // was never written.
        unsafe {
            self.pointer.write_bytes(0, self.count);
            std::slice::from_raw_parts_mut(self.pointer, self.count)
        }
    }
}

impl ArrayOut<c_char> {
    /// Copies as much of `from` as fits, with a zero byte at the end. Returns the size of the whole
    /// in bytes.
    pub(crate) fn write_text(&self, from: &str) -> usize {
        if self.count > 0 {
            let mut length = from.len().min(self.count - 1);
            while !from.is_char_boundary(length) {
                length -= 1;
            }
            let bytes = from.as_bytes()[..length].iter().chain(&[0]);
            self.write(bytes.map(|byte| *byte as c_char));
        }
        from.len() + 1
    }
}
