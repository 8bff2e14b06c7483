//! Finds the ends of cells and lines in a text, sixteen bytes at a time. Cells are so short that a
//! search that starts anew for each of them costs more.

use wide::u8x16;

/// The places of four bytes in a text, in order.
pub(super) struct Marks<'t> {
    words: &'t [[u8; SIZE]],
    rest: &'t [u8],
    bytes: [u8x16; 4],
    /// Where the next word begins.
    at: usize,
    /// A bit for each byte of the word before that is one of them.
    found: u32,
}

const SIZE: usize = 16;

impl<'t> Marks<'t> {
    /// The bytes are not 0.
    pub(super) fn new(text: &'t [u8], bytes: [u8; 4]) -> Self {
        let (words, rest) = text.as_chunks();
        Self {
            words,
            rest,
            bytes: bytes.map(u8x16::splat),
            at: 0,
            found: 0,
        }
    }

    #[inline]
    fn search(&mut self, word: [u8; SIZE]) {
        let word = u8x16::new(word);
        let [a, b, c, d] = self.bytes.map(|byte| word.simd_eq(byte));
        self.found = (a | b | c | d).to_bitmask();
        self.at += SIZE;
    }
}

impl Iterator for Marks<'_> {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        while self.found == 0 {
            if let Some((word, words)) = self.words.split_first() {
                self.words = words;
                self.search(*word);
            } else if self.rest.is_empty() {
                return None;
            } else {
                let mut word = [0; SIZE];
                word[..self.rest.len()].copy_from_slice(self.rest);
                self.rest = &[];
                self.search(word);
            }
        }
        let place = self.at - SIZE + self.found.trailing_zeros() as usize;
        self.found &= self.found - 1;
        Some(place)
    }
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
        for round in 0..20_000 {
            let length = round % 40;
            let byte = |_| match random.next_u32() % 4 {
                0 => random.next_u32() as u8,
                _ => alphabet[random.next_u32() as usize % alphabet.len()],
            };
            let text: Vec<u8> = (0..length).map(byte).collect();
            let is_mark = |n: &usize| matches!(text[*n], b',' | b'\n' | b'\r' | b'"');
            let expected: Vec<usize> = (0..length).filter(is_mark).collect();
            let found: Vec<usize> = Marks::new(&text, [b',', b'\n', b'\r', b'"']).collect();
            assert_eq!(found, expected, "{text:?}");
        }
    }
}
