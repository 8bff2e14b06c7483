//! A model that learns while it runs, sample by sample.

use super::basis::DriftBasis;
use super::learner::Learner;
use super::learns::Learns;
use super::mixture::AutoOptions;
use super::refit::{Core, Refit};
use crate::error::{Error, Result};
use crate::model::{Model, OperatorState, Operators, Sample, Sign, State, Wanted};
use crate::progress::Progress;
use crate::progress::SAMPLES_BETWEEN;
use hysteron_core::{Adaptation, Channel, Learning, Solution, StageState, Stages};

/// A [`Model`] whose weights and offset follow the plant, with its state.
///
/// Stages around the operators stay as they are. Those in front, such as a thermal body, give the
/// operators' input. Those behind, such as a lag or an output curve, are undone: the
/// operators learn from the output that they must have given. So noise of a reading behind a lag is
/// larger for the learner, by the time constant over the time step. What the learner adds to the
/// offset stands in front of these stages, too: at rest it passes them, and it shifts the
/// knots of a curve.
///
/// ```
/// use hysteron::{Adaptation, Adaptive, Method, Model, Operator, Plane, Sign};
/// let plane = Plane::new(20.0, 80.0, 5)?;
/// let (mkp, sign) = (Operator::Mkp, Sign::Positive);
/// let model = |weight: f64| Model::new(mkp, plane, vec![weight; 15], 0.0, sign);
/// let (noise, spread, correlation) = (0.01, 1.0, 3.0);
/// let method = Method::LeastSquares { forgetting: 0.99, noise, spread, correlation };
/// let mut adaptive = Adaptive::new(&model(1.0)?, Adaptation { method, ..Adaptation::default() })?;
/// let (plant, mut state) = (model(1.5)?, model(1.5)?.start());
/// for n in 0..1000 {
///     let input = 50.0 - 40.0 * (0.05 * f64::from(n)).cos();
///     adaptive.step(input, plant.step(&mut state, input)?.output)?;
/// }
/// assert!((adaptive.simulate(80.0)? - 15.0 * 1.5).abs() < 0.1);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Adaptive {
    offline: Model,
    core: Core,
    /// State at the measured input.
    state: State,
    /// State of the inverse, at the inputs that it asked for.
    wanted: State,
    /// What the stages behind the operators remember of the measured output; `None` before the
    /// first sample.
    measured: Option<StageState<f64>>,
    /// The sums at the knots of the output curve, at the present offset; empty without one.
    knots: Vec<f64>,
    learner: Learns,
}

impl Adaptive {
    /// A model that does not change, for a place where others learn.
    ///
    /// # Errors
    /// [`Error::Fit`] for a model that depends on a load.
    pub fn fixed(model: &Model) -> Result<Self> {
        Self::over(model, Learns::nothing(model)?)
    }

    /// Adapts all weights of `model` and its offset. It starts with all operators off.
    ///
    /// # Errors
    /// [`Error::Core`] for options out of range and for negative weights; [`Error::Fit`] for a model
    /// that depends on a load, and for one with so many levels that the method needs more than
    /// 4 GiB.
    pub fn new(model: &Model, options: Adaptation<f64>) -> Result<Self> {
        Self::over(model, Learns::weights_of(model, options)?)
    }

    /// Fits all weights of `model` and its offset again and again to the last samples. It starts
    /// with all operators off.
    ///
    /// A sample takes constant time, but the one with a refit takes `O(K⁶)`. docs/learners.md has
    /// the times: a loop must have that time to spare.
    ///
    /// ```
    /// use hysteron::{Adaptive, Model, Operator, Plane, Refit, Sign, Window};
    /// let plane = Plane::new(20.0, 80.0, 5)?;
    /// let (mkp, sign) = (Operator::Mkp, Sign::Positive);
    /// let model = |weight: f64| Model::new(mkp, plane, vec![weight; 15], 0.0, sign);
    /// let options = Refit { window: Window::Samples(200), ..Refit::default() };
    /// let mut adaptive = Adaptive::refitting(&model(1.0)?, options)?;
    /// let (plant, mut state) = (model(1.5)?, model(1.5)?.start());
    /// for n in 0..1000 {
    ///     let input = 50.0 - 40.0 * (0.05 * f64::from(n)).cos();
    ///     adaptive.step(input, plant.step(&mut state, input)?.output)?;
    /// }
    /// assert!((adaptive.simulate(80.0)? - 15.0 * 1.5).abs() < 0.01);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Adaptive::new`].
    pub fn refitting(model: &Model, options: Refit) -> Result<Self> {
        Self::over(model, Learns::refits(model, options)?)
    }

