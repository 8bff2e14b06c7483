//! The Everett function of the model: what the output loses when the input falls from `M` to `m`.
//!
//! An MKP operator is the average of ideal relays whose thresholds lie on the diagonal of its grid
//! cell, so the whole model is a classical Preisach model. Its Everett function on grid corners is
//! the prefix sum `C[p][q] = Σ μ_ij over j ≤ p, i > q`, and between corners it is exactly piecewise
//! linear on triangles (Everett 1955; Mayergoyz 1991).

use crate::error::{Error, NegativeWeights};
use crate::plane::{operator_count, operator_index};
use crate::scalar::Real;

/// Elements of the table for `levels` levels: `(K + 1)(K + 2)/2`, the corners `0 ≤ q ≤ p ≤ K`.
#[must_use]
pub const fn table_len(levels: usize) -> usize {
    (levels + 1) * (levels + 2) / 2
}

/// Place of `C[p][q]`, `0 ≤ q ≤ p ≤ K`, in the table.
#[must_use]
pub const fn table_index(p: usize, q: usize) -> usize {
    p * (p + 1) / 2 + q
}

/// Checks `weights` and tells which are negative.
pub(crate) fn check<T: Real>(
    levels: usize,
    weights: &[T],
) -> Result<Option<NegativeWeights>, Error> {
    let (expected, found) = (operator_count(levels), weights.len());
    if expected != found {
        return Err(Error::WeightCount { expected, found });
    }
    let mut negative: Option<NegativeWeights> = None;
    // No output can be larger than this, twice for operators of ±1.
    let mut size = T::ZERO;
    for j in 1..=levels {
        for i in 1..=j {
            let index = operator_index(i, j);
            let weight = weights[index];
            size = size + weight.max(-weight);
            if !(size + size).is_finite() {
                return Err(Error::WeightNotFinite { index });
            }
            if weight < T::ZERO {
                let which = negative.get_or_insert(NegativeWeights {
                    count: 0,
                    first: [None; 3],
                });
                if let Some(free) = which.first.iter_mut().find(|place| place.is_none()) {
                    *free = Some((i, j));
                }
                which.count += 1;
            }
        }
    }
    Ok(negative)
}

/// Writes the table of `weights` to the front of `table`.
pub(crate) fn fill<T: Real>(levels: usize, weights: &[T], table: &mut [T]) {
    table[0] = T::ZERO;
    for p in 1..=levels {
        let (above, row) = rows(table, p);
        fill_row(p, weights, above, row);
    }
}

/// Row `p ≥ 1` of a table and the one above it.
pub(crate) fn rows<T>(table: &mut [T], p: usize) -> (&[T], &mut [T]) {
    let (above, row) = table[table_index(p - 1, 0)..].split_at_mut(p);
    (above, &mut row[..=p])
}

/// Row `p` of the table of `weights` from the row above it.
///
/// Row sums first, then rows on rows, so that every entry is a sum of at most `2K` terms and
/// weights that are exactly zero leave neighbouring entries exactly equal.
pub(crate) fn fill_row<T: Real>(p: usize, weights: &[T], above: &[T], row: &mut [T]) {
    row[p] = T::ZERO;
    let weights = &weights[operator_index(1, p)..][..p];
    let mut sum = T::ZERO;
    for q in (0..p).rev() {
        sum = sum + weights[q];
        row[q] = above[q] + sum;
    }
}

/// A normalised input split into its grid cell and the place within it: `x = cell + part`, `0 ≤ part ≤ 1`.
///
/// On a grid line it is either of the two cells: the Everett function is continuous. `x = K` is the
/// far end of the last cell, so that a cell always has a corner beyond it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Split<T> {
    pub(crate) cell: usize,
    pub(crate) part: T,
}

impl<T: Real> Split<T> {
    #[inline(always)]
    pub(crate) fn of(x: T, levels: usize) -> Self {
        let middle = (x - T::HALF).min(T::from_index(levels - 1));
        let (start, cell) = middle.nearest_index();
        Self {
            cell,
            part: x - start,
        }
    }
}

/// `e(M, m)` as three table entries and their factors.
///
/// Both triangles of the definition in one form: with `u`, `v` the parts of `M`, `m`,
/// `e = (1 − max) C[p][q] + (max − min) C_mid + min C[p+1][q+1]`, `max` and `min` of `u` and `v`, where
/// `C_mid` is the corner on the side of the larger part.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangle<T> {
    pub(crate) near: usize,
    pub(crate) mid: usize,
    pub(crate) far: usize,
    pub(crate) larger: T,
    pub(crate) smaller: T,
}

impl<T: Real> Triangle<T> {
    /// The triangle that `(M, m)` lies in. Where `M = m` the terms cancel to exactly zero.
    #[inline(always)]
    pub(crate) fn of(max: Split<T>, min: Split<T>) -> Self {
        let near = table_index(max.cell, min.cell);
        // On to C[p+1][q] or C[p][q+1].
        let step = if max.part > min.part { max.cell + 1 } else { 1 };
        Self {
            near,
            mid: near + step,
            far: near + max.cell + 2,
            larger: max.part.max(min.part),
            smaller: max.part.min(min.part),
        }
    }
}

/// The Everett function of a model: its table, and the grid that this stands on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid<'a, T> {
    pub(crate) table: &'a [T],
    pub(crate) levels: usize,
}

impl<T: Real> Grid<'_, T> {
    /// `e(M, m)` for `m ≤ M`.
    #[inline(always)]
    pub(crate) fn everett(self, max: Split<T>, min: Split<T>) -> T {
        let Triangle {
            near,
            mid,
            far,
            larger,
            smaller,
        } = Triangle::of(max, min);
        let [near, mid, far] = [near, mid, far].map(|index| self.table[index]);
        near + larger * (mid - near) + smaller * (far - mid)
    }
}
