//! The sparse form of the regressor matrix, `Φ = W S`: `S` the prefix sums of the Everett table, a row
//! of `W` the few triangle factors of a sample's turning points. `Φ` itself is never formed.

use crate::{Operator, Plane, Result, State};
use hysteron_core::{Model, Turn, operator_index, table_index, table_len, turn_capacity};

/// The regressor of one recording: `n` samples, `N` operators with states in `[0, 1]`.
pub(super) struct SparseForm<'a> {
    plane: Plane,
    operator: Operator,
    input: &'a [f64],
    /// A model without weights, that moves states.
    blank: Model<f64, Vec<f64>>,
    /// From a place in the Everett table to the place of `C[p][q]` among the `N` with `q < p`;
    /// those with `q = p` are zero.
    place: Vec<Option<usize>>,
}

impl<'a> SparseForm<'a> {
    pub(super) fn new(plane: Plane, operator: Operator, input: &'a [f64]) -> Result<Self> {
        let levels = plane.levels();
        let zeros = vec![0.0; plane.operators()];
        let blank = Model::new(plane, operator, &zeros, vec![0.0; table_len(levels)])?;
        let mut place = vec![None; table_len(levels)];
        for p in 1..=levels {
            for q in 0..p {
                // C[p][q] has the place of weight (i, j) = (q + 1, p).
                place[table_index(p, q)] = Some(operator_index(q + 1, p));
            }
        }
        Ok(Self {
            plane,
            operator,
            input,
            blank,
            place,
        })
    }

    pub(super) fn samples(&self) -> usize {
        self.input.len()
    }

    pub(super) fn operators(&self) -> usize {
        self.plane.operators()
    }

    /// `Φ μ`: a run of the forward model, `O(n + K²)`.
    pub(super) fn forward(&self, weights: &[f64]) -> Result<Vec<f64>> {
        let table = vec![0.0; table_len(self.plane.levels())];
        // A relay's states come doubled and shifted by its output of ±1; KP states are those of MKP.
        let relay = self.operator == Operator::Relay;
        let operator = if relay {
            Operator::Relay
        } else {
            Operator::Mkp
        };
        let model = Model::new(self.plane, operator, weights, table)?;
        let mut output = vec![0.0; self.input.len()];
        model.run(&mut state_of(&model)?, self.input, &mut output)?;
        if relay {
            let (low, high) = model.output_range();
            output
                .iter_mut()
                .for_each(|y| *y = (*y + 0.5 * (high - low)) * 0.5);
        }
        Ok(output)
    }

    /// `Φᵀ r`, the adjoint run.
    pub(super) fn adjoint(&self, residual: &[f64]) -> Result<Vec<f64>> {
        let mut sums = vec![0.0; self.operators()];
        self.rows(|n, terms| {
            for &(place, factor) in terms {
                sums[place] += factor * residual[n];
            }
        })?;
        transpose_sums(self.plane.levels(), &mut sums);
        Ok(sums)
    }

    /// `Φᵀ Φ = Sᵀ (Wᵀ W) S`, row by row, `N × N`: `O(n · nnz² + N²)`.
    pub(super) fn gram(&self) -> Result<Vec<f64>> {
        let count = self.operators();
        let levels = self.plane.levels();
        let mut gram = vec![0.0; count * count];
        self.rows(|_, terms| {
            for &(a, factor_a) in terms {
                for &(b, factor_b) in terms {
                    gram[a * count + b] += factor_a * factor_b;
                }
            }
        })?;
        // Sᵀ from the left: the same sums with whole rows as elements; then from the right.
        let row = |i: usize, j: usize| operator_index(i, j) * count;
        for j in 1..=levels {
            for i in 2..=j {
                add_row(&mut gram, row(i - 1, j), row(i, j), count);
            }
        }
        for j in (1..levels).rev() {
            for i in 1..=j {
                add_row(&mut gram, row(i, j + 1), row(i, j), count);
            }
        }
        for row in gram.chunks_exact_mut(count) {
            transpose_sums(levels, row);
        }
        Ok(gram)
    }

