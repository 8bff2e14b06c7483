//! The forward model: amortised `O(1)` per sample, independent of the number of levels.

use crate::branch::Turn;
use crate::error::{Error, NegativeWeights};
use crate::everett::{self, Grid};
use crate::memory::Memory;
use crate::operator::Operator;
use crate::plane::{Clipped, Plane};
use crate::scalar::Real;
use crate::state::State;

/// A model ready to run. It is constant while it runs; what changes is a [`State`].
///
/// `C` is the memory for the Everett table: `&mut [T]`, an array or a vector with at least
/// [`crate::table_len`] elements.
///
/// ```
/// use hysteron_core::{Model, Operator, Plane, Turn, table_len, turn_capacity};
/// const K: usize = 3;
/// let plane = Plane::new(20.0, 80.0, K)?;
/// let weights = [1.0, 0.5, 1.0, 0.0, 0.5, 1.0]; // row by row: j = 1…K, i = 1…j
/// let model = Model::new(plane, Operator::Mkp, &weights, [0.0; table_len(K)])?;
/// let mut state = model.state([Turn::default(); turn_capacity(K)])?;
/// assert_eq!(model.step(&mut state, 80.0)?.output, 4.0);
/// let cooled = model.step(&mut state, 50.0)?;
/// assert_eq!(cooled.output, 3.0); // operator (3, 3) is off again
/// assert_eq!(cooled.clipped, None);
/// # Ok::<(), hysteron_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Model<T, C> {
    plane: Plane<T>,
    operator: Operator,
    pub(crate) table: C,
    pub(crate) negative: Option<NegativeWeights>,
    /// Identifies the model, because a state has outputs of the model that made it.
    pub(crate) stamp: u64,
    /// Index at which the table in use begins. A model that is renewed row by row has two tables.
    pub(crate) base: usize,
    /// The next row to renew in the other table, from 1.
    pub(crate) renewed: usize,
}

/// The result of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output<T> {
    /// `H = Σ μ_ij γ_ij`, with the operators' own outputs.
    pub output: T,
    /// The end of the plane that the input lay beyond; `None` within the active range.
    pub clipped: Option<Clipped>,
}

/// How many samples of an array lay outside the plane's active range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ClippedCount {
    /// Below `T_min − ΔT`.
    pub low: usize,
    /// Above `T_max`.
    pub high: usize,
}

impl<T: Real, C: Memory<T>> Model<T, C> {
    /// Builds the Everett table of `weights` in `table`. `O(K²)`.
    ///
    /// There are `N = K(K + 1)/2` weights, row by row ([`operators`](crate::operators)), in the
    /// output's unit. They may be negative; such a model has no inverse.
    ///
    /// # Errors
    /// [`Error::WeightCount`] for another number of weights, [`Error::WeightNotFinite`] for a
    /// weight or a sum of weights that is not finite, [`Error::MemoryTooSmall`] for a `table` with
    /// fewer than [`crate::table_len`] elements.
    pub fn new(
        plane: Plane<T>,
        operator: Operator,
        weights: &[T],
        mut table: C,
    ) -> Result<Self, Error> {
        let levels = plane.levels();
        let negative = everett::check(levels, weights)?;
        let needed = everett::table_len(levels);
        let found = table.as_ref().len();
        if found < needed {
            return Err(Error::MemoryTooSmall { needed, found });
        }
        everett::fill(levels, weights, table.as_mut());
        let used = table.as_ref()[..needed].iter();
        let stamp = stamp(operator, used.chain([&plane.min(), &plane.max()]));
        Ok(Self {
            plane,
            operator,
            table,
            negative,
            stamp,
            base: 0,
            renewed: 1,
        })
    }
}

impl<T: Real, C: AsRef<[T]>> Model<T, C> {
    /// The plane.
    #[must_use]
    pub fn plane(&self) -> &Plane<T> {
        &self.plane
    }

    /// The elementary operator.
    #[must_use]
    pub fn operator(&self) -> Operator {
        self.operator
    }

    /// Which weights are below zero; `None` for none.
    #[must_use]
    pub fn negative_weights(&self) -> Option<NegativeWeights> {
        self.negative
    }

    /// The outputs with every operator off and with every operator on, in this order.
    #[must_use]
    pub fn output_range(&self) -> (T, T) {
        (self.outward(T::ZERO), self.outward(self.total()))
    }

    /// A state with every operator off, over memory for at least [`crate::turn_capacity`] turning
    /// points.
    ///
    /// # Errors
    /// [`Error::MemoryTooSmall`] for fewer elements.
    pub fn state<S>(&self, memory: S) -> Result<State<T, S>, Error>
    where
        S: Memory<Turn<T>>,
    {
        State::new(&self.plane, self.operator, self.stamp, memory)
    }

