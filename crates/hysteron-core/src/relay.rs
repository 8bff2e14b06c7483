//! Relays move in jumps: their normalised positions are the whole numbers of the levels passed.

use crate::plane::Plane;
use crate::scalar::Real;

/// The position after `input`, from the last input and the position there. Rising, it is the last level
/// reached; falling, the level below the last one left. There the Everett function is the table itself.
pub(crate) fn position<T: Real>(plane: &Plane<T>, (last, x): (T, T), input: T) -> T {
    if input > last {
        T::from_index(plane.level_at_or_below(input))
    } else if input < last {
        T::from_index(plane.level_at_or_above(input) - 1)
    } else {
        x
    }
}

/// The input that takes a relay up to position `level`; the last input, where it is there or above.
///
/// A relay switches on only where the input rises, so the input moves even if the level is the last input.
pub(crate) fn up_to<T: Real>(plane: &Plane<T>, (last, x): (T, T), level: usize) -> T {
    if x >= T::from_index(level) {
        last
    } else {
        plane.level(level).max(last + plane.nudge())
    }
}

/// The input that takes a relay down to position `level`; the last input, where it is there or below.
///
/// Position `level` is reached by switching off at the level above it.
pub(crate) fn down_to<T: Real>(plane: &Plane<T>, (last, x): (T, T), level: usize) -> T {
    if x <= T::from_index(level) {
        last
    } else {
        plane.level(level + 1).min(last - plane.nudge())
    }
}
