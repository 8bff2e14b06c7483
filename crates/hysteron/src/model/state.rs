//! The state of a model, and the sample that moves it.

use crate::error::Result;
use crate::model::load::no_load;
use crate::model::{Model, OperatorState};
use hysteron_core::{Error, Output, STATE_NUMBERS, StageState, mix};

/// One input sample of a model. A plain number converts to a sample with that input only.
pub type Sample = hysteron_core::Sample<f64>;

/// The state of a model: of its operators and of its stages.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    pub(crate) operators: OperatorState,
    pub(crate) stages: StageState<f64>,
    /// Offset and operators at the load of the last sample, if they depend on a load.
    pub(crate) mixed: Option<Box<Mixed>>,
}

/// The model at one load.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Mixed {
    pub(crate) core: hysteron_core::Model<f64, Vec<f64>>,
    pub(crate) offset: f64,
    load: f64,
}

impl From<OperatorState> for State {
    fn from(operators: OperatorState) -> Self {
        Self {
            operators,
            stages: StageState::default(),
            mixed: None,
        }
    }
}

impl Model {
    /// The state that returned these `turning_points` ([`State::turning_points`]) and this `input`
    /// ([`State::input`]), to the last bit. The stages are at rest with the next sample.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for turning points that are not nested and for an input that is not
    /// finite.
    ///
    /// ```
    /// # use hysteron::{Model, Operator, Plane, Sign};
    /// # let plane = Plane::new(20.0, 80.0, 3)?;
    /// # let model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
    /// let mut state = model.start();
    /// model.run(&mut state, &[70.0, 40.0, 55.0], &mut [0.0; 3])?;
    /// let saved: Vec<f64> = state.turning_points().collect();
    /// assert_eq!(model.restore(&saved, state.input())?, state);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    pub fn restore(&self, turning_points: &[f64], input: f64) -> Result<State> {
        Ok(State::new(
            self,
            self.operators.restore(turning_points, input)?,
        ))
    }

    /// Moves `state` by one sample. Returns the output, and whether the operators' input was
    /// outside the plane. A plain model takes a number. A model with a thermal body also needs the
    /// time step, and one that depends on a load needs the load.
    ///
    /// ```
    /// use hysteron::{FirstOrder, Model, Operator, Plane, Sample, Sign};
    /// let plane = Plane::new(1.0, 2.0, 2)?;
    /// let mut model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)?;
    /// assert_eq!(model.step(&mut model.start(), 2.0)?.output, 3.0);
    ///
    /// model.thermal = Some(FirstOrder { gain: 2.0, ..FirstOrder::default() });
    /// let mut state = model.start();
    /// model.step(&mut state, 1.0)?; // at rest at twice the drive
    /// assert!(model.step(&mut state, 1.0).is_err()); // from here on time counts
    /// let held = model.step(&mut state, Sample { dt: Some(50.0), ..1.0.into() })?;
    /// assert_eq!(held.output, 3.0);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`crate::Error::Core`] for an input that is not finite or a state of another model.
    /// - [`crate::Error::Thermal`] for a thermal body without `dt`, or a negative `dt`.
    /// - [`crate::Error::Fit`] for a load that is missing, out of range, or given to a model that has
    ///   none.
    ///
    /// After an error the state is unchanged.
    #[inline]
    pub fn step(&self, state: &mut State, sample: impl Into<Sample>) -> Result<Output<f64>> {
        state.step(self, sample.into())
    }

    /// The state `γ_ij` in `[0, 1]` of the operator that switches off at level `i` and on at level
    /// `j`, counted from 1.
    ///
    /// # Errors
    /// [`crate::Error::Core`] unless `1 <= i <= j <= K`, and for a state of another model.
    pub fn operator_state(&self, state: &State, i: usize, j: usize) -> Result<f64> {
        Ok(state.operators.gamma(i, j)?)
    }

    /// The operators' states `γ_ij` in `[0, 1]`, in the order of the weights.
    ///
    /// # Errors
    /// As [`crate::Operators::operator_states`].
    pub fn operator_states(&self, state: &State) -> Result<Vec<f64>> {
        self.operators.operator_states(&state.operators)
    }
}

impl State {
    pub(super) fn new(model: &Model, operators: OperatorState) -> Self {
        let depends = model.load.as_ref().filter(|load| load.parts().len() > 1);
        let mixed = depends.map(|_| {
            Box::new(Mixed {
                core: model.operators().core.clone(),
                offset: model.offset(),
                load: f64::NAN,
            })
        });
        Self {
            mixed,
            ..operators.into()
        }
    }

    /// The last input of the operators.
    ///
    /// With a thermal body it is made from the temperature; with a load or unequal levels it is
    /// also shifted and stretched.
    #[must_use]
    pub fn input(&self) -> f64 {
        self.operators.input()
    }

    /// The temperature after the last sample: the input itself for a model without a thermal body.
    #[must_use]
    pub fn temperature(&self) -> f64 {
        match self.stages.is_started() {
            true => self.stages.temperature(),
            false => self.operators.input(),
        }
    }

