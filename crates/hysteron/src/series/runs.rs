//! Values of samples that keep the same value for long: runs instead of a value for each.

use std::ops::Range;

/// One value for each sample, kept as runs of equal values. It takes memory for the runs, and a
/// little for the samples.
#[derive(Debug, Clone, Default)]
pub(crate) struct Runs<T> {
    /// The first sample of each run, and the value of all of them.
    runs: Vec<(usize, T)>,
    /// For every [`BLOCK`] samples, the run of the first of them. From there it is not far to any.
    of_block: Vec<u32>,
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
            // No more runs than samples, and of these no memory holds 2³².
            self.of_block.push((self.runs.len() - 1) as u32);
        }
        self.len += 1;
    }

    /// The value of a sample that was added.
    #[inline]
    pub(crate) fn at(&self, sample: usize) -> T {
        let mut run = self.of_block[sample / BLOCK] as usize;
        while self
            .runs
            .get(run + 1)
            .is_some_and(|(first, _)| *first <= sample)
        {
            run += 1;
        }
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

impl<T: Copy + PartialEq> Extend<T> for Runs<T> {
    fn extend<I: IntoIterator<Item = T>>(&mut self, values: I) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

impl<T: Copy + PartialEq> FromIterator<T> for Runs<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        let mut runs = Self {
            runs: Vec::new(),
            of_block: Vec::new(),
            len: 0,
        };
        runs.extend(values);
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
