//! Where a search from zero begins: at the minimum over weights that are alike in squares of two by
//! two operators, which is a problem of a fourth of the size (nested iteration). Smooth weights are
//! nearly alike there. From zero, the first steps of pivoting would factor the matrix of nearly all
//! weights.

use crate::identify::weights::column::Column;
use crate::identify::weights::pivoting;
use hysteron_core::operators;
use std::collections::HashMap;

/// So few weights are searched for from zero.
const FEW: usize = 60;

/// For each size, the square that a weight, or a square of the size before, belongs to; and how many
/// squares there are.
#[derive(Debug, Default)]
pub(crate) struct Squares(Vec<(Vec<usize>, usize)>);

impl Squares {
    /// For the columns of a plane of so many levels.
    pub(crate) fn new(columns: &[Column], levels: usize) -> Self {
        let places: Vec<(usize, usize)> = operators(levels).collect();
        let place = |column: &Column| (column.part, column.on, places[column.operator]);
        let mut own: Vec<_> = columns.iter().map(place).collect();
        let mut sizes = Vec::new();
        while own.len() > FEW {
            let mut squares = Vec::new();
            let mut known = HashMap::new();
            let square = |(part, on, (i, j)): &(usize, u64, (usize, usize))| {
                let square = (*part, *on, (i.div_ceil(2), j.div_ceil(2)));
                *known.entry(square).or_insert_with(|| {
                    squares.push(square);
                    squares.len() - 1
                })
            };
            let of = own.iter().map(square).collect();
            if squares.len() == own.len() {
                break;
            }
            sizes.push((of, squares.len()));
            own = squares;
        }
        Self(sizes)
    }

    /// Weights near the minimum of `½ xᵀ A x − bᵀ x` over `x ≥ 0`.
    pub(crate) fn start(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        start(&self.0, a, b)
    }
}

fn start(sizes: &[(Vec<usize>, usize)], a: &[f64], b: &[f64]) -> Vec<f64> {
    let Some(((of, count), larger)) = sizes.split_first() else {
        return vec![0.0; b.len()];
    };
    let mut sums = vec![0.0; count * count];
    let mut right = vec![0.0; *count];
    for ((row, b), square) in a.chunks_exact(b.len()).zip(b).zip(of) {
        right[*square] += b;
        let sums = &mut sums[square * count..][..*count];
        row.iter().zip(of).for_each(|(a, other)| sums[*other] += a);
    }
    let near = start(larger, &sums, &right);
    let (found, _) = pivoting::minimum(&sums, &right, &near);
    of.iter().map(|square| found[*square]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Half of `xᵀ A x − 2 bᵀ x`.
    fn value(a: &[f64], b: &[f64], x: &[f64]) -> f64 {
        let rows = a.chunks_exact(b.len()).zip(b).zip(x);
        let each = rows.map(|((row, b), own)| {
            let moved: f64 = row.iter().zip(x).map(|(a, x)| a * x).sum();
            own * (0.5 * moved - b)
        });
        each.sum()
    }

    /// The minimum is one, wherever its search begins; and the start is better than zero.
    #[test]
    fn a_search_from_the_squares_finds_the_same_minimum() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        for levels in [11, 16, 23] {
            let count = levels * (levels + 1) / 2;
            let mut columns: Vec<Column> = (0..count).map(|n| Column::known(0, n)).collect();
            // Those of an unknown start: some operators once more.
            columns.extend((0..count).step_by(3).map(|n| Column {
                on: 1,
                ..Column::known(0, n)
            }));
            let size = columns.len();
            let mut a = vec![0.0; size * size];
            for _ in 0..2 * size {
                let row: Vec<f64> = (0..size).map(|_| rng.random_range(0.0..1.0)).collect();
                for (own, left) in a.chunks_exact_mut(size).zip(&row) {
                    own.iter_mut()
                        .zip(&row)
                        .for_each(|(a, right)| *a += left * right);
                }
            }
            let b: Vec<f64> = (0..size).map(|_| rng.random_range(-50.0..100.0)).collect();
            let near = Squares::new(&columns, levels).start(&a, &b);
            assert!(value(&a, &b, &near) < 0.0);
            let (from_near, exact) = pivoting::minimum(&a, &b, &near);
            let (from_zero, other) = pivoting::minimum(&a, &b, &vec![0.0; size]);
            assert!(exact && other, "{levels}");
            for (x, y) in from_near.iter().zip(&from_zero) {
                // Rounding of some hundred products.
                assert!((x - y).abs() < 1e-9, "{levels}: {x} for {y}");
            }
        }
    }
}
