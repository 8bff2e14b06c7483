//! Finds rows that come twice, as when a logger writes a block again.

use crate::series::spread::quantile;
use std::collections::HashMap;
use std::ops::Range;

/// Fewer equal rows in a row may be chance.
const SHORTEST: usize = 8;
/// Where a block begins again, the series go back by more than so many times their usual steps, and
/// where it ends they go forward. A cycle that repeats exactly goes on smoothly, also after a gap.
const SEAM: f64 = 3.0;

/// A block of rows, and the rows before it that are the same.
pub(crate) type Repeated = (Range<usize>, Range<usize>);

/// The blocks of rows that repeat earlier ones, bit by bit.
pub(crate) fn repeated(input: &[f64], output: &[f64]) -> Vec<Repeated> {
    let len = input.len().min(output.len());
    let row = |n: usize| (input[n].to_bits(), output[n].to_bits());
    // A series that stands still repeats itself.
    let changes = |start: usize| (start + 1..start + SHORTEST).all(|n| row(n) != row(n - 1));
    let key = |start: usize| -> [(u64, u64); SHORTEST] { std::array::from_fn(|k| row(start + k)) };
    let seams = [input, output].map(|values| {
        let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        SEAM * quantile(steps, 0.98)
    });
    let is_seam = |n: usize| {
        let step = |values: &[f64]| (values[n] - values[n - 1]).abs();
        n > 0 && (step(input) > seams[0] || step(output) > seams[1])
    };
    // Most series have none, and nothing is kept of them.
    if !(1..len).any(is_seam) {
        return Vec::new();
    }
    // Where rows like these stood first, and where they stood last.
    let mut places: HashMap<[(u64, u64); SHORTEST], (usize, usize)> = HashMap::new();
    let mut found = Vec::new();
    let mut n = 0;
    while n + SHORTEST <= len {
        if !changes(n) {
            n += 1;
            continue;
        }
        let place = places.entry(key(n)).or_insert((n, n));
        let (first, last) = *place;
        place.1 = n;
        if first == n || !is_seam(n) {
            n += 1;
            continue;
        }
        let same = |earlier: usize, n: usize| {
            let pairs = (0..len - n).take_while(|k| row(earlier + k) == row(n + k));
            pairs.count()
        };
        // The rows go on where the earlier ones ended, or elsewhere. A block may be made of
        // several, where one had been written into another before.
        let block = |earlier: usize| {
            let count = same(earlier, n);
            let of = earlier..earlier + count;
            let mut end = n + count;
            while of.end < n && end + SHORTEST <= len && !is_seam(end) {
                let (first, last) = *places.get(&key(end))?;
                let count = [first, last].map(|earlier| same(earlier, end));
                end += count[0].max(count[1]);
            }
            let goes_back = of.end >= n || end == len || is_seam(end);
            goes_back.then_some((n..end, of))
        };
        match [last, first].into_iter().find_map(block) {
            Some(block) => {
                n = block.0.end;
                found.push(block);
            }
            None => n += 1,
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_written_twice_is_found_and_a_cycle_is_not() {
        let input: Vec<f64> = (0..1000)
            .map(|n| f64::from((n % 200 - 100_i32).abs()))
            .collect();
        let output: Vec<f64> = input.iter().map(|x| x * x).collect();
        assert_eq!(repeated(&input, &output), vec![]);
        let again = |values: &[f64]| [&values[..350], &values[310..]].concat();
        let found = repeated(&again(&input), &again(&output));
        // The triangle has been there before: the first rows of that kind are named.
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].0.start, 350);
        assert!(found[0].0.len() >= 40);
    }
}
