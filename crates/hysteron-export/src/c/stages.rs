//! The stages of a model in the number type of the target, at a fixed sample time.

use super::real::{Number, unfit};
use hysteron::{Error, Model, Remedy, Result, Setting, StageConstants};
use hysteron_core::{Constant, MAX_CREEP, MAX_PARTS, Plane, RATE_NUMBERS, Real, Stages, table_len};

/// How a model with stages runs on the target.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CSampling {
    /// The sample time in seconds, above zero. Needed by a model that depends on time, and only by
    /// one.
    pub dt: Option<f64>,
    /// Lowest and highest drive that the inverse may give; by default [`Model::drive_range`]. Only
    /// for a model with stages.
    pub drive: Option<(f64, f64)>,
    /// Whether the time of each sample is measured on the target and given to
    /// `hys_controller_step_after`. Only for a control loop, and for a model without a ring: its
    /// factors need sine, cosine and `e^x − 1`, and the library's sine of a `float` computes in
    /// `double`, which chips have in software or not at all.
    pub measured: bool,
}

impl CSampling {
    /// For a loop around `model`, with its sample time if the model depends on time. The inverse
    /// keeps to the drives that were fitted, as in a run: at the loop's own limit it would leave
    /// the integral no room.
    ///
    /// ```
    /// use hysteron::{Model, Operator, Plane, Sign};
    /// use hysteron_export::CSampling;
    /// let plane = Plane::new(0.0, 1.0, 2)?;
    /// let model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)?;
    /// assert_eq!(CSampling::of_loop(&model, Some(0.05)).dt, None);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    #[must_use]
    pub fn of_loop(model: &Model, dt: Option<f64>) -> Self {
        Self {
            dt: dt.filter(|_| model.is_timed()),
            ..Self::default()
        }
    }
}

/// Weights that depend on the load: the constants of `hys_parts`.
pub(super) struct Parts<T> {
    /// The Everett tables, one after the other.
    pub(super) tables: Vec<T>,
    pub(super) offsets: Vec<T>,
    /// The range of the loads.
    pub(super) range: (T, T),
    /// Whether a weight of a part is below zero.
    negative: bool,
}

/// The constants of `hys_actuator`.
pub(super) struct Staged<T> {
    pub(super) dt: Option<f64>,
    /// Whether its factors are those of a measured time.
    pub(super) measured: bool,
    pub(super) constants: StageConstants<T>,
    /// Those of [`hysteron_core::Rates::to_numbers`].
    pub(super) rates: [T; RATE_NUMBERS],
    /// The gain at rest of the stages behind the operators.
    pub(super) gain: T,
    /// The size of the numbers that they add to the output's.
    pub(super) size: T,
    /// Levels per corner, where they are closest, in units of the plane's axis.
    pub(super) steepest: T,
    /// The range of the drive, where there is one.
    pub(super) drive: Option<(T, T)>,
    /// `None` where the weights do not depend on the load.
    pub(super) parts: Option<Parts<T>>,
    /// Offset and sign of the output.
    offset: T,
    falls: bool,
}

impl<T: Number> Staged<T> {
    /// `None` for a model without a stage.
    pub(super) fn new(
        model: &Model,
        operators: &hysteron_core::Model<T, Vec<T>>,
        (offset, falls): (T, bool),
        sampling: &CSampling,
    ) -> Result<Option<Self>> {
        let bare = model.is_plain() || {
            // One part of weights for a load, without curves.
            let parts = model.load.as_ref().map_or(1, |load| load.parts().len());
            parts == 1 && model.constants().is_none()
        };
        check(model, sampling, bare)?;
        if bare {
            return Ok(None);
        }
        let number = |what: &str, number: f64| {
            let near = T::nearest(number).filter(|near| near.is_finite());
            near.ok_or_else(|| unfit(&format!("{what} of {number:e}")))
        };
        let drive = match (sampling.drive, model.thermal) {
            (None, None) => None,
            (drive, _) => {
                let (low, high) = drive.unwrap_or_else(|| model.drive_range());
                Some((number("a drive", low)?, number("a drive", high)?))
            }
        };
        let all = model.constants();
        let of_stage = |constant: &Constant, value| number(&format!("`{}`", constant.name), value);
        let mut staged = Self {
            dt: sampling.dt,
            measured: sampling.measured && model.is_timed(),
            constants: all.map(of_stage)?,
            rates: [T::ZERO; RATE_NUMBERS],
            gain: T::ONE,
            size: T::ZERO,
            steepest: T::ONE,
            drive,
            parts: Parts::new(model, *operators.plane())?,
            offset,
            falls,
        };
        let core = staged.core();
        core.check(operators)
            .map_err(|error| unfit(&error.to_string()))?;
        let (gain, size) = (core.behind.steepest_at_rest(), core.behind.size());
        let rates = match sampling.dt {
            Some(dt) => core.rates(number("a sample time", dt)?).to_numbers(),
            None => staged.rates,
        };
        let step = operators.plane().step();
        let corners = core.axis.spacing.windows(2);
        let slopes = corners.map(|pair| step / (pair[1] - pair[0]));
        let steepest = slopes.reduce(Real::max).unwrap_or(T::ONE);
        let steepest = steepest * core.axis.registration.steepest();
        (staged.gain, staged.size) = (gain, size);
        (staged.rates, staged.steepest) = (rates, steepest);
        Ok(Some(staged))
    }

