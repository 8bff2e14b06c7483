//! The exact inverse: the input that gives a wanted output, in `O(log K)` (equations 6 to 14).
//!
//! With weights that are not negative, the output is monotone along a branch. Three searches
//! follow:
//!
//! 1. The outputs stored at the turning points tell which of the nested branches has the target.
//! 2. A search over one row or column of the Everett table, from the present cell on, finds the grid
//!    cell.
//! 3. Inside the cell the output is piecewise linear, with two pieces.
//!
//! The result is the first crossing of the target. It equals the minimum (10) and the maximum (13)
//! over candidates in the chapter.

mod crossing;

use crate::branch::Turn;
use crate::error::Error;
use crate::memory::Memory;
use crate::model::Model;
use crate::operator::Operator;
use crate::relay;
use crate::scalar::Real;
use crate::search::{Goal, Landing, within};
use crate::solution::{Solution, Status};
use crate::state::State;
use crate::target::{Direction, Target};

/// The inverse of a model whose weights are not negative ([`Model::inverse`]).
#[derive(Debug, Clone, Copy)]
pub struct Inverse<'m, T, C> {
    pub(crate) model: &'m Model<T, C>,
    /// Outputs closer than this are equal: the rounding error of a table entry.
    rounding: T,
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
    /// Outputs `Σ μ γ` closer than this are taken as equal: the rounding error of a table entry,
    /// `4 ε Σ μ` with the number type's `ε`. In the output's unit.
    #[must_use]
    pub fn rounding(&self) -> T {
        self.rounding
    }

    /// Finds the input for `target` and moves `state` there.
    ///
    /// Where the output is constant over a range of inputs, the result is the first input that
    /// reaches the target. A relay model moves in jumps: the result is the input of the first jump
    /// that reaches or passes the target, and [`Status::Passed`] marks a target that is passed.
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
        // From the sum of the operators' outputs to `Σ μ γ`. Operators of ±1 span twice as much.
        let (wanted, unit) = match self.model.operator() {
            Operator::Mkp => (target, T::ONE),
            Operator::Kp | Operator::Relay => (T::HALF * target + T::HALF * total, T::HALF),
        };
        let tolerance = unit * tolerance.max(T::ZERO); // zero for NaN
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
        // Tolerances count from the target itself, not from the nearest end of the range.
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

    /// The input that switches every operator on. For relays that fell to `T_max` it lies above
    /// `T_max`.
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

    /// The present input.
    ///
    /// An input beyond the plane is given as the nearest end. Relays are the exception: on the way
    /// back a relay switches at that end, so that the end and the present input act differently.
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

    /// The edge of the dead band towards `heading`, if `wanted` rests in that dead band.
    ///
    /// It does where it is near the output at which the branch of that direction began and the
    /// output has not moved away from it.
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
        // No more than `tolerance` beyond the target and beyond the output that it rests at.
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
}
