//! Non-negative least squares on normal equations: the active set method of Lawson and Hanson
//! (1974). The form of Bro and de Jong (1997) needs only the Gram matrix. Here several variables
//! enter at a time, and the factor is updated instead of computed anew.

use crate::error::Result;
use crate::identify::weights::cholesky::Cholesky;
use crate::progress::Progress;

/// One step may add one variable, and one more for each group of this many variables above zero.
/// Adding more at once saves gradients, but many of them leave again.
const STRIDE: usize = 8;

/// Minimises `½ xᵀ A x − bᵀ x` over `x ≥ 0`, from the feasible `x` given. `A` is symmetric and
/// positive definite, `N × N`, row by row. The objective never rises. Where rounding stops its
/// progress, the limit on the number of steps ends the loop, and `x` is as good as rounding allows.
pub(crate) fn solve(a: &[f64], b: &[f64], x: &mut [f64], progress: Progress<'_>) -> Result<()> {
    let dense = Dense {
        elements: a,
        count: b.len(),
    };
    minimise(&dense, b, x, progress)
}

/// A symmetric positive definite matrix, of which few rows are needed.
pub(crate) trait Quadratic {
    fn diagonal(&self, n: usize) -> f64;

    /// The elements of row `n` in some columns.
    fn elements(&self, n: usize, columns: &[usize]) -> Vec<f64>;

    /// Subtracts the product with `x`, which is zero but for the members.
    fn take_from(&self, gradient: &mut [f64], x: &[f64], members: &[usize]);
}

struct Dense<'a> {
    elements: &'a [f64],
    count: usize,
}

impl Dense<'_> {
    fn row(&self, n: usize) -> &[f64] {
        &self.elements[n * self.count..(n + 1) * self.count]
    }
}

impl Quadratic for Dense<'_> {
    fn diagonal(&self, n: usize) -> f64 {
        self.elements[n * self.count + n]
    }

    fn elements(&self, n: usize, columns: &[usize]) -> Vec<f64> {
        let row = self.row(n);
        columns.iter().map(|m| row[*m]).collect()
    }

    fn take_from(&self, gradient: &mut [f64], x: &[f64], members: &[usize]) {
        for &n in members {
            for (g, a) in gradient.iter_mut().zip(self.row(n)) {
                *g -= a * x[n];
            }
        }
    }
}

/// As [`solve`], for a matrix in any form.
pub(crate) fn minimise(
    a: &impl Quadratic,
    b: &[f64],
    x: &mut [f64],
    progress: Progress<'_>,
) -> Result<()> {
    let count = b.len();
    let size = b.iter().fold(0.0_f64, |size, b| size.max(b.abs()));
    // Rounding of sums of `count` products. A gradient below this is zero.
    let rounding = 1e-13 * size;
    let mut set = FreeSet::default();
    let above: Vec<usize> = (0..count).filter(|&n| x[n] > 0.0).collect();
    let rows: Vec<Vec<f64>> = above.iter().map(|n| a.elements(*n, &above)).collect();
    match Cholesky::new(above.len(), |i, j| rows[i][j]) {
        Some(factor) => {
            set.factor = factor;
            set.members = above;
        }
        // A variable that depends on the others must leave, because it would never be examined
        // again.
        None => {
            for n in above {
                if !set.take(n, a) {
                    x[n] = 0.0;
                }
            }
        }
    }
    drop(rows);
    set.descend(b, x);
    // Variables that did not help are not tried again until others have helped.
    let mut tried = vec![false; count];
    for _ in 0..30 * count + 100 {
        progress.tell("weights", set.members.len() as f64 / count as f64)?;
        let mut gradient = b.to_vec();
        a.take_from(&mut gradient, x, &set.members);
        let outside = |n: &usize| x[*n] == 0.0 && !tried[*n] && gradient[*n] > rounding;
        // The steepest first, in units of each variable's own curvature.
        let steepness = |n: usize| (gradient[n] / a.diagonal(n).sqrt(), n);
        let mut wanted: Vec<(f64, usize)> = (0..count).filter(outside).map(steepness).collect();
        if wanted.is_empty() {
            return Ok(());
        }
        let order = |m: &(f64, usize), n: &(f64, usize)| n.0.total_cmp(&m.0).then(m.1.cmp(&n.1));
        let few = 1 + set.members.len() / STRIDE;
        if few < wanted.len() {
            wanted.select_nth_unstable_by(few, order);
            wanted.truncate(few);
        }
        wanted.sort_unstable_by(order);
        for &(_, n) in &wanted {
            set.take(n, a);
        }
        let moved = set.descend(b, x);
        if moved {
            tried.fill(false);
        }
        for &(_, n) in wanted.iter().filter(|(_, n)| x[*n] == 0.0) {
            tried[n] = true;
        }
    }
    Ok(())
}

