//! The inverse of the whole chain, exact for the present sample.

use crate::branch::Turn;
use crate::error::Error;
use crate::inverse::Inverse;
use crate::memory::Memory;
use crate::operator::Operator;
use crate::scalar::Real;
use crate::solution::{Solution, Status};
use crate::stages::chain::{Stages, factors};
use crate::stages::constant::{little, thousandth};
use crate::stages::loaded::Loaded;
use crate::stages::state::{Rates, StageState};
use crate::state::State;
use crate::target::{Direction, Target};

/// What is wanted of the chain in one sample. A target converts to one without time, load and
/// limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted<T> {
    /// The output, its heading and its tolerance, in the output's unit.
    pub target: Target<T>,
    /// Time since the sample before, in seconds; needed by stages that depend on it.
    pub dt: Option<T>,
    /// The load; needed by a model that depends on one.
    pub load: Option<T>,
    /// The range of the drive: of the input, where there is no body.
    pub drive: (T, T),
    /// The temperature is to be reached in this many seconds; `dt` where that is longer.
    ///
    /// With a horizon of several samples, noise of the target does not send the drive from one end
    /// to the other. The output then follows late.
    pub horizon: T,
    /// The range in which the temperature has to stay, as a preview of the reference gives it.
    pub temperature: (T, T),
}

impl<T: Real> From<Target<T>> for Wanted<T> {
    fn from(target: Target<T>) -> Self {
        let everywhere = (-T::INFINITY, T::INFINITY);
        Self {
            target,
            dt: None,
            load: None,
            drive: everywhere,
            horizon: T::ZERO,
            temperature: everywhere,
        }
    }
}

