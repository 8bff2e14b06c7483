//! The exact inverse: which input gives a wanted output, `O(log K)` (equations 6 to 14).
//!
//! With weights that are not negative, the output is monotone along a branch. The outputs stored at
//! the turning points tell which of the nested branches the target lies on, a bisection over one
//! row or column of the Everett table tells the grid cell, and inside the cell there are two linear
//! pieces to solve. The chapter's minimum (10) and maximum (13) over candidates are that first crossing.

use crate::branch::Turn;
use crate::error::Error;
use crate::everett::{Grid, Split, table_index};
use crate::memory::Memory;
use crate::model::Model;
use crate::operator::Operator;
use crate::relay;
use crate::scalar::Real;
use crate::search::{Branch, Goal, along, ceil_index, first_true, within};
use crate::state::State;

/// The inverse of a model whose weights are not negative ([`Model::inverse`]).
#[derive(Debug, Clone, Copy)]
pub struct Inverse<'m, T, C> {
    model: &'m Model<T, C>,
    /// Outputs closer than this are equal: the rounding of a table entry.
    rounding: T,
}

/// Where a target goes next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// To larger outputs (of the model without sign: `Σ μ γ`).
    Rising,
    /// To smaller outputs.
    Falling,
}

/// An output that is wanted.
///
/// ```
/// use hysteron_core::{Direction, Target};
/// let held = Target::new(3.0).tolerance(0.1);
/// let anticipated = held.heading(Some(Direction::Falling));
/// assert_eq!(anticipated.output, 3.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target<T> {
    /// The output, in its unit.
    pub output: T,
    /// Where the target goes next, if the input is to anticipate it: it then crosses the dead band
    /// at once, to the edge where the output starts to move that way. This holds for a target near
    /// the output at which the dead band began, as long as the output is still there. Any other
    /// target, and one with `None`, is held: the input stands still while the target does
    /// (equation 14).
    pub heading: Option<Direction>,
    /// A target that goes back by up to as much stands still too: without a tolerance, the input
    /// crosses the whole dead band and back for each reversal that noise makes. A target out of
    /// reach by up to as much is taken as the nearest end. In the output's unit; below zero and NaN
    /// count as zero.
    pub tolerance: T,
}

impl<T: Real> Target<T> {
    /// The chapter's policy: the input stands still for equal targets only.
    #[must_use]
    pub fn new(output: T) -> Self {
        Self {
            output,
            heading: None,
            tolerance: T::ZERO,
        }
    }

    /// Where the target goes next; `None` where it is to be held.
    #[must_use]
    pub fn heading(self, heading: Option<Direction>) -> Self {
        Self { heading, ..self }
    }

    /// How far the target may go back and still be held.
    #[must_use]
    pub fn tolerance(self, tolerance: T) -> Self {
        Self { tolerance, ..self }
    }
}

/// Whether a target can be reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The input gives the target, up to its tolerance.
    Ok,
    /// The target lies below every output; the input is the lowest one, `T_min − ΔT`.
    Low,
    /// The target lies above every output; the input is the highest one, `T_max`.
    High,
    /// The target lies inside a jump of a relay model. The input is that of the jump, and the output
    /// lies beyond the target by more than the tolerance.
    Passed,
}

impl Status {
    /// Its number in files and on surfaces without enumerations: 0 for [`Status::Ok`], −1 for
    /// [`Status::Low`], 1 for [`Status::High`], 2 for [`Status::Passed`].
    #[must_use]
    pub fn number(self) -> i8 {
        match self {
            Status::Ok => 0,
            Status::Low => -1,
            Status::High => 1,
            Status::Passed => 2,
        }
    }

    /// Its name in tables: `ok`, `low`, `high`, `passed`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::Low => "low",
            Status::High => "high",
            Status::Passed => "passed",
        }
    }

    /// Whether the target lies beyond the model's range of outputs, and its tolerance.
    #[must_use]
    pub fn is_out_of_reach(self) -> bool {
        matches!(self, Status::Low | Status::High)
    }

    /// The status of an output with the opposite sign.
    #[must_use]
    pub fn mirrored(self) -> Self {
        match self {
            Status::Low => Status::High,
            Status::High => Status::Low,
            other => other,
        }
    }
}

/// An input, and whether it gives the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution<T> {
    /// The input, in its unit, within the plane's active range `[T_min − ΔT, T_max]`. There are two
    /// exceptions, both for relays: an input beyond the range stays where the output stays, and one
    /// that fell to `T_max` has to rise above it by [`Plane::nudge`](crate::Plane::nudge) to switch on again.
    pub input: T,
    /// Whether it reaches the target.
    pub status: Status,
}

