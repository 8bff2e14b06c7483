//! What a model remembers of its input: the dominant turning points, in memory that the caller provides.

use crate::everett::{Split, Triangle, everett};
use crate::{Error, Operator, Plane, Real};

/// A turning point of the input: the normalised position `0 ≤ x ≤ K`, and `Σ μ γ` there with `γ` in `[0, 1]`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Turn<T> {
    pub(crate) x: T,
    pub(crate) y: T,
}

/// Memory that a state needs, `4K + 8` turning points: the `2K` corners `(M, m)` that a staircase
/// can have, two for each grid cell it can cross; the peak of the branch being travelled and the
/// free place after it; and six that every history starts from.
#[must_use]
pub const fn turn_capacity(levels: usize) -> usize {
    4 * levels + 8
}

/// The start of every history among the turning points: the input below the plane, after endless
/// heights. There are enough of these for a look at two corners back to need no case of its own.
const START: usize = LOOK + 1;

/// How far back from the branch's own turning point a step looks: the two corners before it.
const LOOK: usize = 4;

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
///
/// The order of the fields is kept, numbers apart from each other: neighbours that are written singly
/// and read as a pair stall the processor, which doubled the time of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Place<T> {
    /// Normalised position; for relays the level last reached, as a whole number.
    pub(crate) x: T,
    /// The turning point that the branch began at, counted like `START`, which is a minimum.
    top: usize,
    /// `Σ μ γ` at `x`.
    pub(crate) y: T,
    /// The cell of that turning point, its output, and the position of the extreme that ends the
    /// branch: all follow from `top`, kept because they change only with it.
    began: Split<T>,
    /// Last input, in its own unit, before clipping.
    pub(crate) input: T,
    began_y: T,
    /// Direction of the branch, +1 rising, −1 falling.
    direction: T,
    end: T,
}

impl<T: Real, S: AsRef<[Turn<T>]> + AsMut<[Turn<T>]>> State<T, S> {
    pub(crate) fn new(plane: &Plane<T>, operator: Operator, mut turns: S) -> Result<Self, Error> {
        let needed = turn_capacity(plane.levels());
        let found = turns.as_ref().len();
        if found < needed {
            return Err(Error::MemoryTooSmall { needed, found });
        }
        let endless = Turn {
            x: T::INFINITY,
            y: T::ZERO,
        };
        turns.as_mut()[..START].fill(endless);
        turns.as_mut()[START] = Turn {
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
        let turns = &self.turns()[2..];
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

    /// All turning points from the start on, and the endless height before it: maxima at even places.
    pub(crate) fn turns(&self) -> &[Turn<T>] {
        &self.turns.as_ref()[START - 1..=self.place.top]
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
        // Turned back, or come to the branch's end: one comparison, so one branch to mispredict.
        let back = self.direction * (self.x - x);
        let beyond = self.direction * (x - self.end);
        if back.larger(beyond) >= T::ZERO {
            if x == self.x {
                return self;
            }
            self = self.change_branch(turns, table, levels, x);
        }
        let here = Split::of(x, levels);
        let change = Triangle::between(self.began, here, self.direction).evaluate(table);
        self.y = self.began_y + self.direction * change;
        self.x = x;
        self
    }

    /// Finds the branch that `x` lies on: where the input turned, the present position becomes a
    /// turning point; every extreme that `x` passes is wiped out with the opposite one after it.
    #[inline(always)]
    fn change_branch(mut self, turns: &mut [Turn<T>], table: &[T], levels: usize, x: T) -> Self {
        let direction = (x - self.x).signum();
        let recent = turns.get_mut(self.top - LOOK..);
        let Some(recent) = recent.and_then(|turns| turns.first_chunk_mut::<{ LOOK + 2 }>()) else {
            return self; // the memory has this many elements beyond the bound
        };
        if self.may_merge(recent, x) && merge(recent, table, levels, self.x) {
            self.top -= 1;
            self.direction = direction;
            return self.wipe_out(turns, levels, x);
        }
        // Where nothing turned the element is written all the same, and stays free.
        recent[LOOK + 1] = Turn {
            x: self.x,
            y: self.y,
        };
        let turned = (direction * self.direction).sign_bit();
        // Signs instead of branches: neither this choice nor the next can be predicted.
        let short = direction * x - direction * recent[LOOK - 1 + turned].x;
        let place = LOOK + turned + 2 * short.sign_bit() - 2;
        self.top = self.top + place - LOOK;
        self.direction = direction;
        let (began, end) = (recent[place], recent[place - 1].x);
        if direction * x >= direction * end {
            return self.wipe_out(turns, levels, x);
        }
        self.began = Split::of(began.x, levels);
        self.began_y = began.y;
        self.end = end;
        self
    }

    /// Drops every extreme that `x` passes, and the opposite one after it.
    #[inline(always)]
    fn wipe_out(mut self, turns: &[Turn<T>], levels: usize, x: T) -> Self {
        while self.top > START && self.direction * x >= self.direction * turns[self.top - 1].x {
            self.top -= 2;
        }
        if self.top < START {
            // Below everything: all operators are off, as at the start.
            self.top = START;
            self.direction = T::ONE;
        }
        self.began = Split::of(turns[self.top].x, levels);
        self.began_y = turns[self.top].y;
        self.end = turns[self.top - 1].x;
        self
    }

    /// Whether the input, falling, turns at the present position, and the corner that this makes may
    /// share a grid cell with the two before it: they are less than a cell apart.
    ///
    /// Four conditions in one comparison, that none of these numbers reaches zero. With fewer than two
    /// corners before, one of them is an endless height.
    #[inline(always)]
    fn may_merge(&self, recent: &[Turn<T>; LOOK + 2], x: T) -> bool {
        let (maxima, minima) = (recent[0].x - recent[LOOK].x, self.x - recent[1].x);
        let turned = self.direction * (x - self.x);
        (maxima.larger(minima) - T::ONE)
            .larger(turned)
            .larger(self.direction)
            < T::ZERO
    }
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
fn merge<T: Real>(recent: &mut [Turn<T>; LOOK + 2], table: &[T], levels: usize, min: T) -> bool {
    let [outer_max, outer_min, inner_max, inner_min, peak, _] = *recent;
    let cell = |max: T, min: T| (Split::of(max, levels).cell, Split::of(min, levels).cell);
    let here = cell(peak.x, min);
    if cell(outer_max.x, outer_min.x) != here || cell(inner_max.x, inner_min.x) != here {
        return false;
    }
    let (p, q) = here;
    let held = T::from_index(p) + (inner_min.x - T::from_index(q));
    let max = held.limited(peak.x, inner_max.x);
    // From the corner before on, so that ten thousand of these leave no more rounding than one.
    let at_max = outer_min.y + everett(table, levels, max, outer_min.x);
    let at_min = at_max - everett(table, levels, max, min);
    recent[2] = Turn { x: max, y: at_max };
    recent[3] = Turn { x: min, y: at_min };
    true
}
