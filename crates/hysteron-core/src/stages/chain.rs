//! The whole chain, forward: one sample of drive, time and load in, one output out.

use crate::branch::Turn;
use crate::error::Error;
use crate::everett::table_len;
use crate::memory::Memory;
use crate::model::{Model, Output};
use crate::operator::Operator;
use crate::scalar::Real;
use crate::stages::axis::Axis;
use crate::stages::behind::{self, Behind};
use crate::stages::body::Body;
use crate::stages::constant::{Constant, Constants, Declared, Range};
use crate::stages::latent::Latent;
use crate::stages::loaded::Loaded;
use crate::stages::state::{Rates, Sample, StageState};
use crate::state::State;

/// The constants of all stages around the operators of a [`Model`]. Each stage can be left out.
///
/// ```text
/// T = body(drive)    x = W(R(a(σ) T − s(σ)))    h = operators(x)
/// y = offset + o(σ) + sign · behind(g(σ) h)
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
    /// Heat that the operators bind; none without a body.
    pub latent: Latent<T>,
    /// Load, registration and spacing.
    pub axis: Axis<'a, T>,
    /// The stages behind the operators.
    pub behind: Behind<'a, T>,
    /// The output where the operators' sum is zero.
    pub offset: T,
    /// Whether the output falls while the operators' sum rises.
    pub falling: bool,
}

impl<'a, T: Real> Stages<'a, T> {
    /// What each stage declares, in the order of the signal's path.
    pub fn declared() -> impl Iterator<Item = &'static Declared> {
        <Option<Body<T>> as Constants<T>>::DECLARED
            .iter()
            .chain(<Latent<T> as Constants<T>>::DECLARED)
            .chain(<Axis<'_, T> as Constants<T>>::DECLARED)
            .chain(Behind::<T>::declared())
    }

    /// The constants of all stages, each with its numbers: none, where it has no effect. Offset and
    /// sign of the output are apart.
    ///
    /// ```
    /// use hysteron_core::{Behind, Lag, Stages};
    /// let behind = Behind { lag: Lag { tau: 0.5 }, ..Behind::NONE };
    /// let stages = Stages { behind, ..Stages::NONE };
    /// let lag = stages.constants().find(|(constant, _)| constant.name == "lag");
    /// assert_eq!(lag.map(|(_, numbers)| numbers), Some(&[0.5][..]));
    /// ```
    pub fn constants(&self) -> impl Iterator<Item = (&'static Constant, &[T])> {
        let in_front = self.body.lists().chain(self.latent.lists());
        let lists = in_front.chain(self.axis.lists());
        let constants = Self::declared().flat_map(|stage| stage.constants);
        constants.zip(lists.chain(self.behind.lists()))
    }

    /// The stages with these constants; `numbers` lends those of each. Offset and sign are those of
    /// [`Stages::NONE`].
    ///
    /// # Errors
    /// As [`Stages::of_lists`].
    ///
    /// ```
    /// use hysteron_core::Stages;
    /// let stages = Stages::with_constants(|constant| match constant.name {
    ///     "lag" => &[0.5],
    ///     _ => &[],
    /// })?;
    /// assert_eq!(stages.behind.lag.tau, 0.5);
    /// # Ok::<(), hysteron_core::Error>(())
    /// ```
    pub fn with_constants(
        mut numbers: impl FnMut(&'static Constant) -> &'a [T],
    ) -> Result<Self, Error> {
        let mut constants = Self::declared().flat_map(|stage| stage.constants);
        Self::of_lists(|| constants.next().map_or(&[] as &[T], &mut numbers))
    }

    /// The stages with these constants. `next` lends the numbers of one after the other, in the
    /// order of [`Stages::declared`].
    ///
    /// # Errors
    /// [`Error::Stage`] with the name of a stage of which a constant has too many numbers, or is
    /// missing. Values are checked by [`Stages::check`].
    pub fn of_lists(mut next: impl FnMut() -> &'a [T]) -> Result<Self, Error> {
        let fault = |stage| Error::Stage { stage };
        Ok(Self {
            body: Option::of_lists(&mut next).ok_or(fault("body"))?,
            latent: Latent::of_lists(&mut next).ok_or(fault("latent"))?,
            axis: Axis::of_lists(&mut next).ok_or(fault("load"))?,
            behind: Behind::of_lists(&mut next).map_err(fault)?,
            ..Self::NONE
        })
    }
}

impl<T: Real> Stages<'_, T> {
    /// No stages: the output is the operators' sum.
    pub const NONE: Self = Stages {
        body: None,
        latent: Latent::NONE,
        axis: Axis::PLAIN,
        behind: Behind::NONE,
        offset: T::ZERO,
        falling: false,
    };

