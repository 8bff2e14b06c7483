//! Positions of relay models. Relays switch at levels only, so their normalised positions are whole
//! numbers.

use crate::plane::Plane;
use crate::scalar::Real;

/// The position after `input`, from the `last` input and the position `x` there.
///
/// For a rising input it is the last level reached. For a falling input it is the level below the
/// last one left. At such positions the Everett function equals a table entry.
pub(crate) fn position<T: Real>(plane: &Plane<T>, (last, x): (T, T), input: T) -> T {
    if input > last {
        T::from_index(plane.level_at_or_below(input))
    } else if input < last {
        T::from_index(plane.level_at_or_above(input) - 1)
    } else {
        x
    }
}

/// The input that takes a relay model up to position `level`. It is the last input where the
/// position is there already or above.
///
/// A relay switches on only where the input rises. So the input moves even if it is the level
/// already.
pub(crate) fn up_to<T: Real>(plane: &Plane<T>, (last, x): (T, T), level: usize) -> T {
    if x >= T::from_index(level) {
        last
    } else {
        plane.level(level).max(last + plane.nudge())
    }
}

/// The input that takes a relay model down to position `level`. It is the last input where the
/// position is there already or below.
///
/// The relays of the level above `level` have to switch off for it.
pub(crate) fn down_to<T: Real>(plane: &Plane<T>, (last, x): (T, T), level: usize) -> T {
    if x <= T::from_index(level) {
        last
    } else {
        plane.level(level + 1).min(last - plane.nudge())
    }
}
