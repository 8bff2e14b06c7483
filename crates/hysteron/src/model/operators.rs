//! Weighted operators with offset and sign: the core of every model, without the stages in front of
//! it.

use crate::error::{Error, Result};
use crate::model::sign::Sign;
use crate::series::NOISE;
use hysteron_core::{Operator, Turn, operators, table_len, turn_capacity};
use serde::{Deserialize, Serialize};

/// The discrete Preisach plane, equation (3).
pub type Plane = hysteron_core::Plane<f64>;

/// The state of weighted operators: their turning points.
pub type OperatorState = hysteron_core::State<f64, Vec<Turn<f64>>>;

/// The state of the operators before the first sample of the recording fitted: chosen or found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct FittedStart {
    /// The turning points, normalised to `[0, K]` ([`crate::State::turning_points`]).
    pub turning_points: Vec<f64>,
    /// The input of the operators.
    pub input: f64,
}

/// Weighted operators, offset and sign: `output = offset + sign · Σ μ_ij γ_ij(input)`, equation
/// (2).
///
/// A [`Model`](crate::Model) without a thermal body and a load consists only of this. Functions for
/// such a plain model use this type ([`Model::plain`](crate::Model::plain)).
///
/// ```
/// use hysteron::{Operator, Operators, Plane, Sign};
/// let plane = Plane::new(20.0, 80.0, 3)?;
/// let weights = vec![1.0, 0.5, 1.0, 0.0, 0.5, 1.0]; // row by row: j = 1…K, i = 1…j
/// let operators = Operators::new(Operator::Mkp, plane, weights, 10.0, Sign::Positive)?;
/// assert_eq!(operators.simulate(&[20.0, 80.0, 50.0])?, [11.0, 14.0, 13.0]);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Operators {
    pub(crate) core: hysteron_core::Model<f64, Vec<f64>>,
    weights: Vec<f64>,
    offset: f64,
    sign: Sign,
}

impl Operators {
    /// Operators on `plane`; `weights` holds `N = K(K + 1)/2` numbers row by row,
    /// `j = 1…K` and within a row `i = 1…j`, in the unit of the output.
    ///
    /// # Errors
    /// [`Error::Core`] for a wrong number of weights or one that is not finite;
    /// [`Error::ModelFile`] for an offset that is not finite.
    pub fn new(
        operator: Operator,
        plane: Plane,
        weights: Vec<f64>,
        offset: f64,
        sign: Sign,
    ) -> Result<Self> {
        if !offset.is_finite() {
            return Err(Error::ModelFile {
                path: None,
                field: "output.offset".into(),
                problem: format!("{offset} is not a finite number"),
            });
        }
        // Check the count before the table is allocated: a wrong number of levels can make it huge.
        let (expected, found) = (plane.operators(), weights.len());
        if expected != found {
            return Err(hysteron_core::Error::WeightCount { expected, found }.into());
        }
        let largest = offset.abs() + 2.0 * weights.iter().map(|mu| mu.abs()).sum::<f64>();
        if weights.iter().all(|mu| mu.is_finite()) && !largest.is_finite() {
            return Err(Error::ModelFile {
                path: None,
                field: "weights".into(),
                problem: "their sum with the offset is too large for a number".into(),
            });
        }
        let table = vec![0.0; table_len(plane.levels())];
        let core = hysteron_core::Model::new(plane, operator, &weights, table)?;
        Ok(Self {
            core,
            weights,
            offset,
            sign,
        })
    }

    /// The plane.
    #[must_use]
    pub fn plane(&self) -> &Plane {
        self.core.plane()
    }

    /// The elementary operator.
    #[must_use]
    pub fn operator(&self) -> Operator {
        self.core.operator()
    }

    /// The weights `μ_ij`, row by row: `j = 1…K`, within a row `i = 1…j`.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The output where `Σ μ γ = 0`.
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// Whether the output rises or falls with the input.
    #[must_use]
    pub fn sign(&self) -> Sign {
        self.sign
    }

    /// The outputs with every operator off and with every operator on, in the output's unit.
    #[must_use]
    pub fn output_range(&self) -> (f64, f64) {
        let (off, on) = self.core.output_range();
        (self.outward(off), self.outward(on))
    }

