//! `Wᵀ W`, the Gram matrix over Everett corners, stored sparse. The one over weights follows from it
//! by sums over the plane, see [`Layout`].

use crate::identify::weights::grid_factor::Pattern;
use crate::identify::weights::layout::Layout;
use crate::identify::weights::rows::Term;
use crate::identify::weights::sparse::Accumulate;
use hysteron_core::{operator_index, operators};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
use std::sync::{Arc, OnceLock};

/// A symmetric matrix over corners, row by row.
#[derive(Debug, Clone)]
pub(crate) struct CornerGram {
    pub(crate) layout: Arc<Layout>,
    /// Where each row begins, and where the last one ends.
    pub(crate) starts: Vec<usize>,
    pub(crate) places: Vec<u32>,
    pub(crate) values: Vec<f64>,
    /// The structure of the factors, shared by all matrices whose elements are among these.
    pattern: Arc<OnceLock<Option<Pattern>>>,
    /// Whether its factors are sparse, too.
    pub(crate) is_factored: bool,
    /// The diagonal over the weights, once it was asked for.
    diagonal: OnceLock<Vec<f64>>,
}

impl CornerGram {
    pub(crate) fn pattern(&self) -> Option<&Pattern> {
        let pattern = || Pattern::new(&self.layout, &self.starts, &self.places);
        self.pattern.get_or_init(pattern).as_ref()
    }

    /// The elements at the places of a pattern.
    pub(crate) fn elements(&self, pattern: &Pattern) -> Vec<f64> {
        let mut values = vec![0.0; pattern.rows.len()];
        for column in 0..self.layout.count {
            let mut at = pattern.starts[column];
            for k in self.starts[column]..self.starts[column + 1] {
                let row = self.places[k] as usize;
                if row < column {
                    continue;
                }
                while pattern.rows[at] < row {
                    at += 1;
                }
                values[at] = self.values[k];
            }
        }
        values
    }

    /// `Sᵀ G S x`.
    pub(crate) fn times(&self, x: &[f64]) -> Vec<f64> {
        let corners = self.layout.corners(x);
        self.layout.gathered(&self.times_corners(&corners))
    }

    fn times_corners(&self, corners: &[f64]) -> Vec<f64> {
        let row = |n: usize| {
            let range = self.starts[n]..self.starts[n + 1];
            let elements = self.places[range.clone()].iter().zip(&self.values[range]);
            elements
                .map(|(place, value)| value * corners[*place as usize])
                .sum()
        };
        (0..self.layout.count).map(row).collect()
    }

    /// The diagonal over the weights.
    pub(crate) fn diagonal(&self) -> &[f64] {
        self.diagonal.get_or_init(|| self.over_weights())
    }

    fn over_weights(&self) -> Vec<f64> {
        let layout = &self.layout;
        let places: Vec<(usize, usize)> = operators(layout.levels()).collect();
        let mut own = vec![None; layout.count];
        for (b, block) in layout.blocks.iter().enumerate() {
            for (column, place) in block.columns.iter().zip(&places) {
                if *column != Term::NOWHERE {
                    own[*column as usize] = Some((b, *place));
                }
            }
        }
        // An element of two corners is part of the diagonal elements of all operators that are part
        // of both corners. Those are the operators of the corner where the two meet.
        let mut sums = vec![0.0; layout.count];
        for n in 0..layout.count {
            for k in self.starts[n]..self.starts[n + 1] {
                let (Some((a, (i, j))), Some((b, (k_i, k_j)))) =
                    (own[n], own[self.places[k] as usize])
                else {
                    continue;
                };
                let (i, j) = (i.max(k_i), j.min(k_j));
                if a == b && i <= j {
                    let column = layout.blocks[a].columns[operator_index(i, j)];
                    if column != Term::NOWHERE {
                        sums[column as usize] += self.values[k];
                    }
                }
            }
        }
        layout.gathered(&sums)
    }

    /// Takes the structure of a matrix that has all elements of this one.
    pub(crate) fn share_pattern(&mut self, whole: &Self) {
        self.pattern = whole.pattern.clone();
    }

    /// All elements over weights, row by row.
    pub(crate) fn dense(&self) -> Vec<f64> {
        let count = self.layout.count;
        let mut half = vec![0.0; count * count];
        for (n, row) in half.chunks_exact_mut(count).enumerate() {
            for k in self.starts[n]..self.starts[n + 1] {
                row[self.places[k] as usize] = self.values[k];
            }
        }
        if let Some(form) = self.layout.whole_plane() {
            form.gram_of(&mut half);
            return half;
        }
        for row in half.chunks_exact_mut(count) {
            let gathered = self.layout.gathered(row);
            row.copy_from_slice(&gathered);
        }
        let mut all = vec![0.0; count * count];
        for n in 0..count {
            let column: Vec<f64> = (0..count).map(|row| half[row * count + n]).collect();
            all[n * count..][..count].copy_from_slice(&self.layout.gathered(&column));
        }
        all
    }

