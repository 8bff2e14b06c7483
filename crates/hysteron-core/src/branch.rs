//! Turning points, and the branch that the input travels between two of them.

use core::slice::IterMut;

use crate::everett::{Grid, Split};
use crate::scalar::Real;

/// A turning point of the input: the normalised position `0 ≤ x ≤ K`, and `Σ μ γ` there with `γ` in `[0, 1]`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Turn<T> {
    pub(crate) x: T,
    pub(crate) y: T,
}

/// The start of every history among the turning points: the input below the plane, after endless
/// heights. There are enough of these for a look at two corners back to need no case of its own.
pub(crate) const START: usize = LOOK + 1;

/// How far back from the branch's own turning point a merge looks: the two corners before it.
const LOOK: usize = 4;

/// Where the input is, and the branch it is on. `Copy`, so that a loop over samples can hold it in registers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Position<T> {
    /// Normalised position, never −0; for relays the level last reached, as a whole number.
    pub(crate) x: T,
    /// `Σ μ γ` at `x`.
    pub(crate) y: T,
    /// The turning point that the branch began at, counted like `START`, which is a minimum.
    pub(crate) top: usize,
    /// The cell of that turning point, its output, and the position of the extreme that ends the
    /// branch: all follow from `top`, kept because they change only with it.
    began: Split<T>,
    began_y: T,
    end: T,
}

impl<T: Real> Position<T> {
    pub(crate) fn start(levels: usize) -> Self {
        Self {
            x: T::ZERO,
            y: T::ZERO,
            top: START,
            began: Split::of(T::ZERO, levels),
            began_y: T::ZERO,
            end: T::INFINITY,
        }
    }

    #[inline(always)]
    pub(crate) fn is_rising(&self) -> bool {
        self.top % 2 == START % 2
    }

    /// Moves to each of the normalised positions, in `[0, K]` and never −0, and puts `Σ μ γ` in its stead:
    /// amortised `O(1)` each.
    ///
    /// Each direction has its own code, so that along a branch nothing is left to choose.
    #[inline(always)]
    pub(crate) fn travel(&mut self, turns: &mut [Turn<T>], grid: Grid<'_, T>, positions: &mut [T]) {
        let mut rest = positions.iter_mut();
        let mut next = rest.next();
        if !self.is_rising() {
            next = self.go::<false>(turns, grid, next, &mut rest);
        }
        while next.is_some() {
            next = self.go::<true>(turns, grid, next, &mut rest);
            next = self.go::<false>(turns, grid, next, &mut rest);
        }
    }

    /// Whether this is the same position on the same branch, whatever the outputs.
    pub(crate) fn is_at(&self, other: &Self) -> bool {
        let key = |position: &Self| (position.x, position.top, position.began, position.end);
        key(self) == key(other)
    }

    /// Works out the outputs anew along the turning points and at the present position.
    pub(crate) fn rebase(&mut self, turns: &mut [Turn<T>], grid: Grid<'_, T>) {
        let split = |x| Split::of(x, grid.levels);
        let along = |from: Turn<T>, to: T| {
            if to > from.x {
                from.y + grid.everett(split(to), split(from.x))
            } else {
                from.y - grid.everett(split(from.x), split(to))
            }
        };
        let mut last = turns[START];
        for turn in &mut turns[START + 1..=self.top] {
            turn.y = along(last, turn.x);
            last = *turn;
        }
        self.began_y = last.y;
        self.y = along(last, self.x);
    }

