//! Values of samples that keep the same value for long: runs instead of a value for each.

use std::ops::Range;

/// One value for each sample, kept as runs of equal values. It takes memory for the runs, and a
/// little for the samples.
#[derive(Debug, Clone)]
pub(crate) struct Runs<T> {
    /// The first sample of each run, and the value of all of them.
    runs: Vec<(usize, T)>,
    /// For every [`BLOCK`] samples, the run of the first of them. The others are in this run or in
    /// one shortly after it.
    of_block: Vec<usize>,
    len: usize,
}

const BLOCK: usize = 64;

impl<T: Copy + PartialEq> Runs<T> {
    /// Adds the value of the next sample.
    pub(crate) fn push(&mut self, value: T) {
        if self.runs.last().is_none_or(|(_, last)| *last != value) {
            self.runs.push((self.len, value));
        }
        if self.len.is_multiple_of(BLOCK) {
            self.of_block.push(self.runs.len() - 1);
        }
        self.len += 1;
    }

    /// The value of a sample that was added.
    #[inline]
    pub(crate) fn at(&self, sample: usize) -> T {
        debug_assert!(sample < self.len);
        let block = sample / BLOCK;
        let last = match self.of_block.get(block + 1) {
            Some(run) => *run,
            None => self.runs.len() - 1,
        };
        // The runs that begin in the block.
        let near = &self.runs[self.of_block[block] + 1..=last];
        let run = self.of_block[block] + near.partition_point(|(first, _)| *first <= sample);
        self.runs[run].1
    }

    /// The samples of each run, and their value.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (Range<usize>, T)> {
        let ends = self.runs.iter().skip(1).map(|(first, _)| *first);
        let all = self.runs.iter().zip(ends.chain([self.len]));
        all.map(|((first, value), end)| (*first..end, *value))
    }

    /// The value of each sample.
    pub(crate) fn values(&self) -> impl Iterator<Item = T> {
        self.iter()
            .flat_map(|(samples, value)| samples.map(move |_| value))
    }
}

impl<T> Default for Runs<T> {
    fn default() -> Self {
        Self {
            runs: Vec::new(),
            of_block: Vec::new(),
            len: 0,
        }
    }
}

impl<T: Copy + PartialEq> FromIterator<T> for Runs<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        let mut runs = Self::default();
        values.into_iter().for_each(|value| runs.push(value));
        runs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn values_are_those_that_were_added() {
        for round in 0..300 {
            let mut rng = ChaCha8Rng::seed_from_u64(round);
            let stays = rng.random_range(0.0..1.0);
            let mut value = 0;
            let values = (0..rng.random_range(0..1000)).map(|_| {
                if !rng.random_bool(stays) {
                    value = rng.random_range(0..3_u32);
                }
                value
            });
            let values: Vec<u32> = values.collect();
            let runs: Runs<u32> = values.iter().copied().collect();
            assert!(runs.values().eq(values.iter().copied()));
            for (n, value) in values.iter().enumerate() {
                assert_eq!(runs.at(n), *value, "round {round}, sample {n}");
            }
            for (samples, value) in runs.iter() {
                assert!(values[samples].iter().all(|own| *own == value));
            }
            assert_eq!(runs.runs.len(), values.chunk_by(|a, b| a == b).count());
        }
    }
}
