//! The three elementary operators of Fig. 5 of the chapter, as defined there.

use crate::plane::Plane;
use crate::scalar::Real;

/// The elementary operator of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Operator {
    /// Modified Krasnosel'skii-Pokrovskii: continuous, from 0 to 1.
    #[default]
    Mkp,
    /// Krasnosel'skii-Pokrovskii: continuous, from −1 to +1; `2γ − 1` with `γ` of the MKP operator.
    Kp,
    /// The classical Preisach relay: −1 or +1.
    Relay,
}

impl Operator {
    /// The operator's output for its state `γ` in `[0, 1]`.
    #[must_use]
    #[inline(always)]
    pub fn output<T: Real>(self, gamma: T) -> T {
        match self {
            Operator::Mkp => gamma,
            Operator::Kp | Operator::Relay => gamma + gamma - T::ONE,
        }
    }
}

/// The ridge function of level `k` at the normalised input `x`, equation (4):
/// `r_k(x) = clamp(x − (k − 1), 0, 1)`.
#[must_use]
pub fn ridge<T: Real>(x: T, k: usize) -> T {
    (x - T::from_index(k.saturating_sub(1))).clamp(T::ZERO, T::ONE)
}

/// One MKP operator, equation (5): `γ ← max(r_j(x), min(γ, r_i(x)))`.
///
/// Returns the new state. No test of the input's direction is needed, because `r_j(x) ≤ γ ≤ r_i(x)`
/// holds before and after every step. The KP operator has the same state; only its output differs
/// ([`Operator::output`]).
#[must_use]
pub fn mkp<T: Real>(gamma: T, x: T, i: usize, j: usize) -> T {
    ridge(x, j).max(gamma.min(ridge(x, i)))
}

/// One relay, Fig. 5(a), with state 0 (output −1) or 1 (output +1).
///
/// It switches on at `T ≥ β_j` where the input rises and off at `T ≤ α_i` where the input falls.
/// Otherwise it does not change. `previous` and `input` are in the input's unit. Returns the new
/// state.
#[must_use]
pub fn relay<T: Real>(gamma: T, previous: T, input: T, plane: &Plane<T>, i: usize, j: usize) -> T {
    if input > previous && input >= plane.level(j) {
        T::ONE
    } else if input < previous && input <= plane.level(i) {
        T::ZERO
    } else {
        gamma
    }
}
