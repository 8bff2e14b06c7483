//! The prior of the weights: neighbours in the plane have similar weights. It is scaled so that a
//! given strength means the same for any number of levels.
//!
//! With `α` and `β` in units of the plane's width, the weights are a density `ρ = K² μ` inside the
//! plane. On the diagonal, where operators have no memory, they are a line density `ρ = K μ`. The
//! penalty is on squared slopes of both densities (Tikhonov 1963), see [`Smooth`]. With `Δ` the
//! difference to the neighbour one level on, `λ ∫∫ (∂ρ)² = λ K⁴ Σ Δ²` inside and
//! `λ ∫ ρ'² = λ K³ Σ Δ²` on the diagonal. It is added to the mean squared error.

use crate::identify::weights::column::Column;
use crate::model::Smooth;
use hysteron_core::operator_index;

/// Pairs of neighbours in the plane, as operators, with their kind: along the diagonal 0, across it
/// 1, on it 2.
pub(crate) fn edges(levels: usize) -> Vec<(usize, usize, usize)> {
    let mut edges = Vec::new();
    for j in 1..=levels {
        for i in 1..=j {
            let here = operator_index(i, j);
            if j < levels {
                let kind = if i < j { 0 } else { 2 };
                edges.push((kind, here, operator_index(i + 1, j + 1)));
            }
            if i < j && j < levels {
                edges.push((1, here, operator_index(i, j + 1)));
            }
            if i + 1 < j {
                edges.push((1, here, operator_index(i + 1, j)));
            }
        }
    }
    edges
}

pub(crate) struct Smoothness {
    /// Pairs of neighbours, and the factor of their squared difference.
    edges: Vec<(usize, usize, f64)>,
    /// The factor of each kind of pair.
    pub(crate) strengths: [f64; 3],
    operators: usize,
}

impl Smoothness {
    /// No penalty.
    pub(crate) fn none() -> Self {
        Self {
            edges: Vec::new(),
            strengths: [0.0; 3],
            operators: 1,
        }
    }

    /// A penalty of these strengths, to be added to the sum of squared errors of `samples`.
    pub(crate) fn new(levels: usize, smooth: Smooth, samples: f64) -> Self {
        let k = levels as f64;
        let [along, across] = [smooth.along, smooth.across].map(|s| s * samples * k.powi(4));
        let line = (smooth.along + smooth.across) * samples * k.powi(3);
        let strengths = [along, across, line];
        let edges = match smooth.is_none() {
            true => Vec::new(),
            false => edges(levels),
        };
        let edges = edges.into_iter();
        let edges = edges.map(|(kind, from, to)| (from, to, strengths[kind]));
        Self {
            edges: edges.filter(|(.., factor)| *factor > 0.0).collect(),
            strengths,
            operators: operator_index(levels, levels) + 1,
        }
    }

    pub(crate) fn is_any(&self) -> bool {
        !self.edges.is_empty()
    }

    /// Adds the penalty's matrix to the Gram matrix of the columns.
    pub(crate) fn add_to(&self, gram: &mut [f64], columns: &[Column]) {
        if self.edges.is_empty() {
            return;
        }
        let mut members = vec![Vec::new(); self.places(columns)];
        for (n, column) in columns.iter().enumerate() {
            members[self.place(column)].push(n);
        }
        for part in members.chunks(self.operators) {
            for &(k, l, factor) in &self.edges {
                for (a, b, factor) in [
                    (k, k, factor),
                    (l, l, factor),
                    (k, l, -factor),
                    (l, k, -factor),
                ] {
                    for &a in &part[a] {
                        for &b in &part[b] {
                            gram[a * columns.len() + b] += factor;
                        }
                    }
                }
            }
        }
    }

    /// Adds the diagonal of the penalty's matrix.
    pub(crate) fn add_diagonal(&self, diagonal: &mut [f64], columns: &[Column]) {
        let mut own = vec![0.0; self.places(columns)];
        for part in own.chunks_mut(self.operators) {
            for &(k, l, factor) in &self.edges {
                part[k] += factor;
                part[l] += factor;
            }
        }
        if !self.edges.is_empty() {
            let all = diagonal.iter_mut().zip(columns);
            all.for_each(|(d, column)| *d += own[self.place(column)]);
        }
    }

