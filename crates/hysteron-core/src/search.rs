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
    /// Finds the branch that ends at the innermost extreme that meets the goal.
    ///
    /// Extremes of one kind are nested: `kind` is 0 for the maxima, which have even indices, and 1
    /// for the minima, which have odd ones. All extremes further in are passed. The state does not
    /// change.
    pub(crate) fn find<S>(state: &State<T, S>, kind: usize, met: impl Fn(&Turn<T>) -> bool) -> Self
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
        let at = |inner: usize| 2 * (count + 1 - inner) + kind;
        let passed = first_true(1, count, |n| met(&turns[at(n)]));
        let end = passed.map_or(kind, at);
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
///
/// It is mostly near `first`. So the steps from there double until one is too far (Bentley and Yao
/// 1976); the rest is a bisection.
pub(crate) fn first_true(first: usize, last: usize, test: impl Fn(usize) -> bool) -> Option<usize> {
    let (mut low, mut high, mut step) = (first, last + 1, 1_usize);
    while low < high {
        // After the first success the half is always less than the step.
        let middle = low + (step - 1).min((high - low) / 2);
        if test(middle) {
            high = middle
        } else {
            low = middle + 1;
            step = step.saturating_mul(2);
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

/// Where a way ends.
pub(crate) struct Landing<T> {
    /// The input, in its unit.
    pub(crate) input: T,
    /// `Σ μ γ` there.
    pub(crate) output: T,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every range of up to 70 numbers, and every place in it.
    #[test]
    fn the_first_success_is_found() {
        for first in [0, 1, 5] {
            for count in 0..70 {
                let last = first + count;
                for from in first..=last + 1 {
                    let expected = (from <= last).then_some(from);
                    assert_eq!(first_true(first, last, |n| n >= from), expected);
                }
            }
        }
        assert_eq!(first_true(1, 0, |_| true), None);
    }

    /// Two searches of 20 steps are enough for a million numbers.
    #[test]
    fn a_search_takes_few_tests() {
        for from in [0, 1, 2, 1000, 65_536, 999_998, 999_999, 1_000_000] {
            let tests = core::cell::Cell::new(0);
            let test = |n| {
                tests.set(tests.get() + 1);
                n >= from
            };
            first_true(0, 999_999, test);
            assert!(tests.get() <= 40, "{from}: {}", tests.get());
            assert!(from > 2 || tests.get() <= 3, "{from}: {}", tests.get());
        }
    }
}
