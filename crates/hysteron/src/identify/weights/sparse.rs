//! The sparse form of the regressor matrix, `Φ = W S`. `S` is the prefix sum of the Everett table.
//! A row of `W` holds the few triangle factors of a sample's turning points. `Φ` itself is never
//! formed.
//!
//! Along a branch only three factors of a row change. The factors of the turning points before the
//! branch stay the same. So sums over samples are taken branch by branch: `O(1)` per sample, and
//! the turning points once per branch.

use crate::error::Result;
use crate::identify::initial::Initial;
use crate::identify::weights::rows::{Rows, Term, branch_terms, memory_terms};
use crate::model::{OperatorState, Plane};
use crate::progress::Progress;
use hysteron_core::Operator;
use hysteron_core::{Model, operator_index, operators, table_index, table_len};

/// An operator is undetermined if more than this share of it is. Smaller shares are rounding of a
/// first sample at the edge of the plane.
pub(crate) const OPEN: f64 = 1e-9;

/// Number of samples between two progress reports of a long loop.
const REPORT: usize = 1 << 16;
/// Samples that the model runs through at once.
const BLOCK: usize = 1024;

/// The regressor of a plane: `N` operators with states in `[0, 1]`, for any input.
#[derive(Debug, Clone)]
pub(crate) struct SparseForm {
    plane: Plane,
    operator: Operator,
    /// A model without weights, which only moves states.
    blank: Model<f64, Vec<f64>>,
    /// Maps an index in the Everett table to the index of `C[p][q]` among the `N` corners with
    /// `q < p`; [`Term::NOWHERE`] for the corners with `q = p`, which are zero.
    place: Vec<u32>,
}

impl SparseForm {
    pub(crate) fn new(plane: Plane, operator: Operator) -> Result<Self> {
        let levels = plane.levels();
        let zeros = vec![0.0; plane.operators()];
        let blank = Model::new(plane, operator, &zeros, vec![0.0; table_len(levels)])?;
        let mut place = vec![Term::NOWHERE; table_len(levels)];
        for p in 1..=levels {
            for q in 0..p {
                // C[p][q] has the index of the weight (i, j) = (q + 1, p).
                place[table_index(p, q)] = operator_index(q + 1, p) as u32;
            }
        }
        Ok(Self {
            plane,
            operator,
            blank,
            place,
        })
    }

    pub(crate) fn plane(&self) -> &Plane {
        &self.plane
    }

    pub(crate) fn operators(&self) -> usize {
        self.plane.operators()
    }

