//! The normalised gradient (Goodwin & Sin 1984, section 3.3; Ioannou & Sun 1996, section 4.3).

use super::memory::Slices;
use super::vector::dot;
use crate::scalar::Real;

/// Moves the parameters along the regressor by the share `gain` of the error, and by `leakage` to the off-line ones;
/// `floor` is `c`.
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

/// Projection onto weights that are not negative; the offset, the last parameter, is free.
pub(super) fn project<T: Real>(theta: &mut [T]) {
    if let Some((_offset, weights)) = theta.split_last_mut() {
        for weight in weights {
            *weight = weight.max(T::ZERO);
        }
    }
}