    /// Hands the non-zero elements of each row of `W` to `each`, every place once.
    fn rows(&self, mut each: impl FnMut(usize, &[(usize, f64)])) -> Result<()> {
        let mut state = state_of(&self.blank)?;
        let mut terms: Vec<(usize, f64)> = Vec::new();
        for (n, &input) in self.input.iter().enumerate() {
            self.blank.step(&mut state, input)?;
            terms.clear();
            state.everett_terms(|index, factor| {
                if let (Some(place), true) = (self.place[index], factor != 0.0) {
                    match terms.iter_mut().find(|(other, _)| *other == place) {
                        Some((_, sum)) => *sum += factor,
                        None => terms.push((place, factor)),
                    }
                }
            });
            each(n, &terms);
        }
        Ok(())
    }
}

fn state_of(model: &Model<f64, Vec<f64>>) -> Result<State> {
    let memory = vec![Turn::default(); turn_capacity(model.plane().levels())];
    Ok(model.state(memory)?)
}

/// `Sᵀ w` in place: operator `(i, j)` is part of every `C[p][q]` with `p ≥ j` and `q < i`.
fn transpose_sums(levels: usize, w: &mut [f64]) {
    for j in 1..=levels {
        for i in 2..=j {
            w[operator_index(i, j)] += w[operator_index(i - 1, j)];
        }
    }
    for j in (1..levels).rev() {
        for i in 1..=j {
            w[operator_index(i, j)] += w[operator_index(i, j + 1)];
        }
    }
}

fn add_row(matrix: &mut [f64], from: usize, to: usize, count: usize) {
    let (source, target) = if from < to {
        let (head, tail) = matrix.split_at_mut(to);
        (&head[from..from + count], &mut tail[..count])
    } else {
        let (head, tail) = matrix.split_at_mut(from);
        (&tail[..count], &mut head[to..to + count])
    };
    for (t, s) in target.iter_mut().zip(source) {
        *t += s;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use hysteron_core::Definition;
    use rand::{RngExt, SeedableRng};

    /// `Φ` from the definition, column by column of each row.
    fn dense(plane: Plane, operator: Operator, input: &[f64]) -> Vec<Vec<f64>> {
        let weights = vec![1.0; plane.operators()];
        let mut states = weights.clone();
        let mut plain = Definition::new(plane, operator, &weights, &mut states).unwrap();
        let step = |&t: &f64| {
            plain.step(t).unwrap();
            plain.states().to_vec()
        };
        input.iter().map(step).collect()
    }

    #[test]
    fn products_equal_those_with_the_dense_matrix() {
        for (seed, levels) in [2, 3, 7, 15].into_iter().enumerate() {
            for operator in [Operator::Mkp, Operator::Kp, Operator::Relay] {
                let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed as u64);
                let plane = Plane::new(-1.0, 4.0, levels).unwrap();
                let input: Vec<f64> = (0..300).map(|_| rng.random_range(-4.0..5.0)).collect();
                let form = SparseForm::new(plane, operator, &input).unwrap();
                let phi = dense(plane, operator, &input);
                let count = plane.operators();
                let mu: Vec<f64> = (0..count).map(|_| rng.random_range(-1.0..1.0)).collect();
                let r: Vec<f64> = input.iter().map(|_| rng.random_range(-1.0..1.0)).collect();
                // Sums of at most 300 · N numbers of size one.
                let close = |a: f64, b: f64| (a - b).abs() < 1e-10;
                let forward = form.forward(&mu).unwrap();
                for (row, y) in phi.iter().zip(&forward) {
                    assert!(close(row.iter().zip(&mu).map(|(a, b)| a * b).sum(), *y));
                }
                let adjoint = form.adjoint(&r).unwrap();
                let gram = form.gram().unwrap();
                for a in 0..count {
                    assert!(close(
                        phi.iter().zip(&r).map(|(row, r)| row[a] * r).sum(),
                        adjoint[a]
                    ));
                    for b in 0..count {
                        let exact: f64 = phi.iter().map(|row| row[a] * row[b]).sum();
                        assert!(close(exact, gram[a * count + b]), "K = {levels}, {a}, {b}");
                    }
                }
            }
        }
    }
}
