//! The normalised gradient (Goodwin & Sin 1984, section 3.3; Ioannou & Sun 1996, section 4.3).

use super::memory::Slices;
use super::vector::dot;
use crate::scalar::Real;

/// One update: `θ ← θ + g φ e/(c + φᵀφ) + l (θ₀ − θ)`, with gain `g`, leakage `l`, off-line
/// parameters `θ₀` and `floor` `c`. The offset's share `κ` is the last element of `φ`.
pub(super) fn update<T: Real>(
    slices: &mut Slices<'_, T>,
    error: T,
    (gain, leakage): (T, T),
    floor: T,
) {
    let step = gain * error / (floor + dot(slices.phi, slices.phi));
    if !step.is_finite() {
        return;
    }
    let each = slices.theta.iter_mut().zip(&*slices.phi);
    for ((theta, &phi), &offline) in each.zip(&*slices.offline) {
        *theta = *theta + step * phi + leakage * (offline - *theta);
    }
}

/// Sets negative weights to zero. The last parameter, the offset, may be negative.
pub(super) fn project<T: Real>(theta: &mut [T]) {
    if let Some((_offset, weights)) = theta.split_last_mut() {
        for weight in weights {
            *weight = weight.max(T::ZERO);
        }
    }
}
