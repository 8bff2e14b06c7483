//! The state of a model: the dominant turning points of its input, in memory of the caller.

use crate::branch::{Position, START, Turn};
use crate::error::Error;
use crate::everett::{Grid, Split, Triangle};
use crate::memory::Memory;
use crate::operator::Operator;
use crate::plane::Plane;
use crate::relay;
use crate::scalar::Real;

/// Number of turning points that a state needs memory for: `4K + 8` for `K` levels.
///
/// - `4K` for the `2K` corners `(M, m)` that a staircase can have: two for each of the `K` grid
///   cells it crosses.
/// - 2 for the peak of the present branch and the next turning point.
/// - 6 that every history starts with.
#[must_use]
pub const fn turn_capacity(levels: usize) -> usize {
    4 * levels + 8
}

/// How many positions a run computes before it moves through them.
///
/// The positions do not depend on each other, so the compiler can compute several with one
/// instruction. And a turn of a noisy input, which the processor cannot predict, is resolved
/// sooner.
const AHEAD: usize = 64;

/// The state of a model: the turning points `M_1 > M_2 > …`, `m_1 < m_2 < …` and the present
/// branch.
///
/// `S` is the memory: `&mut [Turn<T>]`, an array or a vector with at least [`turn_capacity`]
/// elements.
///
/// The number of turning points inside one grid cell has no bound. But they affect the output only
/// through that cell's `γ`. So the state keeps the outermost corner of the cell and replaces all
/// others, exactly, by one: the maximum that gives the same `γ`, and the last minimum.
#[derive(Debug, Clone, PartialEq)]
pub struct State<T, S> {
    turns: S,
    levels: usize,
    operator: Operator,
    /// Stamp of the model whose outputs the turning points have.
    stamp: u64,
    /// Last input, in its own unit, before clipping.
    input: T,
    position: Position<T>,
}

