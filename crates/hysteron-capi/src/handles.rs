//! Handles: numbers that name an object, and name nothing once it is freed.

use crate::codes::{HYSTERON_HANDLE, HYSTERON_VALUE};
use crate::fault::{Fault, Result};
use std::sync::{Arc, PoisonError, RwLock};

/// A handle: 8 bits for the kind of object, 24 for how often its place was used, 32 for the place. Never 0.
pub(crate) struct Table<T> {
    kind: u8,
    places: RwLock<Places<T>>,
}

struct Places<T> {
    all: Vec<Place<T>>,
    free: Vec<u32>,
}

struct Place<T> {
    generation: u32,
    object: Option<Arc<T>>,
}

/// A place that was used so often is not used again: no handle comes twice.
const LAST_GENERATION: u32 = (1 << 24) - 1;

impl<T> Table<T> {
    /// `kind` is not 0, and each table's own.
    pub(crate) const fn new(kind: u8) -> Self {
        let places = RwLock::new(Places {
            all: Vec::new(),
            free: Vec::new(),
        });
        Self { kind, places }
    }

    pub(crate) fn insert(&self, object: T) -> Result<u64> {
        let mut places = self.places.write().unwrap_or_else(PoisonError::into_inner);
        let index = match places.free.pop() {
            Some(index) => index,
            None => {
                let Ok(index) = u32::try_from(places.all.len()) else {
                    return Err(Fault::Call(HYSTERON_VALUE, "too many objects"));
                };
                let (generation, object) = (0, None);
                places.all.push(Place { generation, object });
                index
            }
        };
        let place = &mut places.all[index as usize];
        place.object = Some(Arc::new(object));
        Ok(u64::from(self.kind) << 56 | u64::from(place.generation) << 32 | u64::from(index))
    }

    pub(crate) fn get(&self, handle: u64, name: &'static str) -> Result<Arc<T>> {
        let places = self.places.read().unwrap_or_else(PoisonError::into_inner);
        let place = places.all.get(self.place(handle, name)?);
        let place = place.filter(|place| place.generation == generation(handle));
        let object = place.and_then(|place| place.object.clone());
        object.ok_or(Fault::Call(HYSTERON_HANDLE, name))
    }

    /// What the object is used for at this moment in other threads comes to its end.
    pub(crate) fn remove(&self, handle: u64, name: &'static str) -> Result<()> {
        let mut places = self.places.write().unwrap_or_else(PoisonError::into_inner);
        let index = self.place(handle, name)?;
        let place = places.all.get_mut(index);
        let place = place.filter(|place| place.generation == generation(handle));
        let Some((place, object)) = place.and_then(|place| {
            let object = place.object.take()?;
            Some((place, object))
        }) else {
            return Err(Fault::Call(HYSTERON_HANDLE, name));
        };
        if place.generation < LAST_GENERATION {
            place.generation += 1;
            places.free.push(index as u32);
        }
        drop(places);
        drop(object);
        Ok(())
    }

    fn place(&self, handle: u64, name: &'static str) -> Result<usize> {
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
        assert_eq!(first as u32, second as u32, "the place is used again");
        assert!(table.get(first, "").is_err());
        assert!(table.remove(first, "").is_err());
        assert_eq!(*table.get(second, "").ok().unwrap(), "second");
        assert!(Table::<u8>::new(2).get(second, "").is_err());
        assert!(table.get(0, "").is_err());
        assert!(table.get(u64::MAX, "").is_err());
    }
}
