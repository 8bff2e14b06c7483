//! The forward model, `O(1)` per sample whatever the number of levels.

use crate::branch::Turn;
use crate::error::{Error, NegativeWeights};
use crate::everett;
use crate::memory::Memory;
use crate::operator::Operator;
use crate::plane::{Clipped, Plane};
use crate::scalar::Real;
use crate::state::State;

/// A model ready to run: the configuration apart from the [`State`].
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
    /// Tells models apart, for a state holds outputs of the one that made it.
    pub(crate) stamp: u64,
    /// Where the table in use begins: a model that is renewed row by row has room for two.
    pub(crate) base: usize,
    /// The next row to renew in the other table, from 1.
    pub(crate) renewed: usize,
}

/// What one step gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output<T> {
    /// `H = Σ μ_ij γ_ij`, with the operator's own outputs.
    pub output: T,
    /// Whether the input lay outside the plane, and at which end.
    pub clipped: Option<Clipped>,
}

/// How many samples of an array lay outside the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ClippedCount {
    /// Below `T_min − ΔT`.
    pub low: usize,
    /// Above `T_max`.
    pub high: usize,
}

impl<T: Real, C: Memory<T>> Model<T, C> {
    /// Builds the Everett table of `weights` (`N = K(K + 1)/2`, row by row: `j = 1…K`, `i = 1…j`) in `table`. `O(K²)`.
    ///
    /// # Errors
    /// [`Error::WeightCount`], [`Error::WeightNotFinite`], [`Error::MemoryTooSmall`].
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

    /// The weights below zero, if there are any.
    #[must_use]
    pub fn negative_weights(&self) -> Option<NegativeWeights> {
        self.negative
    }

    /// The outputs with every operator off and with every operator on.
    #[must_use]
    pub fn output_range(&self) -> (T, T) {
        (self.outward(T::ZERO), self.outward(self.total()))
    }

    /// A state with every operator off, over memory for at least [`crate::turn_capacity`] turning points.
    ///
    /// # Errors
    /// [`Error::MemoryTooSmall`].
    pub fn state<S>(&self, memory: S) -> Result<State<T, S>, Error>
    where
        S: Memory<Turn<T>>,
    {
        State::new(&self.plane, self.operator, self.stamp, memory)
    }

    /// Every operator off, the input at the bottom of the plane. The state may have been that of
    /// another model of the same levels and operator.
    ///
    /// # Errors
    /// [`Error::StateMismatch`].
    pub fn reset_off<S>(&self, state: &mut State<T, S>) -> Result<(), Error>
    where
        S: Memory<Turn<T>>,
    {
        self.fits(state)?;
        state.reset_off(&self.plane, self.stamp);
        Ok(())
    }

    /// Every operator on (saturated), the input at `T_max`.
    ///
    /// # Errors
    /// [`Error::StateMismatch`].
    pub fn reset_on<S>(&self, state: &mut State<T, S>) -> Result<(), Error>
    where
        S: Memory<Turn<T>>,
    {
        self.reset_off(state)?;
        self.step(state, self.plane.max())?;
        Ok(())
    }

    /// Rebuilds the state that gave, in this model or one with other weights, `turning_points` ([`State::turning_points`]) and `input` ([`State::input`]).
    ///
    /// # Errors
    /// [`Error::StateMismatch`], [`Error::InputNotFinite`], [`Error::TurningPoints`] where the
    /// points are not finite, leave `[0, K]` or do not nest; the state is then as it was.
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
            // Comparisons written so that NaN fails them.
            if !(low <= x && x <= high) {
                return Err(Error::TurningPoints { index });
            }
            if index % 2 == 0 { high = x } else { low = x }
        }
        state.reset_off(&self.plane, self.stamp);
        state.travel(self.table(), T::ZERO, input);
        for &x in turning_points {
            // Never −0, which has no place in the order of positions.
            state.travel(self.table(), x.max(T::ZERO), input);
        }
        Ok(())
    }

    /// Moves to `input` and returns the output: amortised `O(1)`, at most `2K` turning points passed.
    ///
    /// # Errors
    /// [`Error::InputNotFinite`], [`Error::StateMismatch`]; the state is then as it was.
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

    /// Steps through `input` and writes the outputs to `output`, as many as inputs.
    ///
    /// # Errors
    /// As [`Model::step`], and [`Error::MemoryTooSmall`] where `output` is shorter than `input`;
    /// the state is then as it was.
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
        // One pass without an early exit, so that checking costs next to nothing.
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
        // What the operators put out is linear in their states: one gain and offset for all.
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

    /// The Everett table, from [`crate::table_index`]`(0, 0)` on: [`crate::table_len`] elements or more.
    #[must_use]
    pub fn table(&self) -> &[T] {
        &self.table.as_ref()[self.base..]
    }

    /// `Σ μ_ij`.
    #[must_use]
    pub fn total(&self) -> T {
        self.table()[everett::table_index(self.plane.levels(), 0)]
    }

    /// From `Σ μ γ` to the sum of the operators' own outputs.
    #[inline(always)]
    pub(crate) fn outward(&self, sum: T) -> T {
        let (gain, offset) = self.outward_line();
        gain * sum + offset
    }

    /// Gain and offset of that: `γ` itself, or `2γ − 1` for each operator.
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

    /// Whether a state's memory is of the right size and kind.
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

/// FNV-1a over whole numbers instead of bytes: quick, and different for different weights but by a
/// chance of one in 2⁶⁴.
fn stamp<'a, T: Real + 'a>(operator: Operator, numbers: impl Iterator<Item = &'a T>) -> u64 {
    let start = 0xcbf2_9ce4_8422_2325 ^ operator as u64;
    numbers.fold(start, |hash, number| {
        (hash ^ number.bits())
            .wrapping_mul(0x0000_0100_0000_01b3)
            .rotate_left(29)
    })
}
