//! The estimator: a method, its guards, and the model that it keeps up to date.

use super::increments::Increment;
use super::least_squares::{self, Law};
use super::memory::{Layout, Slices};
use super::trial::{Trial, Verdict};
use super::{Adaptation, Method, gradient, operators, trial};
use crate::everett;
use crate::plane::{operator_count, operator_index};
use crate::state::{State, Turn};
use crate::{Clipped, Error, Model, Operator, Real};

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
/// assert!((learning.output - 12.0).abs() < 1e-3); // 6 before it learned
/// # Ok::<(), hysteron_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Estimator<T, M> {
    options: Adaptation<T>,
    operator: Operator,
    levels: usize,
    layout: Layout,
    memory: M,
    /// The off-line one; how it differs now, in units of its share, is the last parameter.
    offset: T,
    /// Where the operators' states stand; none where they have to be taken from a state first.
    position: Option<T>,
    /// Middle of the play that the input has to overcome.
    play: T,
    increment: Option<Increment<T>>,
    trial: Trial<T>,
    frozen: bool,
}

/// What a sample taught.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Learning<T> {
    /// Output that was expected before anything was learned from the sample.
    pub output: T,
    /// Measured less expected.
    pub error: T,
    /// What was done with it.
    pub outcome: Outcome,
    /// Whether the input lay outside the plane, and at which end.
    pub clipped: Option<Clipped>,
}

/// What an estimator did with a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The weights moved.
    Learned,
    /// The error was within the dead zone, or an increment is not finished.
    Waiting,
    /// The input did not move: no excitation.
    AtRest,
    /// The estimator is frozen.
    Frozen,
    /// The weights did far worse than the last good ones, or were no numbers any more: these are back.
    RolledBack,
}

impl<T: Real, M: AsRef<[T]> + AsMut<[T]>> Estimator<T, M> {
    /// An estimator of all weights and the offset, from the off-line ones, which `model` is given too.
    ///
    /// # Errors
    /// [`Error::Adaptation`], [`Error::WeightCount`], [`Error::WeightNotFinite`], [`Error::NegativeWeights`];
    /// [`Error::InputNotFinite`] for the offset; [`Error::MemoryTooSmall`] for `memory` and, with [`Method::Increments`], for
    /// the model's table, which has to be twice as large.
    pub fn new<C: AsRef<[T]> + AsMut<[T]>>(
        options: Adaptation<T>,
        model: &mut Model<T, C>,
        weights: &[T],
        offset: T,
        memory: M,
    ) -> Result<Self, Error> {
        let layout = Layout::all(model.plane().levels(), options.method);
        let mut estimator = Self::empty(options, model, layout, memory)?;
        if matches!(options.method, Method::Increments { .. }) {
            model.check_renewable()?;
        }
        refuse_negative(model.plane().levels(), weights)?;
        model.set_weights(weights)?;
        estimator.begin(weights, offset)?;
        Ok(estimator)
    }

    /// An estimator of the shares of `parts`, which stand for the ways in which weights can change (loads, drift), and the offset:
    /// `μ = Σ_k shares_k parts_k`. `parts` holds `N` weights for each of the shares, one part after the other. A
    /// step is `O(P K²)` for the table.
    ///
    /// # Errors
    /// As [`Estimator::new`]; [`Error::Adaptation`] for [`Method::Increments`], for a correlation,
    /// and for shares that are negative or not finite.
    pub fn of_parts<C: AsRef<[T]> + AsMut<[T]>>(
        options: Adaptation<T>,
        model: &mut Model<T, C>,
        parts: &[T],
        shares: &[T],
        offset: T,
        memory: M,
    ) -> Result<Self, Error> {
        let levels = model.plane().levels();
        let (n, count) = (operator_count(levels), shares.len());
        let unfit = match options.method {
            Method::Increments { .. } => Some("method"),
            Method::LeastSquares { correlation, .. } if correlation != T::ZERO => {
                Some("correlation")
            }
            _ => None,
        };
        let bad_share = |share: &T| !(*share >= T::ZERO && share.is_finite());
        let unfit = unfit.or((count == 0 || shares.iter().any(bad_share)).then_some("shares"));
        if let Some(option) = unfit {
            return Err(Error::Adaptation { option });
        }
        if parts.len() != n * count {
            let (expected, found) = (n * count, parts.len());
            return Err(Error::WeightCount { expected, found });
        }
        let layout = Layout::parts(levels, options.method, count);
        let mut estimator = Self::empty(options, model, layout, memory)?;
        let tables = layout.cut(estimator.memory.as_mut()).tables;
        let each = parts
            .chunks(n)
            .zip(tables.chunks_mut(everett::table_len(levels)));
        for (part, table) in each {
            refuse_negative(levels, part)?;
            everett::fill(levels, part, table);
        }
        estimator.begin(shares, offset)?;
        estimator.rewrite(model);
        Ok(estimator)
    }

