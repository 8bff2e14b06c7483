//! The whole chain, forward: one sample of drive, time and load in, one output out.

use crate::branch::Turn;
use crate::error::Error;
use crate::everett::table_len;
use crate::memory::Memory;
use crate::model::{Model, Output};
use crate::scalar::Real;
use crate::stages::after::{Creep, Fade, MAX_CREEP, Past};
use crate::stages::axis::{Axis, Loaded};
use crate::stages::body::{Body, Decay};
use crate::stages::limits::{is_share, is_size, is_slope, is_time};
use crate::state::State;

/// The constants of all stages around the operators of a [`Model`]. Each stage can be left out.
///
/// ```text
/// T = body(drive)    x = W(a(σ) T − s(σ))    h = operators(x)    y = offset + o(σ) + sign · lag(creep(g(σ) h))
/// ```
///
/// ```
/// use hysteron_core::{Body, Model, Operator, Plane, Sample, StageState, Stages, Turn};
/// use hysteron_core::{table_len, turn_capacity};
/// let plane = Plane::new(1.0, 2.0, 2)?;
/// let model = Model::new(plane, Operator::Mkp, &[1.0; 3], [0.0; table_len(2)])?;
/// let body = Body { ambient: 0.0, gain: 2.0, tau_heating: 1.0, tau_cooling: 1.0 };
/// let stages = Stages { body: Some(body), ..Stages::NONE };
/// let mut state = model.state([Turn::default(); turn_capacity(2)])?;
/// let mut memory = StageState::default();
/// stages.step(&model, &mut state, &mut memory, 0.0.into())?; // at rest
/// let heated = Sample { dt: Some(50.0), ..1.0.into() }; // the drive 1, held for 50 s
/// assert_eq!(stages.step(&model, &mut state, &mut memory, heated)?.output, 3.0);
/// # Ok::<(), hysteron_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stages<'a, T> {
    /// From the drive to the temperature; `None` where the input is the temperature itself.
    pub body: Option<Body<T>>,
    /// Load and spacing.
    pub axis: Axis<'a, T>,
    /// Creep after the operators.
    pub creep: Creep<'a, T>,
    /// Time constant of a lag of the whole, in seconds; 0 for none.
    pub lag: T,
    /// The output where the operators' sum is zero.
    pub offset: T,
    /// Whether the output falls while the operators' sum rises.
    pub falling: bool,
}

/// What the stages remember from one sample to the next.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StageState<T> {
    /// `false` before the first sample. At that sample body, creep and lag are at rest.
    pub(crate) started: bool,
    pub(crate) temperature: T,
    pub(crate) past: Past<T>,
}

impl<T: Real> StageState<T> {
    /// The temperature after the last sample; 0 before the first one.
    #[must_use]
    pub fn temperature(&self) -> T {
        self.temperature
    }

    /// Whether there was a sample.
    #[must_use]
    pub fn is_started(&self) -> bool {
        self.started
    }

    /// The state as numbers, for saving: 0 or 1 for whether there was a sample, the temperature,
    /// the output of each creep term, the lagged sum.
    #[must_use]
    pub fn to_numbers(&self) -> [T; MAX_CREEP + 3] {
        let mut numbers = [T::ZERO; MAX_CREEP + 3];
        numbers[0] = if self.started { T::ONE } else { T::ZERO };
        numbers[1] = self.temperature;
        numbers[2..2 + MAX_CREEP].copy_from_slice(&self.past.crept);
        numbers[2 + MAX_CREEP] = self.past.lagged;
        numbers
    }

    /// The state that [`StageState::to_numbers`] gave.
    ///
    /// # Errors
    /// [`Error::InputNotFinite`] with the index of a number that is not finite.
    pub fn from_numbers(numbers: &[T; MAX_CREEP + 3]) -> Result<Self, Error> {
        if let Some(index) = numbers.iter().position(|number| !number.is_finite()) {
            return Err(Error::InputNotFinite { index });
        }
        let mut past = Past::default();
        past.crept.copy_from_slice(&numbers[2..2 + MAX_CREEP]);
        past.lagged = numbers[2 + MAX_CREEP];
        Ok(Self {
            started: numbers[0] != T::ZERO,
            temperature: numbers[1],
            past,
        })
    }
}

