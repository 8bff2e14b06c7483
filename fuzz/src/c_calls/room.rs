//! The caller's memory: numbers that arrays are parts of, and slots that objects are made in.

use arbitrary::Arbitrary;
use std::ffi::c_void;

/// An array somewhere in the numbers, of any length that there is; or null; or not aligned.
#[derive(Arbitrary, Debug, Clone, Copy)]
pub struct Array {
    from: u8,
    count: u8,
    kind: ArrayKind,
}

#[derive(Arbitrary, Debug, Clone, Copy)]
enum ArrayKind {
    Whole,
    Usual,
    Halved,
    Askew,
    Null,
}

/// One of the places for objects, and how much of it is offered.
#[derive(Arbitrary, Debug, Clone, Copy)]
pub struct Slot {
    which: u8,
    words: Option<u16>,
    kind: SlotKind,
}

#[derive(Arbitrary, Debug, Clone, Copy)]
enum SlotKind {
    Usual,
    AlsoUsual,
    Askew,
    Null,
}

const NUMBERS: usize = 64;
/// Enough for every object of the levels that are drawn.
const WORDS: usize = 4096;

pub struct Room {
    pub numbers: Vec<u64>,
    slots: [Vec<u64>; 4],
}

impl Default for Room {
    fn default() -> Self {
        let ramp = (0..NUMBERS).map(|n| (n as f64).to_bits());
        Self {
            numbers: ramp.collect(),
            slots: std::array::from_fn(|_| vec![0; WORDS]),
        }
    }
}

impl Room {
    pub fn doubles(&mut self, array: Array) -> (*mut f64, usize) {
        let (at, bytes) = self.part(array);
        (at.cast(), bytes / 8)
    }

    pub fn ints(&mut self, array: Array) -> (*mut i32, usize) {
        let (at, bytes) = self.part(array);
        (at.cast(), bytes / 4)
    }

    /// A part of the numbers in bytes, for one number at least.
    fn part(&mut self, array: Array) -> (*mut u8, usize) {
        let from = usize::from(array.from) % (NUMBERS - 1);
        let most = NUMBERS - 1 - from;
        let words = match array.kind {
            ArrayKind::Whole => most,
            _ => 1 + usize::from(array.count) % most,
        };
        let shift = match array.kind {
            ArrayKind::Whole | ArrayKind::Usual => 0,
            ArrayKind::Halved => 4,
            ArrayKind::Askew => 1,
            ArrayKind::Null => return (std::ptr::null_mut(), 8 * words),
        };
        let first = &raw mut self.numbers[..];
        (first.cast::<u8>().wrapping_add(8 * from + shift), 8 * words)
    }

    pub fn memory(&mut self, slot: Slot) -> (*mut c_void, usize) {
        let bytes = 8 * slot
            .words
            .map_or(WORDS - 1, |words| usize::from(words) % WORDS);
        let first = self.slots[usize::from(slot.which) % 4].as_mut_ptr();
        let at = match slot.kind {
            SlotKind::Usual | SlotKind::AlsoUsual => first.cast(),
            SlotKind::Askew => first.cast::<u8>().wrapping_add(1).cast(),
            SlotKind::Null => std::ptr::null_mut(),
        };
        (at, bytes)
    }
}
