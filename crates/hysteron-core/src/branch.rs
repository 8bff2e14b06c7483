//! Turning points, and the branch on which the input moves between two of them.

use core::slice::IterMut;

use crate::everett::{Grid, Split};
use crate::scalar::Real;

/// A turning point of the input: the normalised position `0 ≤ x ≤ K`, and `Σ μ γ` there, with `γ`
/// in `[0, 1]`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Turn<T> {
    pub(crate) x: T,
    pub(crate) y: T,
}

impl<T: Real> Turn<T> {
    /// `Σ μ γ` at `to`, on the branch that begins here.
    pub(crate) fn along(&self, grid: Grid<'_, T>, to: T) -> T {
        let [here, there] = [self.x, to].map(|x| Split::new(x, grid.levels));
        if to > self.x {
            self.y + grid.everett(there, here)
        } else {
            self.y - grid.everett(here, there)
        }
    }
}

/// Index of the first turning point of every history: the input at the bottom of the plane.
///
/// The elements before it are sentinels with infinite positions. There are enough of them that
/// merging can look two corners back without a special case.
pub(crate) const START: usize = LOOK + 1;

/// How many turning points before the start of the branch a merge reads: two corners.
const LOOK: usize = 4;

/// Where the input is, and the branch it is on.
///
/// `Copy`, so that a loop over samples can keep it in registers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Position<T> {
    /// Normalised position, never −0. For relays the index of the level last reached.
    pub(crate) x: T,
    /// `Σ μ γ` at `x`.
    pub(crate) y: T,
    /// Index of the turning point at which the branch began. `START` is a minimum; minima and
    /// maxima alternate from there.
    pub(crate) top: usize,
    // These three follow from `top`. They are kept because they change only with it.
    /// Grid cell of the turning point at which the branch began.
    began: Split<T>,
    /// `Σ μ γ` at that turning point.
    began_y: T,
    /// Position at which the branch ends: the extreme before that turning point.
    end: T,
}

impl<T: Real> Position<T> {
    pub(crate) fn start(levels: usize) -> Self {
        Self {
            x: T::ZERO,
            y: T::ZERO,
            top: START,
            began: Split::new(T::ZERO, levels),
            began_y: T::ZERO,
            end: T::INFINITY,
        }
    }

    #[inline(always)]
    pub(crate) fn is_rising(&self) -> bool {
        self.top % 2 == START % 2
    }

    /// Moves to each of `positions` and replaces it by `Σ μ γ` there. Amortised `O(1)` each.
    ///
    /// Positions are normalised, in `[0, K]` and never −0. Each direction has its own code, so that
    /// no sample along a branch tests the direction.
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

    /// Moves to `x` if it lies ahead on the present branch. Returns whether it does.
    #[inline(always)]
    pub(crate) fn advance(&mut self, grid: Grid<'_, T>, x: T) -> bool {
        match self.is_rising() {
            true => self.follow::<true>(grid, x),
            false => self.follow::<false>(grid, x),
        }
    }

    /// Whether both are the same position on the same branch. Outputs are not compared.
    pub(crate) fn is_at(&self, other: &Self) -> bool {
        let key = |position: &Self| (position.x, position.top, position.began, position.end);
        key(self) == key(other)
    }

    /// The slope of `Σ μ γ` over the position, along the present branch.
    pub(crate) fn slope(&self, grid: Grid<'_, T>) -> T {
        let here = Split::new(self.x, grid.levels);
        match self.is_rising() {
            true => grid.slope_up(here, self.began),
            false => grid.slope_down(self.began, here),
        }
    }

    /// As [`Position::slope`] for relays, whose position is the index of a level: the larger one of
    /// the steps to the next level and from the last one.
    pub(crate) fn step_of_relays(&self, grid: Grid<'_, T>) -> T {
        let level = |split: Split<T>| split.cell + usize::from(split.part > T::HALF);
        let (here, began) = (level(Split::new(self.x, grid.levels)), level(self.began));
        let step = |n: usize| match self.is_rising() {
            true => grid.corner(n + 1, began) - grid.corner(n, began),
            false => grid.corner(began, n) - grid.corner(began, n + 1),
        };
        let next = |n: usize| if n < grid.levels { step(n) } else { T::ZERO };
        let last = here.checked_sub(1).map_or(T::ZERO, step);
        next(here).max(last)
    }