    /// Switches every operator off. The input is then the bottom of the plane, `T_min − ΔT`.
    ///
    /// The state may be that of another model with the same number of levels and the same operator.
    ///
    /// # Errors
    /// [`Error::StateMismatch`] for a state of another size or operator.
    pub fn reset_off<S>(&self, state: &mut State<T, S>) -> Result<(), Error>
    where
        S: Memory<Turn<T>>,
    {
        self.fits(state)?;
        state.reset_off(&self.plane, self.stamp);
        Ok(())
    }

    /// Switches every operator on (saturation). The input is then `T_max`.
    ///
    /// # Errors
    /// As [`Model::reset_off`].
    pub fn reset_on<S>(&self, state: &mut State<T, S>) -> Result<(), Error>
    where
        S: Memory<Turn<T>>,
    {
        self.reset_off(state)?;
        self.step(state, self.plane.max())?;
        Ok(())
    }

    /// Rebuilds a state from its `turning_points` ([`State::turning_points`]) and its `input`
    /// ([`State::input`]).
    ///
    /// They may come from this model or from one with other weights on the same plane.
    ///
    /// # Errors
    /// [`Error::StateMismatch`], [`Error::InputNotFinite`], and [`Error::TurningPoints`] for points
    /// that are not finite, leave `[0, K]` or do not nest. The state then stays as it is.
    pub fn restore<S>(
        &self,
        state: &mut State<T, S>,
        turning_points: &[T],
        input: T,
    ) -> Result<(), Error>
    where
        S: Memory<Turn<T>>,
    {
        self.fits(state)?;
        if !input.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        let (mut low, mut high) = (T::ZERO, T::from_index(self.plane.levels()));
        for (index, &x) in turning_points.iter().enumerate() {
            // Written so that NaN fails the comparison.
            if !(low <= x && x <= high) {
                return Err(Error::TurningPoints { index });
            }
            if index % 2 == 0 { high = x } else { low = x }
        }
        state.reset_off(&self.plane, self.stamp);
        state.travel(self.table(), T::ZERO, input);
        for &x in turning_points {
            // No −0: positions are compared by their bits.
            state.travel(self.table(), x.max(T::ZERO), input);
        }
        Ok(())
    }

    /// Moves to `input` and returns the output.
    ///
    /// Amortised `O(1)`; a single step passes at most `2K` corners. Inputs beyond the plane act as
    /// its ends.
    ///
    /// # Errors
    /// [`Error::InputNotFinite`] for NaN and infinity, [`Error::StateMismatch`] for a state of
    /// another model. The state then stays as it is.
    #[inline]
    pub fn step<S>(&self, state: &mut State<T, S>, input: T) -> Result<Output<T>, Error>
    where
        S: Memory<Turn<T>>,
    {
        self.check(state)?;
        if !input.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        let sum = state.step(&self.plane, self.table(), input);
        Ok(Output {
            output: self.outward(sum),
            clipped: self.plane.clipped(input),
        })
    }

    /// Steps through `input` and writes as many outputs to the first elements of `output`.
    ///
    /// Returns how many inputs lay beyond each end of the plane.
    ///
    /// # Errors
    /// As [`Model::step`], and [`Error::MemoryTooSmall`] where `output` is shorter than `input`.
    /// State and `output` then stay as they are.
    pub fn run<S>(
        &self,
        state: &mut State<T, S>,
        input: &[T],
        output: &mut [T],
    ) -> Result<ClippedCount, Error>
    where
        S: Memory<Turn<T>>,
    {
        self.check(state)?;
        let found = output.len();
        let Some(output) = output.get_mut(..input.len()) else {
            let needed = input.len();
            return Err(Error::MemoryTooSmall { needed, found });
        };
        // One pass without an early exit, so that the compiler can vectorise it.
        let mut count = ClippedCount::default();
        let mut finite = true;
        for &t in input {
            finite &= t.is_finite();
            count.low += usize::from(t < self.plane.bottom());
            count.high += usize::from(t > self.plane.max());
        }
        if !finite {
            let index = input.iter().position(|t| !t.is_finite()).unwrap_or(0);
            return Err(Error::InputNotFinite { index });
        }
        // The sum of the operators' outputs is linear in `Σ μ γ`: one gain and one offset for all.
        let (gain, offset) = self.outward_line();
        state.run(&self.plane, self.table(), input, output, |y| {
            gain * y + offset
        });
        Ok(count)
    }

