//! Recursive least squares with stabilised forgetting (Kulhavý & Zarrop 1993).
//!
//! A sample takes from the covariance what it tells, `P ← P − (Pφ)(Pφ)ᵀ/(r + φᵀPφ)`. Forgetting then leads it back to the
//! one at the start, `P ← λP + (1 − λ)P₀`: `P` never exceeds `P₀`, stays positive because both are, and rounding
//! is forgotten as well. Parameters that are not excited become as uncertain as they were off-line, and no more.

use super::memory::Slices;
use crate::Real;
use crate::plane::operator_index;

/// Negative weights that are led back along the covariance in one sample; what is left is cut off.
const LED_BACK: usize = 4;

/// Forgetting factor and variance of a reading.
#[derive(Clone, Copy)]
pub(super) struct Law<T> {
    pub(super) forgetting: T,
    pub(super) variance: T,
}

/// Fills the covariance at the start: `covariance(a, b)` of the parameters `a` and `b`, counted from 0.
pub(super) fn reset<T: Real>(
    slices: &mut Slices<'_, T>,
    mut covariance: impl FnMut(usize, usize) -> T,
) {
    let mut entries = slices.start.iter_mut();
    for a in 0..slices.theta.len() {
        for b in 0..=a {
            if let Some(entry) = entries.next() {
                *entry = covariance(a, b);
            }
        }
    }
    slices.covariance.copy_from_slice(slices.start);
}

impl<T: Real> Law<T> {
    /// One sample: parameters and covariance move. Says whether the numbers still make sense: rounding can, after very
    /// many samples, take from the covariance its being positive; it has to start again then.
    pub(super) fn update(self, slices: &mut Slices<'_, T>, error: T, leakage: T) -> bool {
        let Slices {
            theta,
            offline,
            phi,
            covariance,
            start,
            gain,
            ..
        } = slices;
        multiply(covariance, phi, gain);
        let spread = dot(phi, gain);
        if !(spread >= T::ZERO) || !spread.is_finite() {
            return false;
        }
        if spread <= T::ZERO {
            return true;
        }
        let Self {
            forgetting,
            variance,
        } = self;
        let step = error / (variance + spread);
        for ((theta, &gain), &offline) in theta.iter_mut().zip(&**gain).zip(&**offline) {
            *theta = *theta + step * gain + leakage * (offline - *theta);
        }
        add_square(covariance, gain, -(T::ONE / (variance + spread)));
        if forgetting < T::ONE {
            for (now, &start) in covariance.iter_mut().zip(&**start) {
                *now = start + forgetting * (*now - start);
            }
        }
        true
    }
}

/// Leads negative weights back to zero along the covariance: `θ ← θ − P_k θ_k/P_kk` is the nearest point
/// with `θ_k = 0` in the metric of `P⁻¹`, in which the parameters that go together move together
/// (Goodwin & Sin 1984, section 3.7; Simon 2010). `O(n)` for each.
pub(super) fn project<T: Real>(slices: &mut Slices<'_, T>) {
    let weights = slices.theta.len().saturating_sub(1);
    for _ in 0..LED_BACK {
        let mut worst = (T::ZERO, 0);
        for (k, &theta) in slices.theta[..weights].iter().enumerate() {
            if theta < worst.0 {
                worst = (theta, k);
            }
        }
        let (negative, k) = worst;
        let own = slices.covariance[packed(k, k)];
        if negative >= T::ZERO || own <= T::ZERO {
            break;
        }
        let step = negative / own;
        for (n, theta) in slices.theta.iter_mut().enumerate() {
            *theta = *theta - step * slices.covariance[packed(n, k)];
        }
        slices.theta[k] = T::ZERO;
    }
    super::gradient::project(slices.theta);
}

/// Place of `(a, b)` in the lower triangle of a symmetric matrix, row by row.
fn packed(a: usize, b: usize) -> usize {
    operator_index(a.min(b) + 1, a.max(b) + 1)
}

/// `out = A x` of a symmetric `A`.
fn multiply<T: Real>(a: &[T], x: &[T], out: &mut [T]) {
    let mut rest = a;
    for n in 0..x.len() {
        let (row, after) = rest.split_at(n + 1);
        rest = after;
        let mut sum = row[n] * x[n];
        let xn = x[n];
        for ((&a, &x), out) in row[..n].iter().zip(x).zip(out.iter_mut()) {
            sum = sum + a * x;
            *out = *out + a * xn;
        }
        out[n] = sum;
    }
}

/// `A ← A + s x xᵀ`.
fn add_square<T: Real>(a: &mut [T], x: &[T], s: T) {
    let mut rest = a;
    for n in 0..x.len() {
        let (row, after) = rest.split_at_mut(n + 1);
        rest = after;
        let scaled = s * x[n];
        for (a, &x) in row.iter_mut().zip(x) {
            *a = *a + scaled * x;
        }
    }
}

fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    let products = a.iter().zip(b).map(|(&a, &b)| a * b);
    products.fold(T::ZERO, |sum, product| sum + product)
}
