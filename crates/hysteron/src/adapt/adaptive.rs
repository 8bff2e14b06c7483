//! A model that learns while it runs.

use crate::error::{Error, Result};
use crate::model::{Model, OperatorState, Sign};
use crate::progress::Progress;
use crate::progress::SAMPLES_BETWEEN;
use hysteron_core::{
    Adaptation, Estimator, Learning, Method, estimator_len, estimator_len_of_basis, table_len,
};
use hysteron_core::{Solution, Target};

/// A [`Model`] whose weights and offset follow the plant, with the state that it runs in.
///
/// ```
/// use hysteron::{Adaptation, Adaptive, Method, Model, Operator, Plane, Sign};
/// let plane = Plane::new(20.0, 80.0, 5)?;
/// let model = |weight: f64| Model::new(Operator::Mkp, plane, vec![weight; 15], 0.0, Sign::Positive);
/// let method = Method::LeastSquares { forgetting: 0.99, noise: 0.01, spread: 1.0, correlation: 3.0 };
/// let mut adaptive = Adaptive::new(&model(1.0)?, Adaptation { method, ..Adaptation::default() })?;
/// let (plant, mut state) = (model(1.5)?, model(1.5)?.start());
/// for n in 0..1000 {
///     let input = 50.0 - 40.0 * (0.05 * f64::from(n)).cos();
///     adaptive.step(input, plant.step(&mut state, input)?.output)?;
/// }
/// assert!((adaptive.predict(80.0)? - 15.0 * 1.5).abs() < 0.1);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Adaptive {
    offline: Model,
    core: hysteron_core::Model<f64, Vec<f64>>,
    /// Where the measured input is.
    state: OperatorState,
    /// Where the inverse stands: at the inputs that it asked for.
    wanted: OperatorState,
    estimator: Estimator<f64, Vec<f64>>,
    /// The basis whose coefficients the parameters are; empty where they are the weights.
    basis: Vec<Vec<f64>>,
}

impl Adaptive {
    /// Adapts all weights of `model`, and its offset, from all operators off.
    ///
    /// # Errors
    /// As [`Model::plain`]; [`Error::Core`] for options out of range and for negative weights;
    /// [`Error::Fit`] for a model with so many levels that the method takes more than 4 GiB.
    pub fn new(model: &Model, options: Adaptation<f64>) -> Result<Self> {
        let mut core = renewable(model, options.method)?;
        let memory = reserved(estimator_len(model.plane().levels(), options.method))?;
        let offset = model.sign().factor() * model.offset();
        let estimator = Estimator::new(options, &mut core, model.weights(), offset, memory)?;
        Self::over(model, core, estimator, Vec::new())
    }

    /// Adapts the coefficients of `basis` (each member `N` weights) and the offset; `coefficients` are
    /// those of the model. Far fewer unknowns than weights, where the ways are known in which these
    /// can change.
    ///
    /// # Errors
    /// As [`Adaptive::new`].
    pub fn of_basis(
        model: &Model,
        basis: Vec<Vec<f64>>,
        coefficients: &[f64],
        options: Adaptation<f64>,
    ) -> Result<Self> {
        let mut core = renewable(model, options.method)?;
        let levels = model.plane().levels();
        let memory = reserved(estimator_len_of_basis(
            levels,
            options.method,
            coefficients.len(),
        ))?;
        let offset = model.sign().factor() * model.offset();
        let all = basis.concat();
        let estimator =
            Estimator::of_basis(options, &mut core, &all, coefficients, offset, memory)?;
        Self::over(model, core, estimator, basis)
    }

    fn over(
        model: &Model,
        core: hysteron_core::Model<f64, Vec<f64>>,
        estimator: Estimator<f64, Vec<f64>>,
        basis: Vec<Vec<f64>>,
    ) -> Result<Self> {
        let mut state = model.plain()?.start();
        core.rebase(&mut state)?;
        Ok(Self {
            offline: model.clone(),
            core,
            wanted: state.clone(),
            state,
            estimator,
            basis,
        })
    }

    /// Moves to `input`, tells the output expected there, and learns from the one `measured`.
    ///
    /// # Errors
    /// [`Error::Core`] for numbers that are not finite; nothing is changed then.
    pub fn step(&mut self, input: f64, measured: f64) -> Result<Learning<f64>> {
        let factor = self.sign().factor();
        let learning =
            self.estimator
                .step(&mut self.core, &mut self.state, input, factor * measured)?;
        Ok(Learning {
            output: factor * learning.output,
            error: factor * learning.error,
            ..learning
        })
    }

    /// [`Adaptive::step`] through samples, as many as the shorter series has.
    ///
    /// # Errors
    /// [`Error::Core`] for the first number that is not finite; nothing is changed then. What `progress` returns; what was learned until
    /// then stays.
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

    /// Moves to `input` and tells the output expected there, without learning.
    ///
    /// # Errors
    /// [`Error::Core`] for an input that is not finite; nothing is changed then.
    pub fn predict(&mut self, input: f64) -> Result<f64> {
        let sum = self.core.step(&mut self.state, input)?.output;
        Ok(self.sign().factor() * (sum + self.estimator.offset()))
    }

    /// The output expected where the input is now.
    #[must_use]
    pub fn output(&self) -> f64 {
        self.sign().factor() * (self.core.output(&self.state) + self.estimator.offset())
    }

