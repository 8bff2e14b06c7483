//! The estimator of the shift: an unknown load as one number.
//!
//! A load shifts the operators' axis: `x = a T − s − δ` ([`Load`]). The estimator follows `δ` by a
//! Kalman filter with one state. The slope of the output over `δ` is exact, because the output is
//! piecewise linear along a branch.
//!
//! A filter assumes that a correction acts at once. Operators with memory do not do that: a
//! correction against the motion only opens a small loop, and the output stays. So after such a
//! correction the estimator waits until the temperature has made up for it.

use super::gate::{Gate, Verdict};
use super::shift_options::ShiftOptions;
use super::watch::{Channel, Reading, Watch, Watched};
use super::{Learning, Outcome};
use crate::branch::Turn;
use crate::error::Error;
use crate::inverse::Inverse;
use crate::memory::Memory;
use crate::model::{Model, Output};
use crate::scalar::Real;
use crate::solution::Solution;
use crate::stages::{Load, Loaded, Rates, Sample, StageState, Stages, Wanted, factors};
use crate::state::State;
use crate::target::Direction;

/// A slope below the mean one divided by this is flat. It teaches nothing: the errors of a model
/// over a flat branch are not those of its shift.
const FLAT: usize = 4;

/// An error of so many standard deviations says that the shift is less certain than thought.
const UNLIKELY: usize = 3;

/// The weights are renewed where the load moved by the range of loads divided by this.
const RENEWALS: usize = 256;

/// Follows the shift `δ` of the operators' axis under a load that nobody measures.
///
/// Each sample is first predicted, then learned from, as with [`Estimator`](crate::Estimator). A
/// sample costs `O(1)`, and nothing is allocated. The weights stay.
///
/// - **Sign.** `δ` adds to the shift `s` of [`Load`]: the operators see `a T − s − δ`.
/// - **One sample moves `δ` by one level at most**, so a wrong reading that the gate lets through
///   does so, too.
/// - **Nothing is learned** while the temperature rests, and where the output hardly depends on the
///   shift: in saturation and in the dead band after a turn.
/// - **Load.** If the model has a curve of shifts that rises or falls all the way, the shift tells
///   the load ([`ShiftEstimator::load`]). Gain, offset and scale are then those of that load.
///
/// ```
/// use hysteron_core::{Model, Operator, Plane, ShiftEstimator, ShiftOptions, StageState, Stages};
/// use hysteron_core::{Turn, table_len, turn_capacity};
/// const K: usize = 10;
/// let plane = Plane::new(20.0_f64, 65.0, K)?; // levels are 5 K apart
/// let model = Model::new(plane, Operator::Mkp, &[1.0; 55], [0.0; table_len(K)])?;
/// let stages = Stages::NONE;
/// let mut state = model.state([Turn::default(); turn_capacity(K)])?;
/// let mut memory = StageState::default();
/// let options = ShiftOptions::usual(&model, &stages);
/// let mut estimator = ShiftEstimator::new(options, &model, &stages)?;
///
/// // The same actuator under a load that shifts it by 8 K.
/// let mut there = model.state([Turn::default(); turn_capacity(K)])?;
/// for n in 0..500 {
///     let input = 45.0 - 40.0 * (0.05 * f64::from(n)).cos();
///     let measured = model.step(&mut there, input - 8.0)?.output;
///     let sample = input.into();
///     estimator.step(&stages, &model, &mut state, &mut memory, sample, measured)?;
/// }
/// assert!((estimator.shift() - 8.0).abs() < 0.1);
/// # Ok::<(), hysteron_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ShiftEstimator<T> {
    options: ShiftOptions<T>,
    shift: T,
    variance: T,
    gate: Gate<T>,
    watch: Watch<T>,
    /// What the model left alone is expected to say at the next sample.
    expected: Option<T>,
    /// Shift and variance before the last piece of the watch in which the output moved, and before
    /// the present piece.
    trusted: (T, T),
    pending: (T, T),
    /// The mean distance between levels, in the unit of the temperature.
    level: T,
    /// Below this slope of the output over the shift, a branch is flat.
    flat: T,
    /// `a T` at the last sample learned from; `None` before the first one.
    learned: Option<T>,
    wait: Option<Wait<T>>,
    frozen: bool,
}

