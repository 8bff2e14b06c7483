//! What a model remembers of its input: the dominant turning points, in memory that the caller provides.

use crate::everett::{Split, Triangle, everett};
use crate::{Clipped, Error, Operator, Plane, Real};

/// A maximum `M_k` of the input's history and the minimum `m_k` after it, with the outputs there.
///
/// Positions are normalised inputs, `0 ≤ m_k < M_k ≤ K`; outputs are `Σ μ γ` with `γ` in `[0, 1]`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Corner<T> {
    pub(crate) max: T,
    pub(crate) min: T,
    pub(crate) output_max: T,
    pub(crate) output_min: T,
}

/// Corners that a state needs at most, `2K`: two for each grid cell that a staircase can cross.
#[must_use]
pub const fn corner_capacity(levels: usize) -> usize {
    2 * levels
}

/// The state of a model: turning points `M_1 > M_2 > …`, `m_1 < m_2 < …` and the branch being travelled.
///
/// `S` is the memory for the corners: `&mut [Corner<T>]`, an array or a vector with at least
/// [`corner_capacity`] elements, which are never exceeded.
///
/// Turning points nested inside one grid cell can be arbitrarily many, but they act on the rest
/// only through that cell's `γ`. The outermost is kept as it is; all others are replaced, exactly,
/// by the one turning point that leaves the same `γ` and the same last minimum.
#[derive(Debug, Clone, PartialEq)]
pub struct State<T, S> {
    corners: S,
    depth: usize,
    levels: usize,
    pub(crate) operator: Operator,
    /// Normalised position; for relays the level last reached, as a whole number.
    pub(crate) x: T,
    /// `Σ μ γ` there.
    pub(crate) y: T,
    /// Where the falling branch began; when rising, meaningless.
    peak: T,
    peak_output: T,
    rising: bool,
    /// Last input, in its own unit, before clipping.
    input: T,
}

impl<T: Real, S: AsRef<[Corner<T>]> + AsMut<[Corner<T>]>> State<T, S> {
    pub(crate) fn new(plane: &Plane<T>, operator: Operator, corners: S) -> Result<Self, Error> {
        let needed = corner_capacity(plane.levels());
        let found = corners.as_ref().len();
        if found < needed {
            return Err(Error::MemoryTooSmall { needed, found });
        }
        Ok(Self {
            corners,
            depth: 0,
            levels: plane.levels(),
            operator,
            x: T::ZERO,
            y: T::ZERO,
            peak: T::ZERO,
            peak_output: T::ZERO,
            rising: true,
            input: plane.bottom(),
        })
    }

    /// The last input, in its own unit, as it was given.
    #[must_use]
    pub fn input(&self) -> T {
        self.input
    }

    /// The last input as a normalised position in `[0, K]`; for relays the whole number of the level last passed.
    #[must_use]
    pub fn position(&self) -> T {
        self.x
    }

    /// Whether the branch being travelled is a rising one.
    #[must_use]
    pub fn is_rising(&self) -> bool {
        self.rising
    }