    /// Adapts the coefficients of `basis` (each member `N` weights) and the offset.
    /// `coefficients` are those of `model`. If it is known in which ways the weights can
    /// change, this needs far fewer unknowns than adapting all weights.
    ///
    /// # Errors
    /// As [`Adaptive::new`].
    pub fn of_basis(
        model: &Model,
        basis: Vec<Vec<f64>>,
        coefficients: &[f64],
        options: Adaptation<f64>,
    ) -> Result<Self> {
        let learns = Learns::coefficients(model, basis, coefficients, options)?;
        Self::over(model, learns)
    }

    /// Several learners of one model side by side: the model as it is, the coefficients of `drift`,
    /// all weights by increments, by least squares and by refits, and the trend of the refits.
    /// Their mean is the model, each weighted by how well it has predicted lately; see
    /// [`Learner::Auto`].
    ///
    /// # Errors
    /// As [`Adaptive::new`].
    pub fn mixing(drift: DriftBasis, options: AutoOptions) -> Result<Self> {
        let DriftBasis {
            model,
            basis,
            coefficients,
        } = drift;
        let coefficients = Learns::coefficients(&model, basis, &coefficients, options.drift)?;
        let increments = Learns::weights_of(&model, options.increments)?;
        let mut learners = vec![
            (Learner::Drift.name(), coefficients),
            (Learner::Increments.name(), increments),
        ];
        if let Some(squares) = options.least_squares {
            let squares = Learns::weights_of(&model, squares)?;
            learners.push((Learner::LeastSquares.name(), squares));
        }
        if let Some(refit) = options.refit {
            learners.push((Learner::Refit.name(), Learns::refits(&model, refit)?));
        }
        Self::over(&model, Learns::mixture(&model, learners)?)
    }

    fn over(model: &Model, (core, learner): (Core, Learns)) -> Result<Self> {
        let mut state = model.off();
        core.rebase(&mut state.operators)?;
        Ok(Self {
            offline: model.clone(),
            core,
            wanted: state.clone(),
            state,
            measured: None,
            knots: model.stages().behind.curve.sums.to_vec(),
            learner,
        })
    }