    /// Finds the input that gives `target`, by the weights as they are now. The inverse moves there from where it stood: it has a
    /// state of its own, as reference and plant are not in the same place.
    ///
    /// # Errors
    /// [`Error::Core`] for a target that is not finite; nothing is changed then.
    pub fn solve(&mut self, target: Target<f64>) -> Result<Solution<f64>> {
        let offset = self.estimator.offset();
        let core = &self.core;
        invert(core, self.offline.sign(), offset, &mut self.wanted, target)
    }

    /// Lets the inverse set out from where the measured input is. Turning points that were asked for by weights long changed
    /// stay in its memory until they are wiped out; a loop may call this wherever its target turns.
    pub fn align(&mut self) {
        self.wanted.clone_from(&self.state);
    }

    /// As [`Adaptive::solve`], from a `state` of the caller's: one of this model, which may have had other weights since.
    ///
    /// # Errors
    /// As [`Adaptive::solve`].
    pub(crate) fn solve_from(
        &self,
        state: &mut OperatorState,
        target: Target<f64>,
    ) -> Result<Solution<f64>> {
        let offset = self.estimator.offset();
        invert(&self.core, self.sign(), offset, state, target)
    }

    /// The weights as they are now, row by row.
    #[must_use]
    pub fn weights(&self) -> Vec<f64> {
        let parameters = self.estimator.parameters();
        if self.basis.is_empty() {
            return parameters.to_vec();
        }
        let mut weights = vec![0.0; self.offline.weights().len()];
        for (coefficient, member) in parameters.iter().zip(&self.basis) {
            for (weight, member) in weights.iter_mut().zip(member) {
                *weight += coefficient * member;
            }
        }
        weights
    }

    /// The output with every operator off, as it is now.
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.sign().factor() * self.estimator.offset()
    }

    /// The model as it is now, with the names of the off-line one.
    ///
    /// # Errors
    /// As [`Model::new`].
    pub fn model(&self) -> Result<Model> {
        let Model { input, output, .. } = self.offline.clone();
        let (operator, plane) = (self.offline.operator(), *self.offline.plane());
        let mut model = Model::new(operator, plane, self.weights(), self.offset(), self.sign())?;
        (model.input, model.output) = (input, output);
        Ok(model)
    }

    /// The off-line model.
    #[must_use]
    pub fn offline(&self) -> &Model {
        &self.offline
    }

    /// The state that the model is in.
    #[must_use]
    pub fn state(&self) -> &OperatorState {
        &self.state
    }

    /// Turns every operator off, those of the inverse too; the weights stay.
    ///
    /// # Errors
    /// None that a caller can cause.
    pub fn reset(&mut self) -> Result<()> {
        self.estimator.realign();
        self.core.reset_off(&mut self.state)?;
        self.align();
        Ok(())
    }

    /// Turns every operator on, as at the top of the plane, those of the inverse too; the weights stay.
    ///
    /// # Errors
    /// None that a caller can cause.
    pub fn saturate(&mut self) -> Result<()> {
        self.estimator.realign();
        self.core.reset_on(&mut self.state)?;
        self.align();
        Ok(())
    }

    /// While frozen, [`Adaptive::step`] predicts and nothing is learned.
    pub fn freeze(&mut self, frozen: bool) {
        self.estimator.freeze(frozen);
    }

    /// Takes the present weights and offset as the last good ones.
    pub fn keep(&mut self) {
        self.estimator.keep();
    }

    /// Goes back to the last good weights and offset: those last kept, or that stood a trial since ([`Adaptation::trial`]).
    ///
    /// # Errors
    /// None that a caller can cause.
    pub fn roll_back(&mut self) -> Result<()> {
        self.estimator.roll_back(&mut self.core);
        Ok(self.core.rebase(&mut self.state)?)
    }

    fn sign(&self) -> Sign {
        self.offline.sign()
    }
}

/// The inverse of a core model and an offset, with the model's sign.
fn invert(
    core: &hysteron_core::Model<f64, Vec<f64>>,
    sign: Sign,
    offset: f64,
    state: &mut OperatorState,
    target: Target<f64>,
) -> Result<Solution<f64>> {
    let raw = sign.factor() * target.output - offset;
    core.rebase(state)?;
    let solution = core.inverse()?.step(state, sign.inward(target, raw))?;
    Ok(sign.outward(solution))
}

/// Bytes that an estimator may take.
const MOST_BYTES: u128 = 4 << 30;

/// An estimator's memory.
fn reserved(numbers: usize) -> Result<Vec<f64>> {
    let bytes = 8 * numbers as u128;
    if bytes > MOST_BYTES {
        return Err(Error::Fit(format!(
            "an estimator with this method and so many levels takes {:.1} GiB, more than the {} GiB allowed: take another method, or a model with fewer levels",
            bytes as f64 / f64::from(1 << 30),
            MOST_BYTES >> 30
        )));
    }
    Ok(vec![0.0; numbers])
}

/// A core model with the memory that the method asks for.
fn renewable(model: &Model, method: Method<f64>) -> Result<hysteron_core::Model<f64, Vec<f64>>> {
    let model = model.plain()?;
    let tables = match method {
        Method::Increments { .. } => 2,
        _ => 1,
    };
    let (plane, operator) = (*model.plane(), model.operator());
    let table = vec![0.0; tables * table_len(plane.levels())];
    Ok(hysteron_core::Model::new(
        plane,
        operator,
        model.weights(),
        table,
    )?)
}
