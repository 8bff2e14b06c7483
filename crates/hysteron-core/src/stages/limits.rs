//! How large and how small the constants of a stage may be.
//!
//! Within these limits no step overflows, and no stage hides what another one does behind the
//! rounding of its digits. Each limit is checked in [`Stages::check`](crate::Stages::check) alone.

use crate::scalar::Real;

/// The largest factor: a coefficient of the creep, a gain or a scale of the load. `float` has 2²³
/// parts of a number, so beyond a million it no longer holds the output that creeps beside its
/// creep, or the smallest stroke beside the largest one.
const FACTOR: usize = 1_000_000;

/// The longest time constant in seconds, some 30 years; the shortest one is as far below a second.
/// A longer one is none that an experiment shows.
const SECONDS: usize = 1_000_000_000;

/// A coefficient of the creep: from 0 on.
pub(super) fn is_share<T: Real>(value: T) -> bool {
    value >= T::ZERO && value <= T::from_index(FACTOR)
}

/// A gain or a scale of the load: about one, and not as small that the largest is out of reach.
pub(super) fn is_factor<T: Real>(value: T) -> bool {
    is_share(value) && value >= T::ONE / T::from_index(FACTOR)
}

/// A time constant.
pub(super) fn is_time<T: Real>(seconds: T) -> bool {
    let most = T::from_index(SECONDS);
    seconds >= T::ONE / most && seconds <= most
}

/// A number in the unit of an input, a load or an output. Its square and products with factors stay
/// numbers, because it is no larger than [`Real::LARGEST`].
pub(super) fn is_size<T: Real>(value: T) -> bool {
    value <= T::LARGEST && value >= -T::LARGEST
}

/// A slope, which is divided by as well: neither it nor its inverse is too large.
pub(super) fn is_slope<T: Real>(value: T) -> bool {
    value >= T::ONE / T::LARGEST && value <= T::LARGEST
}

/// What the rounding of digits may amount to where a target counts as reached, as a part of the
/// range of outputs: a thousandth.
pub(super) fn thousandth<T: Real>(range: T) -> T {
    range * (T::ONE / T::from_index(1000))
}