/// After a correction against the motion, until the operators are back where they were.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Wait<T> {
    /// The direction of the motion.
    rising: bool,
    /// Where the operators were, `a T − s − δ`.
    until: T,
    /// How far the temperature has turned back since.
    back: T,
}

impl<T: Real> ShiftEstimator<T> {
    /// An estimator for `model` between `stages`. The shift is zero.
    ///
    /// # Errors
    /// [`Error::Adaptation`] with the name of an option out of range, [`Error::Stage`] for stages
    /// that cannot be.
    pub fn new<C: AsRef<[T]>>(
        options: ShiftOptions<T>,
        model: &Model<T, C>,
        stages: &Stages<'_, T>,
    ) -> Result<Self, Error> {
        options.check()?;
        stages.check(model)?;
        let range = stages.range(model);
        let level = stages.axis.level(model.plane());
        let width = level * T::from_index(model.plane().levels());
        Ok(Self {
            options,
            shift: T::ZERO,
            variance: options.spread * options.spread,
            gate: Gate::new(range),
            watch: Watch::new(range, T::from_index(model.plane().levels())),
            expected: None,
            trusted: (T::ZERO, options.spread * options.spread),
            pending: (T::ZERO, options.spread * options.spread),
            level,
            flat: range / width / T::from_index(FLAT),
            learned: None,
            wait: None,
            frozen: false,
        })
    }

