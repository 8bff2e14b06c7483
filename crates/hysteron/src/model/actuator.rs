//! The model of an actuator: its operators, the stages around them and what is known of its fit.

use crate::error::{Error, Result};
use crate::model::body::{FirstOrder, needs_time};
use crate::model::constants::StageConstants;
use crate::model::delay::Delay;
use crate::model::load::LoadDependence;
use crate::model::operators::{FittedStart, Operators, Plane};
use crate::model::registration::Registration;
use crate::model::sign::Sign;
use crate::model::summary::FitSummary;
use crate::recording::Quantity;
use crate::remedy::{Remedy, Setting};
use crate::series::NOISE;
use hysteron_core::Operator;

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
    pub(super) operators: Operators,
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
    /// The heat that the operators bind, in degrees for a whole stroke.
    pub(super) latent: f64,
    /// At which inputs rising and falling input pass each threshold.
    pub(super) registration: Registration,
    /// The inputs at the corners of the grid; empty for equal distances.
    pub(super) spacing: Vec<f64>,
    /// The constants of the stages behind the operators.
    pub(super) behind: StageConstants<f64>,
    /// The dead time in front of all of it.
    pub(super) delay: Delay,
    /// The state found before the first sample fitted.
    pub(super) start: Option<FittedStart>,
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
            latent: 0.0,
            registration: Registration::default(),
            spacing: Vec::new(),
            behind: StageConstants::default(),
            delay: Delay::NONE,
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
        if !self.registration.is_none() {
            let what = "the model has an axis for each direction of its input, which this cannot \
                        have";
            let remedy = Remedy::new("fit with {}", [Setting::word("load-law", "shift")]);
            return Err(Error::Fit(what.into()).remedied(remedy));
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
        NOISE * (on - off).abs()
    }

    /// The model behind its thermal body: its input is the temperature.
    #[must_use]
    pub fn without_body(&self) -> Self {
        let mut model = self.clone();
        (model.thermal, model.drive, model.latent) = (None, None, 0.0);
        model
    }
}

impl Model {
    /// The same model with a dead time.
    #[must_use]
    pub fn with_delay(mut self, delay: Delay) -> Self {
        self.delay = delay;
        self
    }

    /// The dead time of the actuator.
    #[must_use]
    pub fn delay(&self) -> Delay {
        self.delay
    }

    /// Whether a time of the samples changes the outputs of a series: a model that depends on time
    /// needs it, and a dead time has another number of samples on another clock.
    #[must_use]
    pub fn reads_time(&self) -> bool {
        self.is_timed() || !self.delay.is_none()
    }
}
