//! The stages of a model in the number type of the target, at a fixed sample time.

use super::constants::{Constants, Number, unfit};
use hysteron::{Error, Model, Remedy, Result, Setting};
use hysteron_core::{Axis, Body, Creep, Load, MAX_CREEP, MAX_PARTS, Real, Stages, table_len};

/// How a model with stages runs on the target.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CSampling {
    /// The sample time in seconds, above zero. Needed by a model that depends on time, and only by
    /// one.
    pub dt: Option<f64>,
    /// Lowest and highest drive that the inverse may give; by default [`Model::drive_range`]. Only
    /// for a model with stages.
    pub drive: Option<(f64, f64)>,
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
    pub(super) body: Option<Body<T>>,
    pub(super) loads: Vec<T>,
    pub(super) shifts: Vec<T>,
    pub(super) scales: Vec<T>,
    pub(super) gains: Vec<T>,
    pub(super) offsets: Vec<T>,
    pub(super) spacing: Vec<T>,
    pub(super) creep: Vec<T>,
    taus: Vec<T>,
    lag: T,
    /// Those of [`hysteron_core::Rates::to_numbers`].
    pub(super) rates: [T; MAX_CREEP + 3],
    pub(super) creep_gain: T,
    /// Levels per corner, where they are closest, in units of the plane's axis.
    pub(super) steepest: T,
    /// The range of the drive, where there is one.
    pub(super) drive: Option<(T, T)>,
    /// `None` where the weights do not depend on the load.
    pub(super) parts: Option<Parts<T>>,
}

impl<T: Number> Staged<T> {
    /// `None` for a model without a stage.
    pub(super) fn of(
        model: &Model,
        constants: &Constants<T>,
        sampling: &CSampling,
    ) -> Result<Option<Self>> {
        let stages = model.stages();
        let load = stages.axis.load;
        let parts = model
            .load
            .as_ref()
            .is_some_and(|load| load.parts().len() > 1);
        let bare = !parts
            && stages.body.is_none()
            && load.loads.is_empty()
            && stages.axis.spacing.is_empty()
            && !model.is_timed();
        check(model, sampling, bare)?;
        if bare {
            return Ok(None);
        }
        let number = |what: &str, number: f64| {
            let near = T::of(number).filter(|near| near.is_finite());
            near.ok_or_else(|| unfit(&format!("{what} of {number:e}")))
        };
        let all = |what: &str, numbers: &[f64]| {
            let numbers = numbers.iter().map(|&n| number(what, n));
            numbers.collect::<Result<Vec<T>>>()
        };
        let body = |body: Body<f64>| -> Result<Body<T>> {
            Ok(Body {
                ambient: number("an ambient temperature", body.ambient)?,
                gain: number("a gain of the body", body.gain)?,
                tau_heating: number("a time constant", body.tau_heating)?,
                tau_cooling: number("a time constant", body.tau_cooling)?,
            })
        };
        let drive = match (sampling.drive, stages.body) {
            (None, None) => None,
            (drive, _) => {
                let (low, high) = drive.unwrap_or_else(|| model.drive_range());
                Some((number("a drive", low)?, number("a drive", high)?))
            }
        };
        let mut staged = Self {
            dt: sampling.dt,
            body: stages.body.map(body).transpose()?,
            loads: all("a load", load.loads)?,
            shifts: all("a shift", load.shifts)?,
            scales: all("a scale", load.scales)?,
            gains: all("a gain of the load", load.gains)?,
            offsets: all("an offset of the load", load.offsets)?,
            spacing: all("a level", stages.axis.spacing)?,
            creep: all("a coefficient of the creep", stages.creep.coefficients)?,
            taus: all("a time constant", stages.creep.taus)?,
            lag: number("a lag", stages.lag)?,
            rates: [T::ZERO; MAX_CREEP + 3],
            creep_gain: T::ONE,
            steepest: T::ONE,
            drive,
            parts: Parts::of(model, constants)?,
        };
        let core = staged.core(constants);
        core.check(&constants.core)
            .map_err(|error| unfit(&error.to_string()))?;
        let creep_gain = core.creep.gain();
        let rates = match sampling.dt {
            Some(dt) => core.rates(number("a sample time", dt)?).to_numbers(),
            None => staged.rates,
        };
        let step = constants.core.plane().step();
        let slopes = staged
            .spacing
            .windows(2)
            .map(|pair| step / (pair[1] - pair[0]));
        let steepest = slopes.fold(T::ZERO, Real::max);
        (staged.creep_gain, staged.rates) = (creep_gain, rates);
        if !staged.spacing.is_empty() {
            staged.steepest = steepest;
        }
        Ok(Some(staged))
    }

    /// The stages as the core takes them.
    fn core(&self, constants: &Constants<T>) -> Stages<'_, T> {
        Stages {
            body: self.body,
            axis: Axis {
                load: Load {
                    loads: &self.loads,
                    shifts: &self.shifts,
                    scales: &self.scales,
                    gains: &self.gains,
                    offsets: &self.offsets,
                },
                spacing: &self.spacing,
            },
            creep: Creep {
                coefficients: &self.creep,
                taus: &self.taus,
            },
            lag: self.lag,
            offset: constants.offset,
            falling: constants.falls,
        }
    }

    /// Names of the stages that are there.
    pub(super) fn names(&self) -> Vec<&'static str> {
        let all = [
            ("body", self.body.is_some()),
            ("load", !self.loads.is_empty() || self.parts.is_some()),
            ("spacing", !self.spacing.is_empty()),
            ("creep", !self.creep.is_empty()),
            ("lag", self.lag > T::ZERO),
        ];
        let there = all.into_iter().filter(|(_, there)| *there);
        there.map(|(name, _)| name).collect()
    }

    /// How many numbers the arrays of the constants have, without the start.
    pub(super) fn numbers(&self) -> usize {
        let curves = [&self.shifts, &self.scales, &self.gains, &self.offsets];
        let curves: usize = curves.iter().map(|curve| curve.len()).sum();
        let offsets = self.parts.as_ref().map_or(0, |parts| parts.offsets.len());
        self.loads.len() + curves + self.spacing.len() + offsets
    }

    /// Whether the inverse has to be refused, because a part has weights below zero.
    pub(super) fn is_negative(&self) -> bool {
        self.parts.as_ref().is_some_and(|parts| parts.negative)
    }
}

impl<T: Number> Parts<T> {
    fn of(model: &Model, constants: &Constants<T>) -> Result<Option<Self>> {
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
            let near = T::of(number).filter(|near| near.is_finite());
            near.ok_or_else(|| unfit(&format!("{what} of {number:e}")))
        };
        let plane = *constants.core.plane();
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