    /// The default tolerance for targets: [`crate::NOISE`] times the output's range. Smaller
    /// reversals of a target count as noise.
    #[must_use]
    pub fn usual_tolerance(&self) -> f64 {
        let (off, on) = self.output_range();
        NOISE * (on - off).abs()
    }

    /// A state with every operator off.
    #[must_use]
    pub fn start(&self) -> OperatorState {
        let memory = vec![Turn::default(); turn_capacity(self.plane().levels())];
        match self.core.state(memory) {
            Ok(state) => state,
            Err(_) => unreachable!("the memory has the capacity asked for"),
        }
    }

    /// A state with every operator on, at the top of the plane.
    #[must_use]
    pub fn saturated(&self) -> OperatorState {
        let mut state = self.start();
        let reset = self.core.reset_on(&mut state);
        debug_assert!(reset.is_ok(), "the state is this model's own");
        state
    }

    /// The state that returned these `turning_points` ([`OperatorState::turning_points`]) and this `input`
    /// ([`OperatorState::input`]), to the last bit.
    ///
    /// # Errors
    /// [`Error::Core`] for turning points that are not nested and for an input that is not finite.
    ///
    /// ```
    /// # use hysteron::{Operator, Operators, Plane, Sign};
    /// # let plane = Plane::new(20.0, 80.0, 3)?;
    /// # let model = Operators::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
    /// let mut state = model.start();
    /// model.run(&mut state, &[70.0, 40.0, 55.0], &mut [0.0; 3])?;
    /// let saved: Vec<f64> = state.turning_points().collect();
    /// assert_eq!(model.restore(&saved, state.input())?, state);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    pub fn restore(&self, turning_points: &[f64], input: f64) -> Result<OperatorState> {
        let mut state = self.start();
        self.core.restore(&mut state, turning_points, input)?;
        Ok(state)
    }

    /// Moves `state` to `input`. Returns the output, and whether the input was outside the plane.
    ///
    /// # Errors
    /// [`Error::Core`] for an input that is not finite or a state of another model; then the state
    /// is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut OperatorState,
        input: f64,
    ) -> Result<hysteron_core::Output<f64>> {
        let step = self.core.step(state, input)?;
        Ok(hysteron_core::Output {
            output: self.outward(step.output),
            ..step
        })
    }

    /// Moves `state` through `input` and writes the outputs to `output`, which is at least as long.
    /// Returns how many inputs were clipped.
    ///
    /// # Errors
    /// As [`Operators::step`], with the index of the sample; [`Error::Core`] for an `output` that
    /// is shorter than `input`.
    pub fn run(
        &self,
        state: &mut OperatorState,
        input: &[f64],
        output: &mut [f64],
    ) -> Result<hysteron_core::ClippedCount> {
        let clipped = self.core.run(state, input, output)?;
        for value in &mut output[..input.len()] {
            *value = self.outward(*value);
        }
        Ok(clipped)
    }

    /// The outputs for `input`, from every operator off.
    ///
    /// # Errors
    /// As [`Operators::run`].
    pub fn simulate(&self, input: &[f64]) -> Result<Vec<f64>> {
        let mut output = vec![0.0; input.len()];
        self.run(&mut self.start(), input, &mut output)?;
        Ok(output)
    }

    /// The operators' states `γ_ij` in `[0, 1]`, in the order of the weights.
    ///
    /// # Errors
    /// [`Error::Core`] for a state of a model with fewer levels.
    ///
    /// ```
    /// # use hysteron::{Operator, Operators, Plane, Sign};
    /// # let plane = Plane::new(0.0, 1.0, 2)?;
    /// # let weights = vec![1.0, 2.0, 4.0];
    /// # let model = Operators::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive)?;
    /// let mut state = model.start();
    /// model.run(&mut state, &[0.5, 1.0, 0.5], &mut [0.0; 3])?;
    /// assert_eq!(model.operator_states(&state)?, [1.0, 1.0, 0.5]); // γ_11, γ_12, γ_22
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    pub fn operator_states(&self, state: &OperatorState) -> Result<Vec<f64>> {
        operators(self.plane().levels())
            .map(|(i, j)| Ok(state.gamma(i, j)?))
            .collect()
    }

    fn outward(&self, sum: f64) -> f64 {
        self.offset + self.sign.factor() * sum
    }
}
