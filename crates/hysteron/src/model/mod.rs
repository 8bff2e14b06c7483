//! The model of an actuator: operators, the stages in front of them, and a record of how they were
//! identified.
//!
//! `operators` are the weighted operators; `body`, `load` and `constants` are those of the
//! stages around them, and `stages` hands them to the core. `state` moves a model sample by sample
//! from its `start`, `surroundings` simulates it with time and load, and `inverse` inverts it
//! (`policy` says how). `band` is the interval around the output, and `bounds` where it may really be. `file` reads and writes models;
//! `summary`, `smooth`, `validation`, `confidence` and `excitation` are the record of the
//! fit.

mod band;
mod body;
mod bounds;
mod confidence;
mod constants;
mod excitation;
mod file;
mod inverse;
mod load;
mod operators;
mod policy;
mod preview;
mod sign;
mod smooth;
mod stages;
mod start;
mod state;
mod summary;
mod surroundings;
mod validation;
mod within;

pub(crate) use band::add_variance;
pub use band::{Band, BandEvaluation};
pub use body::FirstOrder;
pub(crate) use body::needs_time;
pub use bounds::Bounds;
pub use confidence::{Confidence, INTERVAL};
pub use constants::{CreepTerm, StageConstants};
pub use excitation::Excitation;
#[cfg(feature = "data")]
pub(crate) use file::{FORMAT, no_model};
pub use inverse::{Inverse, Wanted};
pub use load::{LoadCurves, LoadDependence, LoadPart};
pub(crate) use load::{bernstein, no_load};
pub use operators::{OperatorState, Operators};
pub use policy::Policy;
pub(crate) use preview::Preview;
pub use sign::Sign;
pub use smooth::Smooth;
pub use start::FittedStart;
pub use state::{Sample, State};
pub use summary::{FitSummary, Outlier, SeenFile, Solver, Start};
pub use surroundings::Surroundings;
pub use validation::{Criterion, RivalScore, Score, Validation};
pub(crate) use within::{Bend, Found};

use crate::error::{Error, Result};
use crate::recording::Quantity;
use crate::remedy::{Remedy, Setting};
use hysteron_core::{ClippedCount, Operator, Output};

/// The discrete Preisach plane, equation (3).
pub type Plane = hysteron_core::Plane<f64>;

/// A model of an actuator: weighted operators and the stages in front of them.
///
/// ```
/// use hysteron::{Model, Operator, Plane, Sign, Target};
/// let plane = Plane::new(20.0, 80.0, 3)?;
/// let weights = vec![1.0, 0.5, 1.0, 0.0, 0.5, 1.0]; // row by row: j = 1…K, i = 1…j
/// let model = Model::new(Operator::Mkp, plane, weights, 10.0, Sign::Positive)?;
/// let heated_and_cooled = model.simulate(&[20.0, 80.0, 50.0])?;
/// assert_eq!(heated_and_cooled, [11.0, 14.0, 13.0]);
///
/// let inverse = model.inverse()?;
/// let mut state = model.start();
/// let solution = inverse.step(&mut state, Target::new(12.5))?;
/// assert!((model.simulate(&[solution.input])?[0] - 12.5).abs() < 1e-12);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    operators: Operators,
    /// Name and unit of the input.
    pub input: Quantity,
    /// Name and unit of the output.
    pub output: Quantity,
    /// How offset and weights depend on a load, if they do. `operators` are then those of the
    /// middle of the load range.
    pub load: Option<LoadDependence>,
    /// The thermal body in front of the operators, if there is one. The input then drives the body,
    /// and the operators follow the body's temperature. The plane is in units of that temperature.
    pub thermal: Option<FirstOrder>,
    /// The lowest and the highest drive that the actuator was recorded with. The inverse of a model
    /// with a thermal body stays between them, if it is given no other range.
    pub drive: Option<(f64, f64)>,
    /// The inputs at the corners of the grid; empty for equal distances.
    spacing: Vec<f64>,
    /// The constants of the stages behind the operators.
    behind: StageConstants<f64>,
    /// The state found before the first sample fitted.
    start: Option<FittedStart>,
    /// How the model was obtained, if it was identified.
    pub fit: Option<FitSummary>,
}

impl From<Operators> for Model {
    /// A model of these operators without stages.
    fn from(operators: Operators) -> Self {
        Self {
            operators,
            input: Quantity::named("input"),
            output: Quantity::named("output"),
            load: None,
            thermal: None,
            drive: None,
            spacing: Vec::new(),
            behind: StageConstants::default(),
            start: None,
            fit: None,
        }
    }
}