    /// Moves to a sample, returns the output expected there, and learns from the output `measured`.
    /// A plain number is a sample with that input; a model with a stage that depends on time needs
    /// the time since the sample before.
    ///
    /// ```
    /// use hysteron::{Adaptive, Model, Operator, Plane, Refit, Sample, Sign};
    /// let plane = Plane::new(20.0, 80.0, 5)?;
    /// let model = |weight: f64| {
    ///     let model = Model::new(Operator::Mkp, plane, vec![weight; 15], 0.0, Sign::Positive)?;
    ///     model.with_after(&[], 0.2)
    /// };
    /// let mut adaptive = Adaptive::refitting(&model(1.0)?, Refit::default())?;
    /// let (plant, mut state) = (model(1.5)?, model(1.5)?.start());
    /// let mut error = f64::MAX;
    /// for n in 0..1000 {
    ///     let input = 50.0 - 40.0 * (0.05 * f64::from(n)).cos();
    ///     let sample = Sample { dt: Some(0.1), ..input.into() };
    ///     error = adaptive.step(sample, plant.step(&mut state, sample)?.output)?.error;
    /// }
    /// assert!(error.abs() < 0.01);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Model::step`]; [`Error::Core`] for a measured output that is not finite;
    /// [`Error::Thermal`] where time stands still and the model has a lag. Then nothing is changed.
    pub fn step(&mut self, sample: impl Into<Sample>, measured: f64) -> Result<Learning<f64>> {
        let sample = self.accepted(sample.into())?;
        if self.offline.is_plain() {
            return self.learn(sample.input, measured);
        }
        if !measured.is_finite() {
            return Err(hysteron_core::Error::InputNotFinite { index: 1 }.into());
        }
        let (mut there, stages) = (self.state.clone(), self.stages());
        let expected = stages.step(&self.core, &mut there.operators, &mut there.stages, sample);
        let expected = expected.map_err(|error| self.offline.worded(error))?;
        let dt = sample.dt.unwrap_or(0.0);
        let offline = self.offline.stages();
        let (seen, after) = offline.undo_after(self.measured, dt, measured);
        if !seen.is_finite() {
            let what = "time stands still, which a model with a lag cannot have while it learns";
            return Err(Error::Thermal(what.into()));
        }
        // Of a mixture: the stages before it learns, and what its model says in front of them.
        let mixes = matches!(self.learner, Learns::Mixture(_));
        let before = mixes.then(|| {
            let (factor, sum) = (self.sign().factor(), self.core.output(&there.operators));
            let offset = self.stages().offset;
            let said = (factor * (sum + self.level()), offset + factor * sum);
            (offset, self.knots.clone(), said)
        });
        let learning = self.learn(there.operators.input(), seen)?;
        // A mixture expects something else of this sample than its model says.
        let output = match before {
            Some((offset, knots, (model, ahead))) if learning.output != model => {
                let past = Some(self.state.stages).filter(StageState::is_started);
                let mut stages = self.stages();
                stages.offset = offset;
                if !knots.is_empty() {
                    stages.behind.curve.sums = &knots;
                }
                stages.after(past, dt, ahead + (learning.output - model)).0
            }
            _ => expected.output,
        };
        (self.state.stages, self.measured) = (there.stages, Some(after));
        Ok(Learning {
            output,
            error: measured - output,
            ..learning
        })
    }

    /// A step of the operators: `measured` is the output in front of the stages behind them.
    fn learn(&mut self, input: f64, measured: f64) -> Result<Learning<f64>> {
        let factor = self.sign().factor();
        let raw = factor * measured;
        let state = &mut self.state.operators;
        let learning = self.learner.step(&mut self.core, state, input, raw)?;
        self.follow();
        Ok(Learning {
            output: factor * learning.output,
            error: factor * learning.error,
            ..learning
        })
    }

    /// A sample that the model takes.
    fn accepted(&self, sample: Sample) -> Result<Sample> {
        match sample.load {
            None => Ok(sample),
            Some(_) => Err(crate::model::no_load()),
        }
    }

