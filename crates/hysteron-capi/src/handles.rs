//! Handles: numbers that identify an object. After the object is freed, its handle is refused.

use crate::codes::{HYSTERON_HANDLE, HYSTERON_VALUE};
use crate::fault::{Fault, Result};
use std::sync::{Arc, PoisonError, RwLock};

/// A handle has 8 bits for the kind of object, 24 for the generation of its slot and 32 for the
/// index of the slot. It is never 0.
pub(crate) struct Table<T> {
    kind: u8,
    slots: RwLock<Slots<T>>,
}

struct Slots<T> {
    all: Vec<Slot<T>>,
    free: Vec<u32>,
}

impl<T> Slots<T> {
    /// Takes an object out of its slot, whose handle is not valid from then on.
    fn clear(&mut self, index: usize) -> Option<Arc<T>> {
        let slot = &mut self.all[index];
        let object = slot.object.take()?;
        if slot.generation < LAST_GENERATION {
            slot.generation += 1;
            self.free.push(index as u32);
        }
        Some(object)
    }
}

struct Slot<T> {
    generation: u32,
    object: Option<Arc<T>>,
}

/// A slot of this generation is not used again, so that no handle comes twice.
const LAST_GENERATION: u32 = (1 << 24) - 1;

impl<T> Table<T> {
    /// `kind` is not 0, and differs between tables.
    pub(crate) const fn new(kind: u8) -> Self {
        let slots = RwLock::new(Slots {
            all: Vec::new(),
            free: Vec::new(),
        });
        Self { kind, slots }
    }

    pub(crate) fn insert(&self, object: T) -> Result<u64> {
        let mut slots = self.slots.write().unwrap_or_else(PoisonError::into_inner);
        let index = match slots.free.pop() {
            Some(index) => index,
            None => {
                let Ok(index) = u32::try_from(slots.all.len()) else {
                    return Err(Fault::Call(HYSTERON_VALUE, "too many objects"));
                };
                let (generation, object) = (0, None);
                slots.all.push(Slot { generation, object });
                index
            }
        };
        let slot = &mut slots.all[index as usize];
        slot.object = Some(Arc::new(object));
        Ok(u64::from(self.kind) << 56 | u64::from(slot.generation) << 32 | u64::from(index))
    }

    pub(crate) fn get(&self, handle: u64, name: &'static str) -> Result<Arc<T>> {
        let slots = self.slots.read().unwrap_or_else(PoisonError::into_inner);
        let slot = slots.all.get(self.slot(handle, name)?);
        let slot = slot.filter(|slot| slot.generation == generation(handle));
        let object = slot.and_then(|slot| slot.object.clone());
        object.ok_or(Fault::Call(HYSTERON_HANDLE, name))
    }

    /// Calls in other threads that use the object at this moment end regularly.
    pub(crate) fn remove(&self, handle: u64, name: &'static str) -> Result<()> {
        let mut slots = self.slots.write().unwrap_or_else(PoisonError::into_inner);
        let index = self.slot(handle, name)?;
        let slot = slots.all.get(index);
        let live = slot.is_some_and(|slot| slot.generation == generation(handle));
        let object = if live { slots.clear(index) } else { None };
        drop(slots);
        object.map(drop).ok_or(Fault::Call(HYSTERON_HANDLE, name))
    }

    /// Removes the objects that are `meant`.
    pub(crate) fn end_where(&self, meant: impl Fn(&T) -> bool) {
        let mut slots = self.slots.write().unwrap_or_else(PoisonError::into_inner);
        for index in 0..slots.all.len() {
            if slots.all[index].object.as_deref().is_some_and(&meant) {
                slots.clear(index);
            }
        }
    }

    fn slot(&self, handle: u64, name: &'static str) -> Result<usize> {
        if handle >> 56 != u64::from(self.kind) {
            return Err(Fault::Call(HYSTERON_HANDLE, name));
        }
        Ok(handle as u32 as usize)
    }
}

fn generation(handle: u64) -> u32 {
    (handle >> 32) as u32 & LAST_GENERATION
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_handle_names_its_object_and_nothing_after_it() {
        let table = Table::new(1);
        let first = table.insert("first").ok().unwrap();
        assert!(table.remove(first, "").is_ok());
        let second = table.insert("second").ok().unwrap();
        assert_eq!(first as u32, second as u32, "the slot is used again");
        assert!(table.get(first, "").is_err());
        assert!(table.remove(first, "").is_err());
        assert_eq!(*table.get(second, "").ok().unwrap(), "second");
        assert!(Table::<u8>::new(2).get(second, "").is_err());
        assert!(table.get(0, "").is_err());
        assert!(table.get(u64::MAX, "").is_err());
    }
}
