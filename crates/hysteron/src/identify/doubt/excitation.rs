//! How well recorded inputs determine each operator's weight. This depends on the input only, not
//! on the output.
//!
//! The offset is free, so the relevant matrix is the regressor with its column means subtracted. A
//! weight is determined if its unit vector lies in the row space of that matrix. The test uses the
//! resolution matrix `R = (G + εI)⁻¹ G` (Backus and Gilbert 1968), where `G` is the centred Gram
//! matrix. A diagonal element of 1 means that the weight is determined. Less than 1 means that a
//! part of the weight can be moved to other operators without a change of the output.

use crate::error::{Error, Result};
use crate::identify::initial::Initial;
use crate::identify::weights::sparse::{SparseForm, Square};
use crate::model::Excitation;
use crate::model::Plane;
use crate::progress::Progress;
use crate::series::{NOISE, Turning, usual_tolerance};
use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, Side};
use hysteron_core::Definition;
use hysteron_core::Operator;

/// Ridge `ε`. The centred Gram matrix counts samples. An operator that swings fully on its own for
/// a few samples has an element of about 1. A spiral of [`crate::design()`] with ten samples per
/// level has no eigenvalue below 0.1. Swings of 1 % in a single sample give 1e-4 and count as none.
const RIDGE: f64 = 1e-4;

/// Rounding of the Gram matrix relative to its trace. The trace bounds every eigenvalue.
const ROUNDING: f64 = 1e-12;

/// A weight counts as determined if its unresolved part is at most this. The ridge alone leaves up
/// to `RIDGE / 0.1`. One missing equation among weights leaves 1/4, because its coefficients are
/// `+1, −1, −1, +1` around a corner. If a whole row is seen only as a sum, 1/K is left.
pub(crate) const UNRESOLVED: f64 = 5e-3;

/// The class of every operator, in the order of the weights, for recorded `inputs`. Each input
/// starts with every operator off. One offset is common to all.
///
/// A branch ends at a reversal of more than 1 % of the recording's range. Noise on an input counts
/// as movement, so prepare a noisy input first. `O(n + N³)` time and `O(N²)` memory.
///
/// ```
/// use hysteron::{Excitation, Operator, Plane, excitation};
/// let plane = Plane::new(1.0, 2.0, 2)?; // operators (1, 1), (1, 2), (2, 2)
/// let found = excitation(&[&[0.0, 1.0, 2.0]], plane, Operator::Mkp)?;
/// // The last two switch on together, and not off again.
/// assert_eq!(found, [Excitation::Determined, Excitation::Once, Excitation::Once]);
/// let found = excitation(&[&[0.0, 1.0, 2.0, 1.0]], plane, Operator::Mkp)?;
/// assert_eq!(found, [Excitation::Determined; 3]);
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// [`Error::Core`] for an input that is not finite; [`Error::Fit`] if the Gram matrix of the
/// plane's operators would be too large.
pub fn excitation(inputs: &[&[f64]], plane: Plane, operator: Operator) -> Result<Vec<Excitation>> {
    Unresolved::new(inputs, plane, operator, Initial::Off)?.classes(inputs)
}

/// What recorded inputs leave unresolved: `I − R = ε (G + εI)⁻¹`, the share of a unit prior
/// variance that remains after data of unit noise.
pub(crate) struct Unresolved {
    form: SparseForm,
    operator: Operator,
    start: Initial,
    matrix: Mat<f64>,
}

impl Unresolved {
    pub(crate) fn new(
        inputs: &[&[f64]],
        plane: Plane,
        operator: Operator,
        start: Initial,
    ) -> Result<Self> {
        crate::identify::weights::room::check_dense(plane.operators())?;
        let count = plane.operators();
        let form = SparseForm::new(plane, operator)?;
        let mut gram = centred_gram(inputs, &form, start)?;
        let trace: f64 = (0..count).map(|n| gram[n * count + n]).sum();
        let ridge = RIDGE.max(ROUNDING * trace);
        for n in 0..count {
            gram[n * count + n] += ridge;
        }
        let factor = Mat::from_fn(count, count, |a, b| gram[a * count + b])
            .llt(Side::Lower)
            .map_err(|_| {
                Error::Fit("the Gram matrix is not definite: the input cannot be used".into())
            })?;
        let mut matrix = factor.inverse();
        matrix *= faer::Scale(ridge);
        Ok(Self {
            form,
            operator,
            start,
            matrix,
        })
    }