    /// The stages as the core takes them.
    pub(super) fn core(&self) -> Stages<'_, T> {
        Stages {
            offset: self.offset,
            falling: self.falls,
            ..self.constants.stages()
        }
    }

    /// Names of the stages that are there.
    pub(super) fn names(&self) -> Vec<&'static str> {
        let by_load = |name| name == "load" && self.parts.is_some();
        let has = |constants: &[Constant]| {
            let mut numbers = constants.iter().flat_map(|c| self.constants.get(c.name));
            numbers.any(|number| *number != T::ZERO)
        };
        Stages::<T>::declared()
            .filter(|stage| by_load(stage.name) || has(stage.constants))
            .map(|stage| stage.name)
            .collect()
    }

    /// The constants that C has as arrays: those that are lists. Time constants and frequencies act
    /// through factors alone, and those of the body and its heat are single numbers.
    pub(super) fn arrays(&self) -> impl Iterator<Item = (&'static str, &[T])> {
        let single = |name: &str| ["ambient", "gain", "latent"].contains(&name);
        self.constants
            .iter()
            .filter(move |(constant, _)| !single(constant.name) && !constant.range.is_timed())
            .map(|(constant, numbers)| (constant.name, numbers))
    }

    /// The time constant of each factor, in the order of the rates; zero where there is none.
    pub(super) fn times(&self) -> [T; RATE_NUMBERS] {
        let mut times = [T::ZERO; RATE_NUMBERS];
        let places = [
            ("tau_heating", 0),
            ("tau_cooling", 1),
            ("creep_taus", 2),
            ("lag", 2 + MAX_CREEP),
        ];
        for (name, first) in places {
            let own = self.constants.get(name);
            times[first..][..own.len()].copy_from_slice(own);
        }
        times
    }

    /// How many numbers the arrays of the constants have, without the start.
    pub(super) fn numbers(&self) -> usize {
        let offsets = self.parts.as_ref().map_or(0, |parts| parts.offsets.len());
        self.arrays()
            .map(|(_, numbers)| numbers.len())
            .sum::<usize>()
            + offsets
    }

    /// Whether the inverse has to be refused, because a part has weights below zero.
    pub(super) fn is_negative(&self) -> bool {
        self.parts.as_ref().is_some_and(|parts| parts.negative)
    }
}

impl<T: Number> Parts<T> {
    fn new(model: &Model, plane: Plane<T>) -> Result<Option<Self>> {
        let Some(load) = model.load.as_ref().filter(|load| load.parts().len() > 1) else {
            return Ok(None);
        };
        let count = load.parts().len();
        if count > MAX_PARTS {
            let what =
                format!("the weights have {count} parts over the load, and C has {MAX_PARTS}");
            let remedy = Remedy::new("export it at one load with {}", [Setting::any("load")]);
            return Err(Error::Export(what).remedied(remedy));
        }
        let number = |what: &str, number: f64| {
            let near = T::nearest(number).filter(|near| near.is_finite());
            near.ok_or_else(|| unfit(&format!("{what} of {number:e}")))
        };
        let (low, high) = load.range();
        let mut parts = Self {
            tables: Vec::new(),
            offsets: Vec::new(),
            range: (number("a load", low)?, number("a load", high)?),
            negative: false,
        };
        for part in load.parts() {
            let weights = part.weights.iter().map(|&mu| number("a weight", mu));
            let weights = weights.collect::<Result<Vec<T>>>()?;
            let table = vec![T::ZERO; table_len(plane.levels())];
            let core = hysteron_core::Model::new(plane, model.operator(), &weights, table)
                .map_err(|_| unfit("the sum of the weights"))?;
            parts.negative |= core.negative_weights().is_some();
            parts.tables.extend_from_slice(core.table());
            parts.offsets.push(number("an offset", part.offset)?);
        }
        // False where both round to one number.
        let apart = parts.range.0 < parts.range.1;
        match apart {
            true => Ok(Some(parts)),
            false => Err(unfit("the range of the loads")),
        }
    }
}

/// Refuses what does not belong to the model.
fn check(model: &Model, sampling: &CSampling, bare: bool) -> Result<()> {
    let refused = |what: String, words: &'static str, name: &'static str| {
        let remedy = Remedy::new(words, [Setting::any(name)]);
        Err(Error::Export(what).remedied(remedy))
    };
    match sampling.dt {
        None if model.is_timed() => {
            let what = "the model depends on time, and the C runs at a fixed sample time".into();
            return refused(what, "give it in seconds with {}", "dt");
        }
        Some(dt) if !model.is_timed() => {
            let what =
                format!("the model does not depend on time, so there is no sample time {dt}");
            return refused(what, "leave {} out", "dt");
        }
        Some(dt) if !(dt > 0.0 && dt.is_finite()) => {
            let what = format!("the sample time of {dt} s is not a finite number above zero");
            return refused(what, "give another one with {}", "dt");
        }
        _ => {}
    }
    let rings = !model.constants().get("ring_frequency").is_empty();
    if sampling.measured && rings {
        let what = "a ring has constants for one sample time alone on the target: those of a \
                    measured one need a sine that computes in double"
            .into();
        return refused(what, "leave {} out", "measured-dt");
    }
    match sampling.drive {
        Some(_) if bare => {
            let what = "the model has no stages: its inverse stays in the plane by itself".into();
            refused(what, "leave {} out", "drive-range")
        }
        // Written so that NaN fails the comparison.
        Some((low, high)) if !(low <= high && low.is_finite() && high.is_finite()) => {
            let what = format!(
                "the range of the drive, {low} to {high}, needs two finite numbers in order"
            );
            refused(what, "give another one with {}", "drive-range")
        }
        _ => Ok(()),
    }
}
