//! Where the output crosses a goal: on the way up, and on the way down.
//!
//! A way starts at the present position, on the present branch. If the goal lies beyond that
//! branch, the way goes on along an enclosing branch, which [`Branch::find`] selects.

use crate::branch::Turn;
use crate::everett::{Split, table_index};
use crate::inverse::Inverse;
use crate::memory::Memory;
use crate::operator::Operator;
use crate::relay;
use crate::scalar::Real;
use crate::search::{Branch, Goal, Landing, along, ceil_index, first_true};
use crate::state::State;

impl<T: Real, C: AsRef<[T]>> Inverse<'_, T, C> {
    /// The first input on the way up at which the output meets `goal`.
    pub(crate) fn rising<S>(&self, state: &State<T, S>, goal: Goal<T>) -> Landing<T>
    where
        S: Memory<Turn<T>>,
    {
        let plane = self.model.plane();
        let branch = Branch::find(state, 0, |maximum| goal.met_rising(maximum.y));
        let x = self.climb(branch.began.x, branch.start, goal.shifted(branch.began.y));
        let x = x.clamp(branch.start, branch.end);
        if self.model.operator() != Operator::Relay {
            return Landing {
                input: plane.denormalise(x),
                output: goal.value(),
            };
        }
        let level = match goal {
            Goal::Reach(..) => ceil_index(x, plane.levels()),
            Goal::Leave(..) => x.floor_index(),
        };
        let rise = self.everett(T::from_index(level), branch.began.x);
        Landing {
            input: relay::up_to(plane, (state.input(), state.position()), level),
            output: branch.began.y + rise,
        }
    }

    /// The first input on the way down at which the output meets `goal`.
    pub(crate) fn falling<S>(&self, state: &State<T, S>, goal: Goal<T>) -> Landing<T>
    where
        S: Memory<Turn<T>>,
    {
        let plane = self.model.plane();
        let branch = Branch::find(state, 1, |minimum| goal.met_falling(minimum.y));
        let x = self.descend(branch.began.x, branch.start, goal.mirrored(branch.began.y));
        let x = x.clamp(branch.end, branch.start);
        if self.model.operator() != Operator::Relay {
            return Landing {
                input: plane.denormalise(x),
                output: goal.value(),
            };
        }
        let level = match goal {
            Goal::Reach(..) => x.floor_index(),
            Goal::Leave(..) => ceil_index(x, plane.levels()),
        };
        let fall = self.everett(branch.began.x, T::from_index(level));
        Landing {
            input: relay::down_to(plane, (state.input(), state.position()), level),
            output: branch.began.y - fall,
        }
    }

    /// `e(max, min)` between two normalised positions, `min ≤ max`.
    fn everett(&self, max: T, min: T) -> T {
        let grid = self.model.grid();
        grid.everett(Split::new(max, grid.levels), Split::new(min, grid.levels))
    }

    /// The first `x` from `start` up at which `e(x, min)` meets `goal`; `K` if there is none.
    ///
    /// The search runs along column `q` of the table, the column of `min`.
    fn climb(&self, min: T, start: T, goal: Goal<T>) -> T {
        let levels = self.model.plane().levels();
        let table = self.model.table();
        let Split { cell: q, part: v } = Split::new(min, levels);
        let at = |p: usize| {
            let n = table_index(p, q);
            if p > q {
                table[n] + v * (table[n + 1] - table[n])
            } else {
                T::ZERO
            }
        };
        // The first grid line beyond `start` that meets the goal: the crossing is in the cell
        // before it.
        let first = Split::new(start, levels).cell + 1;
        let Some(row) = first_true(first, levels, |p| goal.met_rising(at(p))) else {
            return T::from_index(levels);
        };
        let p = row - 1;
        let (near, below) = (table_index(p, q), table_index(p + 1, q));
        // The two linear pieces, u ≤ v and u ≥ v, meet on the diagonal of the cell.
        let knot = if p > q {
            table[near] + v * (table[below + 1] - table[near])
        } else {
            T::ZERO
        };
        let u = if goal.met_rising(knot) {
            // In a cell on the plane's diagonal this piece is zero and never has the crossing.
            let slope = if p > q {
                table[below + 1] - table[near + 1]
            } else {
                T::ZERO
            };
            along(goal.value() - at(p), slope, v)
        } else {
            v + along(goal.value() - knot, table[below] - table[near], T::ONE - v)
        };
        T::from_index(p) + u
    }

    /// The first `x` from `start` down at which `e(max, x)` meets `goal`; 0 if there is none.
    ///
    /// The search runs along rows `p` and `p + 1` of the table, between which `max` lies.
    fn descend(&self, max: T, start: T, goal: Goal<T>) -> T {
        let levels = self.model.plane().levels();
        let table = self.model.table();
        let Split { cell: p, part: u } = Split::new(max, levels);
        let at = |q: usize| {
            let (near, below) = (table[table_index(p, q)], table[table_index(p + 1, q)]);
            near + u * (below - near)
        };
        let last = Split::new(start, levels).cell;
        // The first grid line from `last` down to 0 that meets the goal.
        let Some(steps) = first_true(0, last, |n| goal.met_rising(at(last - n))) else {
            return T::ZERO;
        };
        let q = last - steps;
        let (near, below) = (table_index(p, q), table_index(p + 1, q));
        let knot = if p > q {
            table[near] + u * (table[below + 1] - table[near])
        } else {
            T::ZERO
        };
        let v = if goal.met_rising(knot) {
            // From v = 1, where the input enters the cell, back to the diagonal.
            let slope = if p > q {
                table[near] - table[near + 1]
            } else {
                T::ZERO
            };
            u + along(knot - goal.value(), slope, T::ONE - u)
        } else {
            along(at(q) - goal.value(), table[below] - table[below + 1], u)
        };
        T::from_index(q) + v
    }
}
