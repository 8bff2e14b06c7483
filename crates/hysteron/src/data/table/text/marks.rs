//! Finds the ends of cells and lines in a text, 64 bytes at a time. Cells are so short that a search
//! that starts anew for each of them costs more.

use wide::u8x16;

/// The places of four bytes in a text, in order. They are searched for as far as they are needed.
#[derive(Default)]
pub(super) struct Marks {
    /// Places that were found, of which the first `passed` are behind.
    places: Vec<u32>,
    passed: usize,
    /// The text has been searched up to here, and so many bytes come next.
    searched: usize,
    piece: usize,
}

const LANES: usize = 16;

/// The bytes that are searched at once, first and at most. Where few rows are plain, a walk ends soon.
const FIRST: usize = 1 << 7;
const MOST: usize = 1 << 10;

impl Marks {
    /// Begins another text.
    pub(super) fn begin(&mut self) {
        self.places.clear();
        self.passed = 0;
        self.searched = 0;
        self.piece = FIRST;
    }

    /// The next places of `bytes` in the text, which has less than 4 GiB: `count` of them or more,
    /// unless it ends before.
    #[inline]
    pub(super) fn ahead(&mut self, text: &[u8], bytes: [u8; 4], count: usize) -> &[u32] {
        while self.places.len() < self.passed + count && self.searched < text.len() {
            self.search(text, bytes);
        }
        &self.places[self.passed..]
    }

    /// Leaves so many of the next places behind.
    pub(super) fn pass(&mut self, count: usize) {
        self.passed += count;
    }

    /// Searches the next piece of the text.
    fn search(&mut self, text: &[u8], bytes: [u8; 4]) {
        self.places.drain(..self.passed);
        self.passed = 0;
        let bytes = bytes.map(u8x16::splat);
        let end = text.len().min(self.searched + self.piece);
        let (words, rest) = text[self.searched..end].as_chunks::<{ 4 * LANES }>();
        let mut start = self.searched as u32;
        for word in words {
            self.push(start, found(word, bytes));
            start += word.len() as u32;
        }
        if !rest.is_empty() {
            let mut last = [0; 4 * LANES];
            last[..rest.len()].copy_from_slice(rest);
            self.push(start, found(&last, bytes) & !(u64::MAX << rest.len()));
        }
        self.searched = end;
        self.piece = MOST.min(2 * self.piece);
    }

    /// Adds the place of each bit that is set.
    #[inline]
    fn push(&mut self, start: u32, mut found: u64) {
        while found != 0 {
            self.places.push(start + found.trailing_zeros());
            found &= found - 1;
        }
    }
}

/// A bit for each byte of the word that is one of the bytes.
#[inline]
fn found(word: &[u8; 4 * LANES], bytes: [u8x16; 4]) -> u64 {
    let (lanes, _) = word.as_chunks::<LANES>();
    let bits = lanes.iter().zip([0, 16, 32, 48]).map(|(lane, shift)| {
        let lane = u8x16::new(*lane);
        let [a, b, c, d] = bytes.map(|byte| lane.simd_eq(byte));
        u64::from((a | b | c | d).to_bitmask()) << shift
    });
    bits.fold(0, |all, bits| all | bits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    #[test]
    fn marks_are_those_of_a_search_byte_by_byte() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let alphabet = [
            b',',
            b'\n',
            b',' + 1,
            b',' - 1,
            b',' | 0x80,
            0,
            0xff,
            b'\r',
            b'"',
            b'a',
            b'\n' | 0x80,
        ];
        let mut marks = Marks::default();
        for round in 0..6000 {
            let length = round % 3000;
            let byte = |_| match random.next_u32() % 4 {
                0 => random.next_u32() as u8,
                _ => alphabet[random.next_u32() as usize % alphabet.len()],
            };
            let text: Vec<u8> = (0..length).map(byte).collect();
            let is_mark = |n: &u32| matches!(text[*n as usize], b',' | b'\n' | b'\r' | b'"');
            let expected: Vec<u32> = (0..length).filter(is_mark).collect();
            marks.begin();
            let mut all = Vec::new();
            loop {
                let count = random.next_u32() as usize % 9;
                let ahead = marks.ahead(&text, [b',', b'\n', b'\r', b'"'], count + 1);
                let taken = ahead.len().min(count + 1);
                if taken == 0 {
                    break;
                }
                all.extend_from_slice(&ahead[..taken]);
                marks.pass(taken);
            }
            assert_eq!(all, expected, "{text:?}");
        }
    }

    /// A row that is not plain ends the walk at once: then most of a text must not be searched yet.
    #[test]
    fn no_more_is_searched_than_is_needed() {
        let text = vec![b','; 100_000];
        let mut marks = Marks::default();
        marks.begin();
        marks.ahead(&text, [b',', b'\n', b'\r', b'"'], 5);
        assert!(marks.searched <= FIRST, "{}", marks.searched);
    }
}