    /// `P x`.
    pub(crate) fn times(&self, x: &[f64], columns: &[Column]) -> Vec<f64> {
        if self.edges.is_empty() {
            return vec![0.0; x.len()];
        }
        let mut weights = vec![0.0; self.places(columns)];
        for (column, x) in columns.iter().zip(x) {
            weights[self.place(column)] += x;
        }
        let mut slopes = vec![0.0; weights.len()];
        for (weights, slopes) in weights
            .chunks(self.operators)
            .zip(slopes.chunks_mut(self.operators))
        {
            for &(k, l, factor) in &self.edges {
                let slope = factor * (weights[k] - weights[l]);
                slopes[k] += slope;
                slopes[l] -= slope;
            }
        }
        columns.iter().map(|c| slopes[self.place(c)]).collect()
    }

    /// A random vector whose covariance is the penalty's matrix: one independent number of variance
    /// 1 from `normal` for each pair of neighbours.
    pub(crate) fn draw(&self, columns: &[Column], mut normal: impl FnMut() -> f64) -> Vec<f64> {
        let mut all = vec![0.0; self.places(columns)];
        for part in all.chunks_mut(self.operators) {
            for &(k, l, factor) in &self.edges {
                let pull = factor.sqrt() * normal();
                part[k] += pull;
                part[l] -= pull;
            }
        }
        columns.iter().map(|c| all[self.place(c)]).collect()
    }

    fn place(&self, column: &Column) -> usize {
        column.part * self.operators + column.operator
    }

    fn places(&self, columns: &[Column]) -> usize {
        let parts = columns.iter().map(|c| c.part + 1).max().unwrap_or(0);
        parts * self.operators
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line density `ρ = t` on the diagonal has `∫ ρ'² = 1`.
    #[test]
    fn the_diagonal_is_a_line() {
        for levels in [20, 80] {
            let k = levels as f64;
            let columns: Vec<Column> = (0..levels * (levels + 1) / 2)
                .map(|operator| Column::known(0, operator))
                .collect();
            let mut weights = vec![0.0; columns.len()];
            for i in 1..=levels {
                weights[operator_index(i, i)] = i as f64 / (k * k);
            }
            let slopes =
                Smoothness::new(levels, Smooth::from((0.0, 1.0)), 1.0).times(&weights, &columns);
            let value: f64 = weights.iter().zip(&slopes).map(|(w, s)| w * s).sum();
            // K − 1 of K steps.
            assert!(
                (value - (1.0 - 1.0 / k)).abs() < 1e-9,
                "K = {levels}: {value}"
            );
        }
    }

    /// A density `ρ = α + 2β` has `∫∫ |∇ρ|² = 5/2` on the plane, whatever its levels.
    #[test]
    fn strength_does_not_change_with_levels() {
        for levels in [20, 80] {
            let k = levels as f64;
            let columns: Vec<Column> = (0..levels * (levels + 1) / 2)
                .map(|operator| Column::known(0, operator))
                .collect();
            let mut weights = Vec::new();
            for j in 1..=levels {
                for i in 1..=j {
                    let inside = (i as f64 + 2.0 * j as f64) / k.powi(3);
                    weights.push(if i < j { inside } else { 0.0 });
                }
            }
            let penalty = Smoothness::new(levels, Smooth::from((0.0, 1.0)), 1.0);
            let slopes = penalty.times(&weights, &columns);
            let value: f64 = weights.iter().zip(&slopes).map(|(w, s)| w * s).sum();
            // The sum omits a strip of one step along the edges: at most 5 ΔT of the integral.
            assert!((value / 2.5 - 1.0).abs() < 5.0 / k, "K = {levels}: {value}");
            let mut gram = vec![0.0; weights.len().pow(2)];
            penalty.add_to(&mut gram, &columns);
            for (row, slope) in gram.chunks(weights.len()).zip(&slopes) {
                let product: f64 = row.iter().zip(&weights).map(|(a, b)| a * b).sum();
                // Sums of six products of about K.
                assert!((product - slope).abs() < 1e-9);
            }
        }
    }
}
