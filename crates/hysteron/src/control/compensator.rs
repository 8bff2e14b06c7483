//! A hysteresis model inside a control loop. It predicts the output at the measured input, and its
//! inverse gives the input for a target.
//!
//! These are two states of one model. The first state follows the measured input; it is used to
//! predict the output and to learn. The second state follows the inputs that the inverse has asked
//! for, as in the chapter's compensator. If the inverse started from the measured input instead,
//! each overshoot of the loop behind it would make it cross the dead band again.
//!
//! But weights that learn cause a problem: a turning point asked for with old weights stays in the
//! memory of the inverse until it is wiped out. So with a learning model, the inverse restarts from
//! the measured input where the target turns, if the model expects what is measured there. There it
//! has to cross the dead band anyway. It also does so where the inverse would turn round by itself,
//! because the inputs that it has asked for lead elsewhere with the new weights.

use super::trust::Trust;
use crate::adapt::{Adaptive, AdaptiveLoad};
use crate::error::{Error, Result};
use crate::model::{Delay, Model, Policy, Sample, Sign, State, Wanted};
use crate::series::{NOISE, Turning};
use hysteron_core::{Direction, Outcome, Solution, Target};

/// Learning moves the expected output slightly up and down. While the target itself has not turned,
/// the inverse crosses the dead band only if the difference exceeds this many tolerances.
const NOT_TURNED: f64 = 8.0;

/// Number of samples after a jump of the input during which the model does not learn.
const JUMP: u32 = 10;

/// A hysteresis model and its inverse in the loop, fixed or adaptive.
#[derive(Debug, Clone)]
pub struct Compensator {
    kind: Kind,
    /// State of the inverse; `None` before the first sample.
    wanted: Option<State>,
    /// The branch that the target is on.
    target: Option<Turning>,
    /// The last input that the model followed.
    input: Option<f64>,
    /// Number of samples until learning continues.
    resting: u32,
    /// Whether the weights of the inverse have changed at once since that was last asked.
    changed: bool,
    /// Whether its weights came from elsewhere while it ran.
    renewed: bool,
    /// The output expected at the last input.
    prediction: f64,
    /// By how much the last reading was missed.
    missed: f64,
}

#[derive(Debug, Clone)]
enum Kind {
    Fixed { model: Box<Model>, state: State },
    Adaptive(Box<Adaptive>),
    Load(Box<AdaptiveLoad>),
    Shadow(Box<Shadow>),
}

impl Kind {
    /// The state at the last input, and the sign of the output.
    fn at(&self) -> (State, Sign) {
        match self {
            Self::Fixed { model, state } => (state.clone(), model.sign()),
            Self::Adaptive(adaptive) => (adaptive.state().clone(), adaptive.offline().sign()),
            Self::Load(adaptive) => (adaptive.state().clone(), adaptive.offline().sign()),
            Self::Shadow(shadow) => shadow.used().kind.at(),
        }
    }

    /// Whether the drive heats a body, which has to be driven ahead of the reference.
    fn is_heated(&self) -> bool {
        match self {
            Self::Fixed { model, .. } => model.thermal.is_some(),
            Self::Adaptive(adaptive) => adaptive.offline().thermal.is_some(),
            Self::Load(_) | Self::Shadow(_) => false,
        }
    }

    fn solve_from(
        &self,
        from: &mut State,
        wanted: Wanted,
        after: &[Wanted],
    ) -> Result<Solution<f64>> {
        match self {
            Self::Fixed { model, .. } => model.inverse()?.step_ahead(from, wanted, after),
            Self::Adaptive(adaptive) => adaptive.solve_ahead(from, wanted, after),
            Self::Load(adaptive) => adaptive.solve_from(from, wanted),
            Self::Shadow(shadow) => shadow.used().kind.solve_from(from, wanted, after),
        }
    }
}

/// A learner beside the model that it began from.
#[derive(Debug, Clone)]
struct Shadow {
    fixed: Compensator,
    learner: Compensator,
    trust: Trust,
}

impl Shadow {
    fn used(&self) -> &Compensator {
        match self.trust.learner() {
            true => &self.learner,
            false => &self.fixed,
        }
    }
}

impl Compensator {
    /// A model that does not change. It starts as the model does ([`Model::start`]).
    ///
    /// # Errors
    /// As [`Model::inverse`], for a model that has no inverse.
    pub fn fixed(model: &Model) -> Result<Self> {
        model.inverse()?;
        Ok(Self::new(Kind::Fixed {
            model: Box::new(model.clone()),
            state: model.start(),
        }))
    }