    /// The stages, at the present offset.
    fn stages(&self) -> Stages<'_, f64> {
        let mut stages = self.offline.stages();
        match self.knots.is_empty() {
            true => stages.offset += self.sign().factor() * stages.behind.settled(self.moved()),
            false => stages.behind.curve.sums = &self.knots,
        }
        stages
    }

    /// By how much the offset has moved in front of the stages behind the operators, without sign.
    fn moved(&self) -> f64 {
        self.level() - self.sign().factor() * self.offline.offset()
    }

    /// Lets the knots of the output curve follow the offset.
    fn follow(&mut self) {
        let moved = self.moved();
        let own = self.offline.stages().behind.curve.sums;
        for (knot, own) in self.knots.iter_mut().zip(own) {
            *knot = own - moved;
        }
    }

    /// Runs [`Adaptive::step`] through samples, as many as the shorter series has.
    ///
    /// # Errors
    /// [`Error::Core`] for the first number that is not finite; then nothing is changed. The error
    /// that `progress` returns; what was learned until then is kept.
    pub fn run(
        &mut self,
        input: &[f64],
        measured: &[f64],
        progress: Progress<'_>,
    ) -> Result<Vec<Learning<f64>>> {
        let pairs = || input.iter().zip(measured);
        if let Some(index) = pairs().position(|(x, y)| !(x.is_finite() && y.is_finite())) {
            return Err(hysteron_core::Error::InputNotFinite { index }.into());
        }
        let count = input.len().min(measured.len());
        let step = |(n, (x, y)): (usize, (&f64, &f64))| {
            if n % SAMPLES_BETWEEN == 0 {
                progress.tell("adaptation", n as f64 / count as f64)?;
            }
            self.step(*x, *y)
        };
        pairs().enumerate().map(step).collect()
    }

    /// Moves to a sample and returns the output expected there, without learning. Of a mixture it
    /// is that of its model, not what [`Adaptive::step`] expects by the learners' last errors.
    ///
    /// # Errors
    /// As [`Model::step`]; then nothing is changed.
    pub fn simulate(&mut self, sample: impl Into<Sample>) -> Result<f64> {
        let sample = self.accepted(sample.into())?;
        let output = match self.offline.is_plain() {
            true => {
                let sum = self.core.step(&mut self.state.operators, sample.input)?;
                self.sign().factor() * (sum.output + self.level())
            }
            false => {
                let mut there = self.state.clone();
                let State {
                    operators, stages, ..
                } = &mut there;
                let step = self.stages().step(&self.core, operators, stages, sample);
                let output = step.map_err(|error| self.offline.worded(error))?.output;
                self.measured = Some(there.stages);
                self.state = there;
                output
            }
        };
        self.learner.follow(&self.state.operators)?;
        Ok(output)
    }

    /// The output expected at the present input, if no time passes.
    #[must_use]
    pub fn output(&self) -> f64 {
        let (factor, sum) = (
            self.sign().factor(),
            self.core.output(&self.state.operators),
        );
        if self.offline.is_plain() {
            return factor * (sum + self.level());
        }
        let output = self.stages().offset + factor * sum;
        let past = Some(self.state.stages).filter(StageState::is_started);
        self.stages().after(past, 0.0, output).0
    }

    /// Finds the input for what is wanted with the current weights. The inverse moves there from
    /// its own state, because the reference and the plant are at different points.
    ///
    /// # Errors
    /// As [`crate::Inverse::step`]; then nothing is changed.
    pub fn solve(&mut self, wanted: impl Into<Wanted>) -> Result<Solution<f64>> {
        let mut state = self.wanted.clone();
        let solution = self.solve_from(&mut state, wanted.into())?;
        self.wanted = state;
        Ok(solution)
    }

    /// Sets the state of the inverse to that of the measured input. Otherwise, turning points that
    /// the inverse asked for with old weights stay in its memory until they are wiped out. A loop
    /// may call this where its target turns and the model expects what is measured.
    pub fn align(&mut self) {
        self.wanted.clone_from(&self.state);
    }

    /// As [`Adaptive::solve_from`]. The targets `after` this one are known, for a model with a
    /// thermal body.
    ///
    /// # Errors
    /// As [`Adaptive::solve`].
    pub(crate) fn solve_ahead(
        &self,
        state: &mut State,
        wanted: Wanted,
        after: &[Wanted],
    ) -> Result<Solution<f64>> {
        if after.is_empty() {
            return self.solve_from(state, wanted);
        }
        let model = self.model()?;
        model.operators().core.rebase(&mut state.operators)?;
        model.inverse()?.step_ahead(state, wanted, after)
    }

    /// As [`Adaptive::solve`], from a `state` of the caller. It must be a state of this model,
    /// which may have had other weights at that time.
    ///
    /// # Errors
    /// As [`Adaptive::solve`].
    pub(crate) fn solve_from(&self, state: &mut State, wanted: Wanted) -> Result<Solution<f64>> {
        if wanted.load.is_some() {
            return Err(crate::model::no_load());
        }
        let State {
            operators, stages, ..
        } = state;
        self.core.rebase(operators)?;
        let inverse = self.core.inverse()?;
        if self.offline.is_plain() {
            let (sign, target) = (self.sign(), wanted.target);
            let raw = sign.factor() * target.output - self.level();
            let solution = inverse.step(operators, sign.inward(target, raw))?;
            return Ok(sign.outward(solution));
        }
        let wanted = hysteron_core::Wanted {
            target: wanted.target,
            dt: wanted.dt,
            load: None,
            drive: self.offline.drive_range(),
            horizon: 0.0,
            temperature: wanted.temperature,
        };
        let solution = self.stages().invert(&inverse, operators, stages, wanted);
        solution.map_err(|error| self.offline.worded(error))
    }

    /// The learners that a [mixture](Adaptive::mixing) has, each with its share of the model;
    /// otherwise empty.
    #[must_use]
    pub fn shares(&self) -> Vec<(&'static str, f64)> {
        match &self.learner {
            Learns::Mixture(mixture) => mixture.shares(),
            _ => Vec::new(),
        }
    }

    /// The current weights, row by row.
    #[must_use]
    pub fn weights(&self) -> Vec<f64> {
        self.learner.weights()
    }

    /// The current output with every operator off.
    #[must_use]
    pub fn offset(&self) -> f64 {
        let factor = self.sign().factor();
        if self.offline.is_plain() {
            return factor * self.level();
        }
        let stages = self.stages();
        stages.offset + factor * stages.behind.settled(0.0)
    }

    /// The offset without the sign.
    fn level(&self) -> f64 {
        self.learner.level()
    }

    /// The current model, with the stages and the names of the off-line model.
    ///
    /// # Errors
    /// As [`Model::new`].
    pub fn model(&self) -> Result<Model> {
        let (operator, plane) = (self.offline.operator(), *self.offline.plane());
        let offset = self.sign().factor() * self.level();
        let operators = Operators::new(operator, plane, self.weights(), offset, self.sign())?;
        let mut model = self.offline.around_within(operators)?;
        model.fit = None;
        model.with_start(None)
    }

    /// The model before adaptation.
    #[must_use]
    pub fn offline(&self) -> &Model {
        &self.offline
    }

    /// The current state of operators and stages.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Turns every operator off, also in the state of the inverse. The weights are not changed.
    ///
    /// # Errors
    /// None in practice.
    pub fn reset(&mut self) -> Result<()> {
        self.core.reset_off(&mut self.state.operators)?;
        self.begin()
    }

    /// Turns every operator on, as at the top of the plane, also in the state of the inverse. The
    /// weights are not changed.
    ///
    /// # Errors
    /// None in practice.
    pub fn saturate(&mut self) -> Result<()> {
        self.core.reset_on(&mut self.state.operators)?;
        self.begin()
    }

    /// While frozen, [`Adaptive::step`] returns the expected output but does not learn.
    pub fn freeze(&mut self, frozen: bool) {
        self.learner.freeze(frozen);
    }

    /// The channel that stands still while the other one moves: nothing is learned then, and what
    /// was learned since it began to is undone.
    #[must_use]
    pub fn stuck(&self) -> Option<Channel> {
        self.learner.stuck()
    }

    /// Stores the current weights and offset as the last good ones.
    pub fn keep(&mut self) {
        self.learner.keep();
    }

    /// Restores the last good weights and offset: those stored last, or those that have passed a
    /// trial since ([`Adaptation::trial`]).
    ///
    /// # Errors
    /// None in practice.
    pub fn roll_back(&mut self) -> Result<()> {
        self.learner.roll_back(&mut self.core)?;
        self.follow();
        Ok(self.core.rebase(&mut self.state.operators)?)
    }

    /// Refits now, with what has come since the last refit. A learner that learns from sample to
    /// sample has learned all of it. Call it before what was learned is used for long: at the end
    /// of a cycle, or before [`Adaptive::model`].
    ///
    /// # Errors
    /// None in practice.
    pub fn refit(&mut self) -> Result<()> {
        if self.learner.refit(&mut self.core)? {
            self.core.rebase(&mut self.state.operators)?;
            self.follow();
        }
        Ok(())
    }

    /// Begins a recording with the operators so. What was learned stays.
    pub(super) fn start_from(&mut self, operators: OperatorState) -> Result<()> {
        self.state.operators = operators;
        self.core.rebase(&mut self.state.operators)?;
        self.begin()
    }

    /// Others set the state of the operators; the stages are at rest.
    fn begin(&mut self) -> Result<()> {
        (self.state.stages, self.measured) = (StageState::default(), None);
        self.learner.realign(&self.state.operators)?;
        self.align();
        Ok(())
    }

    fn sign(&self) -> Sign {
        self.offline.sign()
    }
}

impl DriftBasis {
    /// An estimator of the coefficients and the offset.
    ///
    /// # Errors
    /// As [`Adaptive::of_basis`].
    pub fn adaptive(self, options: Adaptation<f64>) -> Result<Adaptive> {
        Adaptive::of_basis(&self.model, self.basis, &self.coefficients, options)
    }
}
