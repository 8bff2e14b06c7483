//! The shares of several predictors in one, by how well each has predicted lately.
//!
//! Prediction with expert advice, fixed share: M. Herbster and M. K. Warmuth, *Tracking the best
//! expert*, Machine Learning 32, 1998. After each sample a predictor's share is multiplied by
//! `exp(−loss)`, and then a small part of all shares is given to all alike. So a predictor that
//! was bad for long is back soon after it becomes good.
//!
//! For any losses `l(n, i)`, with the shares `v(n, i)` before sample `n`, the loss of the mixture
//! `−ln Σ v exp(−l)`, summed over `N` samples, exceeds that of the best predictor by at most
//! `−ln v(0, i) − (N − 1) ln(1 − α + α/m)`, where `α` is the part that is given away and `m` the
//! number of predictors; and that of the best sequence with `k` changes by `k ln(m/α)` more.

/// The part of all shares that is given to all alike after each sample.
pub(super) const GIVEN: f64 = 0.01;

/// The loss of a usual error. Independent errors of a normal distribution would have ½; those of
/// neighbouring samples are alike.
const RATE: f64 = 0.2;

/// A squared error counts as at most so many usual ones: a spike says little about a predictor.
const CAP: f64 = 9.0;

/// The usual squared error is a mean over about so many samples.
const MEMORY: f64 = 100.0;

/// Errors below this share of the output's range are no errors.
const FLOOR: f64 = 1e-5;

/// The shares of predictors; their sum is 1.
#[derive(Debug, Clone)]
pub(super) struct Shares {
    shares: Vec<f64>,
    /// The usual squared error of each predictor.
    usual: Vec<f64>,
    /// Errors that `usual` is the mean of, up to [`MEMORY`].
    seen: f64,
    floor: f64,
}

impl Shares {
    /// Shares of so many predictors: nearly all belongs to the first. `range` is that of the
    /// output.
    pub(super) fn new(count: usize, range: f64) -> Self {
        let mut shares = vec![GIVEN / count as f64; count];
        shares[0] += 1.0 - GIVEN;
        Self {
            shares,
            usual: vec![0.0; count],
            seen: 0.0,
            floor: (FLOOR * range).powi(2).max(f64::MIN_POSITIVE),
        }
    }

    pub(super) fn all(&self) -> &[f64] {
        &self.shares
    }

    /// Shares by the losses of both, those of the `other` by a `part`: the geometric mean.
    pub(super) fn beside(&self, other: &Self, part: f64) -> Vec<f64> {
        let pairs = self.shares.iter().zip(&other.shares);
        let joint = pairs.map(|(own, other)| own.powf(1.0 - part) * other.powf(part));
        let joint: Vec<f64> = joint.collect();
        let sum: f64 = joint.iter().sum();
        joint.iter().map(|share| share / sum).collect()
    }

    /// Gives the shares anew after the predictors had these `errors`, which count as so many samples
    /// as `part` says, at most one. Errors that are not finite count as the largest.
    pub(super) fn judge(&mut self, errors: &[f64], part: f64) {
        // What is large beside the best is bad, be it usually the best or now. After a jump, or at
        // a spike, all are far off, and the nearest is the measure.
        let least = |squares: &mut dyn Iterator<Item = f64>| squares.fold(f64::INFINITY, f64::min);
        let best = least(&mut self.usual.iter().copied());
        let now = least(&mut errors.iter().map(|error| error * error));
        let best = best.max(now).max(self.floor);
        let capped = |error: f64, usual: f64| match (error * error / usual).min(CAP) {
            square if square.is_finite() => square,
            _ => CAP,
        };
        let losses = errors
            .iter()
            .map(|&error| RATE * part * capped(error, best));
        let losses: Vec<f64> = losses.collect();
        self.update(&losses, GIVEN * part);
        self.seen = (self.seen + part).min(MEMORY);
        for (usual, &error) in self.usual.iter_mut().zip(errors) {
            let own = usual.max(self.floor);
            let square = own * capped(error, own);
            *usual += (square - *usual) * (part / self.seen);
        }
    }

