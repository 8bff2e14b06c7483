//! The estimator: it joins a method, its guards and the model whose weights it adapts.

use super::gate::Gate;
use super::increments::Increment;
use super::memory::{Layout, Slices};
use super::trial::Trial;
use super::watch::{Channel, Watch};
use super::{Adaptation, Learning, Method, Outcome, operators, parameters};
use crate::branch::Position;
use crate::branch::Turn;
use crate::error::Error;
use crate::everett;
use crate::memory::Memory;
use crate::model::Model;
use crate::operator::Operator;
use crate::scalar::Real;
use crate::state::State;

/// Adapts the weights of a [`Model`], and an offset beside it, from sample to sample.
///
/// `M` is its memory: `&mut [T]`, an array or a vector with at least [`crate::estimator_len`] or
/// [`crate::estimator_len_of_basis`] elements.
///
/// ```
/// use hysteron_core::{
///     Adaptation, Estimator, Method, Model, Operator, Plane, Turn, estimator_len, table_len,
///     turn_capacity,
/// };
/// const K: usize = 3;
/// let method = Method::LeastSquares {
///     forgetting: 0.98,
///     noise: 0.01,
///     spread: 1.0,
///     correlation: 0.0,
/// };
/// let options = Adaptation { method, ..Adaptation::default() };
/// let plane = Plane::new(20.0, 80.0, K)?;
/// let mut model = Model::new(plane, Operator::Mkp, &[1.0; 6], [0.0; table_len(K)])?;
/// let mut state = model.state([Turn::default(); turn_capacity(K)])?;
/// let memory = vec![0.0; estimator_len(K, method)];
/// let mut estimator = Estimator::new(options, &mut model, &[1.0; 6], 0.0, memory)?;
///
/// // A plant whose output is twice as large.
/// let plant = Model::new(plane, Operator::Mkp, &[2.0; 6], [0.0; table_len(K)])?;
/// let mut there = plant.state([Turn::default(); turn_capacity(K)])?;
/// for n in 0..500 {
///     let input = 50.0 - 40.0 * (0.1 * f64::from(n)).cos();
///     let measured = plant.step(&mut there, input)?.output;
///     estimator.step(&mut model, &mut state, input, measured)?;
/// }
/// let learning = estimator.step(&mut model, &mut state, 80.0, 12.0)?;
/// assert!((learning.output - 12.0).abs() < 0.01); // 6 before it learned
/// # Ok::<(), hysteron_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Estimator<T, M> {
    pub(super) options: Adaptation<T>,
    pub(super) operator: Operator,
    pub(super) levels: usize,
    pub(super) layout: Layout,
    pub(super) memory: M,
    /// The off-line offset. The last parameter is the deviation from it, in units of
    /// `offset_share`.
    pub(super) offset: T,
    /// The position that the operators' states belong to. `None` where they have to be computed
    /// from a state first.
    pub(super) aligned: Option<Position<T>>,
    /// The normalised position of the last sample learned from.
    pub(super) learned: T,
    /// The increment under way, for [`Method::Increments`].
    pub(super) increment: Option<Increment<T>>,
    /// How many rows still have to be written until the table has the present weights, where it is
    /// renewed row by row.
    pub(super) rows_due: usize,
    pub(super) trial: Trial<T>,
    /// The trial of the offset alone, for [`Method::Increments`].
    pub(super) level: Trial<T>,
    pub(super) gate: Gate<T>,
    pub(super) watch: Watch<T>,
    /// The output expected by the off-line weights, but for a constant. Unused with a basis.
    pub(super) expected: T,
    /// Whether the watch took parameters back that the model's table still has.
    pub(super) undone: bool,
    pub(super) frozen: bool,
}

impl<T: Real, M: Memory<T>> Estimator<T, M> {
    /// Moves `state` to `input`, predicts the output there, and learns from the output `measured`.
    ///
    /// `model` has to be the model that the estimator was made with, and nobody else may change its
    /// weights. A state of the model with earlier weights is [rebased](Model::rebase). Outputs
    /// include the offset. [`Method`] has the cost of a step.
    ///
    /// # Errors
    /// [`Error::InputNotFinite`] with index 0 for the input and 1 for the measured output,
    /// [`Error::StateMismatch`] for a model or state of another size or operator, and
    /// [`Error::MemoryTooSmall`] for another model whose table is too small. Nothing is changed
    /// then.
    pub fn step<C, S>(
        &mut self,
        model: &mut Model<T, C>,
        state: &mut State<T, S>,
        input: T,
        measured: T,
    ) -> Result<Learning<T>, Error>
    where
        C: Memory<T>,
        S: Memory<Turn<T>>,
    {
        if !input.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        if !measured.is_finite() {
            return Err(Error::InputNotFinite { index: 1 });
        }
        if model.plane().levels() != self.levels || model.operator() != self.operator {
            return Err(Error::StateMismatch);
        }
        // The caller may have passed another model, without memory for a second table.
        if matches!(self.options.method, Method::Increments { .. }) {
            model.check_renewable()?;
        }
        if model.check(state).is_err() {
            model.rebase(state)?;
        }
        self.align(state);
        let from = state.position();
        let output = model.step(state, input)?;
        self.follow(from, state);
        let above = measured - output.output;
        let offset = self.offset();
        let error = above - offset;
        let outcome = self.judge(state, measured, (above, error));
        let (outcome, changed) = self.renew(model, outcome);
        if changed {
            model.rebase(state)?;
        }
        if outcome.is_of_believed() {
            self.gate
                .settle(measured - model.output(state) - self.offset());
        }
        Ok(Learning {
            output: output.output + offset,
            error,
            outcome,
            clipped: output.clipped,
        })
    }

