//! The Cholesky factor of a dense matrix, made where its elements are put.
//!
//! Searches factor some hundred matrices for a fit, each of a few hundred columns. At that size,
//! copying takes as long as the arithmetic. So only what is at and below the diagonal is asked for,
//! once, by whole columns.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::{factor, solve};
use faer::{Mat, MatMut, Par, get_global_parallelism};

/// `L` with `L Lᵀ` the matrix. What is above the diagonal of `lower` has no meaning.
pub(crate) struct Definite {
    lower: Mat<f64>,
}

impl Definite {
    /// The factor of a matrix of `size` columns; `None` where it is not positive definite.
    /// `column(j, to)` writes the elements of column `j` from the diagonal down.
    pub(crate) fn new(size: usize, column: impl Fn(usize, &mut [f64])) -> Option<Self> {
        let mut lower = Mat::<f64>::zeros(size, size);
        for j in 0..size {
            column(j, &mut lower.col_as_slice_mut(j)[j..]);
        }
        let threads = get_global_parallelism();
        let room = factor::cholesky_in_place_scratch::<f64>(size, threads, Default::default());
        let mut memory = MemBuffer::new(room);
        factor::cholesky_in_place(
            lower.as_mut(),
            Default::default(),
            threads,
            MemStack::new(&mut memory),
            Default::default(),
        )
        .ok()?;
        Some(Self { lower })
    }

    /// The factor of a symmetric matrix, row by row.
    pub(crate) fn of_rows(matrix: &[f64]) -> Option<Self> {
        let size = matrix.len().isqrt();
        Self::new(size, |j, to| {
            to.copy_from_slice(&matrix[j * size + j..(j + 1) * size]);
        })
    }

    /// The factor of some rows and columns of a symmetric matrix of `count` columns, row by row.
    pub(crate) fn of_members(matrix: &[f64], count: usize, members: &[usize]) -> Option<Self> {
        Self::new(members.len(), |j, to| {
            let row = &matrix[members[j] * count..][..count];
            let below = members[j..].iter().map(|i| row[*i]);
            to.iter_mut().zip(below).for_each(|(to, a)| *to = a);
        })
    }

    /// The element of the factor in row `i` and column `j`, at or below the diagonal.
    pub(crate) fn at(&self, i: usize, j: usize) -> f64 {
        self.lower[(i, j)]
    }

    /// The solution of `L Lᵀ x = b`.
    pub(crate) fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut x = b.to_vec();
        let size = x.len();
        solve::solve_in_place(
            self.lower.as_ref(),
            MatMut::from_column_major_slice_mut(&mut x, size, 1),
            Par::Seq,
            MemStack::new(&mut []),
        );
        x
    }

    /// Half the logarithm of the matrix's determinant.
    pub(crate) fn half_log_determinant(&self) -> f64 {
        (0..self.lower.nrows()).map(|n| self.at(n, n).ln()).sum()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use rand::{RngExt, SeedableRng};

    /// The matrix is made from a factor, so the factor and the solution are known.
    #[test]
    fn the_factor_is_found_and_solves() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        for size in [0, 1, 2, 3, 17, 64, 130, 300] {
            let known = Mat::from_fn(size, size, |i, j| match i.cmp(&j) {
                std::cmp::Ordering::Less => 0.0,
                std::cmp::Ordering::Equal => rng.random_range(1.0..2.0),
                std::cmp::Ordering::Greater => rng.random_range(-1.0..1.0) / size as f64,
            });
            let matrix = &known * known.transpose();
            let rows: Vec<f64> = (0..size * size)
                .map(|n| matrix[(n / size, n % size)])
                .collect();
            let found = Definite::of_rows(&rows).unwrap();
            for i in 0..size {
                for j in 0..=i {
                    // A condition number below a hundred, times the rounding of `size` products.
                    assert!((found.at(i, j) - known[(i, j)]).abs() < 1e-11);
                }
            }
            let x: Vec<f64> = (0..size).map(|_| rng.random_range(-1.0..1.0)).collect();
            let b: Vec<f64> = (0..size)
                .map(|i| (0..size).map(|j| rows[i * size + j] * x[j]).sum())
                .collect();
            let solved = found.solve(&b);
            assert!(x.iter().zip(&solved).all(|(x, s)| (x - s).abs() < 1e-11));
        }
    }

    #[test]
    fn what_is_not_definite_has_none() {
        assert!(Definite::of_rows(&[1.0, 2.0, 2.0, 1.0]).is_none());
        assert!(Definite::of_rows(&[0.0]).is_none());
        assert!(Definite::of_rows(&[f64::NAN]).is_none());
    }
}
