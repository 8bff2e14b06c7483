//! The Everett function `e(M, m)` of the model: by how much the output falls when the input falls
//! from the maximum `M` to the minimum `m`.
//!
//! An MKP operator is the average of ideal relays whose thresholds lie on the diagonal of its grid
//! cell. So the whole model is a classical Preisach model. On the corners of the grid its Everett
//! function is the prefix sum `C[p][q] = Σ μ_ij over j ≤ p, i > q`. Between the corners it is
//! exactly linear on each of the two triangles of a cell (Everett 1955; Mayergoyz 1991).

use crate::error::{Error, NegativeWeights};
use crate::plane::{operator_count, operator_index};
use crate::scalar::Real;

/// Number of elements of the Everett table for `levels` levels: `(K + 1)(K + 2)/2`, one for each
/// corner `0 ≤ q ≤ p ≤ K`.
#[must_use]
pub const fn table_len(levels: usize) -> usize {
    (levels + 1) * (levels + 2) / 2
}

/// Index of `C[p][q]`, `0 ≤ q ≤ p ≤ K`, in the Everett table: row by row, from 0.
#[must_use]
pub const fn table_index(p: usize, q: usize) -> usize {
    p * (p + 1) / 2 + q
}

/// Checks the number and the values of `weights`. Returns which are negative, `None` for none.
pub(crate) fn check<T: Real>(
    levels: usize,
    weights: &[T],
) -> Result<Option<NegativeWeights>, Error> {
    let (expected, found) = (operator_count(levels), weights.len());
    if expected != found {
        return Err(Error::WeightCount { expected, found });
    }
    let mut negative: Option<NegativeWeights> = None;
    // Bound of the output; for operators of ±1 the bound is twice this.
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
                if let Some(free) = which.first.iter_mut().find(|slot| slot.is_none()) {
                    *free = Some((i, j));
                }
                which.count += 1;
            }
        }
    }
    Ok(negative)
}

/// Writes the Everett table of `weights` to the first elements of `table`.
pub(crate) fn fill<T: Real>(levels: usize, weights: &[T], table: &mut [T]) {
    table[0] = T::ZERO;
    for p in 1..=levels {
        let (above, row) = rows(table, p);
        fill_row(p, weights, above, row);
    }
}

/// Row `p ≥ 1` of a table, and the row above it.
pub(crate) fn rows<T>(table: &mut [T], p: usize) -> (&[T], &mut [T]) {
    let (above, row) = table[table_index(p - 1, 0)..].split_at_mut(p);
    (above, &mut row[..=p])
}

/// Computes row `p` of the table of `weights` from the row above it.
///
/// The sum within the row is formed first and then added to the row above. So every entry results
/// from at most `2K` additions, and weights that are exactly zero make neighbouring entries exactly
/// equal.
pub(crate) fn fill_row<T: Real>(p: usize, weights: &[T], above: &[T], row: &mut [T]) {
    row[p] = T::ZERO;
    let weights = &weights[operator_index(1, p)..][..p];
    let mut sum = T::ZERO;
    for q in (0..p).rev() {
        sum = sum + weights[q];
        row[q] = above[q] + sum;
    }
}

/// A normalised position as its grid cell and the fraction of that cell: `x = cell + part`,
/// `0 ≤ part ≤ 1`.
///
/// A position on a grid line may belong to either cell, because the Everett function is continuous.
/// `x = K` is the upper end of the last cell, so that the table has a corner above every cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Split<T> {
    pub(crate) cell: usize,
    pub(crate) part: T,
}

impl<T: Real> Split<T> {
    #[inline(always)]
    pub(crate) fn new(x: T, levels: usize) -> Self {
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
/// `M` lies in cell `p` with part `u`, `m` in cell `q` with part `v`. One form covers both
/// triangles: `e = (1 − max(u, v)) C[p][q] + (max(u, v) − min(u, v)) C_mid + min(u, v)
/// C[p+1][q+1]`. `C_mid` is `C[p+1][q]` where `u > v` and `C[p][q+1]` otherwise.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangle<T> {
    /// Index of `C[p][q]`.
    pub(crate) near: usize,
    /// Index of `C_mid`.
    pub(crate) mid: usize,
    /// Index of `C[p+1][q+1]`.
    pub(crate) far: usize,
    /// `max(u, v)`.
    pub(crate) larger: T,
    /// `min(u, v)`.
    pub(crate) smaller: T,
}

impl<T: Real> Triangle<T> {
    /// The triangle that has `(M, m)`. Where `M = m` the terms cancel to exactly zero.
    #[inline(always)]
    pub(crate) fn new(max: Split<T>, min: Split<T>) -> Self {
        let near = table_index(max.cell, min.cell);
        // From C[p][q] to C[p+1][q] or to C[p][q+1].
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

/// The Everett function of a model: its table, and the number of levels of its grid.
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
        } = Triangle::new(max, min);
        let [near, mid, far] = [near, mid, far].map(|index| self.table[index]);
        near + larger * (mid - near) + smaller * (far - mid)
    }

    /// The slope of `e(M, m)` over `M`, on the side of larger `M`.
    pub(crate) fn slope_up(self, max: Split<T>, min: Split<T>) -> T {
        // Where the parts are equal, `M` moves into the triangle in which its part is the larger.
        let q = min.cell + usize::from(max.part < min.part);
        self.corner(max.cell + 1, q) - self.corner(max.cell, q)
    }

    /// The fall of `e(M, m)` over `m`, on the side of smaller `m`.
    pub(crate) fn slope_down(self, max: Split<T>, min: Split<T>) -> T {
        let p = max.cell + usize::from(min.part <= max.part);
        self.corner(p, min.cell) - self.corner(p, min.cell + 1)
    }

    /// `C[p][q]`, which is zero for `q ≥ p`.
    pub(crate) fn corner(self, p: usize, q: usize) -> T {
        match q < p {
            true => self.table[table_index(p, q)],
            false => T::ZERO,
        }
    }
}
