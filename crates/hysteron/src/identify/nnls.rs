//! Non-negative least squares on normal equations, by block principal pivoting (Portugal, Júdice and
//! Vicente 1994; Kim and Park 2011): whole blocks of variables change sides at once, so that a few
//! factorisations do where an active set needs one for each variable.

use crate::{Error, Result};
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// How often a block exchange may fail to improve before one variable at a time is exchanged,
/// which always ends (Murty's rule).
const PATIENCE: usize = 3;

/// Minimises `½ xᵀ A x − bᵀ x` over `x ≥ 0`, `A` positive definite (`N × N`, given by its elements).
///
/// `free` says which variables are above zero: on entry a guess, on return the answer.
pub(super) fn solve(
    a: &impl Fn(usize, usize) -> f64,
    b: &[f64],
    free: &mut [bool],
) -> Result<Vec<f64>> {
    let count = b.len();
    let size = b.iter().fold(0.0_f64, |size, b| size.max(b.abs()));
    // Rounding of sums of `count` products: below this a gradient is zero.
    let slack = 1e-13 * size;
    let mut fewest = count + 1;
    let mut patience = PATIENCE;
    // Murty's rule ends after at most 2^N steps in theory and a few N in practice.
    for _ in 0..20 * count + 100 {
        let chosen: Vec<usize> = (0..count).filter(|&n| free[n]).collect();
        let values = solve_free(a, b, &chosen)?;
        let mut x = vec![0.0; count];
        for (&n, &value) in chosen.iter().zip(&values) {
            x[n] = value;
        }
        let wrong: Vec<usize> = (0..count)
            .filter(|&n| {
                if free[n] {
                    x[n] < 0.0
                } else {
                    let gradient: f64 = chosen.iter().zip(&values).map(|(&m, v)| a(n, m) * v).sum();
                    gradient - b[n] < -slack
                }
            })
            .collect();
        if wrong.is_empty() {
            return Ok(x);
        }
        if wrong.len() < fewest {
            fewest = wrong.len();
            patience = PATIENCE;
        } else {
            patience = patience.saturating_sub(1);
        }
        let exchanged = if patience > 0 {
            &wrong[..]
        } else {
            &wrong[wrong.len() - 1..]
        };
        for &n in exchanged {
            free[n] = !free[n];
        }
    }
    Err(Error::Fit("the non-negative solution was not found: the problem is too badly conditioned, take fewer levels".into()))
}

/// The unconstrained solution over the free variables.
fn solve_free(a: &impl Fn(usize, usize) -> f64, b: &[f64], chosen: &[usize]) -> Result<Vec<f64>> {
    let size = chosen.len();
    let part = Mat::from_fn(size, size, |i, j| a(chosen[i], chosen[j]));
    let factor = part.llt(Side::Lower).map_err(|_| not_definite())?;
    let right = Mat::from_fn(size, 1, |i, _| b[chosen[i]]);
    let x = factor.solve(&right);
    Ok((0..size).map(|i| x[(i, 0)]).collect())
}

pub(super) fn not_definite() -> Error {
    Error::Fit("the normal equations cannot be factorised: the data hold values too large or too small to work with".into())
}
