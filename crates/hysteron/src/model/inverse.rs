//! The inverse of a model: the input for a wanted output, for one target or a series of them.

use crate::error::{Error, Result};
use crate::model::policy::Policy;
use crate::model::{Model, Operators, Sample, Sign, State, Surroundings};
use hysteron_core::{Direction, Solution, Target};

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

/// No limit.
const EVERYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// What is wanted of a model in one sample. A [`Target`] converts to one, with the model's own range
/// of drives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// The output, its heading and its tolerance.
    pub target: Target<f64>,
    /// Time since the sample before, s; needed by a model that depends on time.
    pub dt: Option<f64>,
    /// The load; needed by a model that depends on one.
    pub load: Option<f64>,
    /// The range in which the temperature has to stay, for example because of what comes next; the
    /// input itself for a model without a thermal body.
    pub temperature: (f64, f64),
}

impl From<Target<f64>> for Wanted {
    fn from(target: Target<f64>) -> Self {
        Self {
            target,
            dt: None,
            load: None,
            temperature: EVERYWHERE,
        }
    }
}

impl Wanted {
    /// What a sample wants whose input is the target.
    pub(crate) fn new(sample: Sample, heading: Option<Direction>, tolerance: f64) -> Self {
        let Sample {
            input: output,
            dt,
            load,
        } = sample;
        let target = Target {
            output,
            heading,
            tolerance,
        };
        Self {
            dt,
            load,
            ..target.into()
        }
    }
}

/// The inverse of a [`Model`]: the input that gives a wanted output, in the units of the model. For
/// a model with a thermal body it is the drive.
#[derive(Debug, Clone)]
pub struct Inverse<'m> {
    pub(super) model: &'m Model,
    core: hysteron_core::Inverse<'m, f64, Vec<f64>>,
    pub(super) drive: (f64, f64),
    horizon: f64,
}

impl Model {
    /// The inverse of this model.
    ///
    /// # Errors
    /// [`Error::Core`](crate::Error::Core) for negative weights, which names the first of them.
    pub fn inverse(&self) -> Result<Inverse<'_>> {
        let core = self.operators().core.inverse()?;
        if self.load.as_ref().is_some_and(|load| load.is_negative()) {
            let what =
                "the inverse needs weights that are not negative, but some are at some loads";
            return Err(Error::Fit(what.into()));
        }
        Ok(Inverse {
            model: self,
            core,
            drive: self.drive_range(),
            horizon: 0.0,
        })
    }
}

impl Operators {
    /// The inverse of these operators in the core, without offset and sign.
    ///
    /// # Errors
    /// [`Error::Core`](crate::Error::Core) for negative weights, which names the first of them.
    pub fn core_inverse(&self) -> Result<hysteron_core::Inverse<'_, f64, Vec<f64>>> {
        Ok(self.core.inverse()?)
    }
}

