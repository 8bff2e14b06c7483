//! Where on a branch a goal for the output is met: what both directions of the inverse share.

use crate::branch::Turn;
use crate::memory::Memory;
use crate::scalar::Real;
use crate::state::State;

/// The part of a branch that a goal is met on, once the turning points before it are passed.
pub(crate) struct Branch<T> {
    /// Where the branch began: `H` on it is this output and the Everett function from here.
    pub(crate) began: Turn<T>,
    /// Position from which on it is travelled.
    pub(crate) start: T,
    /// Position at which it ends.
    pub(crate) end: T,
}

impl<T: Real> Branch<T> {
    /// Of the nested extremes of one kind (maxima at even places, minima at odd ones), finds the
    /// innermost whose output meets the goal: all further in are passed, a virtual pop.
    pub(crate) fn find<S>(state: &State<T, S>, kind: usize, met: impl Fn(T) -> bool) -> Self
    where
        S: Memory<Turn<T>>,
    {
        let turns = state.turns();
        let here = Turn {
            x: state.branch_position().x,
            y: state.branch_position().y,
        };
        // The one at `kind` itself, the end of the plane, counts as met.
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

/// What an output on the way has to do.
#[derive(Clone, Copy)]
pub(crate) enum Goal<T> {
    /// Come to this value or beyond. Short of it by the rounding, the second number, is there.
    Reach(T, T),
    /// Go beyond this value: its last place on a flat stretch is wanted. Beyond it by no more than the
    /// rounding, the second number, is still there.
    Leave(T, T),
}

impl<T: Real> Goal<T> {
    pub(crate) fn value(self) -> T {
        match self {
            Goal::Reach(value, _) | Goal::Leave(value, _) => value,
        }
    }

    pub(crate) fn met_rising(self, output: T) -> bool {
        match self {
            Goal::Reach(value, rounding) => output >= value - rounding,
            Goal::Leave(value, rounding) => output > value + rounding,
        }
    }

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

    /// The goal for `peak − output`, which rises where the output falls.
    pub(crate) fn mirrored(self, peak: T) -> Self {
        match self {
            Goal::Reach(value, rounding) => Goal::Reach(peak - value, rounding),
            Goal::Leave(value, rounding) => Goal::Leave(peak - value, rounding),
        }
    }
}

pub(crate) fn within<T: Real>(a: T, b: T, distance: T) -> bool {
    a - b <= distance && b - a <= distance
}

/// How far along a linear piece of length `length` a rise of `rise` is reached.
pub(crate) fn along<T: Real>(rise: T, slope: T, length: T) -> T {
    if rise <= T::ZERO {
        T::ZERO
    } else if slope * length > rise {
        rise / slope
    } else {
        length
    }
}

/// The smallest number in `first..=last` for which `test` holds; it holds from there on.
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