    pub(crate) fn rows(&self, from: Initial) -> Result<Rows<'_>> {
        Rows::new(&self.blank, &self.place, from)
    }

    /// The factors of the branch that `state` is on, and those of the turning points before it are
    /// written to `memory` if that is given. The state may be that of any model of this plane and
    /// operator.
    pub(crate) fn row(&self, state: &OperatorState, memory: Option<&mut Vec<Term>>) -> [Term; 3] {
        if let Some(memory) = memory {
            memory_terms(state, &self.place, memory);
        }
        branch_terms(state, &self.place)
    }

    /// The share of each operator that the first sample does not determine: its state from on minus
    /// its state from off.
    pub(crate) fn open(&self, first: f64) -> Result<Vec<f64>> {
        let levels = self.plane.levels();
        let (mut off, mut on) = (self.rows(Initial::Off)?, self.rows(Initial::On)?);
        off.leaves_branch(first)?;
        on.leaves_branch(first)?;
        operators(levels)
            .map(|(i, j)| Ok(on.state().gamma(i, j)? - off.state().gamma(i, j)?))
            .collect()
    }

    /// Tells `Φ μ` at each sample: a run of the forward model, `O(n + K²)`.
    pub(crate) fn forward(
        &self,
        weights: &[f64],
        input: &[f64],
        from: Initial,
        mut tell: impl FnMut(usize, f64),
    ) -> Result<()> {
        let table = vec![0.0; table_len(self.plane.levels())];
        // A relay's output is ±1: scale and shift it to [0, 1]. KP states are those of MKP already.
        let relay = self.operator == Operator::Relay;
        let operator = if relay {
            Operator::Relay
        } else {
            Operator::Mkp
        };
        let model = Model::new(self.plane, operator, weights, table)?;
        let (low, high) = model.output_range();
        let mut output = [0.0; BLOCK];
        let mut state = from.state(&model)?;
        for (block, input) in input.chunks(BLOCK).enumerate() {
            model.run(&mut state, input, &mut output)?;
            for (n, y) in output[..input.len()].iter().enumerate() {
                let y = match relay {
                    true => (y + 0.5 * (high - low)) * 0.5,
                    false => *y,
                };
                tell(block * BLOCK + n, y);
            }
        }
        Ok(())
    }

    /// Adds `Wᵀ r` over the samples of each group to its `sums`. Samples without a group do not
    /// count. [`SparseForm::operators_of`] turns the results into `Φᵀ r`.
    pub(crate) fn add_adjoints(
        &self,
        input: &[f64],
        from: Initial,
        residual: impl Fn(usize) -> f64,
        group: impl Fn(usize) -> Option<usize>,
        sums: &mut [Vec<f64>],
    ) -> Result<()> {
        let mut rows = self.rows(from)?;
        let (mut held, mut at) = (0.0, None);
        for (n, &x) in input.iter().enumerate() {
            let left_branch = rows.leaves_branch(x)?;
            let next = group(n);
            if left_branch || next != at {
                if let Some(at) = at {
                    rows.add_memory(held, &mut sums[at]);
                }
                (held, at) = (0.0, next);
            }
            if left_branch {
                rows.remember();
            }
            let Some(at) = at else {
                continue;
            };
            let r = residual(n);
            held += r;
            for term in rows.branch() {
                sums[at][term.place as usize] += term.factor * r;
            }
        }
        if let Some(at) = at {
            rows.add_memory(held, &mut sums[at]);
        }
        Ok(())
    }

    /// Adds `Φ μ` times `scale` to the output of each sample that has a group, with the `corners`
    /// `S μ` of its group, see [`SparseForm::corners_of`].
    pub(crate) fn add_forward(
        &self,
        input: &[f64],
        from: Initial,
        corners: &[Vec<f64>],
        group: impl Fn(usize) -> Option<usize>,
        mut add: impl FnMut(usize, f64),
    ) -> Result<()> {
        let mut rows = self.rows(from)?;
        let (mut held, mut at) = (0.0, None);
        for (n, &x) in input.iter().enumerate() {
            let left_branch = rows.leaves_branch(x)?;
            if left_branch {
                rows.remember();
            }
            let next = group(n);
            let Some(own) = next.map(|group| &corners[group]) else {
                at = None;
                continue;
            };
            let product = |term: &Term| term.factor * own[term.place as usize];
            if left_branch || next != at {
                held = rows.memory().iter().map(product).sum();
                at = next;
            }
            add(n, held + rows.branch().iter().map(product).sum::<f64>());
        }
        Ok(())
    }

    /// `S μ` in place: the Everett corners `C[p][q] = Σ μ_ij` over `j ≤ p`, `i > q`, each at the
    /// index of the weight `(q + 1, p)`.
    pub(crate) fn corners_of(&self, mu: &mut [f64]) {
        let levels = self.plane.levels();
        for j in 1..=levels {
            for i in (1..j).rev() {
                mu[operator_index(i, j)] += mu[operator_index(i + 1, j)];
            }
        }
        for j in 2..=levels {
            for i in 1..j {
                mu[operator_index(i, j)] += mu[operator_index(i, j - 1)];
            }
        }
    }

    /// `Sᵀ w` in place: operator `(i, j)` is part of every `C[p][q]` with `p ≥ j` and `q < i`.
    pub(crate) fn operators_of(&self, w: &mut [f64]) {
        transpose_sums(self.plane.levels(), w);
    }

    /// Adds `Wᵀ diag(scale) W'` over the samples of each group to its part of `grams`, where `W` and `W'` are the rows for the two starts. Samples without a group do not
    /// count. [`SparseForm::gram_of`] turns the results into `Φᵀ diag(scale) Φ'`.
    pub(crate) fn add_outer(
        &self,
        input: &[f64],
        (left, right): (Initial, Initial),
        scale: impl Fn(usize) -> f64,
        group: impl Fn(usize) -> Option<usize>,
        grams: &mut [impl Accumulate],
        progress: Progress<'_>,
    ) -> Result<()> {
        let mut a = self.rows(left)?;
        // If both sides have the same rows, compute them once.
        let mut other = (left != right).then(|| self.rows(right)).transpose()?;
        let mut sums = BranchSums::default();
        let mut at = None;
        for (n, &x) in input.iter().enumerate() {
            if n % REPORT == 0 {
                progress.tell("samples", n as f64 / input.len() as f64)?;
            }
            let mut left_branch = a.leaves_branch(x)?;
            if let Some(b) = &mut other {
                left_branch |= b.leaves_branch(x)?;
            }
            let next = group(n);
            if left_branch || next != at {
                if let Some(at) = at {
                    let b = other.as_ref().unwrap_or(&a);
                    sums.flush(a.memory(), b.memory(), &mut grams[at]);
                }
                at = next;
            }
            if left_branch {
                a.remember();
                if let Some(b) = &mut other {
                    b.remember();
                }
            }
            let Some(at) = at else {
                continue;
            };
            let t = a.branch();
            let u = other.as_ref().map_or(t, Rows::branch);
            sums.add(scale(n), &t, &u, &mut grams[at]);
        }
        if let Some(at) = at {
            let b = other.as_ref().unwrap_or(&a);
            sums.flush(a.memory(), b.memory(), &mut grams[at]);
        }
        Ok(())
    }

    /// `Sᵀ A S` in place.
    pub(crate) fn gram_of(&self, gram: &mut [f64]) {
        let (count, levels) = (self.operators(), self.plane.levels());
        // Sᵀ from the left: the same sums with whole rows as elements. Then S from the right.
        let row = |i: usize, j: usize| operator_index(i, j) * count;
        for j in 1..=levels {
            for i in 2..=j {
                add_row(gram, row(i - 1, j), row(i, j), count);
            }
        }
        for j in (1..levels).rev() {
            for i in 1..=j {
                add_row(gram, row(i, j + 1), row(i, j), count);
            }
        }
        for row in gram.chunks_exact_mut(count) {
            transpose_sums(levels, row);
        }
    }
}