    /// A model that learns while it runs.
    #[must_use]
    pub fn adaptive(adaptive: Adaptive) -> Self {
        Self::new(Kind::Adaptive(Box::new(adaptive)))
    }

    /// A model that follows the shift of its axis by an unknown load while it runs.
    #[must_use]
    pub fn load(adaptive: AdaptiveLoad) -> Self {
        Self::new(Kind::Load(Box::new(adaptive)))
    }

    /// A `learner` in the shadow of the fixed `model` that it began from: its predictions and its
    /// inverse are used only while its predictions have been the better ones.
    ///
    /// ```
    /// use hysteron::control::Compensator;
    /// use hysteron::{AdaptOptions, Learner, Model, Operator, Plane, Sign};
    /// let plane = Plane::new(20.0, 80.0, 5)?;
    /// let model = Model::new(Operator::Mkp, plane, vec![1.0; 15], 0.0, Sign::Positive)?;
    /// let options = AdaptOptions { learner: Learner::Increments, ..AdaptOptions::default() };
    /// let learner = Compensator::adaptive(options.adaptive(&model)?);
    /// let compensator = Compensator::shadowed(&model, learner)?;
    /// assert!(!compensator.trusts_learner()); // it has shown nothing yet
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Compensator::fixed`].
    pub fn shadowed(model: &Model, learner: Self) -> Result<Self> {
        Ok(Self::new(Kind::Shadow(Box::new(Shadow {
            fixed: Self::fixed(model)?,
            learner,
            trust: Trust::default(),
        }))))
    }

    /// Whether a learner in the shadow of a fixed model is used at present.
    #[must_use]
    pub fn trusts_learner(&self) -> bool {
        matches!(&self.kind, Kind::Shadow(shadow) if shadow.trust.learner())
    }

    /// Replaces the model of a compensator that does not learn itself, or of the learner in a
    /// shadow, by one that was learned elsewhere. What the operators remember stays.
    ///
    /// # Errors
    /// [`Error::Control`] for a model on another plane, and for a compensator that learns itself;
    /// as [`Model::inverse`]. Nothing is changed then.
    pub fn renew(&mut self, renewed: &Model) -> Result<()> {
        match &mut self.kind {
            Kind::Shadow(shadow) => {
                shadow.learner.renew(renewed)?;
                self.changed |= shadow.trust.learner();
                Ok(())
            }
            Kind::Fixed { model, state } => {
                let same =
                    (model.operator(), model.plane()) == (renewed.operator(), renewed.plane());
                if !same || model.load.is_some() || renewed.load.is_some() {
                    let what = "a renewed model needs the operators and the plane of the old one";
                    return Err(Error::Control(what.into()));
                }
                renewed.inverse()?;
                let core = &renewed.operators().core;
                core.rebase(&mut state.operators)?;
                if let Some(wanted) = &mut self.wanted {
                    core.rebase(&mut wanted.operators)?;
                }
                **model = renewed.clone();
                (self.changed, self.renewed) = (true, true);
                Ok(())
            }
            Kind::Adaptive(_) | Kind::Load(_) => Err(Error::Control(
                "a model that learns in the loop takes no weights from elsewhere".into(),
            )),
        }
    }

    /// Whether the inverse has changed at once, by new weights or another model, since this was
    /// last asked.
    pub(super) fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// By how much the output changes with `input`, from the last one that the model followed.
    /// Nothing is moved.
    pub(super) fn expected_change(&self, input: f64, dt: f64) -> f64 {
        let sample = Sample {
            input,
            dt: Some(dt),
            load: None,
        };
        let change = |before: f64, after: Result<f64>| after.map_or(0.0, |after| after - before);
        match &self.kind {
            Kind::Fixed { model, state } => {
                let after = model.step(&mut state.clone(), sample);
                change(self.prediction, after.map(|step| step.output))
            }
            Kind::Adaptive(adaptive) => change(self.prediction, adaptive.clone().simulate(sample)),
            Kind::Load(adaptive) => change(self.prediction, adaptive.clone().simulate(sample)),
            Kind::Shadow(shadow) => shadow.used().expected_change(input, dt),
        }
    }

    /// The output that a model which learns nothing expected at the last input, where there is one:
    /// a learner may have learned from a reading that stands still.
    pub(super) fn prediction(&self) -> f64 {
        match &self.kind {
            Kind::Shadow(shadow) => shadow.fixed.prediction,
            _ => self.prediction,
        }
    }

    /// The dead time of the actuator, as its model has it.
    pub(super) fn delay(&self) -> Delay {
        match &self.kind {
            Kind::Fixed { model, .. } => model.delay(),
            Kind::Adaptive(adaptive) => adaptive.offline().delay(),
            Kind::Load(adaptive) => adaptive.offline().delay(),
            Kind::Shadow(shadow) => shadow.fixed.delay(),
        }
    }

    /// The range of the outputs of the model at its beginning.
    pub(super) fn output_range(&self) -> (f64, f64) {
        match &self.kind {
            Kind::Fixed { model, .. } => model.output_range(),
            Kind::Adaptive(adaptive) => adaptive.offline().output_range(),
            Kind::Load(adaptive) => adaptive.offline().output_range(),
            Kind::Shadow(shadow) => shadow.fixed.output_range(),
        }
    }

    fn new(kind: Kind) -> Self {
        Self {
            kind,
            wanted: None,
            target: None,
            input: None,
            resting: 0,
            changed: false,
            renewed: false,
            prediction: f64::NAN,
            missed: 0.0,
        }
    }

    /// Moves the model to `input`. Returns the output expected there and, for a model that learns
    /// from the measured output, what was done with that measurement. `dt` is the time since the
    /// sample before.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for numbers that are not finite.
    pub(super) fn follow(
        &mut self,
        input: f64,
        dt: Option<f64>,
        measured: Option<f64>,
    ) -> Result<(f64, Option<Outcome>)> {
        let followed = self.moved(input, dt, measured)?;
        self.prediction = followed.0;
        if let Some(measured) = measured {
            self.missed = (measured - followed.0).abs();
        }
        Ok(followed)
    }

    fn moved(
        &mut self,
        input: f64,
        dt: Option<f64>,
        measured: Option<f64>,
    ) -> Result<(f64, Option<Outcome>)> {
        let from = self.input.replace(input).unwrap_or(input);
        match (&mut self.kind, measured) {
            (Kind::Fixed { model, state }, _) => {
                let sample = Sample {
                    input,
                    dt,
                    load: None,
                };
                Ok((model.step(state, sample)?.output, None))
            }
            (Kind::Shadow(shadow), measured) => {
                let Shadow {
                    fixed,
                    learner,
                    trust,
                } = shadow.as_mut();
                let (first, _) = fixed.follow(input, dt, measured)?;
                let (second, outcome) = learner.follow(input, dt, measured)?;
                let used = match trust.learner() {
                    true => second,
                    false => first,
                };
                let errors = measured.map(|measured| (measured - first, measured - second));
                if errors.is_some_and(|errors| trust.push(errors)) {
                    self.changed = true;
                    self.set_out_again();
                }
                Ok((used, outcome))
            }
            (Kind::Load(adaptive), measured) => {
                let sample = Sample {
                    input,
                    dt,
                    load: None,
                };
                let Some(measured) = measured else {
                    return Ok((adaptive.simulate(sample)?, None));
                };
                let learning = adaptive.step(sample, measured)?;
                Ok((learning.output, Some(learning.outcome)))
            }
            (Kind::Adaptive(adaptive), measured) => {
                let offline = adaptive.offline();
                // Stages in front of the operators have inputs of another kind.
                let jumps = offline.is_plain() && (input - from).abs() > offline.plane().step();
                self.resting = match jumps {
                    true => JUMP,
                    false => self.resting.saturating_sub(1),
                };
                let sample = Sample {
                    input,
                    dt,
                    load: None,
                };
                let Some(measured) = measured.filter(|_| self.resting == 0) else {
                    return Ok((adaptive.simulate(sample)?, None));
                };
                let learning = adaptive.step(sample, measured)?;
                Ok((learning.output, Some(learning.outcome)))
            }
        }
    }

    /// Finds the input that gives `target`, starting from the last input asked for. The heading of
    /// the target is used by *anticipate*. Reversals of the target up to `tolerance` are not
    /// followed. `next` are the targets after this one, each after the time `dt`, for a model with a
    /// thermal body.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for a target that is not finite.
    pub(super) fn solve(
        &mut self,
        target: f64,
        heading: Option<Direction>,
        tolerance: f64,
        dt: Option<f64>,
        next: &[f64],
    ) -> Result<Solution<f64>> {
        if let Kind::Shadow(shadow) = &mut self.kind {
            let used = match shadow.trust.learner() {
                true => &mut shadow.learner,
                false => &mut shadow.fixed,
            };
            return used.solve(target, heading, tolerance, dt, next);
        }
        let branch = self.target.get_or_insert_with(|| Turning::new(tolerance));
        let turns = branch.push(target).is_some();
        let branch = branch.branch();
        // Where the model expects something else than is measured, a feedback has made up for that.
        // An inverse that sets out from the drive would make up for it once more.
        let (off, on) = self.output_range();
        let expects = self.missed <= tolerance.max(NOISE * (on - off).abs());
        if turns && expects && !matches!(self.kind, Kind::Fixed { .. }) {
            self.set_out_again();
        }
        let (followed, sign) = self.kind.at();
        let goes = |state: &State| match state.is_rising() == (sign == Sign::Positive) {
            true => Direction::Rising,
            false => Direction::Falling,
        };
        let branch = branch.map(|(branch, _)| branch);
        let wanted = self.wanted.get_or_insert_with(|| followed.clone());
        let went = goes(wanted);
        let turned = branch.is_some_and(|branch| branch != went);
        let asked = tolerance;
        let tolerance = match heading {
            None if !turned => NOT_TURNED * tolerance,
            _ => tolerance,
        };
        let after: Vec<Wanted> =
            match &self.kind {
                kind if kind.is_heated() => {
                    let policy = match heading {
                        Some(_) => Policy::Anticipate,
                        None => Policy::Hold,
                    };
                    // *Hold* has no headings.
                    let headings = policy.headings(next, asked).into_iter();
                    let ahead = headings.chain(std::iter::repeat(None)).zip(next).map(
                        |(heading, &target)| Wanted {
                            dt,
                            ..Target::new(target).heading(heading).tolerance(asked).into()
                        },
                    );
                    ahead.collect()
                }
                _ => Vec::new(),
            };
        let target = Target::new(target).heading(heading).tolerance(tolerance);
        let wanted_now = Wanted {
            dt,
            ..target.into()
        };
        let solution = self.kind.solve_from(wanted, wanted_now, &after)?;
        let turns_round = heading.or(branch) == Some(went) && goes(wanted) != went;
        if turns_round && self.has_learned() {
            // The model has changed, and not the target: the inputs asked for lead elsewhere now.
            // Where the input really went, the output may be on its way all the same. What a
            // feedback has made up for is then counted twice, until it has noticed. Measured, that
            // costs less than a burst of drive the wrong way, also where the model still misses
            // what is measured; to take it from the integral at once costs more.
            let ahead = match went {
                Direction::Rising => target.output - self.prediction,
                Direction::Falling => self.prediction - target.output,
            };
            let mut anew = followed;
            if ahead >= -asked
                && let Ok(other) = self.kind.solve_from(&mut anew, wanted_now, &after)
            {
                self.wanted = Some(anew);
                return Ok(other);
            }
        }
        Ok(solution)
    }

    /// Whether its weights may have changed.
    fn has_learned(&self) -> bool {
        self.renewed || !matches!(self.kind, Kind::Fixed { .. })
    }

    /// Restarts the inverse from the last measured input. While the input is not measured, it may
    /// go anywhere, and the inputs asked for in that time may not have been reached.
    pub(super) fn set_out_again(&mut self) {
        self.wanted = None;
        if let Kind::Shadow(shadow) = &mut self.kind {
            shadow.fixed.set_out_again();
            shadow.learner.set_out_again();
        }
    }

    /// The model whose weights adapt, if this compensator has one.
    #[must_use]
    pub fn adapting(&self) -> Option<&Adaptive> {
        match &self.kind {
            Kind::Fixed { .. } | Kind::Load(_) => None,
            Kind::Adaptive(adaptive) => Some(adaptive),
            Kind::Shadow(shadow) => shadow.learner.adapting(),
        }
    }

    /// The model as it has been learned; `None` where nothing learns weights.
    #[must_use]
    pub fn learned(&self) -> Option<Model> {
        match &self.kind {
            Kind::Adaptive(adaptive) => adaptive.model().ok(),
            Kind::Shadow(shadow) => match &shadow.learner.kind {
                // Its weights came from elsewhere.
                Kind::Fixed { model, .. } => Some(model.as_ref().clone()),
                _ => shadow.learner.learned(),
            },
            Kind::Fixed { .. } | Kind::Load(_) => None,
        }
    }

    /// The model that follows an unknown load, if this compensator has one.
    #[must_use]
    pub fn following(&self) -> Option<&AdaptiveLoad> {
        match &self.kind {
            Kind::Load(adaptive) => Some(adaptive),
            Kind::Fixed { .. } | Kind::Adaptive(_) => None,
            Kind::Shadow(shadow) => shadow.learner.following(),
        }
    }
}
