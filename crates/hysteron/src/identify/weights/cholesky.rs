//! A Cholesky factor that is updated when one variable is added or removed, in `O(p²)` time.

use crate::identify::weights::definite::Definite;

/// `L` with `L Lᵀ` the matrix of the variables added so far, in that order. The rows are packed.
#[derive(Default)]
pub(crate) struct Cholesky {
    rows: Vec<f64>,
    size: usize,
}

/// A pivot below this share of its diagonal element is zero up to the rounding of a thousand terms.
const ROUNDING: f64 = 1e-13;

/// Index of the first element of row `i`.
fn start(i: usize) -> usize {
    i * (i + 1) / 2
}

impl Cholesky {
    fn row(&self, i: usize) -> &[f64] {
        &self.rows[start(i)..=start(i) + i]
    }

    /// The factor of a whole matrix; `None` if the matrix is not positive definite up to rounding.
    pub(crate) fn new(size: usize, element: impl Fn(usize, usize) -> f64) -> Option<Self> {
        let factor = Definite::new(size, |j, to| {
            let below = (j..size).map(|i| element(i, j));
            to.iter_mut().zip(below).for_each(|(to, a)| *to = a);
        })?;
        let definite = |i: usize| factor.at(i, i).powi(2) > ROUNDING * element(i, i);
        let rows = (0..size).flat_map(|i| (0..=i).map(move |j| (i, j)));
        (0..size).all(definite).then(|| Self {
            rows: rows.map(|(i, j)| factor.at(i, j)).collect(),
            size,
        })
    }

    /// Adds a variable. `column` holds its matrix elements with the variables added before,
    /// `diagonal` the one with itself. Returns false and changes nothing if the variable depends
    /// linearly on the others, up to rounding.
    pub(crate) fn append(&mut self, mut column: Vec<f64>, diagonal: f64) -> bool {
        self.forward(&mut column);
        let pivot = diagonal - column.iter().map(|l| l * l).sum::<f64>();
        if pivot.is_nan() || pivot <= ROUNDING * diagonal {
            return false;
        }
        self.rows.append(&mut column);
        self.rows.push(pivot.sqrt());
        self.size += 1;
        true
    }

    /// Removes the variable at index `k`. Without its row, the rows below have one element to the
    /// right of the diagonal. Plane rotations of neighbouring columns remove that element (Golub
    /// and Van Loan 2013, 6.5).
    pub(crate) fn remove(&mut self, k: usize) {
        let mut to = start(k);
        let rest: Vec<f64> = self.rows.split_off(start(k + 1));
        self.rows.truncate(to);
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let mut from = 0;
        for i in k + 1..self.size {
            let mut row = rest[from..=from + i].to_vec();
            from += i + 1;
            for (n, &(c, s)) in rotations.iter().enumerate() {
                let (a, b) = (row[k + n], row[k + n + 1]);
                (row[k + n], row[k + n + 1]) = (c * a + s * b, c * b - s * a);
            }
            let (a, b) = (row[i - 1], row[i]);
            let length = a.hypot(b);
            rotations.push((a / length, b / length));
            row[i - 1] = length;
            self.rows.extend_from_slice(&row[..i]);
            to += i;
        }
        debug_assert_eq!(to, self.rows.len());
        self.size -= 1;
    }

    /// The solution of `L Lᵀ x = b`.
    pub(crate) fn solve(&self, mut b: Vec<f64>) -> Vec<f64> {
        self.forward(&mut b);
        for i in (0..self.size).rev() {
            let row = self.row(i);
            let x = b[i] / row[i];
            b[i] = x;
            for (b, l) in b[..i].iter_mut().zip(row) {
                *b -= l * x;
            }
        }
        b
    }

    fn forward(&self, b: &mut [f64]) {
        for i in 0..self.size {
            let row = self.row(i);
            let (known, rest) = b.split_at_mut(i);
            let sum: f64 = row.iter().zip(known.iter()).map(|(l, b)| l * b).sum();
            rest[0] = (rest[0] - sum) / row[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn follows_variables_in_and_out() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let count = 30;
        let parts: Vec<Vec<f64>> = (0..count)
            .map(|_| (0..40).map(|_| rng.random_range(-1.0..1.0)).collect())
            .collect();
        let a = |i: usize, j: usize| -> f64 {
            parts[i].iter().zip(&parts[j]).map(|(a, b)| a * b).sum()
        };
        let mut factor = Cholesky::default();
        let mut chosen: Vec<usize> = Vec::new();
        for _ in 0..500 {
            let n = rng.random_range(0..count);
            match chosen.iter().position(|&m| m == n) {
                Some(k) => {
                    chosen.remove(k);
                    factor.remove(k);
                }
                None => {
                    let column = chosen.iter().map(|&m| a(n, m)).collect();
                    assert!(factor.append(column, a(n, n)));
                    // The same variable again depends on itself.
                    let again = chosen.iter().chain([&n]).map(|&m| a(n, m)).collect();
                    assert!(!factor.append(again, a(n, n)));
                    chosen.push(n);
                }
            }
            let whole = Cholesky::new(chosen.len(), |i, j| a(chosen[i], chosen[j]));
            let whole = whole.map(|whole| whole.rows).unwrap_or_default();
            assert_eq!(whole.len(), factor.rows.len());
            for (a, b) in whole.iter().zip(&factor.rows) {
                // Condition numbers of some thousands, times a rounding of 1e-16.
                assert!((a.abs() - b.abs()).abs() < 1e-9, "{a} for {b}");
            }
            let x = factor.solve(chosen.iter().map(|&m| m as f64).collect());
            for &m in &chosen {
                let product: f64 = chosen.iter().zip(&x).map(|(&n, x)| a(m, n) * x).sum();
                assert!((product - m as f64).abs() < 1e-8, "{product} for {m}");
            }
        }
    }
}