impl<T: Real, S: Memory<Turn<T>>> State<T, S> {
    pub(crate) fn new(
        plane: &Plane<T>,
        operator: Operator,
        stamp: u64,
        mut turns: S,
    ) -> Result<Self, Error> {
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
            stamp,
            input: plane.bottom(),
            position: Position::start(plane.levels()),
        })
    }

    /// The last input, in its unit, as it was given. The bottom of the plane before the first one.
    #[must_use]
    pub fn input(&self) -> T {
        self.input
    }

    /// The last input as a normalised position in `[0, K]`. For relays it is the index of the level
    /// last passed, a whole number.
    #[must_use]
    pub fn position(&self) -> T {
        self.position.x
    }

    /// Whether the present branch is a rising one.
    #[must_use]
    pub fn is_rising(&self) -> bool {
        self.position.is_rising()
    }

    /// The number of corners `(M, m)` in the state, at most `2K`.
    #[must_use]
    pub fn corners(&self) -> usize {
        (self.position.top - START) / 2
    }

    /// The turning points `M_1, m_1, M_2, m_2, …` as normalised positions, the present position
    /// last.
    ///
    /// Together with [`State::input`] they are the whole state: [`crate::Model::restore`] rebuilds
    /// it from them, bit for bit.
    pub fn turning_points(&self) -> impl Iterator<Item = T> + '_ {
        let turns = &self.turns()[2..];
        turns.iter().map(|turn| turn.x).chain([self.position.x])
    }

    /// The number of turning points before the present branch.
    ///
    /// While it stays the same from one sample to the next, [`State::memory_terms`] stays the same.
    #[must_use]
    pub fn held(&self) -> usize {
        self.position.top - START
    }

    /// The output as a linear combination of entries of the Everett table.
    ///
    /// Calls `term(index, factor)` so that `Σ factor · C[index] = Σ μ γ`. An index may come more
    /// than once. The terms are those of [`State::memory_terms`] and of [`State::branch_terms`].
    /// They are a row of the sparse matrix of identification.
    pub fn everett_terms(&self, mut term: impl FnMut(usize, T)) {
        self.memory_terms(&mut term);
        for (index, factor) in self.branch_terms() {
            term(index, factor);
        }
    }

    /// The terms of the turning points before the present branch, as in [`State::everett_terms`].
    /// They do not change along the branch.
    pub fn memory_terms(&self, mut term: impl FnMut(usize, T)) {
        let mut last = T::ZERO;
        for turn in &self.turns()[2..] {
            for (index, factor) in self.terms_between(last, turn.x) {
                term(index, factor);
            }
            last = turn.x;
        }
    }

    /// The terms of the present branch, as in [`State::everett_terms`].
    #[must_use]
    #[inline]
    pub fn branch_terms(&self) -> [(usize, T); 3] {
        self.terms_between(self.turns.as_ref()[self.position.top].x, self.position.x)
    }

    /// The terms of a way between two extremes: positive on the way up, negative on the way down.
    #[inline]
    fn terms_between(&self, from: T, to: T) -> [(usize, T); 3] {
        let (sign, max, min) = if to > from {
            (T::ONE, to, from)
        } else {
            (-T::ONE, from, to)
        };
        let [max, min] = [max, min].map(|x| Split::new(x, self.levels));
        let triangle = Triangle::new(max, min);
        [
            (triangle.near, sign * (T::ONE - triangle.larger)),
            (triangle.mid, sign * (triangle.larger - triangle.smaller)),
            (triangle.far, sign * triangle.smaller),
        ]
    }

    pub(crate) fn levels(&self) -> usize {
        self.levels
    }

    pub(crate) fn operator(&self) -> Operator {
        self.operator
    }

    pub(crate) fn branch_position(&self) -> Position<T> {
        self.position
    }

    /// All turning points from the start on, after the sentinel before it. Maxima have even
    /// indices.
    pub(crate) fn turns(&self) -> &[Turn<T>] {
        &self.turns.as_ref()[START - 1..=self.position.top]
    }

    pub(crate) fn stamp(&self) -> u64 {
        self.stamp
    }

    /// Switches all operators off, for the model of this plane and stamp.
    pub(crate) fn reset_off(&mut self, plane: &Plane<T>, stamp: u64) {
        self.stamp = stamp;
        self.input = plane.bottom();
        self.position = Position::start(plane.levels());
    }

    /// Computes the outputs of another table at every turning point and at the present position.
    pub(crate) fn rebase(&mut self, table: &[T], stamp: u64) {
        self.stamp = stamp;
        let levels = self.levels;
        let turns = self.turns.as_mut();
        self.position.rebase(turns, Grid { table, levels });
    }

    /// Moves to the normalised position `x`, which stands for `input`.
    #[inline(always)]
    pub(crate) fn travel(&mut self, table: &[T], x: T, input: T) {
        let levels = self.levels;
        let grid = Grid { table, levels };
        if !self.position.advance(grid, x) {
            self.turn(table, x);
        }
        self.input = input;
    }

    /// Where the input turns or a branch ends. Apart, so that a step along a branch stays short.
    #[inline(never)]
    fn turn(&mut self, table: &[T], x: T) {
        let levels = self.levels;
        let turns = self.turns.as_mut();
        self.position
            .travel(turns, Grid { table, levels }, &mut [x]);
    }

    /// Moves to `input`, which has to be finite, and returns `Σ μ γ` there.
    #[inline(always)]
    pub(crate) fn step(&mut self, plane: &Plane<T>, table: &[T], input: T) -> T {
        let x = match self.operator {
            Operator::Mkp | Operator::Kp => plane.normalise(input),
            Operator::Relay => relay::position(plane, (self.input, self.position.x), input),
        };
        self.travel(table, x, input);
        self.position.y
    }

    /// Moves to each of `inputs`, which have to be finite, and writes `outward(Σ μ γ)` to
    /// `outputs`. Both slices have the same length.
    #[inline(always)]
    pub(crate) fn run(
        &mut self,
        plane: &Plane<T>,
        table: &[T],
        inputs: &[T],
        outputs: &mut [T],
        outward: impl Fn(T) -> T,
    ) {
        match self.operator {
            Operator::Mkp | Operator::Kp => {
                let position = |input| plane.normalise(input);
                self.run_by(table, inputs, outputs, position, outward);
            }
            Operator::Relay => {
                let mut last = (self.input, self.position.x);
                let position = |input| {
                    last = (input, relay::position(plane, last, input));
                    last.1
                };
                self.run_by(table, inputs, outputs, position, outward);
            }
        }
        if let Some(&last) = inputs.last() {
            self.input = last;
        }
    }

    #[inline(always)]
    fn run_by(
        &mut self,
        table: &[T],
        inputs: &[T],
        outputs: &mut [T],
        mut position: impl FnMut(T) -> T,
        outward: impl Fn(T) -> T,
    ) {
        let levels = self.levels;
        let turns = self.turns.as_mut();
        let mut here = self.position;
        for (inputs, outputs) in inputs.chunks(AHEAD).zip(outputs.chunks_mut(AHEAD)) {
            for (x, &input) in outputs.iter_mut().zip(inputs) {
                *x = position(input);
            }
            here.travel(turns, Grid { table, levels }, outputs);
            for y in outputs {
                *y = outward(*y);
            }
        }
        self.position = here;
    }
}
