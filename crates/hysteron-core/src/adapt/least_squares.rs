//! Recursive least squares with regularised linear forgetting (Kulhavý & Kraus 1996; stabilised
//! forgetting: Kulhavý & Zarrop 1993).
//!
//! Each sample reduces the covariance, `P ← P − (Pφ)(Pφ)ᵀ/(r + φᵀPφ)`. Forgetting then leads it
//! back towards the covariance at the start, `P ← λP + (1 − λ)P₀`. So `P` never exceeds `P₀` and
//! stays positive definite, and rounding errors are forgotten too. The uncertainty of parameters
//! without excitation grows back to that of the off-line ones, and no further.

use super::memory::Slices;
use super::vector::{dot, dot_and_add};
use crate::plane::operator_index;
use crate::scalar::Real;

/// A sample leads at most one negative weight back to zero for each of so many parameters.
const PARAMETERS_PER_STEP: usize = 4;

/// Forgetting factor `λ`, and variance `r` of a reading's error.
#[derive(Clone, Copy)]
pub(super) struct Law<T> {
    pub(super) forgetting: T,
    pub(super) variance: T,
}

impl<T: Real> Law<T> {
    /// Updates the estimate and the covariance with a sample. `error` is the prediction error of
    /// the estimate.
    pub(super) fn update(self, slices: &mut Slices<'_, T>, error: T, leakage: T) {
        let Slices {
            estimate,
            offline,
            phi,
            covariance,
            start,
            gain,
            ..
        } = slices;
        multiply(covariance, phi, gain);
        let mut spread = dot(phi, gain);
        if spread < T::ZERO || !spread.is_finite() {
            // After very many samples, rounding can make the covariance indefinite. Restart it.
            covariance.copy_from_slice(start);
            multiply(covariance, phi, gain);
            spread = dot(phi, gain);
        }
        let total = self.variance + spread;
        let step = error / total;
        if !(step.is_finite() && total.is_finite()) {
            return;
        }
        for ((now, &gain), &offline) in estimate.iter_mut().zip(&**gain).zip(&**offline) {
            *now = *now + step * gain + leakage * (offline - *now);
        }
        self.learn_and_forget(covariance, start, gain, total);
    }

    /// `P ← λ(P − ggᵀ/total) + (1 − λ)P₀` in one pass, with `g = Pφ` and `total = r + φᵀPφ`.
    fn learn_and_forget(self, covariance: &mut [T], start: &[T], gain: &[T], total: T) {
        let forgetting = self.forgetting;
        let back = T::ONE - forgetting;
        let (mut covariance, mut start) = (covariance, start);
        for n in 0..gain.len() {
            let (row, after) = covariance.split_at_mut(n + 1);
            let (first, start_after) = start.split_at(n + 1);
            (covariance, start) = (after, start_after);
            let scaled = forgetting * gain[n] / total;
            for ((now, &first), &gain) in row.iter_mut().zip(first).zip(gain) {
                *now = forgetting * *now - scaled * gain + back * first;
            }
        }
    }
}

/// Leads negative weights back to zero along the covariance, `θ ← θ − P_k θ_k/P_kk`.
///
/// This is the nearest point with `θ_k = 0` in the metric of `P⁻¹`: correlated parameters move
/// together. It brings the estimate no further away from any set of parameters that are not
/// negative (Goodwin & Sin 1984, section 3.7; Simon 2010). `O(n)` for each weight, for a bounded
/// number of weights in a sample.
///
/// Weights that remain negative are set to zero in the model's parameters, but not in the estimate.
/// Setting them to zero there would not have that property, and its errors would add up.
pub(super) fn project<T: Real>(slices: &mut Slices<'_, T>) {
    let Slices {
        theta,
        estimate,
        covariance,
        ..
    } = slices;
    let weights = estimate.len().saturating_sub(1);
    for _ in 0..weights / PARAMETERS_PER_STEP + 1 {
        let mut worst = (T::ZERO, T::ZERO, 0);
        for (k, &weight) in estimate[..weights].iter().enumerate() {
            if weight < T::ZERO {
                let step = weight / covariance[packed(k, k)];
                let distance = weight * step;
                if distance > worst.0 {
                    worst = (distance, step, k);
                }
            }
        }
        let (distance, step, k) = worst;
        if !(distance > T::ZERO && distance.is_finite()) {
            break;
        }
        for (n, parameter) in estimate.iter_mut().enumerate() {
            *parameter = *parameter - step * covariance[packed(n, k)];
        }
        estimate[k] = T::ZERO;
    }
    theta.copy_from_slice(estimate);
    if let Some((_offset, weights)) = theta.split_last_mut() {
        for weight in weights {
            *weight = weight.max(T::ZERO);
        }
    }
}