/// One sample. A plain number converts to a sample with that input only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample<T> {
    /// The input; with a thermal body, the drive that was held since the sample before.
    pub input: T,
    /// Time since the sample before, in seconds; needed by body, creep and lag.
    pub dt: Option<T>,
    /// The load; needed by a model that depends on one.
    pub load: Option<T>,
}

impl<T> From<T> for Sample<T> {
    fn from(input: T) -> Self {
        Self {
            input,
            dt: None,
            load: None,
        }
    }
}

/// The factors of all stages for one time step ([`Stages::rates`]). For a fixed sample time they
/// are computed once.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rates<T> {
    pub(crate) decay: Decay<T>,
    pub(crate) fade: Fade<T>,
}

impl<T: Real> Rates<T> {
    /// The factors as numbers, for programs that carry them as constants: heating, cooling, each
    /// creep term, lag.
    #[must_use]
    pub fn to_numbers(&self) -> [T; MAX_CREEP + 3] {
        let mut numbers = [T::ZERO; MAX_CREEP + 3];
        numbers[0] = self.decay.heating;
        numbers[1] = self.decay.cooling;
        numbers[2..2 + MAX_CREEP].copy_from_slice(&self.fade.creep);
        numbers[2 + MAX_CREEP] = self.fade.lag;
        numbers
    }
}