    pub(crate) fn classes(&self, inputs: &[&[f64]]) -> Result<Vec<Excitation>> {
        let moves = branches_moved(inputs, *self.form.plane(), self.operator, self.start)?;
        let class = |(n, moves): (usize, usize)| match moves {
            _ if self.matrix[(n, n)] <= UNRESOLVED => Excitation::Determined,
            0 => Excitation::Never,
            1 => Excitation::Once,
            _ => Excitation::Ambiguous,
        };
        Ok(moves.into_iter().enumerate().map(class).collect())
    }

    /// Which Everett corners `C[p][q]`, `q < p`, are determined. Each is at the index of the weight
    /// `(q + 1, p)`.
    ///
    /// A corner is a sum of weights, so its unresolved part is on the diagonal of `S (I − R) Sᵀ`.
    pub(crate) fn corners_known(&self) -> Vec<bool> {
        let count = self.form.operators();
        let mut half = self.matrix.clone();
        for row in 0..count {
            let mut sums: Vec<f64> = (0..count).map(|n| half[(row, n)]).collect();
            self.form.corners_of(&mut sums);
            for (n, sum) in sums.into_iter().enumerate() {
                half[(row, n)] = sum;
            }
        }
        let known = |n: usize| {
            let mut sums: Vec<f64> = (0..count).map(|row| half[(row, n)]).collect();
            self.form.corners_of(&mut sums);
            sums[n] <= UNRESOLVED
        };
        (0..count).map(known).collect()
    }
}

/// `Φᵀ Φ` of all recordings together, with the common mean subtracted from every column.
pub(super) fn centred_gram(
    inputs: &[&[f64]],
    form: &SparseForm,
    start: Initial,
) -> Result<Vec<f64>> {
    let count = form.operators();
    let mut gram = vec![0.0; count * count];
    let mut all = [vec![0.0; count]];
    for input in inputs {
        let (one, group) = (|_| 1.0, |_| Some(0));
        let mut squares = [Square::new(&mut gram, count)];
        form.add_outer(
            input,
            (start, start),
            one,
            group,
            &mut squares,
            Progress::NONE,
        )?;
        form.add_adjoints(input, start, one, group, &mut all)?;
    }
    let [mut sums] = all;
    form.gram_of(&mut gram);
    form.operators_of(&mut sums);
    let samples = inputs.iter().map(|input| input.len()).sum::<usize>().max(1) as f64;
    for (row, a) in gram.chunks_exact_mut(count).zip(&sums) {
        for (element, b) in row.iter_mut().zip(&sums) {
            *element -= a * b / samples;
        }
    }
    Ok(gram)
}

/// The number of branches on which each operator moves by more than 1 % of its swing.
fn branches_moved(
    inputs: &[&[f64]],
    plane: Plane,
    operator: Operator,
    start: Initial,
) -> Result<Vec<usize>> {
    let mut moves = vec![0; plane.operators()];
    let weights = vec![0.0; plane.operators()];
    for input in inputs {
        let Some(&first) = input.first() else {
            continue;
        };
        let mut states = weights.clone();
        let mut plain = Definition::new(plane, operator, &weights, &mut states)?;
        match start {
            Initial::Off => {}
            Initial::On => _ = plain.step(plane.max())?,
            Initial::After(inputs) => {
                for input in inputs {
                    plain.step(input)?;
                }
            }
        }
        // The movement before the first sample was not recorded, so it does not count.
        plain.step(first)?;
        let mut before = plain.states().to_vec();
        for end in branch_ends(input) {
            plain.step(end)?;
            for ((moves, before), &after) in moves.iter_mut().zip(&mut before).zip(plain.states()) {
                *moves += usize::from((after - *before).abs() > NOISE);
                *before = after;
            }
        }
    }
    Ok(moves)
}

