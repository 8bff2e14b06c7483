//! Sparse factors over Everett corners: the normal equations with a prior, and with some weights
//! held at zero.
//!
//! Over corners, the Gram matrix has few elements, and so have differences of weights: four corners
//! each. So a Cholesky factor with a fill-reducing order is small, though over weights the same
//! matrix is dense. Weights are held at zero by a large multiple of their square. That leaves an
//! error, so the factor serves as the preconditioner of conjugate gradients on the other weights,
//! which end after a few steps (Golub and Van Loan 2013, 11.5).

use crate::identify::weights::layout::Layout;
use crate::identify::weights::smoothness;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use std::collections::BTreeSet;

/// The structure of the matrices over one layout, and the parts that do not depend on the data.
#[derive(Debug)]
pub(crate) struct Pattern {
    /// The lower triangle, column by column.
    pub(super) starts: Vec<usize>,
    pub(super) rows: Vec<usize>,
    symbolic: SymbolicCholesky<usize>,
    /// For each weight, the elements of its square, as places and signs.
    squares: Vec<Vec<(u32, f64)>>,
    /// The penalties of strength 1 along the diagonal, across it, and on it.
    pub(crate) penalties: [Vec<f64>; 3],
}

impl Pattern {
    /// The pattern for Gram matrices whose rows have elements at `places`; row `n` from `starts[n]`
    /// on. `None` if the matrix is too large for an order to be found.
    pub(super) fn new(layout: &Layout, starts: &[usize], places: &[u32]) -> Option<Self> {
        let count = layout.count;
        let mut columns: Vec<Vec<u32>> = vec![Vec::new(); count];
        for (n, column) in columns.iter_mut().enumerate() {
            let places = places[starts[n]..starts[n + 1]].iter();
            column.extend(places.filter(|place| **place as usize >= n));
        }
        let edges = smoothness::edges(layout.levels());
        let parts: BTreeSet<usize> = layout.blocks.iter().map(|block| block.part).collect();
        let mut differences = Vec::new();
        for part in parts {
            for &(kind, from, to) in &edges {
                let mut terms: Vec<(u32, f64)> = Vec::new();
                for (operator, sign) in [(from, 1.0), (to, -1.0)] {
                    for column in layout.columns_of(part, operator) {
                        let own = layout.stencils[column as usize].iter();
                        terms.extend(own.map(|(corner, s)| (*corner, sign * s)));
                    }
                }
                for (a, _) in &terms {
                    for (b, _) in &terms {
                        columns[*a.min(b) as usize].push(*a.max(b));
                    }
                }
                differences.push((kind, terms));
            }
        }
        for stencil in &layout.stencils {
            for (a, _) in stencil {
                for (b, _) in stencil {
                    columns[*a.min(b) as usize].push(*a.max(b));
                }
            }
        }
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for column in &mut columns {
            column.sort_unstable();
            column.dedup();
            rows.extend(column.iter().map(|row| *row as usize));
            starts.push(rows.len());
        }
        drop(columns);
        let matrix = SymbolicSparseColMatRef::new_checked(count, count, &starts, None, &rows);
        let ordering = SymmetricOrdering::Amd;
        // With blocks of columns a factor takes half the time, at every size.
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic = factorize_symbolic_cholesky(matrix, Side::Lower, ordering, params).ok()?;
        let place = |a: u32, b: u32| -> usize {
            let (column, row) = (a.min(b) as usize, a.max(b) as usize);
            let own = &rows[starts[column]..starts[column + 1]];
            starts[column] + own.partition_point(|r| *r < row)
        };
        let mut penalties = [0; 3].map(|_| vec![0.0; rows.len()]);
        for (kind, terms) in &differences {
            for (a, s) in terms {
                for (b, t) in terms.iter().filter(|(b, _)| b >= a) {
                    penalties[*kind][place(*a, *b)] += s * t;
                }
            }
        }
        let square = |stencil: &Vec<(u32, f64)>| {
            let pairs = stencil
                .iter()
                .flat_map(|a| stencil.iter().map(move |b| (a, b)));
            let pairs = pairs.filter(|((a, _), (b, _))| b >= a);
            pairs
                .map(|((a, s), (b, t))| (place(*a, *b) as u32, s * t))
                .collect()
        };
        let squares = layout.stencils.iter().map(square).collect();
        Some(Self {
            symbolic,
            squares,
            penalties,
            starts,
            rows,
        })
    }

    /// Number of elements of a factor.
    pub(crate) fn fill(&self) -> usize {
        self.symbolic.len_val()
    }

    /// Adds the squares of weights, times a factor each.
    pub(crate) fn add_squares(&self, values: &mut [f64], factor: impl Fn(usize) -> f64) {
        for (n, square) in self.squares.iter().enumerate() {
            let factor = factor(n);
            if factor != 0.0 {
                for (place, sign) in square {
                    values[*place as usize] += sign * factor;
                }
            }
        }
    }

    /// The factor of these elements; `None` if they are not definite.
    pub(crate) fn factor(&self, values: &[f64]) -> Option<Factor<'_>> {
        let count = self.starts.len() - 1;
        let structure =
            SymbolicSparseColMatRef::new_checked(count, count, &self.starts, None, &self.rows);
        let matrix = SparseColMatRef::new(structure, values);
        let mut own = vec![0.0; self.symbolic.len_val()];
        let scratch = self
            .symbolic
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(scratch).ok()?;
        self.symbolic
            .factorize_numeric_llt(
                &mut own,
                matrix,
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .ok()?;
        own.iter().all(|value| value.is_finite()).then_some(Factor {
            pattern: self,
            values: own,
        })
    }
}

/// A factor `L Lᵀ` over corners.
pub(crate) struct Factor<'a> {
    pattern: &'a Pattern,
    values: Vec<f64>,
}

impl Factor<'_> {
    /// Solves in place.
    pub(crate) fn solve(&self, right: &mut [f64]) -> Option<()> {
        let symbolic = &self.pattern.symbolic;
        let scratch = symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let mut memory = MemBuffer::try_new(scratch).ok()?;
        let count = right.len();
        LltRef::new(symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right, count, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        Some(())
    }

    /// Half the logarithm of the determinant: the sum of the logarithms of the diagonal of `L`.
    pub(crate) fn half_log_determinant(&self) -> f64 {
        match self.pattern.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(own) => {
                let diagonal = own.col_ptr()[..own.ncols()].iter();
                diagonal.map(|place| self.values[*place].ln()).sum()
            }
            SymbolicCholeskyRaw::Supernodal(own) => {
                let factor = faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef::new(
                    own,
                    &self.values,
                );
                let node = |s: usize| {
                    let values = factor.supernode(s).val();
                    (0..values.ncols())
                        .map(|n| values[(n, n)].ln())
                        .sum::<f64>()
                };
                (0..own.n_supernodes()).map(node).sum()
            }
        }
    }
}