    /// The output at the state's present position.
    #[must_use]
    pub fn output<S>(&self, state: &State<T, S>) -> T
    where
        S: Memory<Turn<T>>,
    {
        self.outward(state.branch_position().y)
    }

    /// The slope of the output over the input along the present branch, per unit of the input.
    ///
    /// It is exact: the output is piecewise linear along a branch. Between two pieces it is the slope
    /// of the next one. It is zero beyond the plane. The output of relays is a staircase; its slope
    /// is that from the last level or to the next one, whichever is larger.
    ///
    /// ```
    /// use hysteron_core::{Model, Operator, Plane, Turn, table_len, turn_capacity};
    /// let plane = Plane::new(1.0, 2.0, 2)?; // from 0 to 2
    /// let model = Model::new(plane, Operator::Mkp, &[1.0, 0.0, 3.0], [0.0; table_len(2)])?;
    /// let mut state = model.state([Turn::default(); turn_capacity(2)])?;
    /// model.step(&mut state, 0.5)?;
    /// assert_eq!(model.slope(&state), 1.0);
    /// model.step(&mut state, 1.5)?;
    /// assert_eq!(model.slope(&state), 3.0);
    /// # Ok::<(), hysteron_core::Error>(())
    /// ```
    #[must_use]
    pub fn slope<S>(&self, state: &State<T, S>) -> T
    where
        S: Memory<Turn<T>>,
    {
        if self.plane.clipped(state.input()).is_some() {
            return T::ZERO;
        }
        let (table, levels) = (self.table(), self.plane.levels());
        let (gain, _) = self.outward_line();
        let (grid, position) = (Grid { table, levels }, state.branch_position());
        let slope = match self.operator {
            Operator::Mkp | Operator::Kp => position.slope(grid),
            Operator::Relay => position.step_of_relays(grid),
        };
        gain * slope * self.plane.per_unit()
    }

    /// The Everett table, ordered by [`crate::table_index`].
    ///
    /// It has at least [`crate::table_len`] elements; elements beyond these have no meaning.
    #[must_use]
    pub fn table(&self) -> &[T] {
        &self.table.as_ref()[self.base..]
    }

    pub(crate) fn grid(&self) -> Grid<'_, T> {
        Grid {
            table: self.table(),
            levels: self.plane.levels(),
        }
    }

    /// `Σ μ_ij`, the sum of all weights.
    #[must_use]
    pub fn total(&self) -> T {
        self.table()[everett::table_index(self.plane.levels(), 0)]
    }

    /// The output `H` from `sum`, which is `Σ μ γ`.
    #[inline(always)]
    pub(crate) fn outward(&self, sum: T) -> T {
        let (gain, offset) = self.outward_line();
        gain * sum + offset
    }

    /// Gain and offset from `Σ μ γ` to `H`. The output of an operator is `γ` or `2γ − 1`.
    #[inline(always)]
    fn outward_line(&self) -> (T, T) {
        match self.operator {
            Operator::Mkp => (T::ONE, T::ZERO),
            Operator::Kp | Operator::Relay => (T::ONE + T::ONE, -self.total()),
        }
    }

    #[inline(always)]
    pub(crate) fn check<S>(&self, state: &State<T, S>) -> Result<(), Error>
    where
        S: Memory<Turn<T>>,
    {
        if state.stamp() == self.stamp {
            self.fits(state)
        } else {
            Err(Error::StateMismatch)
        }
    }

    /// Tells apart the weights that the model had.
    pub(crate) fn stamp(&self) -> u64 {
        self.stamp
    }

    /// Checks that a state has the model's number of levels and operator.
    #[inline(always)]
    pub(crate) fn fits<S>(&self, state: &State<T, S>) -> Result<(), Error>
    where
        S: Memory<Turn<T>>,
    {
        if state.levels() == self.plane.levels() && state.operator() == self.operator {
            Ok(())
        } else {
            Err(Error::StateMismatch)
        }
    }
}

/// A hash of the model: FNV-1a over whole numbers in place of bytes, which is faster. Different
/// models have the same stamp with a probability of about 2⁻⁶⁴.
fn stamp<'a, T: Real + 'a>(operator: Operator, numbers: impl Iterator<Item = &'a T>) -> u64 {
    let start = 0xcbf2_9ce4_8422_2325 ^ operator as u64;
    numbers.fold(start, |hash, number| {
        (hash ^ number.bits())
            .wrapping_mul(0x0000_0100_0000_01b3)
            .rotate_left(29)
    })
}
