//! Objects in memory of the caller: made there, and recognised when they are used.

use crate::codes::HYSTERON_HANDLE;
use crate::fault::{Fault, Result};
use crate::pointer::{Out, Pointers, check};
use hysteron_core::Error;
use std::ffi::c_void;

/// The head of every object.
#[repr(C)]
struct Head {
    /// The kind of object that follows, a number that random memory hardly has. 0 for none.
    mark: u64,
    /// Size of the whole object in bytes.
    bytes: usize,
}

/// A kind of object, as C knows it. Behind its pointer lie the head, the content and the content's
/// elements.
pub(crate) trait Kind {
    const MARK: u64;
    type Content;
}

/// Bytes of an object with `count` elements `E`.
pub(crate) fn size<K: Kind, E>(count: usize) -> Option<usize> {
    const {
        assert!(size_of::<Head>().is_multiple_of(align_of::<K::Content>()));
        assert!(size_of::<K::Content>().is_multiple_of(align_of::<E>()));
        assert!(align_of::<Head>() >= align_of::<K::Content>());
        assert!(align_of::<Head>() >= align_of::<E>());
    };
    count
        .checked_mul(size_of::<E>())?
        .checked_add(size_of::<Head>() + size_of::<K::Content>())
}

impl<const MOST: usize> Pointers<MOST> {
    /// The object at a pointer from an initialisation.
    ///
    /// # Safety
    /// `pointer` is null or points to memory of at least the size of an object, which nobody else
    /// uses during `'a`.
    pub(crate) unsafe fn object<'a, K: Kind>(
        &mut self,
        pointer: *mut K,
        name: &'static str,
    ) -> Result<&'a mut K::Content> {
        // SAFETY: the caller's promise.
        unsafe { Ok(&mut *self.content::<K>(pointer, name)?) }
    }

    /// As [`Pointers::object`], for an object that is only read. Others may read it too.
    ///
    /// # Safety
    /// As for [`Pointers::object`], but others may read it.
    pub(crate) unsafe fn object_ref<'a, K: Kind>(
        &mut self,
        pointer: *const K,
        name: &'static str,
    ) -> Result<&'a K::Content> {
        // SAFETY: the caller's promise.
        unsafe { Ok(&*self.content::<K>(pointer.cast_mut(), name)?) }
    }

    /// An object that is changed only if the call finds that it has to.
    ///
    /// # Safety
    /// As for [`Pointers::object_ref`] while it is read, and as for [`Pointers::object`] once it
    /// is changed.
    pub(crate) unsafe fn object_at<K: Kind>(
        &mut self,
        pointer: *mut K,
        name: &'static str,
    ) -> Result<Object<K>> {
        // SAFETY: the caller's promise.
        unsafe { Ok(Object(self.content::<K>(pointer, name)?)) }
    }

    /// # Safety
    /// As for [`Pointers::object_ref`].
    unsafe fn content<K: Kind>(
        &mut self,
        pointer: *mut K,
        name: &'static str,
    ) -> Result<*mut K::Content> {
        let head = pointer.cast::<Head>();
        check(head, name)?;
        // SAFETY: the caller's promise, not null and aligned as checked.
        let Head { mark, bytes } = unsafe { head.read() };
        if mark != K::MARK {
            return Err(Fault::Call(HYSTERON_HANDLE, name));
        }
        self.claim(head.addr(), bytes, name)?;
        Ok(content_of::<K>(head))
    }

    /// Memory for an object.
    ///
    /// # Safety
    /// `memory` is null or valid for `bytes` bytes that nobody else uses while the object lives.
    pub(crate) unsafe fn room(&mut self, memory: *mut c_void, bytes: usize) -> Result<Room> {
        let head = memory.cast::<Head>();
        check(head, "memory")?;
        self.claim(head.addr(), bytes, "memory")?;
        Ok(Room { head, bytes })
    }
}

/// An object that was found to be there.
pub(crate) struct Object<K: Kind>(*mut K::Content);

impl<K: Kind> Object<K> {
    /// To read it.
    pub(crate) fn get(&self) -> &K::Content {
        // SAFETY: the contract of `Pointers::object_at`.
        unsafe { &*self.0 }
    }

    /// To change it.
    pub(crate) fn get_mut(&mut self) -> &mut K::Content {
        // SAFETY: the contract of `Pointers::object_at`.
        unsafe { &mut *self.0 }
    }
}

fn content_of<K: Kind>(head: *mut Head) -> *mut K::Content {
    head.wrapping_add(1).cast()
}

/// Memory of the caller, for an object.
pub(crate) struct Room {
    head: *mut Head,
    bytes: usize,
}

impl Room {
    /// Makes an object with `count` elements, and with the content that `make` returns.
    ///
    /// An older object in this memory ends when its elements are overwritten. Its mark is cleared
    /// first, so that it is refused from then on, even if `make` fails.
    pub(crate) fn fill<K: Kind, E: Default + 'static>(
        self,
        count: usize,
        out: &Out<*mut K>,
        make: impl FnOnce(&'static mut [E]) -> Result<K::Content>,
    ) -> Result<()> {
        let needed = size::<K, E>(count).unwrap_or(usize::MAX);
        if self.bytes < needed {
            let found = self.bytes;
            return Err(Error::MemoryTooSmall { needed, found }.into());
        }
        let (head, content) = (self.head, content_of::<K>(self.head));
        let (mark, bytes) = (K::MARK, needed);
        // SAFETY: by the contract of `Pointers::room` the bytes are valid and nobody else uses
        // them. They suffice for head, content and elements, which lie apart and aligned, as `size`
        // asserts; each element is written before the slice is made.
        unsafe {
            head.write(Head { mark: 0, bytes });
            let first = content.add(1).cast::<E>();
            for n in 0..count {
                first.add(n).write(E::default());
            }
            content.write(make(std::slice::from_raw_parts_mut(first, count))?);
            head.write(Head { mark, bytes });
        }
        out.set(head.cast());
        Ok(())
    }
}
