//! The inverse of a model: the input for a wanted output, for one target or a series of them.

use crate::error::Result;
use crate::model::policy::Policy;
use crate::model::{Model, OperatorState, Operators, Sign, State};
use crate::series::headings;
use hysteron_core::{Direction, Solution, Target};

impl Model {
    /// The inverse of a plain model.
    ///
    /// # Errors
    /// As [`Model::plain`]; [`Error::Core`](crate::Error::Core) for negative weights, which names
    /// the first of them.
    pub fn inverse(&self) -> Result<Inverse<'_>> {
        self.plain()?.inverse()
    }
}

impl Operators {
    /// The inverse of these operators.
    ///
    /// # Errors
    /// [`Error::Core`](crate::Error::Core) for negative weights, which names the first of them.
    pub fn inverse(&self) -> Result<Inverse<'_>> {
        Ok(Inverse {
            operators: self,
            core: self.core.inverse()?,
        })
    }
}

impl Sign {
    /// The target for the core. `output` is the target's output without offset and sign.
    pub(crate) fn inward(self, target: Target<f64>, output: f64) -> Target<f64> {
        let heading = match (self, target.heading) {
            (Sign::Negative, Some(Direction::Rising)) => Some(Direction::Falling),
            (Sign::Negative, Some(Direction::Falling)) => Some(Direction::Rising),
            (_, heading) => heading,
        };
        Target {
            output,
            heading,
            tolerance: target.tolerance,
        }
    }

    /// The solution of the core, with the status for the signed output.
    pub(crate) fn outward(self, solution: Solution<f64>) -> Solution<f64> {
        let status = match self {
            Sign::Positive => solution.status,
            Sign::Negative => solution.status.mirrored(),
        };
        Solution { status, ..solution }
    }
}

/// The inverse of a [`Model`]: the input that gives a wanted output, in the units of the model.
#[derive(Debug, Clone)]
pub struct Inverse<'m> {
    operators: &'m Operators,
    core: hysteron_core::Inverse<'m, f64, Vec<f64>>,
}

impl Inverse<'_> {
    /// Finds the input for `target` and moves `state` there. `O(log K)`.
    ///
    /// Status and heading refer to the target as given. So with a negative sign,
    /// [`Low`](crate::Status::Low) means that the input would have to be above the plane.
    ///
    /// # Errors
    /// [`Error::Core`](crate::Error::Core) for a target that is not finite or a state of another
    /// model; then the state is unchanged.
    pub fn step(&self, state: &mut State, target: Target<f64>) -> Result<Solution<f64>> {
        self.step_operators(&mut state.operators, target)
    }

    /// As [`Inverse::step`], for the state of the operators alone.
    ///
    /// # Errors
    /// As [`Inverse::step`].
    pub fn step_operators(
        &self,
        state: &mut OperatorState,
        target: Target<f64>,
    ) -> Result<Solution<f64>> {
        let sign = self.operators.sign();
        let raw = sign.factor() * (target.output - self.operators.offset());
        let solution = self.core.step(state, sign.inward(target, raw))?;
        Ok(sign.outward(solution))
    }

    /// Finds the inputs for a whole series of targets, and moves `state` through them. Reversals of
    /// the target up to `tolerance` (in the output's unit) are not followed.
    ///
    /// # Errors
    /// [`Error::Core`](crate::Error::Core) with the index of a target that is not finite, or for a
    /// state of another model; then the state is unchanged.
    ///
    /// ```
    /// use hysteron::{Model, Operator, Plane, Policy, Sign};
    /// let plane = Plane::new(20.0, 80.0, 3)?;
    /// let model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
    /// let wanted = [0.0, 2.0, 5.0, 3.0];
    /// let solutions = model.inverse()?.series(&mut model.start(), &wanted, Policy::Hold, 0.0)?;
    /// let inputs: Vec<f64> = solutions.iter().map(|solution| solution.input).collect();
    /// let reached = model.simulate(&inputs)?;
    /// assert!(wanted.iter().zip(&reached).all(|(y, found)| (y - found).abs() < 1e-12));
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    pub fn series(
        &self,
        state: &mut State,
        targets: &[f64],
        policy: Policy,
        tolerance: f64,
    ) -> Result<Vec<Solution<f64>>> {
        let headings = match policy {
            Policy::Hold => Vec::new(),
            Policy::Anticipate => headings(targets, tolerance),
        };
        self.headed(state, targets, &headings, tolerance)
    }

    /// As [`Inverse::series`], with the direction that each target takes next. A target without one
    /// (`None`, or beyond the end of `headings`) is held.
    ///
    /// # Errors
    /// As [`Inverse::series`].
    ///
    /// ```
    /// use hysteron::{Model, Operator, Plane, Policy, Sign, headings};
    /// let plane = Plane::new(20.0, 80.0, 3)?;
    /// let model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
    /// let (inverse, wanted) = (model.inverse()?, [0.0, 5.0, 5.0, 3.0]);
    /// let told = inverse.headed(&mut model.start(), &wanted, &headings(&wanted, 0.0), 0.0)?;
    /// let found = inverse.series(&mut model.start(), &wanted, Policy::Anticipate, 0.0)?;
    /// assert_eq!(told, found);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    pub fn headed(
        &self,
        state: &mut State,
        targets: &[f64],
        headings: &[Option<Direction>],
        tolerance: f64,
    ) -> Result<Vec<Solution<f64>>> {
        let headings = headings.iter().copied().chain(std::iter::repeat(None));
        let wanted = targets
            .iter()
            .zip(headings)
            .map(|(&output, heading)| Target {
                output,
                heading,
                tolerance,
            });
        self.through(state, &wanted.collect::<Vec<_>>())
    }

    /// As [`Inverse::series`], with a heading and a tolerance for each target.
    ///
    /// # Errors
    /// As [`Inverse::series`].
    pub fn through(
        &self,
        state: &mut State,
        targets: &[Target<f64>],
    ) -> Result<Vec<Solution<f64>>> {
        let finite = |target: &Target<f64>| (target.output - self.operators.offset()).is_finite();
        if let Some(index) = targets.iter().position(|target| !finite(target)) {
            return Err(hysteron_core::Error::InputNotFinite { index }.into());
        }
        targets
            .iter()
            .map(|&target| self.step(state, target))
            .collect()
    }
}