/// The input at the end of each branch.
fn branch_ends(input: &[f64]) -> Vec<f64> {
    let mut turning = Turning::new(usual_tolerance(input));
    let turns = input.iter().filter_map(|&t| turning.push(t));
    // The start is reported as a turning point; it begins the first branch.
    let mut ends: Vec<f64> = turns.skip(1).map(|(n, _)| input[n]).collect();
    ends.extend(turning.branch().map(|(_, n)| input[n]));
    ends
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use rand::{RngExt, SeedableRng};

    /// Whether each unit vector lies in the span of the rows, by Gaussian elimination on the dense
    /// matrix.
    fn in_row_space(rows: &[Vec<f64>], count: usize) -> Vec<bool> {
        let mut rows: Vec<Vec<f64>> = rows.to_vec();
        let mut pivots = 0;
        for column in 0..count {
            let best = (pivots..rows.len())
                .max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
            let Some(best) = best.filter(|&n| rows[n][column].abs() > 1e-9) else {
                continue;
            };
            rows.swap(pivots, best);
            let pivot = rows[pivots].clone();
            for (n, row) in rows.iter_mut().enumerate() {
                let factor = row[column] / pivot[column];
                if n != pivots && factor != 0.0 {
                    row.iter_mut()
                        .zip(&pivot)
                        .for_each(|(r, p)| *r -= factor * p);
                }
            }
            pivots += 1;
        }
        // In reduced form, a unit vector in the span is itself a row.
        (0..count)
            .map(|n| {
                rows[..pivots].iter().any(|row| {
                    let others = row.iter().enumerate().filter(|&(m, _)| m != n);
                    row[n].abs() > 1e-9 && others.map(|(_, r)| r.abs()).fold(0.0, f64::max) < 1e-7
                })
            })
            .collect()
    }

    #[test]
    fn agrees_with_elimination_on_the_definition() {
        for operator in [Operator::Mkp, Operator::Kp, Operator::Relay] {
            for seed in 0..12 {
                let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
                let levels = 2 + seed as usize % 4;
                let plane = Plane::new(1.0, levels as f64, levels).unwrap();
                // With turning points on a quarter grid, every determined weight is determined well
                // above the ridge.
                let turns = 2 + seed % 7;
                let mut input = vec![0.0];
                for _ in 0..turns {
                    let to = f64::from(rng.random_range(0..=4 * levels as u32)) * 0.25;
                    let from = *input.last().unwrap();
                    let count = ((to - from).abs() * 8.0) as u32;
                    input.extend(
                        (1..=count).map(|k| from + (to - from) * f64::from(k) / f64::from(count)),
                    );
                }
                let weights = vec![0.0; plane.operators()];
                let mut states = weights.clone();
                let mut plain = Definition::new(plane, operator, &weights, &mut states).unwrap();
                let rows: Vec<Vec<f64>> = input
                    .iter()
                    .map(|&t| {
                        plain.step(t).unwrap();
                        plain.states().to_vec()
                    })
                    .collect();
                let differences: Vec<Vec<f64>> = rows
                    .windows(2)
                    .map(|pair| pair[1].iter().zip(&pair[0]).map(|(a, b)| a - b).collect())
                    .collect();
                let expected = in_row_space(&differences, plane.operators());
                let found = excitation(&[&input], plane, operator).unwrap();
                let determined: Vec<bool> = found
                    .iter()
                    .map(|class| *class == Excitation::Determined)
                    .collect();
                assert_eq!(determined, expected, "{operator:?}, seed {seed}: {input:?}");
                for (n, class) in found.iter().enumerate() {
                    let moves = rows.iter().any(|row| row[n] != rows[0][n]);
                    assert_eq!(
                        *class == Excitation::Never,
                        !moves,
                        "{operator:?}, seed {seed}, {n}"
                    );
                }
            }
        }
    }

    #[test]
    fn several_recordings_say_together_what_none_says_alone() {
        let plane = Plane::new(1.0, 3.0, 3).unwrap();
        let up = [0.0, 1.0, 2.0, 3.0];
        let inner = [0.0, 2.0, 1.0, 2.0];
        let down = [3.0, 2.0, 1.0];
        let count = |inputs: &[&[f64]]| {
            let classes = excitation(inputs, plane, Operator::Mkp).unwrap();
            classes
                .iter()
                .filter(|class| **class == Excitation::Determined)
                .count()
        };
        assert_eq!(count(&[&up, &inner, &down]), 6);
        for one in [&up[..], &inner, &down] {
            assert!(count(&[one]) < 4);
        }
        assert_eq!(count(&[]), 0);
    }
}