/// A matrix whose elements are sums.
pub(crate) trait Accumulate {
    fn add(&mut self, row: usize, column: usize, value: f64);
}

/// A square matrix, row by row.
pub(crate) struct Square<'a> {
    values: &'a mut [f64],
    count: usize,
}

impl<'a> Square<'a> {
    pub(crate) fn new(values: &'a mut [f64], count: usize) -> Self {
        Self { values, count }
    }
}

impl Accumulate for Square<'_> {
    #[inline]
    fn add(&mut self, row: usize, column: usize, value: f64) {
        self.values[row * self.count + column] += value;
    }
}

/// Sums over the samples of one branch. With `f`, `g` the factors of the turning points and `t`,
/// `u` those of the branch, `Σ s (f + t)(g + u)ᵀ = f gᵀ Σ s + f (Σ s u)ᵀ + (Σ s t) gᵀ + Σ s t uᵀ`.
#[derive(Default)]
pub(crate) struct BranchSums {
    scale: f64,
    left: Vec<Term>,
    right: Vec<Term>,
}

impl BranchSums {
    /// Adds a sample with the factors `t` and `u` of the branch, times `s`. Their own product goes
    /// to `gram` at once.
    pub(crate) fn add(&mut self, s: f64, t: &[Term; 3], u: &[Term; 3], gram: &mut impl Accumulate) {
        for t in t {
            for u in u {
                gram.add(t.place as usize, u.place as usize, s * t.factor * u.factor);
            }
        }
        self.scale += s;
        for (sums, terms) in [(&mut self.left, t), (&mut self.right, u)] {
            for term in terms {
                // A branch passes its triangles in order, so a triangle seen before is among the
                // last ones.
                let recent = sums.len().saturating_sub(4);
                match sums[recent..]
                    .iter_mut()
                    .find(|sum| sum.place == term.place)
                {
                    Some(sum) => sum.factor += s * term.factor,
                    None => sums.push(Term {
                        place: term.place,
                        factor: s * term.factor,
                    }),
                }
            }
        }
    }

    /// Adds what depends on the turning points to `gram`, at the end of a branch.
    pub(crate) fn flush(&mut self, f: &[Term], g: &[Term], gram: &mut impl Accumulate) {
        let mut outer = |a: &[Term], b: &[Term], scale: f64| {
            for a in a {
                for b in b {
                    gram.add(
                        a.place as usize,
                        b.place as usize,
                        scale * a.factor * b.factor,
                    );
                }
            }
        };
        outer(f, g, self.scale);
        outer(f, &self.right, 1.0);
        outer(&self.left, g, 1.0);
        self.scale = 0.0;
        self.left.clear();
        self.right.clear();
    }
}