impl<T: Real> Stages<'_, T> {
    /// Finds the drive for `wanted` and moves there: the operators and all stages go
    /// where the drive takes them, also where it does not give the target.
    ///
    /// Each stage is inverted for the present sample, from the last to the first. The status is
    /// [`Status::Ok`] only where [`Stages::step`] with the drive found gives the target, up to its
    /// tolerance and rounding. What rounding may amount to is at most a thousandth of the range of
    /// outputs: where the digits of the number type do not tell more, the status is
    /// [`Status::Limited`].
    ///
    /// # Errors
    /// As [`Stages::step`], and [`Error::Stage`] for a range of drives whose ends are not in order.
    ///
    /// ```
    /// use hysteron_core::{Body, Model, Operator, Plane, Sample, StageState, Stages, Status};
    /// use hysteron_core::{Target, Turn, Wanted, table_len, turn_capacity};
    /// let plane = Plane::new(1.0, 2.0, 2)?;
    /// let model = Model::new(plane, Operator::Mkp, &[1.0; 3], [0.0; table_len(2)])?;
    /// let body = Body { ambient: 0.0, gain: 2.0, tau_heating: 1.0, tau_cooling: 1.0 };
    /// let stages = Stages { body: Some(body), ..Stages::NONE };
    /// let mut state = model.state([Turn::default(); turn_capacity(2)])?;
    /// let mut memory = StageState::default();
    /// stages.step(&model, &mut state, &mut memory, 0.0.into())?;
    /// let soon = |y| Wanted { dt: Some(0.1), drive: (0.0, 5.0), ..Target::new(y).into() };
    /// let inverse = model.inverse()?;
    /// let found = stages.invert(&inverse, &mut state, &mut memory, soon(0.5))?;
    /// assert_eq!(found.status, Status::Ok);
    /// let found = stages.invert(&inverse, &mut state, &mut memory, soon(3.0))?;
    /// assert_eq!((found.input, found.status), (5.0, Status::Limited));
    /// # Ok::<(), hysteron_core::Error>(())
    /// ```
    pub fn invert<C, S>(
        &self,
        inverse: &Inverse<'_, T, C>,
        state: &mut State<T, S>,
        memory: &mut StageState<T>,
        wanted: Wanted<T>,
    ) -> Result<Solution<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let rates = self.rates_of(memory, wanted.dt)?;
        self.invert_at(inverse, state, memory, &rates, wanted)
    }

    /// As [`Stages::invert`], for a time step whose factors are known. Without a horizon.
    ///
    /// # Errors
    /// As [`Stages::invert`].
    pub fn invert_at<C, S>(
        &self,
        inverse: &Inverse<'_, T, C>,
        state: &mut State<T, S>,
        memory: &mut StageState<T>,
        rates: &Rates<T>,
        wanted: Wanted<T>,
    ) -> Result<Solution<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let loaded = self.axis.load.at(wanted.load)?;
        self.invert_loaded(inverse, state, memory, rates, wanted, loaded)
    }

    /// As [`Stages::invert_at`], with the values of the load's curves in place of the load.
    pub(crate) fn invert_loaded<C, S>(
        &self,
        inverse: &Inverse<'_, T, C>,
        state: &mut State<T, S>,
        memory: &mut StageState<T>,
        rates: &Rates<T>,
        wanted: Wanted<T>,
        loaded: Loaded<T>,
    ) -> Result<Solution<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let target = wanted.target;
        if !target.output.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        // False for NaN.
        let in_order = wanted.drive.0 <= wanted.drive.1;
        if !in_order {
            return Err(Error::Stage { stage: "drive" });
        }
        let (model, plane) = (inverse.model, inverse.model.plane());
        model.check(state)?;
        let range = model.output_range();
        let aim = self.aim(memory, rates, loaded, target, range);
        let solution = match aim.output.is_finite() {
            true => inverse.solve(state, aim)?,
            // A lag or a ring in a step without length cannot move: stay.
            false => Solution {
                input: state.input().clamp(plane.bottom(), plane.max()),
                status: Status::Limited,
            },
        };
        // An input beyond the plane is given as its nearest end: nothing moves there either. A relay
        // switches at that end.
        let held = match model.operator() {
            Operator::Relay => state.input(),
            _ => state.input().clamp(plane.bottom(), plane.max()),
        };
        let held = (held, memory.temperature);
        let heading = aim.heading;
        let place = |aim: T| {
            let temperature = self.axis.towards(plane, loaded, held, heading, aim);
            let temperature = temperature.clamp(wanted.temperature.0, wanted.temperature.1);
            let unbound = match memory.started {
                true => {
                    let axis = (&self.axis, loaded);
                    self.latent.unbound(model, state, axis, temperature)
                }
                false => temperature,
            };
            let input = self.drive(memory, rates, wanted, unbound);
            (input, self.size(unbound, input))
        };
        let (mut input, mut size) = place(solution.input);
        if model.operator() == Operator::Relay {
            // A relay switches at its level and not an ulp before it. One that has just switched
            // switches back where the input turns by an ulp: a branch that stays goes on.
            let rising = match solution.input == state.input() {
                true => state.is_rising() && state.position() > T::ZERO,
                false => solution.input > state.input(),
            };
            let mut aim = solution.input;
            for _ in 0..4 {
                let temperature = self.heated(memory, rates, input);
                let seen = self.axis.seen(plane, loaded, held.0, temperature);
                if seen == solution.input || (seen > solution.input) == rising {
                    break;
                }
                // In the unit of the operators' input, which need not be that of the temperature.
                let nudge = plane.nudge().max(self.axis.rounding(plane, loaded, size));
                aim = if rising { aim + nudge } else { aim - nudge };
                (input, size) = place(aim);
            }
        }
        let slack = self.axis.rounding(plane, loaded, size);
        let steepest = self.behind.steepest(&factors(memory, rates));
        let reached = self
            .step_loaded(model, state, memory, rates, input, loaded)?
            .output;
        let sum = self.inward(target.output - loaded.offset);
        self.behind.keep_wanted(&mut memory.behind, sum);
        let gain = loaded.gain * self.behind.steepest_at_rest().max(steepest);
        let rounding = gain * (inverse.rounding() + model.total() * (slack / plane.step()));
        let error = (reached - target.output).max(target.output - reached);
        let magnitude = |v: T| v.max(-v);
        let offsets = magnitude(self.offset) + magnitude(loaded.offset) + magnitude(target.output);
        let offsets = offsets + self.behind.size();
        let spread = T::from_index(8) * T::EPSILON * offsets;
        let ends = [range.0, range.1].map(|sum| self.behind.settled(loaded.gain * sum));
        let allowed = (rounding + spread).min(thousandth(ends[1] - ends[0]));
        let met = error <= target.tolerance.max(T::ZERO) + allowed;
        let reach = target.tolerance.max(gain * inverse.rounding());
        let static_reach = self.reach(ends, reach, target.output - loaded.offset);
        let status = match solution.status {
            _ if met => Status::Ok,
            _ if static_reach != Status::Ok => static_reach,
            Status::Passed => Status::Passed,
            _ => Status::Limited,
        };
        Ok(Solution { input, status })
    }

    /// The operators' sum that gives the target in this sample. Where the exact inverse of a ring
    /// would alternate by more than a little, it is led there softly, and calmly where that would go
    /// beyond the range of sums.
    fn aim(
        &self,
        memory: &StageState<T>,
        rates: &Rates<T>,
        loaded: Loaded<T>,
        target: Target<T>,
        (off, on): (T, T),
    ) -> Target<T> {
        let heading = match (self.falling, target.heading) {
            (true, Some(Direction::Rising)) => Some(Direction::Falling),
            (true, Some(Direction::Falling)) => Some(Direction::Rising),
            (_, heading) => heading,
        };
        let factors = factors(memory, rates);
        let sum = self.inward(target.output - loaded.offset);
        let h = match self.behind.aims(&memory.behind, &factors, sum) {
            None => self.behind.inverse(&memory.behind, &factors, sum),
            Some(aims) => {
                let (low, high) = (loaded.gain * off, loaded.gain * on);
                let reach = |sum: T| low <= sum && sum <= high;
                let [from, to] = aims.swing;
                let little = (to - from).max(from - to) <= (high - low) * little();
                match reach(aims.exact) && reach(from) && reach(to) {
                    true if little => aims.exact,
                    true => aims.soft,
                    false if aims.exact.is_finite() => aims.calm,
                    false => aims.exact,
                }
            }
        };
        // Within so much of the sum, the output stays within its tolerance wherever it is.
        let tolerance = match target.tolerance == T::ZERO {
            true => T::ZERO,
            false => target.tolerance / (self.behind.steepest(&factors) * loaded.gain),
        };
        Target {
            output: h / loaded.gain,
            heading,
            tolerance,
        }
    }

    /// The size of the numbers that a temperature is made from: a body that is driven fast is aimed
    /// far beyond it.
    fn size(&self, temperature: T, drive: T) -> T {
        let magnitude = |v: T| v.max(-v);
        let body = self.body.map_or(T::ZERO, |body| {
            magnitude(body.ambient) + magnitude(body.gain * drive) + self.latent.heat
        });
        magnitude(temperature) + body
    }

    /// The drive for a temperature that is reached if no heat is bound, within its range.
    fn drive(
        &self,
        memory: &StageState<T>,
        rates: &Rates<T>,
        wanted: Wanted<T>,
        temperature: T,
    ) -> T {
        let (low, high) = wanted.drive;
        let Some(body) = self.body else {
            return temperature.clamp(low, high);
        };
        if !memory.started {
            return body.hold(temperature).clamp(low, high);
        }
        let decay = match (wanted.dt, wanted.horizon) {
            (Some(dt), horizon) if horizon > dt => body.decay(horizon),
            _ => rates.decay,
        };
        let drive = match temperature == memory.temperature {
            true => body.hold(temperature),
            false => body.drive(memory.temperature, temperature, decay),
        };
        let drive = drive.clamp(low, high);
        match drive.is_finite() {
            true => drive,
            // A step without length, and no end of the range: nothing can move.
            false => body.hold(memory.temperature),
        }
    }

    /// Whether an output, without the offset of the load, lies by more than `reach` beyond the ends
    /// of those at rest.
    fn reach(&self, [low, high]: [T; 2], reach: T, output: T) -> Status {
        let sum = self.inward(output);
        let status = if sum > high + reach {
            Status::High
        } else if sum < low - reach {
            Status::Low
        } else {
            Status::Ok
        };
        match self.falling {
            true => status.mirrored(),
            false => status,
        }
    }
}