    /// The parameters: `N` weights, row by row, or the coefficients of the basis. The offset is not
    /// among them.
    #[must_use]
    pub fn parameters(&self) -> &[T] {
        &self.memory.as_ref()[..self.layout.parameters - 1]
    }

    /// The present offset: the output with `H = 0`.
    #[must_use]
    pub fn offset(&self) -> T {
        self.offset + self.options.offset_share * self.memory.as_ref()[self.layout.parameters - 1]
    }

    /// The options.
    #[must_use]
    pub fn options(&self) -> &Adaptation<T> {
        &self.options
    }

    /// Stops learning, or resumes it. A frozen estimator still predicts.
    ///
    /// With [`Method::Increments`], the table still takes up what was learned before.
    pub fn freeze(&mut self, frozen: bool) {
        self.frozen = frozen;
        self.increment = None;
        self.watch.restart();
    }

    /// Whether the estimator is frozen.
    #[must_use]
    pub fn is_frozen(&self) -> bool {
        self.frozen
    }

    /// The channel that stands still while the other one moves: [`Watch`](crate::Watch).
    #[must_use]
    pub fn stuck(&self) -> Option<Channel> {
        self.watch.stuck()
    }

    /// Takes the present parameters as the last good ones and starts a new trial.
    pub fn keep(&mut self) {
        let all = 0..self.layout.parameters;
        self.slices().contest(all).keep();
        self.watch_anew();
        (self.trial, self.level) = (Trial::default(), Trial::default());
    }

    /// Returns to the last good parameters and writes them to `model`.
    pub fn roll_back<C: Memory<T>>(&mut self, model: &mut Model<T, C>) {
        self.take_back();
        self.gate.restart();
        self.watch_anew();
        self.rewrite(model);
    }

    /// Makes the next step compute the operators' states from the turning points.
    ///
    /// A step does so by itself where the state has another position or branch than after the last
    /// step. A call is needed only where others moved the state and brought it back to the same
    /// position and branch.
    pub fn realign(&mut self) {
        self.aligned = None;
    }

    pub(super) fn slices(&mut self) -> Slices<'_, T> {
        self.layout.cut(self.memory.as_mut())
    }

    /// Computes the operators' states from `state`, unless the state did not move since the last
    /// step.
    fn align<S>(&mut self, state: &State<T, S>)
    where
        S: Memory<Turn<T>>,
    {
        if self
            .aligned
            .is_some_and(|position| position.is_at(&state.branch_position()))
        {
            return;
        }
        let levels = self.levels;
        let slices = self.slices();
        if !slices.gamma.is_empty() {
            operators::align(slices.gamma, levels, state);
        }
        self.learned = state.position();
        self.increment = None;
        self.watch_anew();
    }

    /// Starts the watch again, from the present parameters.
    fn watch_anew(&mut self) {
        let slices = self.slices();
        slices.trusted.copy_from_slice(slices.theta);
        slices.pending.copy_from_slice(slices.theta);
        self.expected = T::ZERO;
        self.watch.restart();
    }

    /// Moves the operators' states from position `from` to that of `state`.
    fn follow<S>(&mut self, from: T, state: &State<T, S>)
    where
        S: Memory<Turn<T>>,
    {
        let (levels, operator) = (self.levels, self.operator);
        let Slices { gamma, offline, .. } = self.slices();
        if !gamma.is_empty() {
            let change = operators::follow(gamma, offline, levels, from, state.position());
            let factor = operator.output(T::ONE) - operator.output(T::ZERO);
            self.expected = self.expected + factor * change;
        }
        self.aligned = Some(state.branch_position());
    }

    /// Updates the model's table from the parameters. Returns the outcome of the sample, and
    /// whether the model changed.
    ///
    /// Where the table would not be finite, the last good parameters return.
    fn renew<C: Memory<T>>(
        &mut self,
        model: &mut Model<T, C>,
        outcome: Outcome,
    ) -> (Outcome, bool) {
        let by_rows = matches!(self.options.method, Method::Increments { .. });
        let sound = match outcome {
            Outcome::RolledBack => false,
            _ if core::mem::take(&mut self.undone) => {
                self.rewrite(model);
                return (outcome, true);
            }
            Outcome::Learned if by_rows => {
                // At most the rest of the pass under way, and one whole pass.
                self.rows_due = 2 * self.levels;
                true
            }
            Outcome::Learned => {
                self.rewrite(model);
                let sound = model.is_finite() && self.offset().is_finite();
                if !sound {
                    self.take_back();
                }
                sound
            }
            _ if self.rows_due == 0 => return (outcome, false),
            _ => true,
        };
        if !sound {
            self.rewrite(model);
            return (Outcome::RolledBack, true);
        }
        if !by_rows {
            return (outcome, true);
        }
        self.rows_due -= 1;
        let weights = &*self.slices().theta;
        match model.renew_row(|p, above, row| everett::fill_row(p, weights, above, row)) {
            Ok(changed) => (outcome, changed),
            Err(_) => {
                self.take_back();
                self.rewrite(model);
                (Outcome::RolledBack, true)
            }
        }
    }

    /// Writes the model's whole table from the parameters.
    pub(super) fn rewrite<C: Memory<T>>(&mut self, model: &mut Model<T, C>) {
        let levels = self.levels;
        parameters::rewrite(&self.slices(), levels, model);
        self.rows_due = 0;
    }
}
