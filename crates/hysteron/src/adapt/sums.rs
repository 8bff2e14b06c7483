//! Sums of squares and products over the samples of a window. Samples are added when they enter
//! and taken away when they leave.
//!
//! The sums are those of the sparse rows ([`SparseForm`]), so a sample costs the same for any
//! number of levels. Only a refit turns them into sums over the operators.

use crate::identify::{BranchSums, SparseForm, Square, Term};

/// Rounding left after centring, relative to the diagonal before it.
const ROUNDING: f64 = 1e-13;

/// A sample in the window: the factors of its branch, and the output.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub(super) terms: [Term; 3],
    pub(super) output: f64,
}

/// The sums. `W` are the sparse rows and `y` the outputs.
#[derive(Debug, Clone)]
pub(super) struct Sums {
    /// `Wᵀ W`, `N × N`, row by row.
    gram: Vec<f64>,
    /// `Wᵀ y`.
    right: Vec<f64>,
    /// `Wᵀ 1`.
    rows: Vec<f64>,
    /// `1ᵀ y`.
    output: f64,
    count: f64,
}

/// The normal equations of the weights, with the best offset eliminated.
pub(super) struct Centred {
    /// `Φᵀ Φ`, centred, `N × N`, row by row.
    pub(super) gram: Vec<f64>,
    /// `Φᵀ y`, centred.
    pub(super) right: Vec<f64>,
    /// The mean state of each operator.
    means: Vec<f64>,
    /// The mean output.
    mean: f64,
    /// The largest diagonal element before centring: the size of its rounding errors.
    largest: f64,
}

impl Sums {
    pub(super) fn new(operators: usize) -> Self {
        Self {
            gram: vec![0.0; operators * operators],
            right: vec![0.0; operators],
            rows: vec![0.0; operators],
            output: 0.0,
            count: 0.0,
        }
    }

    pub(super) fn clear(&mut self) {
        for values in [&mut self.gram, &mut self.right, &mut self.rows] {
            values.fill(0.0);
        }
        (self.output, self.count) = (0.0, 0.0);
    }

    /// Adds samples of one branch, or takes them away with `sign` −1. `memory` are the factors of
    /// the turning points before the branch.
    pub(super) fn add<'a>(
        &mut self,
        sign: f64,
        memory: &[Term],
        samples: impl Iterator<Item = &'a Row>,
    ) {
        let count = self.rows.len();
        let mut sums = BranchSums::default();
        let (mut held, mut output) = (0.0, 0.0);
        let mut gram = Square::new(&mut self.gram, count);
        for Row { terms, output: y } in samples {
            sums.add(sign, terms, terms, &mut gram);
            for term in terms {
                self.rows[term.place as usize] += sign * term.factor;
                self.right[term.place as usize] += sign * y * term.factor;
            }
            held += sign;
            output += sign * y;
        }
        sums.flush(memory, memory, &mut gram);
        for term in memory {
            self.rows[term.place as usize] += held * term.factor;
            self.right[term.place as usize] += output * term.factor;
        }
        self.count += held;
        self.output += output;
    }

    /// The sums over the operators; `None` without samples.
    pub(super) fn centred(&self, form: &SparseForm) -> Option<Centred> {
        if self.count < 1.0 {
            return None;
        }
        let operators = self.rows.len();
        let mut gram = self.gram.clone();
        form.gram_of(&mut gram);
        let diagonal = (0..operators).map(|n| gram[n * (operators + 1)]);
        let largest = diagonal.fold(0.0, f64::max);
        let mut means = self.rows.clone();
        form.operators_of(&mut means);
        means.iter_mut().for_each(|sum| *sum /= self.count);
        let mut right = self.right.clone();
        form.operators_of(&mut right);
        for (a, row) in gram.chunks_exact_mut(operators).enumerate() {
            let share = self.count * means[a];
            row.iter_mut()
                .zip(&means)
                .for_each(|(g, m)| *g -= share * m);
        }
        let mean = self.output / self.count;
        right
            .iter_mut()
            .zip(&means)
            .for_each(|(b, m)| *b -= m * self.output);
        Some(Centred {
            gram,
            right,
            means,
            mean,
            largest,
        })
    }
}

impl Centred {
    /// The strength of a ridge relative to the mean diagonal element. It is zero where no sample
    /// moved an operator, and there is none where numbers overflow.
    pub(super) fn strength(&self, ridge: f64) -> Option<f64> {
        let count = self.right.len();
        let trace: f64 = (0..count).map(|n| self.gram[n * (count + 1)]).sum();
        let finite = trace.is_finite() && self.right.iter().all(|b| b.is_finite());
        let rounding = ROUNDING * self.largest;
        finite.then_some(match trace > rounding * count as f64 {
            true => ridge * trace / count as f64 + rounding,
            false => 0.0,
        })
    }

    /// The best offset for these weights.
    pub(super) fn offset(&self, weights: &[f64]) -> f64 {
        let products = self.means.iter().zip(weights).map(|(m, w)| m * w);
        self.mean - products.sum::<f64>()
    }
}
