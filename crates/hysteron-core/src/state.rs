//! What a model remembers of its input: the dominant turning points, in memory that the caller provides.

use crate::everett::{Split, Triangle, everett};
use crate::{Error, Operator, Plane, Real};

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

/// Where the input is, and the branch it is on. `Copy` and handed on by value, so that a loop over
/// samples holds it in registers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place<T> {
    /// Normalised position; for relays the level last reached, as a whole number.
    pub(crate) x: T,
    /// `Σ μ γ` there.
    pub(crate) y: T,
    /// Last input, in its own unit, before clipping.
    pub(crate) input: T,
    /// Direction of the branch, +1 rising, −1 falling.
    direction: T,
    /// The turning point that the branch began at: a minimum where odd, a maximum where even.
    top: usize,
    /// That point's cell and output, and the position of the extreme that ends the branch: all follow
    /// from `top`, kept because they change only with it.
    began: Split<T>,
    began_y: T,
    end: T,
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
            if x != last {
                let sign = if x > last { T::ONE } else { -T::ONE };
                let [a, b] = [last, x].map(|x| Split::of(x, self.levels));
                let triangle = Triangle::between(a, b, sign);
                term(triangle.near, sign * (T::ONE - triangle.larger));
                term(triangle.mid, sign * (triangle.larger - triangle.smaller));
                term(triangle.far, sign * triangle.smaller);
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
        self.place = self
            .place
            .travel(self.turns.as_mut(), table, self.levels, x);
        self.place.input = input;
    }

    /// Moves to each of `inputs`, all known to be finite, and hands `Σ μ γ` to `each`.
    #[inline(always)]
    pub(crate) fn advance(
        &mut self,
        plane: &Plane<T>,
        table: &[T],
        inputs: &[T],
        each: impl FnMut(T),
    ) {
        // Two loops, so that the common one makes no call that would empty its registers.
        if self.operator == Operator::Relay {
            self.advance_by(table, inputs, each, |place, t| {
                place.relay_position(plane, t)
            });
        } else {
            self.advance_by(table, inputs, each, |_, t| plane.normalise(t));
        }
    }

    #[inline(always)]
    fn advance_by(
        &mut self,
        table: &[T],
        inputs: &[T],
        mut each: impl FnMut(T),
        position: impl Fn(&Place<T>, T) -> T,
    ) {
        let turns = self.turns.as_mut();
        let mut place = self.place;
        for &input in inputs {
            let x = position(&place, input);
            place = place.travel(turns, table, self.levels, x);
            place.input = input;
            each(place.y);
        }
        self.place = place;
    }
}

impl<T: Real> Place<T> {
    fn start(plane: &Plane<T>) -> Self {
        Self {
            x: T::ZERO,
            y: T::ZERO,
            input: plane.bottom(),
            direction: T::ONE,
            top: START,
            began: Split::of(T::ZERO, plane.levels()),
            began_y: T::ZERO,
            end: T::INFINITY,
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

    /// The place after moving to the normalised position `x` in `[0, K]`: amortised `O(1)`.
    ///
    /// Both directions are one code, told apart by a sign: on noisy input the direction cannot be
    /// predicted, and a mispredicted branch costs as much as all the rest.
    #[inline(always)]
    fn travel(mut self, turns: &mut [Turn<T>], table: &[T], levels: usize, x: T) -> Self {
        let turned = self.direction * (x - self.x) < T::ZERO;
        let ended = self.direction * x >= self.direction * self.end;
        if turned | ended {
            self = self.change_branch(turns, table, levels, x, turned);
        }
        let here = Split::of(x, levels);
        let change = Triangle::between(self.began, here, self.direction).evaluate(table);
        self.y = self.began_y + self.direction * change;
        self.x = x;
        self
    }

    /// Finds the branch that `x` lies on: the present position becomes a turning point if the input
    /// `turned` there, and every extreme that `x` passes is wiped out with the opposite one after it.
    #[inline(always)]
    fn change_branch(
        mut self,
        turns: &mut [Turn<T>],
        table: &[T],
        levels: usize,
        x: T,
        turned: bool,
    ) -> Self {
        if self.may_merge(turns, x) && merge(turns, self.top, table, levels, self.x) {
            self.top -= 1;
        } else if let Some(free) = turns.get_mut(self.top + 1) {
            // Two corners a cell, K cells along a staircase: the memory is never exceeded. Where
            // nothing turned the element is written all the same, and stays free.
            free.x = self.x;
            free.y = self.y;
            self.top += usize::from(turned);
        }
        if turned {
            self.direction = -self.direction;
        }
        let passes = |top: usize| self.direction * x >= self.direction * turns[top - 1].x;
        // The first one without a branch, which could not be predicted either.
        let mut top = self.top - 2 * usize::from(passes(self.top));
        while top > START && passes(top) {
            top -= 2;
        }
        if top < START {
            // Below everything: all operators are off, as at the start.
            top = START;
            self.direction = T::ONE;
        }
        self.top = top;
        self.began = Split::of(turns[top].x, levels);
        self.began_y = turns[top].y;
        self.end = turns[top - 1].x;
        self
    }

    /// Whether the input, falling, turns at the present position, and the corner that this makes may
    /// share a grid cell with the two before it: they are less than a cell apart.
    ///
    /// Four conditions in one comparison, that none of these numbers reaches zero. With fewer than two
    /// corners before, one of them is the endless height at the start.
    #[inline(always)]
    fn may_merge(&self, turns: &[Turn<T>], x: T) -> bool {
        let back = |n: usize| turns[self.top.saturating_sub(n)].x;
        let (maxima, minima) = (back(4) - back(0), self.x - back(3));
        let turned = self.direction * (x - self.x);
        (maxima.larger(minima) - T::ONE)
            .larger(turned)
            .larger(self.direction)
            < T::ZERO
    }
}

/// Makes one corner of the last one and the one from the maximum at `peak` to the minimum `min`, where
/// both lie in one grid cell with the corner before them; says whether they do.
///
/// In the cell, `γ ← min(max(γ, u'), v')` and then `γ ← min(max(γ, u''), v'')`, with `u'' < u'` and
/// `v' < v''`. Since the corner before has left `γ < v'`, both together equal
/// `γ ← min(max(γ, u), v'')` with `u = clamp(v', u'', u')`. Everything outside the cell sees only
/// the corner before and the last minimum.
#[cold]
#[inline(never)]
fn merge<T: Real>(turns: &mut [Turn<T>], peak: usize, table: &[T], levels: usize, min: T) -> bool {
    let cell = |max: T, min: T| (Split::of(max, levels).cell, Split::of(min, levels).cell);
    let here = cell(turns[peak].x, min);
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
    let at_min = at_max - everett(table, levels, max, min);
    turns[inner] = Turn { x: max, y: at_max };
    turns[inner + 1] = Turn { x: min, y: at_min };
    true
}