impl Model {
    /// A plain model: `operator`s on `plane`, without stages. Arguments as [`Operators::new`].
    ///
    /// # Errors
    /// As [`Operators::new`].
    pub fn new(
        operator: Operator,
        plane: Plane,
        weights: Vec<f64>,
        offset: f64,
        sign: Sign,
    ) -> Result<Self> {
        Ok(Operators::new(operator, plane, weights, offset, sign)?.into())
    }

    /// The operators, without the thermal body and the load in front of them.
    #[must_use]
    pub fn operators(&self) -> &Operators {
        &self.operators
    }

    /// The operators of a plain model: one without stages.
    ///
    /// # Errors
    /// [`Error::Thermal`] for a model that depends on time, [`Error::Fit`] for one that depends on a
    /// load or has its levels at unequal distances.
    pub fn plain(&self) -> Result<&Operators> {
        if self.is_timed() {
            return Err(needs_time());
        }
        if let Some(load) = &self.load {
            return Err(load.one_is_needed());
        }
        if !self.behind.is_none() {
            let what = "the model has a stage behind its operators, which this cannot have";
            return Err(Error::Fit(what.into()));
        }
        if !self.spacing.is_empty() {
            let what = "the model's levels are not at equal distances, which this needs";
            let remedy = Remedy::new("fit with {}", [Setting::word("spacing", "uniform")]);
            return Err(Error::Fit(what.into()).remedied(remedy));
        }
        Ok(&self.operators)
    }

    /// The plane.
    #[must_use]
    pub fn plane(&self) -> &Plane {
        self.operators.plane()
    }

    /// The elementary operator.
    #[must_use]
    pub fn operator(&self) -> Operator {
        self.operators.operator()
    }

    /// The weights `μ_ij`, row by row: `j = 1…K`, within a row `i = 1…j`.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        self.operators.weights()
    }

    /// The output where `Σ μ γ = 0`.
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.operators.offset()
    }

    /// Whether the output rises or falls with the input.
    #[must_use]
    pub fn sign(&self) -> Sign {
        self.operators.sign()
    }

    /// The outputs with every operator off and with every operator on, in the output's unit. Of the
    /// stages behind the operators, those that depend on time have no part in it.
    #[must_use]
    pub fn output_range(&self) -> (f64, f64) {
        let (off, on) = self.operators.output_range();
        (self.untimed(off), self.untimed(on))
    }

    /// The default tolerance for targets: [`crate::NOISE`] times the output's range. Smaller
    /// reversals of a target count as noise.
    #[must_use]
    pub fn usual_tolerance(&self) -> f64 {
        let (off, on) = self.output_range();
        crate::NOISE * (on - off).abs()
    }

    /// The state that returned these `turning_points` ([`State::turning_points`]) and this `input`
    /// ([`State::input`]), to the last bit. The stages are at rest with the next sample.
    ///
    /// # Errors
    /// [`Error::Core`] for turning points that are not nested and for an input that is not finite.
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
    /// - [`Error::Core`] for an input that is not finite or a state of another model.
    /// - [`Error::Thermal`] for a thermal body without `dt`, or a negative `dt`.
    /// - [`Error::Fit`] for a load that is missing, out of range, or given to a model that has
    ///   none.
    ///
    /// After an error the state is unchanged.
    #[inline]
    pub fn step(&self, state: &mut State, sample: impl Into<Sample>) -> Result<Output<f64>> {
        state.step(self, sample.into())
    }

    /// Moves `state` through `input` and writes the outputs to `output`, which is at least as long.
    /// Returns how many inputs were clipped. For models that need neither time nor load.
    ///
    /// # Errors
    /// As [`Model::run_in`].
    pub fn run(
        &self,
        state: &mut State,
        input: &[f64],
        output: &mut [f64],
    ) -> Result<ClippedCount> {
        self.run_in(state, input, Surroundings::default(), output)
    }

    /// The outputs for `input`, from the model's start ([`Model::start`]).
    ///
    /// # Errors
    /// As [`Model::simulate_in`], which is for models that need time or load.
    pub fn simulate(&self, input: &[f64]) -> Result<Vec<f64>> {
        self.simulate_in(input, Surroundings::default())
    }

    /// The operators' states `γ_ij` in `[0, 1]`, in the order of the weights.
    ///
    /// # Errors
    /// As [`Operators::operator_states`].
    pub fn operator_states(&self, state: &State) -> Result<Vec<f64>> {
        self.operators.operator_states(&state.operators)
    }
}