    /// Goes one way until the input turns; gives the position that lies the other way, if there is one.
    #[inline(always)]
    fn go<'a, const RISING: bool>(
        &mut self,
        turns: &mut [Turn<T>],
        grid: Grid<'_, T>,
        mut next: Option<&'a mut T>,
        rest: &mut IterMut<'a, T>,
    ) -> Option<&'a mut T> {
        while let Some(position) = next {
            if self.follow::<RISING>(grid, *position) {
                *position = self.y;
                next = rest.next();
            } else if self.leave::<RISING>(turns, grid, *position) {
                return Some(position);
            } else {
                next = Some(position);
            }
        }
        None
    }

    /// Moves to `x` if the branch goes there; says whether it does.
    #[inline(always)]
    fn follow<const RISING: bool>(&mut self, grid: Grid<'_, T>, x: T) -> bool {
        if before::<T, RISING>(x, self.x) || !before::<T, RISING>(x, self.end) {
            return false;
        }
        let here = Split::of(x, grid.levels);
        self.x = x;
        self.y = if RISING {
            self.began_y + grid.everett(here, self.began)
        } else {
            self.began_y - grid.everett(self.began, here)
        };
        true
    }

    /// Changes to the next branch on the way to `x`; says whether it goes the other way.
    ///
    /// Where the input turned, the present position becomes a turning point. Where the branch
    /// ended, the extreme there is wiped out with the opposite one after it.
    #[inline(always)]
    fn leave<const RISING: bool>(
        &mut self,
        turns: &mut [Turn<T>],
        grid: Grid<'_, T>,
        x: T,
    ) -> bool {
        let mut turned = before::<T, RISING>(x, self.x);
        if !turned {
            self.top -= 2;
            if self.top < START {
                // Below everything: all operators are off, as at the start, and the next way is up.
                self.top = START;
                self.x = T::ZERO;
                turned = true;
            }
        } else if !RISING && self.merged(turns, grid) {
            self.top -= 1;
        } else {
            self.top += 1;
            turns[self.top] = Turn {
                x: self.x,
                y: self.y,
            };
        }
        let began = turns[self.top];
        self.began = Split::of(began.x, grid.levels);
        self.began_y = began.y;
        self.end = turns[self.top - 1].x;
        turned
    }

    /// Merges the corner that falls to the present position with those before it, if they are close
    /// enough to share a grid cell, and do; says whether they do.
    ///
    /// With fewer than two corners before, one of them is an endless height, which is not close.
    #[inline(always)]
    fn merged(&self, turns: &mut [Turn<T>], grid: Grid<'_, T>) -> bool {
        let recent = turns.get_mut(self.top - LOOK..);
        let Some(recent) = recent.and_then(|turns| turns.first_chunk_mut()) else {
            return false; // the memory has this many elements beyond the bound
        };
        let [outer_max, outer_min, _, _, peak] = recent;
        outer_max.x - peak.x < T::ONE
            && self.x - outer_min.x < T::ONE
            && merge(recent, grid, self.x)
    }
}

/// Whether a branch comes to `a` before `b`.
#[inline(always)]
fn before<T: Real, const RISING: bool>(a: T, b: T) -> bool {
    if RISING { a.precedes(b) } else { b.precedes(a) }
}

/// Makes one corner of the last one and the one that falls to `min`, where both lie in one grid cell
/// with the corner before them; says whether they do.
///
/// In the cell, `γ ← min(max(γ, u'), v')` and then `γ ← min(max(γ, u''), v'')`, with `u'' < u'` and
/// `v' < v''`. Since the corner before has left `γ < v'`, both together equal
/// `γ ← min(max(γ, u), v'')` with `u = clamp(v', u'', u')`. Everything outside the cell sees only
/// the corner before and the last minimum.
#[cold]
#[inline(never)]
fn merge<T: Real>(recent: &mut [Turn<T>; LOOK + 1], grid: Grid<'_, T>, min: T) -> bool {
    let [outer_max, outer_min, inner_max, inner_min, peak] = recent.map(|turn| turn.x);
    let split = |x| Split::of(x, grid.levels);
    let cell = |max, min| (split(max).cell, split(min).cell);
    let here = cell(peak, min);
    if cell(outer_max, outer_min) != here || cell(inner_max, inner_min) != here {
        return false;
    }
    let (p, q) = here;
    let held = T::from_index(p) + (inner_min - T::from_index(q));
    let max = held.clamp(peak, inner_max);
    // From the corner before on, so that ten thousand of these leave no more rounding than one.
    let at_max = recent[1].y + grid.everett(split(max), split(outer_min));
    let at_min = at_max - grid.everett(split(max), split(min));
    recent[2] = Turn { x: max, y: at_max };
    recent[3] = Turn { x: min, y: at_min };
    true
}
