//! Finds the ends of cells and lines in a text, 64 bytes at a time. Cells are so short that a search
//! that starts anew for each of them costs more.

use wide::u8x16;

/// The places of four bytes in a text, in order.
#[derive(Default)]
pub(super) struct Marks {
    places: Vec<u32>,
}

const LANES: usize = 16;

impl Marks {
    pub(super) fn places(&self) -> &[u32] {
        &self.places
    }

    /// Finds the places of `bytes` in a text of less than 4 GiB.
    pub(super) fn find(&mut self, text: &[u8], bytes: [u8; 4]) {
        self.places.clear();
        let bytes = bytes.map(u8x16::splat);
        let (words, rest) = text.as_chunks::<{ 4 * LANES }>();
        let mut start = 0;
        for word in words {
            self.push(start, found(word, bytes));
            start += word.len() as u32;
        }
        let mut last = [0; 4 * LANES];
        last[..rest.len()].copy_from_slice(rest);
        self.push(start, found(&last, bytes) & !(u64::MAX << rest.len()));
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
        for round in 0..20_000 {
            let length = round % 200;
            let byte = |_| match random.next_u32() % 4 {
                0 => random.next_u32() as u8,
                _ => alphabet[random.next_u32() as usize % alphabet.len()],
            };
            let text: Vec<u8> = (0..length).map(byte).collect();
            let is_mark = |n: &u32| matches!(text[*n as usize], b',' | b'\n' | b'\r' | b'"');
            let expected: Vec<u32> = (0..length).filter(is_mark).collect();
            marks.find(&text, [b',', b'\n', b'\r', b'"']);
            assert_eq!(marks.places(), expected, "{text:?}");
        }
    }
}
