//! The estimator: a method, its guards, and the model that it keeps up to date.

use super::gate::Gate;
use super::increments::Increment;
use super::memory::{Layout, Slices};
use super::trial::Trial;
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
/// `M` is its memory: `&mut [T]`, an array or a vector with at least [`crate::estimator_len`] numbers.
///
/// ```
/// use hysteron_core::{
///     Adaptation, Estimator, Method, Model, Operator, Plane, Turn, estimator_len, table_len, turn_capacity,
/// };
/// const K: usize = 3;
/// let method = Method::LeastSquares { forgetting: 0.98, noise: 0.01, spread: 1.0, correlation: 0.0 };
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
    /// The off-line one; how it differs now, in units of its share, is the last parameter.
    pub(super) offset: T,
    /// `c` of the gradient.
    pub(super) floor: T,
    /// Where the operators' states stand; none where they have to be taken from a state first.
    pub(super) aligned: Option<Position<T>>,
    /// The position last learned from.
    pub(super) learned: T,
    pub(super) increment: Option<Increment<T>>,
    /// Rows of the table that do not have the present weights yet, where it is renewed row by row.
    pub(super) rows_due: usize,
    pub(super) trial: Trial<T>,
    /// That of the offset alone, where it is learned apart.
    pub(super) level: Trial<T>,
    pub(super) gate: Gate<T>,
    pub(super) frozen: bool,
}

impl<T: Real, M: Memory<T>> Estimator<T, M> {
    /// Moves `state` to `input`, tells the output that `model` expects there, and learns from the one `measured`.
    ///
    /// `model` is the one that the estimator was made with; others leave its weights alone. The outputs include the offset. A
    /// state of the model with earlier weights is [rebased](Model::rebase). Cost: [`Method`].
    ///
    /// # Errors
    /// [`Error::InputNotFinite`] with index 0 for the input and 1 for the output, [`Error::StateMismatch`], and
    /// [`Error::MemoryTooSmall`] for the table of another model than its own; nothing is changed then.
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
        // It may be another model than the one that the estimator was made with.
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

    /// The parameters: `N` weights, row by row, or the shares of the parts.
    #[must_use]
    pub fn parameters(&self) -> &[T] {
        &self.memory.as_ref()[..self.layout.parameters - 1]
    }

    /// Output with `H = 0`.
    #[must_use]
    pub fn offset(&self) -> T {
        self.offset + self.options.offset_share * self.memory.as_ref()[self.layout.parameters - 1]
    }

    /// The options.
    #[must_use]
    pub fn options(&self) -> &Adaptation<T> {
        &self.options
    }

    /// While frozen, the model predicts and nothing is learned. What increments taught before still comes to the table.
    pub fn freeze(&mut self, frozen: bool) {
        self.frozen = frozen;
        self.increment = None;
    }

    /// Whether the estimator is frozen.
    #[must_use]
    pub fn is_frozen(&self) -> bool {
        self.frozen
    }

    /// Takes the present weights as the last good ones.
    pub fn keep(&mut self) {
        let all = 0..self.layout.parameters;
        self.slices().contest(all).keep();
        (self.trial, self.level) = (Trial::default(), Trial::default());
    }

    /// Goes back to the last good weights.
    pub fn roll_back<C: Memory<T>>(&mut self, model: &mut Model<T, C>) {
        self.take_back();
        self.gate.restart();
        self.rewrite(model);
    }

    /// Makes the next step work out the operators' states anew. It does so by itself where it finds the state on another
    /// branch or at another position than it left it: only a state that others brought back to the very same, by another way,
    /// needs this.
    pub fn realign(&mut self) {
        self.aligned = None;
    }

    pub(super) fn slices(&mut self) -> Slices<'_, T> {
        self.layout.cut(self.memory.as_mut())
    }

    /// Takes the operators' states from `state`, unless it is where it was left.
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
    }

    fn follow<S>(&mut self, from: T, state: &State<T, S>)
    where
        S: Memory<Turn<T>>,
    {
        let levels = self.levels;
        let slices = self.slices();
        if !slices.gamma.is_empty() {
            operators::follow(slices.gamma, levels, from, state.position());
        }
        self.aligned = Some(state.branch_position());
    }

    /// Lets the model's table follow the parameters, and takes them back where it would not be one of numbers; says what
    /// came of the sample, and whether the model changed.
    fn renew<C: Memory<T>>(
        &mut self,
        model: &mut Model<T, C>,
        outcome: Outcome,
    ) -> (Outcome, bool) {
        let by_rows = matches!(self.options.method, Method::Increments { .. });
        let sound = match outcome {
            Outcome::RolledBack => false,
            Outcome::Learned if by_rows => {
                // What is left of the pass under way, at most, and a whole one.
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

    pub(super) fn rewrite<C: Memory<T>>(&mut self, model: &mut Model<T, C>) {
        let levels = self.levels;
        parameters::rewrite(&self.slices(), levels, model);
        self.rows_due = 0;
    }
}