    /// The step of *fixed share*, which gives so much to all alike.
    fn update(&mut self, losses: &[f64], given: f64) {
        // Only differences count; so no share underflows together with all others.
        let least = losses.iter().copied().fold(f64::INFINITY, f64::min);
        let pairs = self.shares.iter_mut().zip(losses);
        pairs.for_each(|(share, loss)| *share *= (least - loss).exp());
        let sum: f64 = self.shares.iter().sum();
        let each = given / self.shares.len() as f64;
        for share in &mut self.shares {
            *share = (1.0 - given) * *share / sum + each;
        }
    }
}

/// The mean of `values`, each by its share; the shares sum to 1. Where all values are equal it is
/// exactly theirs.
pub(super) fn mean(shares: &[f64], values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values = values.into_iter();
    let first = values.next().unwrap_or_default();
    let others = shares[1..].iter().zip(values);
    first + others.map(|(v, y)| v * (y - first)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn the_mixture_is_bounded_by_each_predictor_and_by_each_sequence_of_them() {
        let mut rng = ChaCha8Rng::seed_from_u64(1998);
        for _ in 0..300 {
            let count = rng.random_range(2..7);
            let mut shares = Shares::new(count, 1.0);
            let first = shares.all().to_vec();
            let samples = rng.random_range(1..400);
            let mut mixed = 0.0;
            let (mut single, mut best) = (vec![0.0; count], vec![0.0; count]);
            let mut changing = 0.0_f64;
            for n in 0..samples {
                // Good ones take turns.
                let good = n / rng.random_range(20..90) % count;
                let losses: Vec<f64> = (0..count)
                    .map(|k| rng.random_range(0.0..if k == good { 0.2 } else { 3.0 }))
                    .collect();
                let pairs = shares.all().iter().zip(&losses);
                mixed -= pairs.map(|(v, loss)| v * (-loss).exp()).sum::<f64>().ln();
                // The cheapest sequence: stay, or change for `ln(m/α)`; with the first share's cost.
                let (given, stays) = (GIVEN / count as f64, 1.0 - GIVEN + GIVEN / count as f64);
                for k in 0..count {
                    single[k] += losses[k];
                    best[k] = losses[k]
                        + match n {
                            0 => -first[k].ln(),
                            _ => (best[k] - stays.ln()).min(changing - given.ln()),
                        };
                }
                changing = best.iter().copied().fold(f64::INFINITY, f64::min);
                shares.update(&losses, GIVEN);
            }
            // Rounding: a few hundred sums of a few products.
            assert!(mixed <= changing + 1e-9, "{mixed} {changing}");
            let stays = (1.0 - GIVEN + GIVEN / count as f64).ln();
            for k in 0..count {
                let bound = single[k] - first[k].ln() - (samples as f64 - 1.0) * stays;
                assert!(mixed <= bound + 1e-9, "{mixed} {bound}");
            }
        }
    }

    #[test]
    fn whatever_the_errors_are_shares_are_at_least_what_is_given_and_sum_to_one() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let odd = [
            0.0,
            f64::NAN,
            f64::INFINITY,
            f64::MAX,
            f64::MIN_POSITIVE,
            -1e300,
        ];
        for _ in 0..200 {
            let count = rng.random_range(2..7);
            let mut shares = Shares::new(count, rng.random_range(0.0..2.0));
            for _ in 0..100 {
                let mut error = || match rng.random_bool(0.2) {
                    true => odd[rng.random_range(0..odd.len())],
                    false => rng.random_range(-1.0..1.0),
                };
                let errors: Vec<f64> = (0..count).map(|_| error()).collect();
                let part = rng.random_range(0.3..1.0);
                shares.judge(&errors, part);
                let sum: f64 = shares.all().iter().sum();
                assert!((sum - 1.0).abs() < 1e-12, "{sum}");
                let least = part * GIVEN / count as f64;
                assert!(shares.all().iter().all(|v| *v >= least * (1.0 - 1e-12)));
                let mut other = Shares::new(count, 1.0);
                other.judge(&errors, 0.3);
                let joint = shares.beside(&other, rng.random_range(0.0..1.0));
                assert!((joint.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                assert!(joint.iter().all(|v| v.is_finite() && *v > 0.0));
                assert_eq!(mean(&joint, vec![0.7; count]), 0.7);
            }
        }
    }
}