    /// This matrix plus `factor` times the other.
    pub(crate) fn combine(&mut self, factor: f64, other: &Self) {
        let mut starts = vec![0];
        let mut places = Vec::with_capacity(self.places.len());
        let mut values = Vec::with_capacity(self.places.len());
        let mut grown = false;
        for n in 0..self.layout.count {
            let (mut a, mut b) = (self.starts[n], other.starts[n]);
            loop {
                let left = (a < self.starts[n + 1]).then(|| self.places[a]);
                let right = (b < other.starts[n + 1]).then(|| other.places[b]);
                let Some(place) = [left, right].into_iter().flatten().min() else {
                    break;
                };
                let mut value = 0.0;
                if left == Some(place) {
                    value += self.values[a];
                    a += 1;
                } else {
                    grown = true;
                }
                if right == Some(place) {
                    value += factor * other.values[b];
                    b += 1;
                }
                places.push(place);
                values.push(value);
            }
            starts.push(places.len());
        }
        if grown && !Arc::ptr_eq(&self.pattern, &other.pattern) {
            self.pattern = Arc::default();
        }
        (self.starts, self.places, self.values) = (starts, places, values);
        self.diagonal = OnceLock::new();
    }
}

/// Sums of elements as they come.
#[derive(Default)]
pub(crate) struct CornerSums {
    /// The elements in use last. A branch adds to the same few elements many times.
    recent: Vec<(u64, f64)>,
    rest: HashMap<u64, f64, BuildHasherDefault<Mixed>>,
}

/// Number of elements in use last, a power of two.
const RECENT: usize = 1 << 10;

/// No element has this key.
const NONE: u64 = u64::MAX;

fn mixed(key: u64) -> u64 {
    (key ^ (key >> 29)).wrapping_mul(0x9e37_79b9_7f4a_7c15)
}

impl CornerSums {
    fn add(&mut self, row: u32, column: u32, value: f64) {
        let key = (u64::from(row) << 32) | u64::from(column);
        if self.recent.is_empty() {
            self.recent = vec![(NONE, 0.0); RECENT];
        }
        let slot = (mixed(key) >> 54) as usize;
        let held = &mut self.recent[slot];
        if held.0 == key {
            held.1 += value;
            return;
        }
        let (old, sum) = std::mem::replace(held, (key, value));
        if old != NONE {
            *self.rest.entry(old).or_insert(0.0) += sum;
        }
    }

    pub(crate) fn into_gram(mut self, layout: &Arc<Layout>) -> CornerGram {
        for (key, sum) in self.recent {
            if key != NONE {
                *self.rest.entry(key).or_insert(0.0) += sum;
            }
        }
        let mut elements: Vec<(u64, f64)> = self.rest.into_iter().collect();
        elements.sort_unstable_by_key(|(key, _)| *key);
        let mut starts = vec![0; layout.count + 1];
        for (key, _) in &elements {
            starts[(key >> 32) as usize + 1] += 1;
        }
        for n in 0..layout.count {
            starts[n + 1] += starts[n];
        }
        CornerGram {
            layout: layout.clone(),
            starts,
            places: elements.iter().map(|(key, _)| *key as u32).collect(),
            values: elements.into_iter().map(|(_, sum)| sum).collect(),
            pattern: Arc::default(),
            is_factored: true,
            diagonal: OnceLock::new(),
        }
    }
}

/// The sums of two blocks, which have their own columns for each operator.
pub(crate) struct OfBlocks<'a> {
    pub(crate) sums: &'a mut CornerSums,
    pub(crate) left: &'a [u32],
    pub(crate) right: &'a [u32],
    /// Whether the blocks differ, so that the other half of the matrix is not added by itself.
    pub(crate) mirror: bool,
}

impl Accumulate for OfBlocks<'_> {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        let (a, b) = (self.left[row], self.right[column]);
        // Corners that no column reaches are zero.
        if a == Term::NOWHERE || b == Term::NOWHERE || value == 0.0 {
            return;
        }
        self.sums.add(a, b, value);
        if self.mirror {
            self.sums.add(b, a, value);
        }
    }
}

/// A hash of keys that are numbers.
#[derive(Default)]
pub(crate) struct Mixed(u64);

impl Hasher for Mixed {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = mixed(self.0 ^ u64::from(*byte));
        }
    }

    fn write_u64(&mut self, key: u64) {
        self.0 = mixed(key);
    }
}