    fn empty<C: AsRef<[T]>>(
        options: Adaptation<T>,
        model: &Model<T, C>,
        layout: Layout,
        memory: M,
    ) -> Result<Self, Error> {
        options.check()?;
        let (needed, found) = (layout.len(), memory.as_ref().len());
        if found < needed {
            return Err(Error::MemoryTooSmall { needed, found });
        }
        Ok(Self {
            options,
            operator: model.operator(),
            levels: model.plane().levels(),
            layout,
            memory,
            offset: T::ZERO,
            position: None,
            play: T::ZERO,
            increment: None,
            trial: Trial::default(),
            frozen: false,
        })
    }

    fn begin(&mut self, parameters: &[T], offset: T) -> Result<(), Error> {
        if !offset.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        self.offset = offset;
        let slices = self.layout.cut(self.memory.as_mut());
        let n = parameters.len();
        slices.theta[..n].copy_from_slice(parameters);
        slices.theta[n] = T::ZERO;
        slices.offline.copy_from_slice(slices.theta);
        slices.good.copy_from_slice(slices.theta);
        self.reset_covariance();
        Ok(())
    }

    /// Moves `state` to `input`, tells the output that `model` expects there, and learns from the one `measured`.
    ///
    /// The outputs include the offset. A state of the model with earlier weights is [rebased](Model::rebase). Cost: [`Method`]. Where the state was moved by others since the last call, the
    /// operators' states are worked out from its turning points, `O(K²)` for each of them.
    ///
    /// # Errors
    /// [`Error::InputNotFinite`] with index 0 for the input and 1 for the output, [`Error::StateMismatch`];
    /// nothing is changed then.
    pub fn step<C, S>(
        &mut self,
        model: &mut Model<T, C>,
        state: &mut State<T, S>,
        input: T,
        measured: T,
    ) -> Result<Learning<T>, Error>
    where
        C: AsRef<[T]> + AsMut<[T]>,
        S: AsRef<[Turn<T>]> + AsMut<[Turn<T>]>,
    {
        if !measured.is_finite() {
            return Err(Error::InputNotFinite { index: 1 });
        }
        if model.plane().levels() != self.levels || model.operator() != self.operator {
            return Err(Error::StateMismatch);
        }
        if !input.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        if model.check(state).is_err() {
            model.rebase(state)?;
        }
        self.start_from(state);
        let output = model.step(state, input)?;
        self.follow(state);
        let expected = output.output + self.offset();
        let error = measured - expected;
        let moved = self.moves(state.position());
        let outcome = if self.frozen {
            Outcome::Frozen
        } else {
            match self.options.method {
                Method::Increments { gain, span } => {
                    self.learn_increment((state.position(), moved), (measured, error), (gain, span))
                }
                _ if !moved => Outcome::AtRest,
                _ => self.learn(state, measured, error),
            }
        };
        if self.renew(model, outcome) {
            model.rebase(state)?;
        }
        Ok(Learning {
            output: expected,
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

    /// While frozen, the model predicts and nothing is learned.
    pub fn freeze(&mut self, frozen: bool) {
        self.frozen = frozen;
    }

    /// Whether the estimator is frozen.
    #[must_use]
    pub fn is_frozen(&self) -> bool {
        self.frozen
    }

    /// Takes the present weights as the last good ones.
    pub fn keep(&mut self) {
        trial::keep(&mut self.layout.cut(self.memory.as_mut()));
        self.trial = Trial::default();
    }

    /// Goes back to the last good weights.
    pub fn roll_back<C: AsRef<[T]> + AsMut<[T]>>(&mut self, model: &mut Model<T, C>) {
        self.take_back();
        self.rewrite(model);
    }

    /// Makes the next step work out the operators' states anew: needed where a state was reset or restored to the very position
    /// it had.
    pub fn realign(&mut self) {
        self.position = None;
    }

    fn start_from<S>(&mut self, state: &State<T, S>)
    where
        S: AsRef<[Turn<T>]> + AsMut<[Turn<T>]>,
    {
        let position = state.position();
        if self.position == Some(position) {
            return;
        }
        let slices = self.layout.cut(self.memory.as_mut());
        if !slices.gamma.is_empty() {
            operators::align(slices.gamma, self.levels, state);
        }
        self.play = position;
        self.position = Some(position);
        self.increment = None;
    }

    fn follow<S>(&mut self, state: &State<T, S>)
    where
        S: AsRef<[Turn<T>]> + AsMut<[Turn<T>]>,
    {
        let slices = self.layout.cut(self.memory.as_mut());
        if let (Some(last), false) = (self.position, slices.gamma.is_empty()) {
            operators::follow(slices.gamma, self.levels, last, state.position());
        }
        self.position = Some(state.position());
    }

    /// Whether the input pushes against its play: without that, a sample is the same equation again.
    fn moves(&mut self, position: T) -> bool {
        let half = self.options.movement;
        let play = self.play;
        self.play = play.limited(position - half, position + half);
        self.play != play
    }

    /// What an error beyond the dead zone counts.
    fn beyond(&self, error: T) -> T {
        let zone = self.options.dead_zone;
        error - error.limited(-zone, zone)
    }

    fn learn<S>(&mut self, state: &State<T, S>, measured: T, error: T) -> Outcome
    where
        S: AsRef<[Turn<T>]> + AsMut<[Turn<T>]>,
    {
        let counted = self.beyond(error);
        let Adaptation {
            method,
            offset_share,
            leakage,
            trial,
            ..
        } = self.options;
        let mut slices = self.layout.cut(self.memory.as_mut());
        regressor(&mut slices, self.operator, self.levels, offset_share, state);
        let good = slices.good.iter().zip(&*slices.phi);
        let good = good.fold(measured - self.offset, |rest, (&good, &phi)| {
            rest - good * phi
        });
        let verdict = self.trial.judge(error, good, trial);
        let done = counted != T::ZERO;
        let mut sane = true;
        if done {
            match method {
                Method::LeastSquares {
                    forgetting, noise, ..
                } => {
                    let law = Law {
                        forgetting,
                        variance: noise * noise,
                    };
                    sane = law.update(&mut slices, counted, leakage);
                    least_squares::project(&mut slices);
                }
                Method::Gradient { gain } | Method::Increments { gain, .. } => {
                    gradient::update(&mut slices, counted, gain, leakage);
                    gradient::project(slices.theta);
                }
            }
        }
        let size = slices
            .theta
            .iter()
            .fold(T::ZERO, |sum, &theta| sum + theta.larger(-theta));
        if !(size + size).is_finite() || verdict == Verdict::RollBack {
            self.take_back();
            return Outcome::RolledBack;
        }
        if !sane {
            self.reset_covariance();
        }
        if verdict == Verdict::Keep {
            trial::keep(&mut self.layout.cut(self.memory.as_mut()));
        }
        if done {
            Outcome::Learned
        } else {
            Outcome::Waiting
        }
    }

    fn learn_increment(
        &mut self,
        (position, moved): (T, bool),
        (measured, error): (T, T),
        (gain, span): (T, T),
    ) -> Outcome {
        let (operator, levels) = (self.operator, self.levels);
        let Adaptation {
            offset_share,
            leakage,
            trial,
            ..
        } = self.options;
        let level = self.beyond(error);
        let mut slices = self.layout.cut(self.memory.as_mut());
        if moved && offset_share > T::ZERO {
            // As in the gradient with every operator on.
            let share = offset_share * offset_share;
            let norm = share + T::from_index(operator_count(levels));
            let n = slices.theta.len() - 1;
            slices.theta[n] = slices.theta[n] + gain * level * offset_share / norm;
        }
        let Some(increment) = &mut self.increment else {
            slices.anchor.copy_from_slice(slices.gamma);
            self.increment = Some(Increment::start(measured, position));
            return Outcome::Waiting;
        };
        if !increment.extend(position, span) {
            return if moved {
                Outcome::Waiting
            } else {
                Outcome::AtRest
            };
        }
        let finished = increment.finish(&slices, operator, levels, measured);
        self.increment = Some(Increment::start(measured, position));
        let counted = finished.error
            - finished
                .error
                .limited(-self.options.dead_zone, self.options.dead_zone);
        let verdict = self.trial.judge(finished.error, finished.good, trial);
        finished.update(&mut slices, operator, levels, counted, (gain, leakage));
        finished.close(&mut slices, levels);
        match verdict {
            Verdict::RollBack => {
                trial::roll_back(&mut slices);
                return Outcome::RolledBack;
            }
            Verdict::Keep => trial::keep(&mut slices),
            Verdict::Open => {}
        }
        if counted != T::ZERO {
            Outcome::Learned
        } else {
            Outcome::Waiting
        }
    }

    fn take_back(&mut self) {
        trial::roll_back(&mut self.layout.cut(self.memory.as_mut()));
        self.trial = Trial::default();
        self.reset_covariance();
    }

    /// Lets the model's table follow the parameters; says whether the model changed.
    fn renew<C: AsRef<[T]> + AsMut<[T]>>(
        &mut self,
        model: &mut Model<T, C>,
        outcome: Outcome,
    ) -> bool {
        if matches!(self.options.method, Method::Increments { .. }) {
            let weights = &*self.layout.cut(self.memory.as_mut()).theta;
            return model.renew_row(|p, above, row| everett::fill_row(p, weights, above, row));
        }
        let changed = matches!(outcome, Outcome::Learned | Outcome::RolledBack);
        if changed {
            self.rewrite(model);
        }
        changed
    }

    fn rewrite<C: AsRef<[T]> + AsMut<[T]>>(&mut self, model: &mut Model<T, C>) {
        let levels = self.levels;
        let Slices { theta, tables, .. } = self.layout.cut(self.memory.as_mut());
        if tables.is_empty() {
            model.rewrite(|p, above, row| everett::fill_row(p, theta, above, row));
            return;
        }
        let len = everett::table_len(levels);
        model.rewrite(|p, _, row| {
            row.fill(T::ZERO);
            for (&share, table) in theta.iter().zip(tables.chunks(len)) {
                let part = &table[everett::table_index(p, 0)..];
                for (entry, &part) in row.iter_mut().zip(part) {
                    *entry = *entry + share * part;
                }
            }
        });
    }

    fn reset_covariance(&mut self) {
        let Method::LeastSquares {
            spread,
            correlation,
            ..
        } = self.options.method
        else {
            return;
        };
        let levels = self.levels;
        let variance = spread * spread;
        let mut slices = self.layout.cut(self.memory.as_mut());
        let weights = slices.theta.len() - 1;
        let all = slices.tables.is_empty();
        least_squares::reset(&mut slices, |a, b| {
            if a == b {
                variance
            } else if all && correlation > T::ZERO && a < weights {
                let distance: T = distance_squared(a, b, levels);
                variance / (T::ONE + distance / (correlation * correlation))
            } else {
                T::ZERO
            }
        });
    }
}

fn refuse_negative<T: Real>(levels: usize, weights: &[T]) -> Result<(), Error> {
    match everett::check(levels, weights)? {
        Some(which) => Err(Error::NegativeWeights(which)),
        None => Ok(()),
    }
}

/// Writes the derivative of the output with respect to each parameter.
fn regressor<T, S>(
    slices: &mut Slices<'_, T>,
    operator: Operator,
    levels: usize,
    offset_share: T,
    state: &State<T, S>,
) where
    T: Real,
    S: AsRef<[Turn<T>]> + AsMut<[Turn<T>]>,
{
    let n = slices.phi.len() - 1;
    slices.phi[n] = offset_share;
    if slices.tables.is_empty() {
        operators::outputs(operator, slices.gamma, &mut slices.phi[..n]);
        return;
    }
    let len = everett::table_len(levels);
    slices.phi[..n].fill(T::ZERO);
    state.everett_terms(|index, factor| {
        for (phi, table) in slices.phi.iter_mut().zip(slices.tables.chunks(len)) {
            *phi = *phi + factor * table[index];
        }
    });
    // From Σ μ γ to the sum of the operators' own outputs.
    let total = everett::table_index(levels, 0);
    for (phi, table) in slices.phi.iter_mut().zip(slices.tables.chunks(len)) {
        *phi = match operator {
            Operator::Mkp => *phi,
            Operator::Kp | Operator::Relay => *phi + *phi - table[total],
        };
    }
}

/// Square of the distance of two operators on the plane, in levels.
fn distance_squared<T: Real>(a: usize, b: usize, levels: usize) -> T {
    let place = |n: usize| {
        let j = (1..=levels)
            .rev()
            .find(|&j| operator_index(1, j) <= n)
            .unwrap_or(1);
        (n - operator_index(1, j), j)
    };
    let ((i, j), (k, l)) = (place(a), place(b));
    let along = T::from_index(i.abs_diff(k));
    let across = T::from_index(j.abs_diff(l));
    along * along + across * across
}