    /// Checks the constants of all stages, for the operators of `model`: that each is in its
    /// [`Range`], that they fit each other, and that no output is larger than [`Real::LARGEST`]. No
    /// step overflows then.
    ///
    /// # Errors
    /// [`Error::Stage`] with the name of the constant.
    pub fn check<C: AsRef<[T]>>(&self, model: &Model<T, C>) -> Result<(), Error> {
        let fault = |stage| Err(Error::Stage { stage });
        let within = |range: Range, numbers: &[T]| numbers.iter().all(|number| range.has(*number));
        let mut constants = self.constants();
        if let Some((constant, _)) =
            constants.find(|(constant, numbers)| !within(constant.range, numbers))
        {
            return fault(constant.name);
        }
        // A relay binds its heat at once, and weights below zero bind it while they switch off: no
        // temperature, or more than one, may balance it.
        let steady = model.operator() != Operator::Relay && model.negative_weights().is_none();
        if self.latent != Latent::NONE && !(steady && self.body.is_some()) {
            return fault("latent");
        }
        let fits = self
            .axis
            .fits()
            .and_then(|()| self.axis.fits_plane(model.plane()));
        if let Err(stage) = fits.and_then(|()| self.behind.fits()) {
            return fault(stage);
        }
        if !Range::Size.has(self.offset) {
            return fault("offset");
        }
        // Two entries of the table make an output of KP and of relays.
        let entries = &model.table()[..table_len(model.plane().levels())];
        let most = entries
            .iter()
            .fold(T::ZERO, |most, e| most.max(*e).max(-*e));
        let sum = self.gain_most() * (most + most);
        let outputs = [sum, -sum].map(|sum| self.behind.settled(sum));
        match outputs.into_iter().all(|output| Range::Size.has(output)) {
            true => Ok(()),
            false => fault("weights"),
        }
    }

    /// The output behind all stages from that of the operators, `h`, in its unit and with its sign.
    /// `past` is what the call before returned; `None` at the first sample.
    #[must_use]
    pub fn after(&self, past: Option<StageState<T>>, dt: T, h: T) -> (T, StageState<T>) {
        let (factors, mut next) = self.alone(past, dt);
        let sum = self
            .behind
            .forward(next.started, &mut next.behind, &factors, self.inward(h));
        next.started = true;
        (self.outward(sum), next)
    }

    /// The output of the operators, in its unit and with its sign, from the output `y` behind all
    /// stages. `past` is what the call before returned: what the stages remember. `None` at the
    /// first sample, where they are at rest.
    ///
    /// The result is not finite for a lag in a step without length.
    #[must_use]
    pub fn undo_after(&self, past: Option<StageState<T>>, dt: T, y: T) -> (T, StageState<T>) {
        let (factors, mut next) = self.alone(past, dt);
        let h = self.behind.inverse(&next.behind, &factors, self.inward(y));
        self.behind
            .forward(next.started, &mut next.behind, &factors, h);
        next.started = true;
        (self.outward(h), next)
    }

    /// What the stages behind the operators need for a sample without the others.
    fn alone(&self, past: Option<StageState<T>>, dt: T) -> (behind::Factors<T>, StageState<T>) {
        let memory = past.unwrap_or_default();
        let factors = match memory.started {
            true => self.behind.factors(dt),
            false => behind::Factors::default(),
        };
        (factors, memory)
    }

    /// The range of the outputs at rest, at the load where it is widest.
    pub(crate) fn range<C: AsRef<[T]>>(&self, model: &Model<T, C>) -> T {
        let (off, on) = model.output_range();
        let ends = [off, on].map(|sum| self.behind.settled(self.gain_most() * sum));
        (ends[1] - ends[0]).max(ends[0] - ends[1])
    }

    /// The largest gain of the load; 1 without one.
    fn gain_most(&self) -> T {
        let gains = self.axis.load.gains.iter();
        let gain = gains.fold(T::ZERO, |most, gain| most.max(*gain));
        if gain > T::ZERO { gain } else { T::ONE }
    }

    /// Whether no stage is there.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.body.is_none()
            && self.latent == Latent::NONE
            && self.axis == Axis::PLAIN
            && !self.behind.there().any(|(_, there)| there)
    }

    /// Whether a stage depends on time, so that each sample needs its `dt`.
    #[must_use]
    pub fn is_timed(&self) -> bool {
        self.body.is_some() || self.behind.is_timed()
    }

    /// The factors for a time step of `dt` seconds, 0 or more.
    #[must_use]
    pub fn rates(&self, dt: T) -> Rates<T> {
        Rates {
            decay: self.body.map(|body| body.decay(dt)).unwrap_or_default(),
            behind: self.behind.factors(dt),
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
        let unbound = self.heated(memory, rates, input);
        if !(input.is_finite() && unbound.is_finite()) {
            return Err(Error::InputNotFinite { index: 0 });
        }
        let temperature = match memory.started {
            true => {
                model.check(state)?;
                let axis = (&self.axis, loaded);
                self.latent.bound(model, state, axis, unbound)
            }
            false => unbound,
        };
        let seen = self
            .axis
            .seen(model.plane(), loaded, state.input(), temperature);
        let step = model.step(state, seen)?;
        let h = loaded.gain * step.output;
        let factors = factors(memory, rates);
        let sum = self
            .behind
            .forward(memory.started, &mut memory.behind, &factors, h);
        (memory.started, memory.temperature) = (true, temperature);
        Ok(Output {
            output: loaded.offset + self.outward(sum),
            clipped: step.clipped,
        })
    }

    /// The temperature after a step with this input, if it binds no heat.
    pub(crate) fn heated(&self, memory: &StageState<T>, rates: &Rates<T>, input: T) -> T {
        match self.body {
            None => input,
            Some(body) if memory.started => body.step(memory.temperature, input, rates.decay),
            Some(body) => body.rest(input),
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

/// The factors of the stages behind the operators. Before the first sample nothing of a past is
/// left.
pub(crate) fn factors<T: Real>(memory: &StageState<T>, rates: &Rates<T>) -> behind::Factors<T> {
    match memory.started {
        true => rates.behind,
        false => behind::Factors::default(),
    }
}
