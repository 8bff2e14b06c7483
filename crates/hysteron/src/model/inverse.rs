//! The inverse of a model in its own units: of one target, and of a series of them.

use crate::error::{Error, Result};
use crate::model::policy::Invert;
use crate::model::{Model, Sign, State};
use crate::remedy::{Remedy, Setting};
use hysteron_core::{Direction, Policy, Solution};

impl Model {
    /// The inverse of this model.
    ///
    /// # Errors
    /// [`Error::Core`] naming the first weights below zero, if there are any; [`Error::Thermal`] for a model with a thermal body.
    pub fn inverse(&self) -> Result<Inverse<'_>> {
        if self.thermal.is_some() {
            return Err(crate::model::body::no_inverse());
        }
        if let Some(load) = &self.load {
            let (low, high) = load.range();
            let what = format!(
                "the model depends on the load `{}`, from {low} to {high}, and an inverse is that of one load",
                load.quantity.name
            );
            let remedy = Remedy::new("take it at one load ({})", [Setting::any("load")]);
            return Err(Error::Fit(what).remedied(remedy));
        }
        Ok(Inverse {
            model: self,
            core: self.core.inverse()?,
        })
    }
}

impl Sign {
    /// A policy for the output without sign.
    pub(crate) fn inward(self, policy: Policy<f64>) -> Policy<f64> {
        match policy {
            Policy::Anticipate { heading, tolerance } if self == Sign::Negative => {
                let heading = match heading {
                    Direction::Rising => Direction::Falling,
                    Direction::Falling => Direction::Rising,
                };
                Policy::Anticipate { heading, tolerance }
            }
            other => other,
        }
    }

    /// The status for the output with its sign.
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
    model: &'m Model,
    core: hysteron_core::Inverse<'m, f64, Vec<f64>>,
}

impl Inverse<'_> {
    /// Finds the input for `target` and moves `state` there. `O(log K)`.
    ///
    /// Status and heading speak of the target as given: with a negative sign, [`Low`](crate::Status::Low) needs an
    /// input above the plane.
    ///
    /// # Errors
    /// [`Error::Core`] for a target that is not finite or a state of another model; the state is then as it was.
    pub fn step(
        &self,
        state: &mut State,
        target: f64,
        policy: Policy<f64>,
    ) -> Result<Solution<f64>> {
        let sign = self.model.sign();
        let raw = sign.factor() * (target - self.model.offset());
        let solution = self.core.step(state, raw, sign.inward(policy))?;
        Ok(sign.outward(solution))
    }

    /// Finds the inputs for a series of targets, one solution for each, and moves `state` through them.
    ///
    /// # Errors
    /// [`Error::Core`] with the place of a target that is not finite, or for a state of another model; the state is then as it was.
    ///
    /// ```
    /// use hysteron::{Invert, Model, Operator, Plane, Sign};
    /// let plane = Plane::new(20.0, 80.0, 3)?;
    /// let model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
    /// let wanted = [0.0, 2.0, 5.0, 3.0];
    /// let solutions = model.inverse()?.series(&mut model.start(), &wanted, Invert::Hold { band: 0.0 })?;
    /// let inputs: Vec<f64> = solutions.iter().map(|solution| solution.input).collect();
    /// let reached = model.simulate(&inputs)?;
    /// assert!(wanted.iter().zip(&reached).all(|(y, found)| (y - found).abs() < 1e-12));
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    pub fn series(
        &self,
        state: &mut State,
        targets: &[f64],
        how: Invert,
    ) -> Result<Vec<Solution<f64>>> {
        self.through(state, targets, how.policies(targets))
    }

    /// As [`Inverse::series`], told at each target where it goes next; it rests where that is `None` or `headings` is shorter.
    /// Reversals of the target up to `band` are not followed.
    ///
    /// # Errors
    /// As [`Inverse::series`].
    ///
    /// ```
    /// use hysteron::{Invert, Model, Operator, Plane, Sign, headings};
    /// let plane = Plane::new(20.0, 80.0, 3)?;
    /// let model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
    /// let (inverse, wanted) = (model.inverse()?, [0.0, 5.0, 5.0, 3.0]);
    /// let told = inverse.headed(&mut model.start(), &wanted, &headings(&wanted, 0.0), 0.0)?;
    /// let found = inverse.series(&mut model.start(), &wanted, Invert::Anticipate { band: 0.0, rows: 4 })?;
    /// assert_eq!(told, found);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    pub fn headed(
        &self,
        state: &mut State,
        targets: &[f64],
        headings: &[Option<Direction>],
        band: f64,
    ) -> Result<Vec<Solution<f64>>> {
        let told = headings.iter().copied().chain(std::iter::repeat(None));
        let policies = told.map(|heading| match heading {
            Some(heading) => Policy::Anticipate {
                heading,
                tolerance: band,
            },
            None => Policy::Hold { tolerance: band },
        });
        self.through(state, targets, policies)
    }

    /// As [`Inverse::series`], with a policy for each target.
    ///
    /// # Errors
    /// As [`Inverse::series`].
    pub fn through(
        &self,
        state: &mut State,
        targets: &[f64],
        policies: impl IntoIterator<Item = Policy<f64>>,
    ) -> Result<Vec<Solution<f64>>> {
        let finite = |target: &f64| (target - self.model.offset()).is_finite();
        if let Some(index) = targets.iter().position(|target| !finite(target)) {
            return Err(hysteron_core::Error::InputNotFinite { index }.into());
        }
        let steps = targets.iter().zip(policies);
        steps
            .map(|(&target, policy)| self.step(state, target, policy))
            .collect()
    }
}