/// The variables that may be above zero, and the factor of their part of the matrix.
#[derive(Default)]
struct FreeSet {
    members: Vec<usize>,
    factor: Cholesky,
}

impl FreeSet {
    /// Adds a variable unless it depends on those in the set. Returns whether it was added.
    fn take(&mut self, n: usize, a: &impl Quadratic) -> bool {
        let taken = self
            .factor
            .append(a.elements(n, &self.members), a.diagonal(n));
        if taken {
            self.members.push(n);
        }
        taken
    }

    /// Moves to the minimum over the free variables, and drops those that reach zero on the way.
    /// Returns whether any variable moved.
    fn descend(&mut self, b: &[f64], x: &mut [f64]) -> bool {
        let mut moved = false;
        while !self.members.is_empty() {
            let minimum = self
                .factor
                .solve(self.members.iter().map(|&n| b[n]).collect());
            let towards = || self.members.iter().zip(&minimum);
            // Step length until the first variable reaches zero.
            let reach = |x: f64, z: f64| if x > 0.0 { x / (x - z) } else { 0.0 };
            let limit = towards()
                .filter(|(_, z)| **z <= 0.0)
                .map(|(&n, z)| reach(x[n], *z))
                .fold(1.0_f64, f64::min);
            moved |= limit > 0.0;
            if towards().all(|(_, z)| *z > 0.0) {
                for (&n, &z) in towards() {
                    x[n] = z;
                }
                return moved;
            }
            for k in (0..self.members.len()).rev() {
                let (n, z) = (self.members[k], minimum[k]);
                // The same number as above, so that at least one variable is dropped in spite of
                // rounding.
                let meets_zero = z <= 0.0 && reach(x[n], z) <= limit;
                x[n] += limit * (z - x[n]);
                if meets_zero {
                    x[n] = 0.0;
                    self.members.remove(k);
                    self.factor.remove(k);
                }
            }
        }
        moved
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::super::pivoting;
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// `Bᵀ B` with `rows` random rows, plus a ridge. The rank is lower if there are fewer rows than
    /// columns.
    fn system(rng: &mut ChaCha8Rng, count: usize, rows: usize, ridge: f64) -> (Vec<f64>, Vec<f64>) {
        let b: Vec<Vec<f64>> = (0..rows)
            .map(|_| (0..count).map(|_| rng.random_range(0.0..1.0)).collect())
            .collect();
        let y: Vec<f64> = (0..rows).map(|_| rng.random_range(-0.5..1.0)).collect();
        let mut a = vec![0.0; count * count];
        for i in 0..count {
            for j in 0..count {
                a[i * count + j] = b.iter().map(|row| row[i] * row[j]).sum();
            }
            a[i * count + i] += ridge;
        }
        let right = (0..count).map(|i| b.iter().zip(&y).map(|(row, y)| row[i] * y).sum());
        (a, right.collect())
    }

    /// The largest violation of the Karush-Kuhn-Tucker conditions, relative to `b`.
    fn breach(a: &[f64], b: &[f64], x: &[f64]) -> f64 {
        let size = b.iter().fold(0.0_f64, |size, b| size.max(b.abs()));
        let each = a.chunks(b.len()).zip(b).zip(x).map(|((row, b), &own)| {
            let gradient = b - row.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
            assert!(own >= 0.0);
            if own > 0.0 {
                gradient.abs()
            } else {
                gradient.max(0.0)
            }
        });
        each.fold(0.0, f64::max) / size
    }

    #[test]
    fn both_methods_meet_the_conditions_of_a_minimum_from_any_start() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let mut ended = 0;
        for round in 0..200 {
            let count = rng.random_range(1..60);
            let rows = rng.random_range(1..80);
            // From well conditioned to definite only by rounding.
            let ridge = [1e-1, 1e-5, 1e-9][round % 3];
            let (a, b) = system(&mut rng, count, rows, ridge);
            // Starts with zeros, tiny and large numbers: at the boundary a step can have length
            // zero.
            let start: Vec<f64> = (0..count)
                .map(|_| [0.0, 0.0, 1e-300, 1e-12, 1.0][rng.random_range(0..5)])
                .collect();
            let mut x = start.clone();
            solve(&a, &b, &mut x, Progress::NONE).unwrap();
            // Rounding of 80 products, amplified by the factors of the free part.
            assert!(breach(&a, &b, &x) < 1e-6, "round {round}");
            let (other, exact) = pivoting::minimum(&a, &b, &start);
            if exact {
                ended += 1;
                assert!(breach(&a, &b, &other) < 1e-6, "round {round}, pivoting");
            }
            if ridge > 0.01 {
                assert!(
                    exact,
                    "round {round}: nothing keeps pivoting from its end here"
                );
            }
        }
        assert!(ended > 150, "pivoting ended in {ended} of 200 rounds");
    }
}