    /// Computes the outputs of another table at all turning points and at the present position.
    pub(crate) fn rebase(&mut self, turns: &mut [Turn<T>], grid: Grid<'_, T>) {
        let mut last = turns[START];
        for turn in &mut turns[START + 1..=self.top] {
            turn.y = last.along(grid, turn.x);
            last = *turn;
        }
        self.began_y = last.y;
        self.y = last.along(grid, self.x);
    }

    /// Follows `next` and the `rest` in one direction until the input turns. Returns the position
    /// that lies in the other direction, `None` at the end of the positions.
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

    /// Moves to `x` if it lies on the branch ahead. Returns whether it does.
    #[inline(always)]
    fn follow<const RISING: bool>(&mut self, grid: Grid<'_, T>, x: T) -> bool {
        if before::<T, RISING>(x, self.x) || !before::<T, RISING>(x, self.end) {
            return false;
        }
        let here = Split::new(x, grid.levels);
        self.x = x;
        self.y = if RISING {
            self.began_y + grid.everett(here, self.began)
        } else {
            self.began_y - grid.everett(self.began, here)
        };
        true
    }

    /// Changes to the next branch on the way to `x`. Returns whether that branch has the other
    /// direction.
    ///
    /// Where the input turned, the present position becomes a turning point. Where the branch
    /// ended, the turning points that it began and ended at are wiped out.
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
                // The bottom of the plane: all operators are off, as at the start. From here the
                // input can only rise.
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
        self.began = Split::new(began.x, grid.levels);
        self.began_y = began.y;
        self.end = turns[self.top - 1].x;
        turned
    }

    /// Merges the corner that ends at the present position with the one before it, if both and the
    /// corner before them lie in one grid cell. Returns whether it did.
    ///
    /// A cheap test of distance comes first. With fewer than two corners before, it reads a
    /// sentinel, whose position is infinite, and fails.
    #[inline(always)]
    fn merged(&self, turns: &mut [Turn<T>], grid: Grid<'_, T>) -> bool {
        let recent = turns.get_mut(self.top - LOOK..);
        let Some(recent) = recent.and_then(|turns| turns.first_chunk_mut()) else {
            return false; // unreachable: `top` lies within the memory
        };
        let [outer_max, outer_min, _, _, peak] = recent;
        outer_max.x - peak.x < T::ONE
            && self.x - outer_min.x < T::ONE
            && merge(recent, grid, self.x)
    }
}

/// Whether a branch of this direction reaches `a` before `b`.
#[inline(always)]
fn before<T: Real, const RISING: bool>(a: T, b: T) -> bool {
    if RISING { a.precedes(b) } else { b.precedes(a) }
}

/// Replaces two corners by one, where both lie in one grid cell with the corner before them: the
/// last one among the turning points and the one from its peak down to `min`. Returns whether it
/// did.
///
/// In the cell the first corner maps `γ ← min(max(γ, u'), v')` and the second
/// `γ ← min(max(γ, u''), v'')`, with `u'' < u'` and `v' < v''`. The corner before them has left
/// `γ < v'`. So both together equal `γ ← min(max(γ, u), v'')` with `u = clamp(v', u'', u')`: one
/// corner. The operators outside the cell depend only on the corner before and on the last minimum.
#[cold]
#[inline(never)]
fn merge<T: Real>(recent: &mut [Turn<T>; LOOK + 1], grid: Grid<'_, T>, min: T) -> bool {
    let [outer_max, outer_min, inner_max, inner_min, peak] = recent.map(|turn| turn.x);
    let split = |x| Split::new(x, grid.levels);
    let cell = |max, min| (split(max).cell, split(min).cell);
    let here = cell(peak, min);
    if cell(outer_max, outer_min) != here || cell(inner_max, inner_min) != here {
        return false;
    }
    let (p, q) = here;
    let held = T::from_index(p) + (inner_min - T::from_index(q));
    let max = held.clamp(peak, inner_max);
    // Computed from the corner before, so that rounding errors do not add up over many merges.
    let at_max = recent[1].y + grid.everett(split(max), split(outer_min));
    let at_min = at_max - grid.everett(split(max), split(min));
    recent[2] = Turn { x: max, y: at_max };
    recent[3] = Turn { x: min, y: at_min };
    true
}
