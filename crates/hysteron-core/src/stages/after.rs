//! Creep and lag: what happens to the sum of the operators on its way to the output.

use crate::scalar::Real;

/// The largest number of creep terms.
pub const MAX_CREEP: usize = 4;

/// Creep: `h + Σ_k c_k L_k[h]`, where `L_k` is a first-order lag of time constant `τ_k`.
///
/// Piezo stacks creep by 1 to 2 % a decade of time. A few time constants, spaced evenly on a
/// logarithmic scale, follow that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Creep<'a, T> {
    /// The coefficients `c_k`, 0 or more; at most [`MAX_CREEP`] of them, none for no creep.
    pub coefficients: &'a [T],
    /// The time constants `τ_k` in seconds, above zero; as many.
    pub taus: &'a [T],
}

/// What creep and lag remember: the output of each lag.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Past<T> {
    pub(crate) crept: [T; MAX_CREEP],
    pub(crate) lagged: T,
}

/// The factors `e^(−dt/τ)` of creep and lag for one time step. Zero for a lag that is at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Fade<T> {
    pub(crate) creep: [T; MAX_CREEP],
    pub(crate) lag: T,
}

impl<T: Real> Creep<'_, T> {
    /// No creep.
    pub const NONE: Self = Creep {
        coefficients: &[],
        taus: &[],
    };

    /// The output for the operators' sum `h`, and the past for the next sample.
    pub(crate) fn forward(&self, past: Past<T>, fade: Fade<T>, h: T) -> (T, Past<T>) {
        let mut next = past;
        let mut sum = h;
        for (k, &c) in self.coefficients.iter().enumerate() {
            next.crept[k] = h + (past.crept[k] - h) * fade.creep[k];
            sum = sum + c * next.crept[k];
        }
        next.lagged = sum + (past.lagged - sum) * fade.lag;
        (next.lagged, next)
    }

    /// The line `y = base + gain · h` that [`Creep::forward`] is for the present sample.
    pub(crate) fn line(&self, past: Past<T>, fade: Fade<T>) -> (T, T) {
        let (mut base, mut gain) = (T::ZERO, T::ONE);
        for (k, &c) in self.coefficients.iter().enumerate() {
            base = base + c * fade.creep[k] * past.crept[k];
            gain = gain + c * (T::ONE - fade.creep[k]);
        }
        let rest = T::ONE - fade.lag;
        (base * rest + past.lagged * fade.lag, gain * rest)
    }

    /// The gain at rest, `1 + Σ c_k`.
    #[must_use]
    pub fn gain(&self) -> T {
        self.coefficients.iter().fold(T::ONE, |sum, &c| sum + c)
    }
}