fn transpose_sums(levels: usize, w: &mut [f64]) {
    // Row `j` holds the elements of operators `(1, j)` to `(j, j)`.
    let mut rest = &mut w[..];
    for j in 1..=levels {
        let (row, below) = rest.split_at_mut(j);
        let mut sum = 0.0;
        for element in row {
            sum += *element;
            *element = sum;
        }
        rest = below;
    }
    for j in (1..levels).rev() {
        let (rows, below) = w.split_at_mut(operator_index(1, j + 1));
        let row = &mut rows[operator_index(1, j)..];
        row.iter_mut().zip(below).for_each(|(a, b)| *a += *b);
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
    use hysteron_core::{Definition, operator_count};
    use rand::{RngExt, SeedableRng};

    /// `Φ` from the definition, one row per sample.
    fn dense(plane: Plane, operator: Operator, input: &[f64], from: Initial) -> Vec<Vec<f64>> {
        let weights = vec![1.0; plane.operators()];
        let mut states = weights.clone();
        let mut plain = Definition::new(plane, operator, &weights, &mut states).unwrap();
        if from == Initial::On {
            plain.step(plane.max()).unwrap();
        }
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
                for starts in [
                    (Initial::Off, Initial::Off),
                    (Initial::On, Initial::On),
                    (Initial::Off, Initial::On),
                ] {
                    agrees(seed as u64, levels, operator, starts);
                }
            }
        }
    }

    fn agrees(seed: u64, levels: usize, operator: Operator, (left, right): (Initial, Initial)) {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let plane = Plane::new(-1.0, 4.0, levels).unwrap();
        // Runs of small steps, so that branches have many samples, with jumps between them.
        let mut x = 0.0;
        let input: Vec<f64> = (0..400)
            .map(|_| {
                x = match rng.random_range(0..10) {
                    0 => rng.random_range(-4.0..5.0),
                    _ => x + rng.random_range(-0.3..0.4),
                };
                x
            })
            .collect();
        let form = SparseForm::new(plane, operator).unwrap();
        let count = operator_count(levels);
        let phi = [left, right].map(|from| dense(plane, operator, &input, from));
        let mu: Vec<f64> = (0..count).map(|_| rng.random_range(-1.0..1.0)).collect();
        let r: Vec<f64> = input.iter().map(|_| rng.random_range(-1.0..1.0)).collect();
        // Sums of at most 400 · N numbers of size one.
        let close = |a: f64, b: f64| (a - b).abs() < 1e-10;
        let mut forward = vec![f64::NAN; input.len()];
        form.forward(&mu, &input, left, |n, y| forward[n] = y)
            .unwrap();
        for (row, y) in phi[0].iter().zip(&forward) {
            assert!(close(row.iter().zip(&mu).map(|(a, b)| a * b).sum(), *y));
        }
        // Groups change anywhere, also in the middle of a branch, and some samples have none.
        let mut own = 0;
        let group: Vec<Option<usize>> = input
            .iter()
            .map(|_| {
                if rng.random_range(0..7) == 0 {
                    own = rng.random_range(0..4);
                }
                (own < 3).then_some(own)
            })
            .collect();
        let scale = |n: usize| r[n];
        let mut adjoints = vec![vec![0.0; count]; 3];
        form.add_adjoints(&input, left, scale, |n| group[n], &mut adjoints)
            .unwrap();
        let mut grams = vec![vec![0.0; count * count]; 3];
        let starts = (left, right);
        let mut squares: Vec<Square<'_>> = grams
            .iter_mut()
            .map(|gram| Square::new(gram, count))
            .collect();
        form.add_outer(
            &input,
            starts,
            scale,
            |n| group[n],
            &mut squares,
            Progress::NONE,
        )
        .unwrap();
        for (g, (adjoint, gram)) in adjoints.iter_mut().zip(&mut grams).enumerate() {
            form.operators_of(adjoint);
            form.gram_of(gram);
            let inside = |n: &usize| group[*n] == Some(g);
            for a in 0..count {
                let own = (0..input.len()).filter(inside);
                let exact: f64 = own.map(|n| phi[0][n][a] * r[n]).sum();
                assert!(close(exact, adjoint[a]));
                for b in 0..count {
                    let own = (0..input.len()).filter(inside);
                    let exact: f64 = own.map(|n| phi[0][n][a] * r[n] * phi[1][n][b]).sum();
                    assert!(close(exact, gram[a * count + b]), "K = {levels}, {a}, {b}");
                }
            }
        }
        let weights = [1.0, -2.0, 0.5].map(|factor| mu.iter().map(|mu| factor * mu).collect());
        let corners = weights.clone().map(|mut mu: Vec<f64>| {
            form.corners_of(&mut mu);
            mu
        });
        let mut found = vec![0.0; input.len()];
        form.add_forward(&input, left, &corners, |n| group[n], |n, h| found[n] += h)
            .unwrap();
        for (n, row) in phi[0].iter().enumerate() {
            let own = group[n].map_or(0.0, |g| {
                row.iter().zip(&weights[g]).map(|(a, b)| a * b).sum()
            });
            assert!(close(own, found[n]), "K = {levels}, sample {n}");
        }
    }
}
