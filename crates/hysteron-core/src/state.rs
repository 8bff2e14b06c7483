//! What a model remembers of its input: the dominant turning points, in memory that the caller provides.

use crate::everett::{Split, Triangle, everett};
use crate::{Clipped, Error, Operator, Plane, Real};

/// A turning point of the input: the normalised position `0 ≤ x ≤ K`, and `Σ μ γ` there with `γ` in `[0, 1]`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Turn<T> {
    pub(crate) x: T,
    pub(crate) y: T,
}

/// Memory that a state needs, `4K + 3` turning points: the `2K` corners `(M, m)` that a staircase
/// can have, two for each grid cell it can cross; the peak of the branch being travelled; and the
/// two that every history starts from.
#[must_use]
pub const fn turn_capacity(levels: usize) -> usize {
    4 * levels + 3
}

/// The start of every history in the turning points: the input below the plane, after an endless height.
const START: usize = 1;

/// The state of a model: turning points `M_1 > M_2 > …`, `m_1 < m_2 < …` and the branch being travelled.
///
/// `S` is the memory: `&mut [Turn<T>]`, an array or a vector with at least [`turn_capacity`] elements.
///
/// Turning points nested inside one grid cell can be arbitrarily many, but they act on the rest
/// only through that cell's `γ`. The outermost are kept as they are; all others are replaced,
/// exactly, by the one maximum that leaves the same `γ`, and the last minimum.
#[derive(Debug, Clone, PartialEq)]
pub struct State<T, S> {
    turns: S,
    levels: usize,
    operator: Operator,
    place: Place<T>,
}

/// Where the input is. Small and `Copy`, so that a loop over samples can hold it in registers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place<T> {
    /// Normalised position; for relays the level last reached, as a whole number.
    pub(crate) x: T,
    /// `Σ μ γ` there.
    pub(crate) y: T,
    /// The turning point that the present branch began at: a minimum where odd, a maximum where even.
    top: usize,
    /// Direction of the branch, +1 rising, −1 falling.
    direction: T,
    /// Last input, in its own unit, before clipping.
    pub(crate) input: T,
}

impl<T: Real, S: AsRef<[Turn<T>]> + AsMut<[Turn<T>]>> State<T, S> {
    pub(crate) fn new(plane: &Plane<T>, operator: Operator, mut turns: S) -> Result<Self, Error> {
        let needed = turn_capacity(plane.levels());
        let found = turns.as_ref().len();
        if found < needed {
            return Err(Error::MemoryTooSmall { needed, found });
        }
        let start = turns.as_mut();
        start[0] = Turn {
            x: T::INFINITY,
            y: T::ZERO,
        };
        start[START] = Turn {
            x: T::ZERO,
            y: T::ZERO,
        };
        Ok(Self {
            turns,
            levels: plane.levels(),
            operator,
            place: Place::start(plane),
        })
    }

    /// The last input, in its own unit, as it was given.
    #[must_use]
    pub fn input(&self) -> T {
        self.place.input
    }

    /// The last input as a normalised position in `[0, K]`; for relays the whole number of the level last passed.
    #[must_use]
    pub fn position(&self) -> T {
        self.place.x
    }

    /// Whether the branch being travelled is a rising one.
    #[must_use]
    pub fn is_rising(&self) -> bool {
        self.place.top % 2 == START % 2
    }

    /// How many corners `(M, m)` are held now, at most `2K`.
    #[must_use]
    pub fn corners(&self) -> usize {
        (self.place.top - START) / 2
    }

    /// The turning points `M_1, m_1, M_2, m_2, …` as normalised positions, the present position last.
    ///
    /// With [`State::input`] they are the whole state: [`crate::Model::restore`] rebuilds it from them, bit for bit.
    pub fn turning_points(&self) -> impl Iterator<Item = T> + '_ {
        let turns = &self.turns()[START + 1..];
        turns.iter().map(|turn| turn.x).chain([self.place.x])
    }

    /// The terms of `H` over the Everett table: calls `term(index, factor)` so that
    /// `Σ factor · C[index]` is the output `Σ μ γ`. An index may come more than once.
    ///
    /// This is a row of the sparse matrix that identification works with.
    pub fn everett_terms(&self, mut term: impl FnMut(usize, T)) {
        let mut last = T::ZERO;
        for x in self.turning_points() {
            // Up to a maximum adds its triangle, down to a minimum takes one away.
            let (max, min, sign) = if x > last {
                (x, last, T::ONE)
            } else {
                (last, x, -T::ONE)
            };
            if max > min {
                let t = Triangle::of(Split::of(max, self.levels), Split::of(min, self.levels));
                term(t.near, sign * (T::ONE - t.larger));
                term(t.mid, sign * (t.larger - t.smaller));
                term(t.far, sign * t.smaller);
            }
            last = x;
        }
    }

    pub(crate) fn levels(&self) -> usize {
        self.levels
    }

    pub(crate) fn operator(&self) -> Operator {
        self.operator
    }

    pub(crate) fn place(&self) -> Place<T> {
        self.place
    }

    /// All turning points, the two of the start included.
    pub(crate) fn turns(&self) -> &[Turn<T>] {
        &self.turns.as_ref()[..=self.place.top]
    }

    /// All operators off, at the bottom of the plane.
    pub(crate) fn reset_off(&mut self, plane: &Plane<T>) {
        self.place = Place::start(plane);
    }

    /// Moves to a normalised position, as restored: `input` is what it stands for.
    pub(crate) fn travel(&mut self, table: &[T], x: T, input: T) {
        let turns = self.turns.as_mut();
        self.place.travel(turns, table, self.levels, x);
        self.place.input = input;
    }

    /// Moves to each of `inputs`, all known to be finite, and hands `Σ μ γ` and the clipping to `each`.
    #[inline(always)]
    pub(crate) fn advance(
        &mut self,
        plane: &Plane<T>,
        table: &[T],
        inputs: &[T],
        mut each: impl FnMut(T, Option<Clipped>),
    ) {
        let turns = self.turns.as_mut();
        let mut place = self.place;
        for &input in inputs {
            let (mut x, clipped) = plane.normalise(input);
            if self.operator == Operator::Relay {
                x = place.relay_position(plane, input);
            }
            place.input = input;
            place.travel(turns, table, self.levels, x);
            each(place.y, clipped);
        }
        self.place = place;
    }
}

