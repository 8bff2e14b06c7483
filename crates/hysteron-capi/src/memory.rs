//! Memory of the caller, for the numbers of an object.

use crate::fault::Result;
use crate::pointer::{Arguments, check};
use hysteron_core::{Error, Turn};
use std::ffi::c_void;
use std::ops::Range;

/// How much memory an object takes.
#[derive(Clone, Copy)]
pub(crate) struct Size {
    pub(crate) numbers: usize,
    pub(crate) turns: usize,
}

impl Size {
    pub(crate) fn bytes(self) -> usize {
        let numbers = self.numbers.saturating_mul(size_of::<f64>());
        numbers.saturating_add(self.turns.saturating_mul(size_of::<Turn<f64>>()))
    }

    /// Both.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            numbers: self.numbers + other.numbers,
            turns: self.turns + other.turns,
        }
    }

    /// `count` of them.
    pub(crate) fn times(self, count: usize) -> Self {
        Self {
            numbers: count * self.numbers,
            turns: count * self.turns,
        }
    }
}

/// Memory that the caller offers.
pub(crate) struct Room {
    start: *mut c_void,
    bytes: usize,
}

impl Arguments {
    /// Memory for an object.
    ///
    /// # Safety
    /// `memory` is null or valid for `bytes` bytes that nobody else uses while the object lives.
    pub(crate) unsafe fn room(&mut self, memory: *mut c_void, bytes: usize) -> Result<Room> {
        check(memory.cast::<u64>(), "memory")?;
        self.claim(memory.addr(), bytes, "memory")?;
        let start = memory;
        Ok(Room { start, bytes })
    }
}

impl Room {
    /// Lends memory of this size, filled with zeros. `end` ends the objects that were there.
    pub(crate) fn lend(self, size: Size, end: impl FnOnce(&Range<usize>)) -> Result<Lent> {
        let (needed, found) = (size.bytes(), self.bytes);
        if found < needed {
            return Err(Error::MemoryTooSmall { needed, found }.into());
        }
        let from = self.start.addr();
        let range = from..from + needed;
        end(&range);
        let numbers = self.start.cast::<f64>();
        let turns = numbers.wrapping_add(size.numbers).cast::<Turn<f64>>();
        const { assert!(align_of::<Turn<f64>>() <= align_of::<f64>()) };
        // SAFETY: by the contract of `Arguments::room` the bytes are valid and nobody else uses
        // them. They suffice for numbers and turns, which lie apart and aligned; each is written
        // before the slice is made.
        unsafe {
            (0..size.numbers).for_each(|n| numbers.add(n).write(0.0));
            (0..size.turns).for_each(|n| turns.add(n).write(Turn::default()));
            Ok(Lent {
                numbers: std::slice::from_raw_parts_mut(numbers, size.numbers),
                turns: std::slice::from_raw_parts_mut(turns, size.turns),
                range,
            })
        }
    }
}

/// Memory that was lent, and is given away in parts.
pub(crate) struct Lent {
    numbers: &'static mut [f64],
    turns: &'static mut [Turn<f64>],
    pub(crate) range: Range<usize>,
}

impl Lent {
    pub(crate) fn numbers(&mut self, count: usize) -> &'static mut [f64] {
        part(&mut self.numbers, count)
    }

    pub(crate) fn turns(&mut self, count: usize) -> &'static mut [Turn<f64>] {
        part(&mut self.turns, count)
    }
}

/// The first `count` elements, or as many as there are.
fn part<E>(all: &mut &'static mut [E], count: usize) -> &'static mut [E] {
    let rest = std::mem::take(all);
    let (part, rest) = rest.split_at_mut(count.min(rest.len()));
    *all = rest;
    part
}