/// Restarts estimate and covariance from the present parameters, after these were replaced.
pub(super) fn restart<T: Real>(slices: &mut Slices<'_, T>) {
    if slices.estimate.is_empty() {
        return;
    }
    slices.covariance.copy_from_slice(slices.start);
    slices.estimate.copy_from_slice(slices.theta);
}

/// Index of element `(a, b)` in the lower triangle of a symmetric matrix, row by row.
pub(super) fn packed(a: usize, b: usize) -> usize {
    operator_index(a.min(b) + 1, a.max(b) + 1)
}

/// `out = A x` of a symmetric `A`.
fn multiply<T: Real>(a: &[T], x: &[T], out: &mut [T]) {
    let mut rest = a;
    for n in 0..x.len() {
        let (row, after) = rest.split_at(n + 1);
        rest = after;
        out[n] = row[n] * x[n] + dot_and_add(&row[..n], &x[..n], x[n], &mut out[..n]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::memory::Layout;
    use super::super::{Method, parameters};
    use super::*;
    use crate::plane::operator_count;

    const LEVELS: usize = 4;
    const N: usize = operator_count(LEVELS) + 1;
    const METHOD: Method<f64> = Method::LeastSquares {
        forgetting: 0.95,
        noise: 0.01,
        spread: 2.0,
        correlation: 2.0,
    };
    const LAYOUT: Layout = Layout::all(LEVELS, METHOD);

    /// Whether a symmetric matrix is positive definite, by its Cholesky factors.
    fn is_positive(at: impl Fn(usize, usize) -> f64) -> bool {
        let mut lower = [[0.0; N]; N];
        for a in 0..N {
            for b in 0..=a {
                let known: f64 = (0..b).map(|k| lower[a][k] * lower[b][k]).sum();
                let rest = at(a, b) - known;
                // NaN is not positive either.
                if a == b && (rest <= 0.0 || rest.is_nan()) {
                    return false;
                }
                lower[a][b] = if a == b {
                    // A square root by Newton's method, because `no_std` has none.
                    (0..60).fold(rest.max(1.0), |root, _| (root + rest / root) / 2.0)
                } else {
                    rest / lower[b][b]
                };
            }
        }
        true
    }

    #[test]
    fn the_covariance_stays_positive_and_never_exceeds_the_start() {
        let mut memory = [0.0; LAYOUT.len()];
        let mut slices = LAYOUT.cut(&mut memory);
        parameters::start_covariance(&mut slices, LEVELS, METHOD);
        restart(&mut slices);
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 40) as f64 / (1 << 24) as f64
        };
        for n in 0..20_000 {
            // All directions at random, then one at a time, then the offset alone.
            let kind = n / 1000 % 3;
            for (k, phi) in slices.phi.iter_mut().enumerate() {
                *phi = match kind {
                    0 => random(),
                    1 => f64::from(k == n % N),
                    _ => f64::from(k == N - 1),
                };
            }
            let law = Law {
                forgetting: if n < 10_000 { 0.95 } else { 1.0 },
                variance: 1e-4,
            };
            law.update(&mut slices, random() - 0.5, 0.0);
            if n % 97 == 0 {
                let (now, start) = (&*slices.covariance, &*slices.start);
                assert!(is_positive(|a, b| now[packed(a, b)]), "after {n}");
                // P₀ − P is positive up to rounding.
                let rounding = |a, b| if a == b { 1e-9 } else { 0.0 };
                let below = |a, b| start[packed(a, b)] - now[packed(a, b)] + rounding(a, b);
                assert!(is_positive(below), "after {n}");
            }
        }
    }
}
