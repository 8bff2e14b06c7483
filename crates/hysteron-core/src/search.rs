//! Goals for the output, and the search for the branch and the cell that meet them.
//!
//! Both directions of the inverse use this module.

use crate::branch::Turn;
use crate::memory::Memory;
use crate::scalar::Real;
use crate::state::State;

/// The section of a branch on which a goal is met, after the turning points before it are passed.
pub(crate) struct Branch<T> {
    /// The turning point at which the branch began. The output on the branch is that of this point,
    /// plus or minus the Everett function from here.
    pub(crate) began: Turn<T>,
    /// Position at which the input enters the branch.
    pub(crate) start: T,
    /// Position at which the branch ends.
    pub(crate) end: T,
}

impl<T: Real> Branch<T> {
    /// Finds the branch that ends at the innermost extreme whose output meets the goal.
    ///
    /// Extremes of one kind are nested: `kind` is 0 for the maxima, which have even indices, and 1
    /// for the minima, which have odd ones. All extremes further in are passed. The state does not
    /// change.
    pub(crate) fn find<S>(state: &State<T, S>, kind: usize, met: impl Fn(T) -> bool) -> Self
    where
        S: Memory<Turn<T>>,
    {
        let turns = state.turns();
        let here = Turn {
            x: state.branch_position().x,
            y: state.branch_position().y,
        };
        // The outermost extreme, with index `kind`, is the end of the plane. It counts as met.
        let count = (turns.len() - 1 - kind) / 2;
        let passed = first_true(1, count, |n| !met(turns[2 * n + kind].y));
        let end = 2 * passed.map_or(count, |n| n - 1) + kind;
        Self {
            began: turns.get(end + 1).copied().unwrap_or(here),
            start: turns.get(end + 2).map_or(here.x, |turn| turn.x),
            end: turns[end].x,
        }
    }
}

/// A goal for the output on a way. The second number of each is the rounding error allowed.
#[derive(Clone, Copy)]
pub(crate) enum Goal<T> {
    /// Reach this value. Short of it by no more than the rounding error counts as reached.
    Reach(T, T),
    /// Go beyond this value, to find the last input that still gives it. Beyond it by no more than
    /// the rounding error still counts as the value.
    Leave(T, T),
}

impl<T: Real> Goal<T> {
    /// The value to reach or to leave.
    pub(crate) fn value(self) -> T {
        match self {
            Goal::Reach(value, _) | Goal::Leave(value, _) => value,
        }
    }

    /// Whether `output` meets the goal on a way up.
    pub(crate) fn met_rising(self, output: T) -> bool {
        match self {
            Goal::Reach(value, rounding) => output >= value - rounding,
            Goal::Leave(value, rounding) => output > value + rounding,
        }
    }

    /// Whether `output` meets the goal on a way down.
    pub(crate) fn met_falling(self, output: T) -> bool {
        match self {
            Goal::Reach(value, rounding) => output <= value + rounding,
            Goal::Leave(value, rounding) => output < value - rounding,
        }
    }

    /// The goal for `output − base`.
    pub(crate) fn shifted(self, base: T) -> Self {
        match self {
            Goal::Reach(value, rounding) => Goal::Reach(value - base, rounding),
            Goal::Leave(value, rounding) => Goal::Leave(value - base, rounding),
        }
    }

    /// The goal for `peak − output`. It rises where the output falls, so it is met on a way up.
    pub(crate) fn mirrored(self, peak: T) -> Self {
        match self {
            Goal::Reach(value, rounding) => Goal::Reach(peak - value, rounding),
            Goal::Leave(value, rounding) => Goal::Leave(peak - value, rounding),
        }
    }
}

/// Whether `a` and `b` differ by at most `distance`.
pub(crate) fn within<T: Real>(a: T, b: T, distance: T) -> bool {
    a - b <= distance && b - a <= distance
}

/// The distance, from 0 to `length`, at which a linear piece with this `slope` has risen by `rise`.
pub(crate) fn along<T: Real>(rise: T, slope: T, length: T) -> T {
    if rise <= T::ZERO {
        T::ZERO
    } else if slope * length > rise {
        rise / slope
    } else {
        length
    }
}

/// The smallest number in `first..=last` for which `test` holds; `None` for none. Where `test`
/// holds for a number, it has to hold for all larger ones.
pub(crate) fn first_true(first: usize, last: usize, test: impl Fn(usize) -> bool) -> Option<usize> {
    let (mut low, mut high) = (first, last + 1);
    while low < high {
        let middle = low + (high - low) / 2;
        if test(middle) {
            high = middle
        } else {
            low = middle + 1
        }
    }
    (low <= last).then_some(low)
}

/// `⌈x⌉` of a position in `[0, K]`.
pub(crate) fn ceil_index<T: Real>(x: T, levels: usize) -> usize {
    let floor = x.floor_index();
    if T::from_index(floor) < x {
        (floor + 1).min(levels)
    } else {
        floor
    }
}