    /// Moves to a sample, predicts the output there, and learns from the output `measured`.
    ///
    /// `sample.load` is the load that `δ` departs from; a model that depends on none needs none.
    /// Model, stages and states have to be those of the samples before.
    ///
    /// # Errors
    /// As [`Stages::step`], and [`Error::InputNotFinite`] with index 1 for the measured output.
    /// Nothing is changed then.
    pub fn step<C, S>(
        &mut self,
        stages: &Stages<'_, T>,
        model: &Model<T, C>,
        state: &mut State<T, S>,
        memory: &mut StageState<T>,
        sample: Sample<T>,
        measured: T,
    ) -> Result<Learning<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        if !measured.is_finite() {
            return Err(Error::InputNotFinite { index: 1 });
        }
        let rates = stages.rates_of(memory, sample.dt)?;
        let before = *memory;
        let output = self.move_to(stages, model, state, memory, &rates, sample)?;
        let error = measured - output.output;
        let sensitivity = self.sensitivity(stages, model, state, memory, sample.load)?;
        let sum = sensitivity.loaded.gain * model.output(state);
        let factors = factors(&before, &rates);
        let gain = stages
            .behind
            .slope(before.started, before.behind, &factors, sum);
        let gain = if stages.falling { -gain } else { gain };
        let slope = sensitivity.slope(gain, error);
        let here = sensitivity.loaded.scale * memory.temperature();
        let at = (here, here - sensitivity.loaded.shift);
        Ok(Learning {
            output: output.output,
            error,
            outcome: self.judge(at, state.is_rising(), (measured, error), slope),
            clipped: output.clipped,
        })
    }

    /// Moves to a sample without learning: what [`Stages::step`] is to a model alone.
    ///
    /// # Errors
    /// As [`Stages::step`].
    pub fn simulate<C, S>(
        &self,
        stages: &Stages<'_, T>,
        model: &Model<T, C>,
        state: &mut State<T, S>,
        memory: &mut StageState<T>,
        sample: Sample<T>,
    ) -> Result<Output<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let rates = stages.rates_of(memory, sample.dt)?;
        self.move_to(stages, model, state, memory, &rates, sample)
    }

    /// Finds the drive for `wanted` at the present shift and moves there, as [`Stages::invert`].
    ///
    /// # Errors
    /// As [`Stages::invert`].
    pub fn invert<C, S>(
        &self,
        stages: &Stages<'_, T>,
        inverse: &Inverse<'_, T, C>,
        state: &mut State<T, S>,
        memory: &mut StageState<T>,
        wanted: Wanted<T>,
    ) -> Result<Solution<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let rates = stages.rates_of(memory, wanted.dt)?;
        let loaded = self.loaded(&stages.axis.load, wanted.load)?;
        stages.invert_loaded(inverse, state, memory, &rates, wanted, loaded)
    }

    /// The shift `δ`, in the unit of the temperature.
    #[must_use]
    pub fn shift(&self) -> T {
        self.shift
    }

    /// The variance of the shift, as the filter believes it.
    #[must_use]
    pub fn variance(&self) -> T {
        self.variance
    }

    /// The load that the shift tells, for a model that was told the load `told`. `None` if the
    /// model's curve of shifts does not say. Beyond its ends it is the outermost load.
    ///
    /// # Errors
    /// As [`Load::at`].
    pub fn load(&self, load: &Load<'_, T>, told: Option<T>) -> Result<Option<T>, Error> {
        Ok(load.of_shift(load.at(told)?.shift + self.shift))
    }

    /// The load for [`Parts::place`](crate::Parts::place), where the weights depend on the load: at
    /// first the load `told`, then what the call before returned, `placed`.
    ///
    /// It stays until the load that the shift tells is away by 1/256 of the `range` of loads, so
    /// that weights are mixed seldom.
    ///
    /// # Errors
    /// As [`Load::at`].
    pub fn renewed(
        &self,
        load: &Load<'_, T>,
        told: Option<T>,
        placed: T,
        range: (T, T),
    ) -> Result<T, Error> {
        let (low, high) = range;
        let Some(found) = self.load(load, told)? else {
            return Ok(placed);
        };
        let found = found.clamp(low, high);
        let moved = (found - placed).max(placed - found);
        Ok(match moved > (high - low) / T::from_index(RENEWALS) {
            true => found,
            false => placed,
        })
    }

    /// The values of the load's curves, at the present shift from the load `told`.
    ///
    /// # Errors
    /// As [`Load::at`].
    pub fn loaded(&self, load: &Load<'_, T>, told: Option<T>) -> Result<Loaded<T>, Error> {
        at_shift(load, told, self.shift)
    }

    /// The options.
    #[must_use]
    pub fn options(&self) -> &ShiftOptions<T> {
        &self.options
    }

    /// Stops learning, or resumes it. A frozen estimator still predicts.
    pub fn freeze(&mut self, frozen: bool) {
        self.frozen = frozen;
        self.realign();
    }

    /// Whether the estimator is frozen.
    #[must_use]
    pub fn is_frozen(&self) -> bool {
        self.frozen
    }

    /// Takes `shift` for the shift, as uncertain as at the start. Beyond the reach it is the
    /// nearest one within.
    ///
    /// # Errors
    /// [`Error::InputNotFinite`] for a shift that is not finite.
    pub fn reset(&mut self, shift: T) -> Result<(), Error> {
        if !shift.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        self.shift = shift.clamp(-self.options.reach, self.options.reach);
        self.variance = self.options.spread * self.options.spread;
        self.gate.restart();
        self.realign();
        Ok(())
    }

    /// Tells that others moved the state: the next sample only sets out from there.
    pub fn realign(&mut self) {
        (self.learned, self.wait, self.expected) = (None, None, None);
        self.trusted = (self.shift, self.variance);
        self.pending = self.trusted;
        self.watch.restart();
    }

    /// Tells the output that the model left alone expects at the next sample, from a state of its
    /// own. So a channel that stands still is found by a [`Watch`], unless the `gate` is 0, and what
    /// was learned since is undone. Without it, none is found.
    ///
    /// # Errors
    /// [`Error::InputNotFinite`] for an output that is not finite.
    pub fn expect(&mut self, output: T) -> Result<(), Error> {
        if !output.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        self.expected = Some(output);
        Ok(())
    }

    /// The channel that stands still while the other one moves.
    #[must_use]
    pub fn stuck(&self) -> Option<Channel> {
        self.watch.stuck()
    }

    fn move_to<C, S>(
        &self,
        stages: &Stages<'_, T>,
        model: &Model<T, C>,
        state: &mut State<T, S>,
        memory: &mut StageState<T>,
        rates: &Rates<T>,
        sample: Sample<T>,
    ) -> Result<Output<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let loaded = self.loaded(&stages.axis.load, sample.load)?;
        stages.step_loaded(model, state, memory, rates, sample.input, loaded)
    }

    /// How offset and operators' sum change with the shift, at the present position.
    fn sensitivity<C, S>(
        &self,
        stages: &Stages<'_, T>,
        model: &Model<T, C>,
        state: &State<T, S>,
        memory: &StageState<T>,
        told: Option<T>,
    ) -> Result<Sensitivity<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let load = &stages.axis.load;
        let loaded = self.loaded(load, told)?;
        // Beyond the loads known, the curves stay as they are. What they would say further inside
        // still tells the way back.
        let beyond = loaded.shift - load.within(loaded.shift);
        let inside = at_shift(load, told, self.shift - beyond)?;
        // The curves are straight between their knots, so any small step gives their slopes.
        let small = self.level / T::from_index(64);
        let small = if beyond > T::ZERO { -small } else { small };
        let next = at_shift(load, told, self.shift - beyond + small)?;
        let over = |a: T, b: T| (b - a) / small;
        let moves = over(inside.scale, next.scale) * memory.temperature() - T::ONE;
        let direction = match state.is_rising() {
            true => Direction::Rising,
            false => Direction::Falling,
        };
        let seen = stages
            .axis
            .slope(model.plane(), loaded, direction, state.input());
        let along = model.slope(state) * seen;
        let along = loaded.gain * along;
        Ok(Sensitivity {
            loaded,
            beyond,
            offset: over(inside.offset, next.offset),
            sum: over(inside.gain, next.gain) * model.output(state) + along * moves,
            alone: -along,
        })
    }

    /// Learns from a reading whose prediction erred by `error`, at the temperature `a T` and the
    /// operators' position. `slope` is that of the output over the shift.
    fn judge(
        &mut self,
        (here, position): (T, T),
        rising: bool,
        (measured, error): (T, T),
        slope: T,
    ) -> Outcome {
        let expected = self.expected.take();
        if self.frozen {
            return Outcome::Frozen;
        }
        let Some(learned) = self.learned else {
            self.learned = Some(here);
            return Outcome::AtRest;
        };
        let moved = (here - learned).max(learned - here) / self.level;
        // Also for NaN, where temperatures overflow.
        let moves = moved > T::ZERO && moved >= self.options.movement;
        if !moves {
            return Outcome::AtRest;
        }
        let most = self.options.spread * self.options.spread;
        let ShiftOptions { gate, burst, .. } = self.options;
        let verdict = self.gate.judge(error, gate, burst);
        if let Some(expected) = expected.filter(|_| gate > T::ZERO) {
            let reading = Reading {
                position: here / self.level,
                expected,
                measured,
            };
            if let Some(channel) = self.find_stuck(reading, verdict != Verdict::Refused) {
                self.learned = Some(here);
                self.gate.settle(error);
                return channel.outcome();
            }
        }
        match verdict {
            Verdict::Refused => return Outcome::Rejected,
            Verdict::Jump => self.variance = most,
            Verdict::Usual => {}
        }
        let heats = here > learned;
        self.learned = Some(here);
        let part = moved.min(T::ONE);
        let walked = self.options.walk * self.options.walk * part;
        self.variance = (self.variance + walked).min(most);
        let waits = self.waits(heats, moved, position);
        let steep = slope.max(-slope) >= self.flat && slope.is_finite() && slope != T::ZERO;
        let zone = self.options.dead_zone;
        let beyond = error - error.clamp(-zone, zone);
        let step = match waits || heats != rising || !steep || beyond == T::ZERO {
            true => None,
            false => self.correct(beyond, slope, part),
        };
        let Some(step) = step else {
            self.gate.settle(error);
            return Outcome::Waiting;
        };
        // A larger shift moves the operators down.
        if (step > T::ZERO) == heats {
            self.wait = Some(Wait {
                rising: heats,
                until: position,
                back: T::ZERO,
            });
            self.gate.settle(error);
        } else {
            self.gate.settle(error - slope * step);
        }
        Outcome::Learned
    }

    /// The channel that stands still. If one begins to, the shift from before returns.
    fn find_stuck(&mut self, reading: Reading<T>, believed: bool) -> Option<Channel> {
        let already = self.watch.stuck().is_some();
        match self.watch.look(reading, believed) {
            Watched::Moving => {}
            Watched::Piece { alive } => {
                if alive {
                    self.trusted = self.pending;
                }
                self.pending = (self.shift, self.variance);
            }
            Watched::Stuck(_) if already => {}
            Watched::Stuck(_) => {
                (self.shift, self.variance) = self.trusted;
                self.pending = self.trusted;
                self.wait = None;
                self.gate.restart();
            }
        }
        self.watch.stuck()
    }

    /// One step of the filter. Returns how far the shift moved; `None` where numbers overflow.
    fn correct(&mut self, error: T, slope: T, part: T) -> Option<T> {
        let (square, noise) = (slope * slope, self.options.noise);
        // One independent reading for each level of motion.
        let noise = noise * noise / part;
        let most = self.options.spread * self.options.spread;
        let mut variance = self.variance;
        let unlikely = T::from_index(UNLIKELY * UNLIKELY);
        if error * error > unlikely * (square * variance + noise) {
            variance = ((error * error - noise) / square).min(most).max(variance);
        }
        let total = square * variance + noise;
        let wanted = variance * slope / total * error;
        let left = variance * (noise / total);
        if !(wanted.is_finite() && left.is_finite()) {
            return None;
        }
        let step = wanted.clamp(-self.level, self.level);
        let reach = self.options.reach;
        let shift = (self.shift + step).clamp(-reach, reach);
        // What is cut says that the shift is further off than this, so it is no more certain.
        self.variance = if step == wanted { left } else { variance };
        let moved = shift - self.shift;
        self.shift = shift;
        Some(moved)
    }

    /// Whether the operators are still inside the small loop that a correction opened.
    fn waits(&mut self, heats: bool, moved: T, position: T) -> bool {
        let Some(wait) = &mut self.wait else {
            return false;
        };
        let passed = match wait.rising {
            true => position >= wait.until,
            false => position <= wait.until,
        };
        wait.back = match heats == wait.rising {
            true => (wait.back - moved).max(T::ZERO),
            false => wait.back + moved,
        };
        // A level back, the temperature itself has turned.
        let over = passed || wait.back >= T::ONE;
        if over {
            self.wait = None;
        }
        !over
    }
}

/// How the output depends on the shift.
struct Sensitivity<T> {
    loaded: Loaded<T>,
    /// How far the shift is beyond those of the loads known.
    beyond: T,
    /// The slope of the offset over the shift.
    offset: T,
    /// The slope of `g(σ) · h`.
    sum: T,
    /// The same for a shift that changes nothing else.
    alone: T,
}

impl<T: Real> Sensitivity<T> {
    /// The slope of the output for a correction of this `error`, with the gain after the operators.
    fn slope(&self, gain: T, error: T) -> T {
        let slope = self.offset + gain * self.sum;
        let outward = error * slope * self.beyond > T::ZERO;
        if outward { gain * self.alone } else { slope }
    }
}

/// The curves where the shift is that of the load `told` and `shift` more. If that tells a load, they
/// are those of that load.
fn at_shift<T: Real>(load: &Load<'_, T>, told: Option<T>, shift: T) -> Result<Loaded<T>, Error> {
    let told = load.at(told)?;
    let shift = told.shift + shift;
    let there = match load.of_shift(shift) {
        Some(there) => load.at(Some(there))?,
        None => told,
    };
    Ok(Loaded { shift, ..there })
}