impl Inverse<'_> {
    /// The same inverse with another range of drives: of inputs, for a model without a thermal
    /// body. A target that needs more has the status [`Limited`](crate::Status::Limited).
    ///
    /// # Errors
    /// [`Error::Fit`] for ends that are not numbers or not in order.
    pub fn drive_range(mut self, min: f64, max: f64) -> Result<Self> {
        // False for NaN.
        let in_order = min <= max;
        if !in_order {
            let what = format!("the range of the drive, {min} to {max}, must be in order");
            return Err(Error::Fit(what));
        }
        self.drive = (min, max);
        Ok(self)
    }

    /// The same inverse, which reaches a temperature in this many seconds instead of one sample.
    /// Noise of the target then does not send the drive from one end to the other, and the output
    /// follows late.
    ///
    /// # Errors
    /// [`Error::Fit`] for a horizon that is negative or not finite.
    pub fn horizon(mut self, seconds: f64) -> Result<Self> {
        if !(seconds >= 0.0 && seconds.is_finite()) {
            let what = format!("the horizon of {seconds} s must be a finite number from 0 on");
            return Err(Error::Fit(what));
        }
        self.horizon = seconds;
        Ok(self)
    }

    /// Finds the input for what is wanted and moves `state` there. `O(log K)`; a load that changed
    /// since the sample before takes `O(K²)`.
    ///
    /// With a thermal body the input is the drive to hold since the sample before, within its
    /// range. The state goes where the drive takes it, also where that does not give the target.
    ///
    /// Status and heading refer to the target as given. So with a negative sign,
    /// [`Low`](crate::Status::Low) means that the input would have to be above the plane.
    ///
    /// # Errors
    /// As [`Model::step`], for the target in place of the input; then the state is unchanged.
    pub fn step(&self, state: &mut State, wanted: impl Into<Wanted>) -> Result<Solution<f64>> {
        let wanted = wanted.into();
        let model = self.model;
        if self.is_plain(&wanted) {
            let solution = self.step_operators(state, wanted.target)?;
            state.forget_stages();
            return Ok(solution);
        }
        let worded = |error| model.worded(error);
        let mut stages = model.stages();
        let sample = Sample {
            input: wanted.target.output,
            dt: wanted.dt,
            load: wanted.load,
        };
        stages.accepts(&state.stages, sample).map_err(worded)?;
        let wanted = hysteron_core::Wanted {
            target: wanted.target,
            dt: wanted.dt,
            load: wanted.load,
            drive: self.drive,
            horizon: self.horizon,
            temperature: wanted.temperature,
        };
        let Some(mixed) = state.place(model, wanted.load)? else {
            let State {
                operators,
                stages: memory,
                ..
            } = state;
            return stages
                .invert(&self.core, operators, memory, wanted)
                .map_err(worded);
        };
        stages.offset = mixed.offset;
        let State {
            operators,
            stages: memory,
            ..
        } = state;
        let solution = match mixed.core.inverse() {
            Ok(inverse) => stages.invert(&inverse, operators, memory, wanted),
            Err(error) => Err(error),
        };
        state.mixed = Some(mixed);
        solution.map_err(worded)
    }

    /// As [`Inverse::step`], where the operators alone give the input. What stages remember is left
    /// to the caller.
    #[inline]
    fn step_operators(&self, state: &mut State, target: Target<f64>) -> Result<Solution<f64>> {
        let sign = self.model.sign();
        let raw = sign.factor() * (target.output - self.model.offset());
        let solution = self
            .core
            .step(&mut state.operators, sign.inward(target, raw))?;
        Ok(sign.outward(solution))
    }

    /// The outputs with every operator off and with every operator on, at a load.
    pub(crate) fn output_range(&self, load: Option<f64>) -> Result<(f64, f64)> {
        match load.filter(|_| self.model.load.is_some()) {
            Some(load) => self.model.output_range_at(load),
            None => Ok(self.model.output_range()),
        }
    }

    /// Whether the operators alone give the input: there is no stage and no limit.
    fn is_plain(&self, wanted: &Wanted) -> bool {
        self.has_operators_alone() && wanted.load.is_none() && wanted.temperature == EVERYWHERE
    }

    /// Whether there is no stage, and no limit of the drive.
    fn has_operators_alone(&self) -> bool {
        self.model.is_plain() && self.drive == EVERYWHERE
    }

    /// Finds the inputs for a whole series of targets, and moves `state` through them. Reversals of
    /// the target up to `tolerance` (in the output's unit) are not followed. For models that need
    /// neither time nor load.
    ///
    /// # Errors
    /// As [`Inverse::step`], with the index of a target that is not finite; then the state is
    /// unchanged.
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
        self.headed(
            state,
            targets,
            &policy.headings(targets, tolerance),
            tolerance,
        )
    }

    /// As [`Inverse::series`], for any model.
    ///
    /// # Errors
    /// As [`Inverse::series`] and [`Model::run_in`].
    pub fn series_in(
        &self,
        state: &mut State,
        targets: &[f64],
        policy: Policy,
        tolerance: f64,
        surroundings: Surroundings<'_>,
    ) -> Result<Vec<Solution<f64>>> {
        let headings = policy.headings(targets, tolerance);
        self.headed_in(state, targets, &headings, tolerance, surroundings)
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
        self.headed_in(state, targets, headings, tolerance, Surroundings::default())
    }

    /// As [`Inverse::headed`], for any model.
    ///
    /// # Errors
    /// As [`Inverse::series_in`].
    pub fn headed_in(
        &self,
        state: &mut State,
        targets: &[f64],
        headings: &[Option<Direction>],
        tolerance: f64,
        surroundings: Surroundings<'_>,
    ) -> Result<Vec<Solution<f64>>> {
        let mut found = Vec::with_capacity(targets.len());
        let push = |solution| found.push(solution);
        self.each_headed(state, targets, headings, tolerance, surroundings, push)?;
        Ok(found)
    }

    /// As [`Inverse::headed_in`], without memory for the solutions: `take` gets one after the other.
    pub(crate) fn each_headed(
        &self,
        state: &mut State,
        targets: &[f64],
        headings: &[Option<Direction>],
        tolerance: f64,
        surroundings: Surroundings<'_>,
        mut take: impl FnMut(Solution<f64>),
    ) -> Result<()> {
        self.check_targets(targets.iter().copied())?;
        let headings = headings.iter().copied().chain(std::iter::repeat(None));
        let samples = surroundings.samples(self.model, targets)?.zip(headings);
        if targets.is_empty() {
            return Ok(());
        }
        self.model.rest_at(state, surroundings)?;
        if surroundings.load.is_none() && self.has_operators_alone() {
            for ((_, sample), heading) in samples {
                let target = Target {
                    output: sample.input,
                    heading,
                    tolerance,
                };
                take(self.step_operators(state, target)?);
            }
            state.forget_stages();
            return Ok(());
        }
        for ((_, sample), heading) in samples {
            take(self.step(state, Wanted::new(sample, heading, tolerance))?);
        }
        Ok(())
    }

    /// As [`Inverse::series`], with all that is wanted of each sample.
    ///
    /// # Errors
    /// As [`Inverse::series`]. An error of time or load comes when its sample is reached.
    pub fn through(
        &self,
        state: &mut State,
        wanted: &[impl Into<Wanted> + Copy],
    ) -> Result<Vec<Solution<f64>>> {
        let wanted = || wanted.iter().map(|&wanted| wanted.into());
        self.check_targets(wanted().map(|wanted: Wanted| wanted.target.output))?;
        wanted().map(|wanted| self.step(state, wanted)).collect()
    }

    fn check_targets(&self, mut targets: impl Iterator<Item = f64>) -> Result<()> {
        let offset = self.model.offset();
        match targets.position(|target| !(target - offset).is_finite()) {
            Some(index) => Err(hysteron_core::Error::InputNotFinite { index }.into()),
            None => Ok(()),
        }
    }
}