    /// How many corners are held now, at most `2K`.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.depth
    }

    pub(crate) fn set_input(&mut self, input: T) {
        self.input = input;
    }

    pub(crate) fn levels(&self) -> usize {
        self.levels
    }

    /// The corners from the outermost to the innermost.
    pub(crate) fn corners(&self) -> &[Corner<T>] {
        &self.corners.as_ref()[..self.depth]
    }

    /// The maximum that a falling branch began at, with its output.
    pub(crate) fn peak(&self) -> Option<(T, T)> {
        (!self.rising).then_some((self.peak, self.peak_output))
    }

    /// The turning points `M_1, m_1, M_2, m_2, …` as normalised positions, the present position last.
    ///
    /// With [`State::input`] they are the whole state: `Model::restore` rebuilds it from them, bit for bit.
    pub fn turning_points(&self) -> impl Iterator<Item = T> + '_ {
        let peak = self.peak().map(|(peak, _)| peak);
        self.corners()
            .iter()
            .flat_map(|corner| [corner.max, corner.min])
            .chain(peak)
            .chain([self.x])
    }

    /// The terms of `H` over the Everett table: calls `term(index, factor)` so that
    /// `Σ factor · C[index]` is the output `Σ μ γ`. An index may come more than once.
    ///
    /// This is a row of the sparse matrix that identification works with.
    pub fn everett_terms(&self, mut term: impl FnMut(usize, T)) {
        let mut add = |max: T, min: T, sign: T| {
            if max > min {
                let t = Triangle::of(Split::of(max, self.levels), Split::of(min, self.levels));
                term(t.near, sign * (T::ONE - t.larger));
                term(t.mid, sign * (t.larger - t.smaller));
                term(t.far, sign * t.smaller);
            }
        };
        let mut min = T::ZERO;
        for corner in self.corners() {
            add(corner.max, min, T::ONE);
            add(corner.max, corner.min, -T::ONE);
            min = corner.min;
        }
        match self.peak() {
            None => add(self.x, min, T::ONE),
            Some((peak, _)) => {
                add(peak, min, T::ONE);
                add(peak, self.x, -T::ONE);
            }
        }
    }

    /// All operators off, at the bottom of the plane.
    pub(crate) fn reset_off(&mut self, plane: &Plane<T>) {
        self.depth = 0;
        self.rising = true;
        self.x = T::ZERO;
        self.y = T::ZERO;
        self.input = plane.bottom();
    }

    /// Moves to `input`, already known to be finite.
    #[inline(always)]
    pub(crate) fn advance(&mut self, plane: &Plane<T>, table: &[T], input: T) -> Option<Clipped> {
        let (mut x, clipped) = plane.normalise(input);
        if self.operator == Operator::Relay {
            // A relay knows its levels only: rising, the last level reached; falling, the level
            // below the last one left. On these whole numbers the Everett function is the table itself.
            x = if input > self.input {
                T::from_index(plane.level_at_or_below(input))
            } else if input < self.input {
                T::from_index(plane.level_at_or_above(input) - 1)
            } else {
                self.x
            };
        }
        self.input = input;
        self.travel(table, x);
        clipped
    }

    /// Moves to the normalised position `x` in `[0, K]`: amortised `O(1)`.
    #[inline(always)]
    pub(crate) fn travel(&mut self, table: &[T], x: T) {
        if x > self.x {
            if !self.rising {
                self.push(table);
            }
            self.rise(table, x);
        } else if x < self.x {
            self.fall(table, x);
        }
    }

    #[inline(always)]
    fn rise(&mut self, table: &[T], x: T) {
        let corners = self.corners.as_mut();
        // The input wipes out every maximum that it passes, and the minimum after it.
        while self.depth > 0 && x >= corners[self.depth - 1].max {
            self.depth -= 1;
        }
        let (min, output_min) = match self.depth {
            0 => (T::ZERO, T::ZERO),
            depth => (corners[depth - 1].min, corners[depth - 1].output_min),
        };
        self.y = output_min + everett(table, self.levels, x, min);
        self.x = x;
    }

    #[inline(always)]
    fn fall(&mut self, table: &[T], x: T) {
        if self.rising {
            self.rising = false;
            self.peak = self.x;
            self.peak_output = self.y;
        }
        let corners = self.corners.as_mut();
        // Passing a minimum, it wipes out that and the maximum after it, and goes on down the branch before.
        while self.depth > 0 && x <= corners[self.depth - 1].min {
            self.depth -= 1;
            self.peak = corners[self.depth].max;
            self.peak_output = corners[self.depth].output_max;
        }
        if x > T::ZERO {
            self.y = self.peak_output - everett(table, self.levels, self.peak, x);
        } else {
            self.rising = true;
            self.y = T::ZERO;
        }
        self.x = x;
    }

    /// Ends a falling branch: its peak and the present position become a corner.
    #[inline(always)]
    fn push(&mut self, table: &[T]) {
        self.rising = true;
        let mut new = Corner {
            max: self.peak,
            min: self.x,
            output_max: self.peak_output,
            output_min: self.y,
        };
        let corners = self.corners.as_mut();
        if let [.., outer, inner] = &corners[..self.depth] {
            let cell = |c: &Corner<T>| {
                (
                    Split::of(c.max, self.levels).cell,
                    Split::of(c.min, self.levels).cell,
                )
            };
            let here = cell(&new);
            if cell(inner) == here && cell(outer) == here {
                new = merge(table, self.levels, here, outer, inner, &new);
                self.depth -= 1;
            }
        }
        // Two corners a cell, K cells along a staircase: the memory is never exceeded.
        if let Some(free) = corners.get_mut(self.depth) {
            *free = new;
            self.depth += 1;
        }
    }
}

/// The one corner that acts like `inner` followed by `new`, all three in one grid cell within `outer`.
///
/// In the cell, `γ ← min(max(γ, u'), v')` and then `γ ← min(max(γ, u''), v'')`, with `u'' < u'` and
/// `v' < v''`. Since `outer` has left `γ < v'`, both together equal `γ ← min(max(γ, u), v'')` with
/// `u = clamp(v', u'', u')`. Everything outside the cell sees only `outer` and the last minimum.
#[inline(never)]
fn merge<T: Real>(
    table: &[T],
    levels: usize,
    (p, q): (usize, usize),
    outer: &Corner<T>,
    inner: &Corner<T>,
    new: &Corner<T>,
) -> Corner<T> {
    let held = T::from_index(p) + (inner.min - T::from_index(q));
    let max = held.limited(new.max, inner.max);
    // From `outer` on, so that ten thousand of these leave no more rounding than one.
    let output_max = outer.output_min + everett(table, levels, max, outer.min);
    Corner {
        max,
        min: new.min,
        output_max,
        output_min: output_max - everett(table, levels, max, new.min),
    }
}