impl<T: Real> Place<T> {
    fn start(plane: &Plane<T>) -> Self {
        Self {
            x: T::ZERO,
            y: T::ZERO,
            top: START,
            direction: T::ONE,
            input: plane.bottom(),
        }
    }

    /// A relay knows its levels only: rising, the last level reached; falling, the level below the last one left.
    /// On these whole numbers the Everett function is the table itself.
    fn relay_position(&self, plane: &Plane<T>, input: T) -> T {
        if input > self.input {
            T::from_index(plane.level_at_or_below(input))
        } else if input < self.input {
            T::from_index(plane.level_at_or_above(input) - 1)
        } else {
            self.x
        }
    }

    /// Moves to the normalised position `x` in `[0, K]`: amortised `O(1)`.
    ///
    /// Both directions are one code, told apart by a sign: on noisy input the direction cannot be
    /// predicted, and a mispredicted branch costs as much as all the rest.
    #[inline(always)]
    fn travel(&mut self, turns: &mut [Turn<T>], table: &[T], levels: usize, x: T) {
        if self.direction * (x - self.x) < T::ZERO {
            self.turn(turns, table, levels);
        }
        // The input wipes out every extreme that it passes, and the opposite one after it.
        while self.direction * x >= self.direction * turns[self.top - 1].x {
            self.top -= 2;
            if self.top < START {
                // Below everything: all operators are off, as at the start.
                self.top = START;
                self.direction = T::ONE;
                break;
            }
        }
        let began = turns[self.top];
        let change = everett(table, levels, x.larger(began.x), x.smaller(began.x));
        self.y = began.y + self.direction * change;
        self.x = x;
    }

    /// Ends the branch at the present position.
    #[inline(always)]
    fn turn(&mut self, turns: &mut [Turn<T>], table: &[T], levels: usize) {
        let rising_again = self.direction < T::ZERO;
        self.direction = -self.direction;
        if rising_again && self.top >= START + 5 {
            let (outer_max, outer_min) = (turns[self.top - 4].x, turns[self.top - 3].x);
            // Less than a cell apart, as they must be to share one.
            let near = outer_max - turns[self.top].x < T::ONE && self.x - outer_min < T::ONE;
            if near && self.merge(turns, table, levels) {
                return;
            }
        }
        // Two corners a cell, K cells along a staircase: the memory is never exceeded.
        if let Some(free) = turns.get_mut(self.top + 1) {
            *free = Turn {
                x: self.x,
                y: self.y,
            };
            self.top += 1;
        }
    }

    /// Makes one corner of the last one and the one that the present minimum would add, where both
    /// lie in one grid cell with the corner before them; says whether they do.
    ///
    /// In the cell, `γ ← min(max(γ, u'), v')` and then `γ ← min(max(γ, u''), v'')`, with `u'' < u'` and
    /// `v' < v''`. Since the corner before has left `γ < v'`, both together equal
    /// `γ ← min(max(γ, u), v'')` with `u = clamp(v', u'', u')`. Everything outside the cell sees only
    /// the corner before and the last minimum.
    #[cold]
    fn merge(&mut self, turns: &mut [Turn<T>], table: &[T], levels: usize) -> bool {
        let peak = self.top;
        let cell = |max: T, min: T| (Split::of(max, levels).cell, Split::of(min, levels).cell);
        let here = cell(turns[peak].x, self.x);
        let [outer, inner] = [peak - 4, peak - 2];
        if cell(turns[outer].x, turns[outer + 1].x) != here
            || cell(turns[inner].x, turns[inner + 1].x) != here
        {
            return false;
        }
        let (p, q) = here;
        let held = T::from_index(p) + (turns[inner + 1].x - T::from_index(q));
        let max = held.limited(turns[peak].x, turns[inner].x);
        // From the corner before on, so that ten thousand of these leave no more rounding than one.
        let before = turns[outer + 1];
        let at_max = before.y + everett(table, levels, max, before.x);
        let at_min = at_max - everett(table, levels, max, self.x);
        turns[inner] = Turn { x: max, y: at_max };
        turns[inner + 1] = Turn {
            x: self.x,
            y: at_min,
        };
        self.top = inner + 1;
        true
    }
}
