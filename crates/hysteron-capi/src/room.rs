//! Objects in memory that the caller owns: made, found again, never taken for what they are not.

use crate::codes::{HYSTERON_ALIGNMENT, HYSTERON_HANDLE, HYSTERON_NULL};
use crate::fault::{Fault, Result};
use crate::pointer::{Out, check};
use hysteron_core::Error;
use std::ffi::c_void;

/// An object that begins with something that random memory hardly has.
pub(crate) trait Marked {
    const MARK: u64;
    /// # Safety
    /// `this` is valid for reads of `Self`, of whatever content.
    unsafe fn mark(this: *const Self) -> u64;
}

macro_rules! marked {
    ($type:ty, $mark:expr) => {
        impl $crate::room::Marked for $type {
            const MARK: u64 = $mark;
            unsafe fn mark(this: *const Self) -> u64 {
                // SAFETY: the caller's promise.
                unsafe { (&raw const (*this).mark).read() }
            }
        }
    };
}
pub(crate) use marked;

/// The object behind a pointer that an initialisation gave.
///
/// # Safety
/// `pointer` is null or points to memory of at least the size of `T` that nobody else uses during `'a`.
pub(crate) unsafe fn object<'a, T: Marked>(
    pointer: *mut T,
    name: &'static str,
) -> Result<&'a mut T> {
    check(pointer, name)?;
    // SAFETY: the caller's promise; with its mark it is an object that `Room::finish` has written.
    unsafe {
        if T::mark(pointer) != T::MARK {
            return Err(Fault::Call(HYSTERON_HANDLE, name));
        }
        Ok(&mut *pointer)
    }
}

/// As [`object`], of one that is read only: others may read it too.
///
/// # Safety
/// As for [`object`], but others may read it.
pub(crate) unsafe fn object_ref<'a, T: Marked>(
    pointer: *const T,
    name: &'static str,
) -> Result<&'a T> {
    check(pointer, name)?;
    // SAFETY: as in `object`.
    unsafe {
        if T::mark(pointer) != T::MARK {
            return Err(Fault::Call(HYSTERON_HANDLE, name));
        }
        Ok(&*pointer)
    }
}

/// Bytes of an object `T` with `count` elements `E` behind it.
pub(crate) fn size<T, E>(count: usize) -> Option<usize> {
    const {
        assert!(
            size_of::<T>().is_multiple_of(align_of::<E>()) && align_of::<T>() >= align_of::<E>()
        )
    };
    count
        .checked_mul(size_of::<E>())?
        .checked_add(size_of::<T>())
}

/// The caller's memory, cut into the object's place and the elements behind it.
pub(crate) struct Room<T>(*mut T);

impl<T> Room<T> {
    /// # Safety
    /// `memory` is null or valid for `bytes` bytes that nobody else uses while the object lives.
    pub(crate) unsafe fn cut<E: Default + 'static>(
        memory: *mut c_void,
        bytes: usize,
        count: usize,
    ) -> Result<(Self, &'static mut [E])> {
        if memory.is_null() {
            return Err(Fault::Call(HYSTERON_NULL, "memory"));
        }
        let head = memory.cast::<T>();
        if !head.is_aligned() {
            return Err(Fault::Call(HYSTERON_ALIGNMENT, "memory"));
        }
        let needed = size::<T, E>(count).unwrap_or(usize::MAX);
        if bytes < needed {
            return Err(Error::MemoryTooSmall {
                needed,
                found: bytes,
            }
            .into());
        }
        // SAFETY: `bytes` suffice for the head and `count` elements behind it, aligned because the head is and its size is a
        // multiple; each element is written before the slice is made.
        let elements = unsafe {
            let first = head.add(1).cast::<E>();
            for n in 0..count {
                first.add(n).write(E::default());
            }
            std::slice::from_raw_parts_mut(first, count)
        };
        Ok((Self(head), elements))
    }

    pub(crate) fn finish(self, object: T, out: &Out<*mut T>) {
        // SAFETY: valid, aligned and apart from the elements, as `cut` has seen to.
        unsafe { self.0.write(object) };
        out.set(self.0);
    }
}
