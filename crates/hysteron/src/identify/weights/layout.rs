//! How the columns of the regressor lie in the plane, where the change from weights to Everett
//! corners is one-to-one.
//!
//! The sums over samples are sparse over the corners, `Wᵀ W`, and dense over the weights,
//! `Sᵀ Wᵀ W S`. `S` adds weights up and `S⁻¹` takes differences of four corners, so both are cheap.

use crate::identify::weights::column::Column;
use crate::identify::weights::rows::Term;
use crate::identify::weights::sparse::SparseForm;
use hysteron_core::{operator_index, operators};

/// The columns of one function of the load that start in the same way.
#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) part: usize,
    /// The column of each operator, [`Term::NOWHERE`] for operators that have none here.
    pub(crate) columns: Vec<u32>,
}

/// The columns in blocks. A corner has the index of the column whose operator has its place.
#[derive(Debug)]
pub(crate) struct Layout {
    form: SparseForm,
    pub(crate) blocks: Vec<Block>,
    pub(crate) columns: Vec<Column>,
    pub(crate) count: usize,
    /// For each column, the corners whose differences are its weight, with their signs.
    pub(crate) stencils: Vec<Vec<(u32, f64)>>,
}

impl Layout {
    /// `None` if a block's operators are not such that their sums stay among them: with an operator
    /// `(i, j)` also `(i − 1, j)` and `(i, j + 1)`. The blocks have to be complete.
    pub(crate) fn new(form: &SparseForm, columns: &[Column], blocks: Vec<Block>) -> Option<Self> {
        let places: Vec<(usize, usize)> = operators(form.plane().levels()).collect();
        let index = |i: usize, j: usize| {
            (1 <= i && i <= j && j <= form.plane().levels()).then(|| operator_index(i, j))
        };
        let mut stencils = vec![Vec::new(); columns.len()];
        for block in &blocks {
            let at = |i: usize, j: usize| {
                let column = block.columns[index(i, j)?];
                (column != Term::NOWHERE).then_some(column)
            };
            for &(i, j) in &places {
                let Some(own) = at(i, j) else {
                    continue;
                };
                let closed = |i: usize, j: usize| index(i, j).is_none() || at(i, j).is_some();
                if !closed(i - 1, j) || !closed(i, j + 1) {
                    return None;
                }
                let around = [
                    (i, j, 1.0),
                    (i, j - 1, -1.0),
                    (i + 1, j, -1.0),
                    (i + 1, j - 1, 1.0),
                ];
                let around = around.into_iter();
                let around = around.filter_map(|(i, j, sign)| Some((at(i, j)?, sign)));
                stencils[own as usize] = around.collect();
            }
        }
        if stencils.iter().any(Vec::is_empty) {
            return None;
        }
        Some(Self {
            form: form.clone(),
            blocks,
            count: columns.len(),
            columns: columns.to_vec(),
            stencils,
        })
    }

    pub(crate) fn levels(&self) -> usize {
        self.form.plane().levels()
    }

    /// The operators, if there is one block, with a column for each of them in their order.
    pub(crate) fn whole_plane(&self) -> Option<&SparseForm> {
        let [block] = &self.blocks[..] else {
            return None;
        };
        let in_order = (0..).zip(&block.columns).all(|(n, column)| n == *column);
        in_order.then_some(&self.form)
    }

    /// `S x` or `Sᵀ x`, block by block.
    fn sums(&self, x: &[f64], sum: impl Fn(&SparseForm, &mut [f64])) -> Vec<f64> {
        let mut result = vec![0.0; self.count];
        let mut values = vec![0.0; self.form.operators()];
        for block in &self.blocks {
            let columns = || block.columns.iter().enumerate();
            let columns = || columns().filter(|(_, column)| **column != Term::NOWHERE);
            values.fill(0.0);
            columns().for_each(|(n, column)| values[n] = x[*column as usize]);
            sum(&self.form, &mut values);
            columns().for_each(|(n, column)| result[*column as usize] = values[n]);
        }
        result
    }

    /// `S x`: the corners of weights.
    pub(crate) fn corners(&self, x: &[f64]) -> Vec<f64> {
        self.sums(x, SparseForm::corners_of)
    }

    /// `Sᵀ c`.
    pub(crate) fn gathered(&self, corners: &[f64]) -> Vec<f64> {
        self.sums(corners, SparseForm::operators_of)
    }

    /// `S⁻¹ c`: the weights of corners.
    pub(crate) fn weights(&self, corners: &[f64]) -> Vec<f64> {
        let difference = |stencil: &Vec<(u32, f64)>| {
            let terms = stencil.iter();
            terms
                .map(|(corner, sign)| sign * corners[*corner as usize])
                .sum()
        };
        self.stencils.iter().map(difference).collect()
    }

    /// `S⁻ᵀ x`.
    pub(crate) fn spread(&self, x: &[f64]) -> Vec<f64> {
        let mut result = vec![0.0; self.count];
        for (stencil, x) in self.stencils.iter().zip(x) {
            for (corner, sign) in stencil {
                result[*corner as usize] += sign * x;
            }
        }
        result
    }

    /// The columns of a part that belong to the operator.
    pub(crate) fn columns_of(&self, part: usize, operator: usize) -> impl Iterator<Item = u32> {
        let blocks = self.blocks.iter().filter(move |block| block.part == part);
        let columns = blocks.map(move |block| block.columns[operator]);
        columns.filter(|column| *column != Term::NOWHERE)
    }
}