    /// The turning points that the operators remember, normalised to the plane.
    pub fn turning_points(&self) -> impl Iterator<Item = f64> + '_ {
        self.operators.turning_points()
    }

    /// The line on the plane between the operators that are on and those that are off, as points
    /// `[α, β]`, normalised to the plane. Operator `(i, j)` takes the cell from `[i - 1, j - 1]` to
    /// `[i, j]`; the line goes through the cells of operators that are partly on. It begins at the
    /// edge `α = 0` and ends on the diagonal at the present input.
    ///
    /// ```
    /// # use hysteron::{Operator, Operators, Model, Plane, Sign};
    /// # let plane = Plane::new(1.0, 4.0, 4)?;
    /// # let operators = Operators::new(Operator::Mkp, plane, vec![1.0; 10], 0.0, Sign::Positive)?;
    /// let model = Model::from(operators);
    /// let mut state = model.off();
    /// for input in [3.5, 1.0, 2.0] {
    ///     model.step(&mut state, input)?;
    /// }
    /// assert_eq!(state.staircase(), [[0.0, 3.5], [1.0, 3.5], [1.0, 2.0], [2.0, 2.0]]);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    #[must_use]
    pub fn staircase(&self) -> Vec<[f64; 2]> {
        let turns: Vec<f64> = self.turning_points().collect();
        let first = turns.first().map(|top| [0.0, *top]);
        let last = turns.last().map(|now| [*now, *now]);
        let corners = turns
            .windows(2)
            .map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]);
        first.into_iter().chain(corners).chain(last).collect()
    }

    /// Whether the operators' input is rising.
    #[must_use]
    pub fn is_rising(&self) -> bool {
        self.operators.is_rising()
    }

    /// What the stages remember, for saving: 0 or 1 for whether there was a sample, the temperature,
    /// and what each stage behind the operators remembers.
    #[must_use]
    pub fn stage_numbers(&self) -> [f64; STATE_NUMBERS] {
        self.stages.to_numbers()
    }

    /// The same state, in which the stages remember these numbers
    /// ([`State::stage_numbers`]). With [`Model::restore`] it is the whole state.
    ///
    /// ```
    /// # use hysteron::{Model, Operator, Plane, Sample, Sign};
    /// # let plane = Plane::new(1.0, 2.0, 2)?;
    /// # let model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)?;
    /// let model = model.with_after(&[], 0.5)?;
    /// let mut state = model.start();
    /// for input in [0.0, 2.0, 1.3] {
    ///     model.step(&mut state, Sample { dt: Some(0.1), ..input.into() })?;
    /// }
    /// let points: Vec<f64> = state.turning_points().collect();
    /// let restored = model.restore(&points, state.input())?;
    /// assert_eq!(restored.with_stage_numbers(&state.stage_numbers())?, state);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::Core`] with the index of a number that is not finite.
    pub fn with_stage_numbers(self, numbers: &[f64; STATE_NUMBERS]) -> Result<Self> {
        let stages = StageState::from_numbers(numbers)?;
        Ok(Self { stages, ..self })
    }

    #[inline]
    pub(super) fn step(&mut self, model: &Model, sample: Sample) -> Result<Output<f64>> {
        if model.is_plain() {
            if sample.load.is_some() {
                return Err(no_load());
            }
            let step = model.operators().step(&mut self.operators, sample.input)?;
            self.forget_stages();
            return Ok(step);
        }
        self.step_staged(model, sample)
    }

    /// Apart from the step of a plain model, which is a tenth of its instructions.
    #[inline(never)]
    fn step_staged(&mut self, model: &Model, sample: Sample) -> Result<Output<f64>> {
        let mut stages = model.stages();
        let worded = |error| model.worded(error);
        stages.accepts(&self.stages, sample).map_err(worded)?;
        let Some(mixed) = self.place(model, sample.load)? else {
            let core = &model.operators().core;
            let step = stages.step(core, &mut self.operators, &mut self.stages, sample);
            return step.map_err(worded);
        };
        stages.offset = mixed.offset;
        let step = stages.step(&mixed.core, &mut self.operators, &mut self.stages, sample);
        self.mixed = Some(mixed);
        step.map_err(worded)
    }

    /// After a step of the operators alone, what a stage remembered is of the past.
    #[inline]
    pub(super) fn forget_stages(&mut self) {
        if self.stages.is_started() {
            self.stages = StageState::default();
        }
    }

    /// Brings the operators to a load, and lends the model at that load; `None` for a model without
    /// a load. The caller gives it back.
    pub(crate) fn place(&mut self, model: &Model, load: Option<f64>) -> Result<Option<Box<Mixed>>> {
        let (dependence, load) = match (&model.load, load) {
            (None, None) => return Ok(None),
            (None, Some(_)) => return Err(no_load()),
            (Some(dependence), None) => return Err(dependence.one_is_needed()),
            (Some(dependence), Some(load)) => (dependence, load),
        };
        let factors = dependence.factors(load)?;
        if factors.len() == 1 {
            // The weights do not depend on the load.
            return Ok(None);
        }
        // A state of the operators alone, or of another model, has no room for the load.
        let fits = |mixed: &&mut Box<Mixed>| mixed.core.plane() == model.plane();
        let Some(mixed) = self.mixed.as_mut().filter(fits) else {
            return Err(Error::StateMismatch.into());
        };
        if mixed.load != load {
            mix(
                &mut mixed.core,
                &mut self.operators,
                dependence.tables(),
                &factors,
            )?;
            let parts = dependence.parts().iter().zip(&factors);
            mixed.offset = parts.fold(0.0, |sum, (part, factor)| sum + factor * part.offset);
            mixed.load = load;
        }
        Ok(self.mixed.take())
    }
}