/// Where a way along a branch ends: the input, and `Σ μ γ` there.
struct Landing<T> {
    input: T,
    output: T,
}

impl<T: Real, C: AsRef<[T]>> Model<T, C> {
    /// The inverse of this model.
    ///
    /// # Errors
    /// [`Error::NegativeWeights`]: with any weight below zero the output is not monotone.
    pub fn inverse(&self) -> Result<Inverse<'_, T, C>, Error> {
        match self.negative_weights() {
            Some(which) => Err(Error::NegativeWeights(which)),
            None => {
                let rounding = T::from_index(4) * T::EPSILON * self.total();
                Ok(Inverse {
                    model: self,
                    rounding,
                })
            }
        }
    }
}

impl<T: Real, C: AsRef<[T]>> Inverse<'_, T, C> {
    /// Outputs `Σ μ γ` closer than this are taken as equal: the rounding of a table entry.
    #[must_use]
    pub fn rounding(&self) -> T {
        self.rounding
    }

    /// Finds the input for `target` and moves `state` there.
    ///
    /// On a flat stretch it is the first input that reaches the target. A relay model moves in
    /// jumps: the input is that of the first jump that reaches or passes the target, and the status
    /// says which ([`Status::Passed`]).
    ///
    /// # Errors
    /// [`Error::InputNotFinite`] for a target that is NaN or infinite, [`Error::StateMismatch`];
    /// the state is then as it was.
    ///
    /// ```
    /// use hysteron_core::{Model, Operator, Plane, Target, Status, Turn, table_len, turn_capacity};
    /// let plane = Plane::new(0.0, 1.0, 2)?;
    /// let model = Model::new(plane, Operator::Mkp, &[1.0, 2.0, 4.0], [0.0; table_len(2)])?;
    /// let mut state = model.state([Turn::default(); turn_capacity(2)])?;
    /// let inverse = model.inverse()?;
    /// let solution = inverse.step(&mut state, Target::new(4.0))?;
    /// assert_eq!((solution.input, solution.status), (0.5, Status::Ok));
    /// assert_eq!(inverse.step(&mut state, Target::new(9.0))?.status, Status::High);
    /// # Ok::<(), hysteron_core::Error>(())
    /// ```
    pub fn step<S>(&self, state: &mut State<T, S>, target: Target<T>) -> Result<Solution<T>, Error>
    where
        S: Memory<Turn<T>>,
    {
        let solution = self.solve(state, target)?;
        self.model.step(state, solution.input)?;
        Ok(solution)
    }

    /// Finds the input for `target` without moving `state`.
    ///
    /// # Errors
    /// As [`Inverse::step`].
    pub fn solve<S>(&self, state: &State<T, S>, target: Target<T>) -> Result<Solution<T>, Error>
    where
        S: Memory<Turn<T>>,
    {
        self.model.check(state)?;
        let Target {
            output: target,
            heading,
            tolerance,
        } = target;
        if !target.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        let plane = self.model.plane();
        let total = self.model.total();
        // From the operators' own outputs to `Σ μ γ`, of which they are twice as much.
        let (wanted, unit) = match self.model.operator() {
            Operator::Mkp => (target, T::ONE),
            Operator::Kp | Operator::Relay => (T::HALF * target + T::HALF * total, T::HALF),
        };
        let tolerance = unit * tolerance.max(T::ZERO); // NaN too
        let reach = tolerance.max(self.rounding);
        if wanted - total > reach {
            return Ok(Solution {
                input: self.top(state),
                status: Status::High,
            });
        }
        if -wanted > reach {
            return Ok(Solution {
                input: plane.bottom(),
                status: Status::Low,
            });
        }
        // Tolerances count from the target itself, not from the end of the range that is nearest to it.
        let nearest = wanted.clamp(T::ZERO, total);
        let now = state.branch_position().y;
        let edge =
            heading.and_then(|heading| self.edge(state, heading, wanted, (tolerance, reach)));
        if let Some(edge) = edge {
            return Ok(Solution {
                input: edge,
                status: Status::Ok,
            });
        }
        let goes_back = (wanted > now) != state.is_rising();
        if within(nearest, now, self.rounding) || goes_back && within(wanted, now, tolerance) {
            return Ok(Solution {
                input: self.stay(state),
                status: Status::Ok,
            });
        }
        let goal = Goal::Reach(nearest, self.rounding);
        let Landing { input, output } = match nearest > now {
            true => self.rising(state, goal),
            false => self.falling(state, goal),
        };
        let status = match self.model.operator() {
            Operator::Relay if !within(output, wanted, reach + self.rounding) => Status::Passed,
            _ => Status::Ok,
        };
        Ok(Solution { input, status })
    }

    /// The input that switches every operator on. For a relay that fell to `T_max` this is no longer `T_max`.
    fn top<S>(&self, state: &State<T, S>) -> T
    where
        S: Memory<Turn<T>>,
    {
        let plane = self.model.plane();
        match self.model.operator() {
            Operator::Relay => {
                relay::up_to(plane, (state.input(), state.position()), plane.levels())
            }
            _ => plane.max(),
        }
    }

    /// The present input. Beyond the plane only a relay can tell the nearest end from where the input
    /// stands, because on the way back it switches at that end.
    fn stay<S>(&self, state: &State<T, S>) -> T
    where
        S: Memory<Turn<T>>,
    {
        let plane = self.model.plane();
        match self.model.operator() {
            Operator::Relay => state.input(),
            _ => state.input().clamp(plane.bottom(), plane.max()),
        }
    }

    /// The edge of the dead band towards `heading`, if `wanted` rests there: it is near the output at
    /// which the branch of that direction began, and the output has not moved away from there.
    fn edge<S>(
        &self,
        state: &State<T, S>,
        heading: Direction,
        wanted: T,
        (tolerance, reach): (T, T),
    ) -> Option<T>
    where
        S: Memory<Turn<T>>,
    {
        let now = state.branch_position().y;
        let rest = match state.turns().last() {
            Some(began) if state.is_rising() == (heading == Direction::Rising) => began.y,
            _ => now,
        };
        if !within(wanted, rest, reach) {
            return None;
        }
        // No further than `tolerance` beyond the target, nor beyond the output that it rests at.
        match heading {
            Direction::Rising if now - wanted <= reach => {
                let last = wanted.min(rest) + tolerance;
                Some(self.rising(state, Goal::Leave(last, self.rounding)).input)
            }
            Direction::Falling if wanted - now <= reach => {
                let last = wanted.max(rest) - tolerance;
                Some(self.falling(state, Goal::Leave(last, self.rounding)).input)
            }
            _ => None,
        }
    }

    /// The first input on the way up that meets `goal`.
    fn rising<S>(&self, state: &State<T, S>, goal: Goal<T>) -> Landing<T>
    where
        S: Memory<Turn<T>>,
    {
        let plane = self.model.plane();
        let branch = Branch::find(state, 0, |maximum| goal.met_rising(maximum));
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

    /// The first input on the way down that meets `goal`.
    fn falling<S>(&self, state: &State<T, S>, goal: Goal<T>) -> Landing<T>
    where
        S: Memory<Turn<T>>,
    {
        let plane = self.model.plane();
        let branch = Branch::find(state, 1, |minimum| goal.met_falling(minimum));
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

    fn everett(&self, max: T, min: T) -> T {
        let levels = self.model.plane().levels();
        let grid = Grid {
            table: self.model.table(),
            levels,
        };
        grid.everett(Split::of(max, levels), Split::of(min, levels))
    }

    /// The first `x` from `start` up at which `e(x, min)` meets `goal`: along column `q` of the table.
    fn climb(&self, min: T, start: T, goal: Goal<T>) -> T {
        let levels = self.model.plane().levels();
        let table = self.model.table();
        let Split { cell: q, part: v } = Split::of(min, levels);
        let at = |p: usize| {
            let n = table_index(p, q);
            if p > q {
                table[n] + v * (table[n + 1] - table[n])
            } else {
                T::ZERO
            }
        };
        // Grid lines beyond `start`: first one that meets the goal, the crossing is in the cell before it.
        let first = Split::of(start, levels).cell + 1;
        let Some(row) = first_true(first, levels, |p| goal.met_rising(at(p))) else {
            return T::from_index(levels);
        };
        let p = row - 1;
        let (near, below) = (table_index(p, q), table_index(p + 1, q));
        // The two pieces, u ≤ v and u ≥ v, meet where the diagonal of the cell is crossed.
        let knot = if p > q {
            table[near] + v * (table[below + 1] - table[near])
        } else {
            T::ZERO
        };
        let u = if goal.met_rising(knot) {
            // On the diagonal cell this piece is zero and never holds the crossing.
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

    /// The first `x` from `start` down at which `e(max, x)` meets `goal`: along rows `p`, `p + 1`.
    fn descend(&self, max: T, start: T, goal: Goal<T>) -> T {
        let levels = self.model.plane().levels();
        let table = self.model.table();
        let Split { cell: p, part: u } = Split::of(max, levels);
        let at = |q: usize| {
            let (near, below) = (table[table_index(p, q)], table[table_index(p + 1, q)]);
            near + u * (below - near)
        };
        let last = Split::of(start, levels).cell;
        // Columns from `last` down to 0: the first whose grid line meets the goal.
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
            // From v = 1, where the cell is entered, back to the diagonal.
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
