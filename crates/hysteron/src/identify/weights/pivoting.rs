//! Block principal pivoting for non-negative least squares (Portugal, Júdice and Vicente 1994; Kim
//! and Park 2011). In each step a whole block of variables enters or leaves the set above zero, and
//! the factor is computed anew. If most variables end above zero, as with smooth weights, about ten
//! factors are enough. An active set method would add the variables one by one.

use crate::error::Result;
use crate::identify::weights::definite::Definite;
use crate::identify::weights::nnls;
use crate::progress::Progress;

/// Number of block exchanges that may fail to reduce the number of infeasible variables before the
/// method gives up.
const PATIENCE: usize = 5;

/// Largest number of factors.
const MOST: usize = 50;

/// The minimum of `½ xᵀ A x − bᵀ x` over `x ≥ 0`, searched from `x`: by block exchanges, and by the
/// active set method where they stop early.
pub(crate) fn nonnegative(
    a: &[f64],
    b: &[f64],
    x: &[f64],
    progress: Progress<'_>,
) -> Result<Vec<f64>> {
    let (mut x, exact) = minimum(a, b, x);
    if !exact {
        nnls::solve(a, b, &mut x, progress)?;
    }
    Ok(x)
}

/// The minimum of `½ xᵀ A x − bᵀ x` over `x ≥ 0`, starting with the variables that are above zero
/// in `x`. Returns true with the minimum. Returns false with a point near it if rounding or cycling
/// stopped the method.
pub(crate) fn minimum(a: &[f64], b: &[f64], x: &[f64]) -> (Vec<f64>, bool) {
    let count = b.len();
    let gradient = |members: &[usize], values: &[f64]| {
        let mut gradient = b.to_vec();
        for (&n, value) in members.iter().zip(values) {
            let row = &a[n * count..(n + 1) * count];
            gradient
                .iter_mut()
                .zip(row)
                .for_each(|(g, a)| *g -= a * value);
        }
        gradient
    };
    minimum_by(b, x, |members| free_minimum(a, b, members), gradient)
}

/// As [`minimum`], for a matrix in any form. `free_minimum` is the minimum over the members alone,
/// without sign constraint. `gradient` is `b − A x` for members and their values.
pub(crate) fn minimum_by(
    b: &[f64],
    x: &[f64],
    free_minimum: impl Fn(&[usize]) -> Option<Vec<f64>>,
    gradient: impl Fn(&[usize], &[f64]) -> Vec<f64>,
) -> (Vec<f64>, bool) {
    let count = b.len();
    let mut above: Vec<bool> = x.iter().map(|x| *x > 0.0).collect();
    let mut best = (usize::MAX, x.iter().map(|x| x.max(0.0)).collect());
    let mut patience = PATIENCE;
    for _ in 0..MOST {
        let members: Vec<usize> = (0..count).filter(|n| above[*n]).collect();
        let Some(values) = free_minimum(&members) else {
            break;
        };
        let gradient = gradient(&members, &values);
        let rounding = 1e-12 * b.iter().fold(0.0_f64, |size, b| size.max(b.abs()));
        let wrong_below = (0..count).filter(|&n| !above[n] && gradient[n] > rounding);
        let mut wrong: Vec<usize> = wrong_below.collect();
        let below = members.iter().zip(&values).filter(|(_, x)| **x < 0.0);
        wrong.extend(below.map(|(n, _)| *n));
        if wrong.len() < best.0 {
            let mut x = vec![0.0; count];
            for (&n, &value) in members.iter().zip(&values) {
                x[n] = value.max(0.0);
            }
            best = (wrong.len(), x);
            patience = PATIENCE;
        } else if patience == 0 {
            break;
        } else {
            patience -= 1;
        }
        if wrong.is_empty() {
            break;
        }
        for n in wrong {
            above[n] = !above[n];
        }
    }
    (best.1, best.0 == 0)
}

/// The minimum over the members alone, without sign constraint.
fn free_minimum(a: &[f64], b: &[f64], members: &[usize]) -> Option<Vec<f64>> {
    let factor = Definite::of_members(a, b.len(), members)?;
    let right: Vec<f64> = members.iter().map(|n| b[*n]).collect();
    Some(factor.solve(&right))
}