impl<T: Real> Stages<'_, T> {
    /// No stages: the output is the operators' sum.
    pub const NONE: Self = Stages {
        body: None,
        axis: Axis::PLAIN,
        creep: Creep::NONE,
        lag: T::ZERO,
        offset: T::ZERO,
        falling: false,
    };

    /// Checks the constants of all stages, for the operators of `model`: that they fit each other,
    /// and that they are of a size with which no step overflows. Time constants are from 10⁻⁹ s to
    /// 10⁹ s, coefficients of the creep at most 10⁶, gains and scales from 10⁻⁶ to 10⁶; all other
    /// numbers, the output too, at most [`Real::LARGEST`].
    ///
    /// # Errors
    /// [`Error::Stage`] with the name of the constant.
    pub fn check<C: AsRef<[T]>>(&self, model: &Model<T, C>) -> Result<(), Error> {
        let fault = |stage| Err(Error::Stage { stage });
        if let Some(body) = self.body {
            let constants = [
                ("ambient", is_size(body.ambient)),
                ("gain", is_slope(body.gain)),
                ("tau_heating", is_time(body.tau_heating)),
                ("tau_cooling", is_time(body.tau_cooling)),
            ];
            if let Some((name, _)) = constants.into_iter().find(|(_, fits)| !fits) {
                return fault(name);
            }
        }
        self.axis.check(model.plane())?;
        let Creep { coefficients, taus } = self.creep;
        let fits = coefficients.len() <= MAX_CREEP && taus.len() == coefficients.len();
        let shares = coefficients.iter().all(|c| is_share(*c));
        if !(fits && shares && taus.iter().all(|tau| is_time(*tau))) {
            return fault("creep");
        }
        if !(self.lag == T::ZERO || is_time(self.lag)) {
            return fault("lag");
        }
        if !is_size(self.offset) {
            return fault("offset");
        }
        // Two entries of the table make an output of KP and of relays.
        let entries = &model.table()[..table_len(model.plane().levels())];
        let most = entries
            .iter()
            .fold(T::ZERO, |most, e| most.max(*e).max(-*e));
        match is_size(self.gain_most() * self.creep.gain() * (most + most)) {
            true => Ok(()),
            false => fault("weights"),
        }
    }

    /// The output after creep and lag from that of the operators, `h`, in its unit and with its sign.
    /// `past` is what the call before returned; `None` at the first sample.
    #[must_use]
    pub fn after(&self, past: Option<StageState<T>>, dt: T, h: T) -> (T, StageState<T>) {
        let sum = self.inward(h);
        let memory = past.unwrap_or_default();
        let fade = self.fade(&memory, &self.rates(dt));
        let (sum, past) = self.creep.forward(self.past(&memory, sum), fade, sum);
        let next = StageState {
            started: true,
            past,
            ..memory
        };
        (self.outward(sum), next)
    }

    /// The output of the operators, in its unit and with its sign, from the output `y` after creep
    /// and lag. `past` is what the call before returned: the outputs of the lags. `None` at the
    /// first sample, where they are at rest.
    ///
    /// The result is not finite for a lag in a step without length.
    #[must_use]
    pub fn undo_after(&self, past: Option<StageState<T>>, dt: T, y: T) -> (T, StageState<T>) {
        let sum = self.inward(y);
        let memory = past.unwrap_or_default();
        let rates = self.rates(dt);
        let (base, gain) = match memory.started {
            true => self.creep.line(memory.past, rates.fade),
            false => (T::ZERO, self.creep.gain()),
        };
        let h = (sum - base) / gain;
        let fade = self.fade(&memory, &rates);
        let (_, past) = self.creep.forward(self.past(&memory, h), fade, h);
        let next = StageState {
            started: true,
            past,
            ..memory
        };
        (self.outward(h), next)
    }

    /// The range of the operators' sum, at the load where it is widest.
    pub(crate) fn range<C: AsRef<[T]>>(&self, model: &Model<T, C>) -> T {
        let (off, on) = model.output_range();
        (on - off).max(off - on) * self.gain_most()
    }

    /// The largest gain of the load; 1 without one.
    fn gain_most(&self) -> T {
        let gains = self.axis.load.gains.iter();
        let gain = gains.fold(T::ZERO, |most, gain| most.max(*gain));
        if gain > T::ZERO { gain } else { T::ONE }
    }

    /// Whether a stage depends on time, so that each sample needs its `dt`.
    #[must_use]
    pub fn is_timed(&self) -> bool {
        self.body.is_some() || !self.creep.coefficients.is_empty() || self.lag > T::ZERO
    }

    /// The factors for a time step of `dt` seconds, 0 or more.
    #[must_use]
    pub fn rates(&self, dt: T) -> Rates<T> {
        let mut fade = Fade::default();
        for (factor, &tau) in fade.creep.iter_mut().zip(self.creep.taus) {
            *factor = (-dt / tau).exp();
        }
        if self.lag > T::ZERO {
            fade.lag = (-dt / self.lag).exp();
        }
        Rates {
            decay: self.body.map(|body| body.decay(dt)).unwrap_or_default(),
            fade,
        }
    }

    /// Whether [`Stages::step`] would take this sample, as far as the sample alone tells.
    ///
    /// # Errors
    /// [`Error::InputNotFinite`], [`Error::TimeStep`] and [`Error::Load`], as [`Stages::step`].
    pub fn accepts(&self, memory: &StageState<T>, sample: Sample<T>) -> Result<(), Error> {
        if !sample.input.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        self.check_time(memory, sample.dt)?;
        self.axis.load.at(sample.load).map(|_| ())
    }

    /// Moves by one sample and returns the output. `clipped` tells whether the operators' input was
    /// outside the plane.
    ///
    /// # Errors
    /// [`Error::TimeStep`] where the time is needed and missing, negative or not finite;
    /// [`Error::Load`] where the load is; [`Error::InputNotFinite`]; [`Error::StateMismatch`]. Then
    /// nothing has moved.
    pub fn step<C, S>(
        &self,
        model: &Model<T, C>,
        state: &mut State<T, S>,
        memory: &mut StageState<T>,
        sample: Sample<T>,
    ) -> Result<Output<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let rates = self.rates_of(memory, sample.dt)?;
        self.step_at(model, state, memory, &rates, sample.input, sample.load)
    }

    /// As [`Stages::step`], for a time step whose factors are known.
    ///
    /// # Errors
    /// As [`Stages::step`].
    pub fn step_at<C, S>(
        &self,
        model: &Model<T, C>,
        state: &mut State<T, S>,
        memory: &mut StageState<T>,
        rates: &Rates<T>,
        input: T,
        load: Option<T>,
    ) -> Result<Output<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let loaded = self.axis.load.at(load)?;
        self.step_loaded(model, state, memory, rates, input, loaded)
    }

    /// As [`Stages::step_at`], with the values of the load's curves.
    pub(crate) fn step_loaded<C, S>(
        &self,
        model: &Model<T, C>,
        state: &mut State<T, S>,
        memory: &mut StageState<T>,
        rates: &Rates<T>,
        input: T,
        loaded: Loaded<T>,
    ) -> Result<Output<T>, Error>
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let temperature = self.heated(memory, rates, input);
        if !(input.is_finite() && temperature.is_finite()) {
            return Err(Error::InputNotFinite { index: 0 });
        }
        let seen = self.axis.forward(model.plane(), loaded, temperature);
        let step = model.step(state, seen)?;
        let h = loaded.gain * step.output;
        let fade = self.fade(memory, rates);
        let (sum, past) = self.creep.forward(self.past(memory, h), fade, h);
        *memory = StageState {
            started: true,
            temperature,
            past,
        };
        Ok(Output {
            output: loaded.offset + self.outward(sum),
            clipped: step.clipped,
        })
    }

    /// The temperature after a step with this input.
    pub(crate) fn heated(&self, memory: &StageState<T>, rates: &Rates<T>, input: T) -> T {
        match self.body {
            None => input,
            Some(body) if memory.started => body.step(memory.temperature, input, rates.decay),
            Some(body) => body.rest(input),
        }
    }

    /// The gain from the operators' sum `g h` to the output in the next sample, without its sign.
    pub(crate) fn gain_after(&self, memory: &StageState<T>, rates: &Rates<T>) -> T {
        match memory.started {
            true => self.creep.line(memory.past, rates.fade).1,
            false => self.creep.gain(),
        }
    }

    /// The factors for a time step; those of no time before the first sample.
    pub(crate) fn rates_of(
        &self,
        memory: &StageState<T>,
        dt: Option<T>,
    ) -> Result<Rates<T>, Error> {
        self.check_time(memory, dt)?;
        Ok(match dt {
            Some(dt) if self.is_timed() => self.rates(dt),
            _ => Rates::default(),
        })
    }

    /// A time step is needed from the second sample on, where a stage depends on time. One that is
    /// given has to be a number, 0 or more.
    fn check_time(&self, memory: &StageState<T>, dt: Option<T>) -> Result<(), Error> {
        let fits = match dt {
            Some(dt) => dt >= T::ZERO && dt.is_finite(),
            None => !(memory.started && self.is_timed()),
        };
        match fits {
            true => Ok(()),
            false => Err(Error::TimeStep),
        }
    }

    /// The past of creep and lag; before the first sample, that of a rest at `h`.
    pub(crate) fn past(&self, memory: &StageState<T>, h: T) -> Past<T> {
        match memory.started {
            true => memory.past,
            false => Past {
                crept: [h; MAX_CREEP],
                lagged: h,
            },
        }
    }

    /// The factors of creep and lag. Before the first sample nothing of a past is left.
    pub(crate) fn fade(&self, memory: &StageState<T>, rates: &Rates<T>) -> Fade<T> {
        match memory.started {
            true => rates.fade,
            false => Fade::default(),
        }
    }

    pub(crate) fn outward(&self, sum: T) -> T {
        match self.falling {
            true => self.offset - sum,
            false => self.offset + sum,
        }
    }

    pub(crate) fn inward(&self, output: T) -> T {
        match self.falling {
            true => self.offset - output,
            false => output - self.offset,
        }
    }
}
