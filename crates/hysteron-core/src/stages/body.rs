//! The thermal body: from a drive to a temperature.

use crate::scalar::Real;
use crate::stages::constant::{Constant, Constants, Declared, Range, Unit, one};

/// A lumped thermal body: `T' = (T∞ − T)/τ` with `T∞ = T_ambient + gain · drive`. It has one time
/// constant for heating (`T∞ > T`) and one for cooling.
///
/// ```
/// use hysteron_core::Body;
/// let body = Body { ambient: 20.0, gain: 2.0, tau_heating: 2.0_f64, tau_cooling: 4.0 };
/// let decay = body.decay(2.0);
/// let heated = body.step(20.0, 10.0, decay); // held for one time constant
/// assert!((heated - (40.0 - 20.0 * (-1.0_f64).exp())).abs() < 1e-12);
/// assert!((body.drive(20.0, heated, decay) - 10.0).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body<T> {
    /// Temperature at rest without a drive.
    pub ambient: T,
    /// Temperature at rest per unit of the drive; above zero.
    pub gain: T,
    /// Time constant of heating, in seconds; above zero.
    pub tau_heating: T,
    /// Time constant of cooling, in seconds; above zero.
    pub tau_cooling: T,
}

/// The factors `e^(−dt/τ)` of a body for one time step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Decay<T> {
    /// For heating.
    pub heating: T,
    /// For cooling.
    pub cooling: T,
}

impl<T: Real> Body<T> {
    /// The factors for a time step of `dt` seconds, 0 or more.
    #[must_use]
    pub fn decay(&self, dt: T) -> Decay<T> {
        Decay {
            heating: (-dt / self.tau_heating).exp(),
            cooling: (-dt / self.tau_cooling).exp(),
        }
    }

    /// The temperature at rest under a constant `drive`.
    #[must_use]
    pub fn rest(&self, drive: T) -> T {
        self.ambient + self.gain * drive
    }

    /// The drive that holds `temperature`. The inverse of [`Body::rest`].
    #[must_use]
    pub fn hold(&self, temperature: T) -> T {
        (temperature - self.ambient) / self.gain
    }

    /// The temperature after a step in which `drive` is held.
    ///
    /// Exact for any length of the step: the temperature moves towards its rest value and never
    /// beyond it, so one time constant holds for the whole step.
    #[must_use]
    pub fn step(&self, temperature: T, drive: T, decay: Decay<T>) -> T {
        let rest = self.rest(drive);
        let factor = match rest > temperature {
            true => decay.heating,
            false => decay.cooling,
        };
        rest + (temperature - rest) * factor
    }

    /// The drive that takes `temperature` to `wanted` in one step. The inverse of [`Body::step`].
    ///
    /// In a step without length no drive moves the temperature: the result is then infinite, or
    /// NaN where nothing has to move.
    #[must_use]
    pub fn drive(&self, temperature: T, wanted: T, decay: Decay<T>) -> T {
        let factor = match wanted > temperature {
            true => decay.heating,
            false => decay.cooling,
        };
        self.hold(temperature + (wanted - temperature) / (T::ONE - factor))
    }
}

/// A body that may be missing.
impl<'a, T: Real> Constants<'a, T> for Option<Body<T>> {
    const DECLARED: &'static [Declared] = &[Declared {
        name: "body",
        about: "first-order heating and cooling, from a drive to the temperature",
        constants: &[
            Constant {
                name: "ambient",
                unit: Unit::Temperature,
                range: Range::Size,
                meaning: "the temperature at rest without a drive",
            },
            Constant {
                name: "gain",
                unit: Unit::TemperaturePerDrive,
                range: Range::Slope,
                meaning: "the temperature at rest per unit of the drive",
            },
            Constant {
                name: "tau_heating",
                unit: Unit::Second,
                range: Range::Time,
                meaning: "the time constant of heating",
            },
            Constant {
                name: "tau_cooling",
                unit: Unit::Second,
                range: Range::Time,
                meaning: "the time constant of cooling",
            },
        ],
    }];

    fn lists(&self) -> impl Iterator<Item = &[T]> {
        let list = |constant: fn(&Body<T>) -> &T| match self {
            Some(body) => core::slice::from_ref(constant(body)),
            None => &[],
        };
        [
            list(|body| &body.ambient),
            list(|body| &body.gain),
            list(|body| &body.tau_heating),
            list(|body| &body.tau_cooling),
        ]
        .into_iter()
    }

    fn of_lists(mut next: impl FnMut() -> &'a [T]) -> Option<Self> {
        let constants = [one(next())?, one(next())?, one(next())?, one(next())?];
        match constants {
            [None, None, None, None] => Some(None),
            [
                Some(ambient),
                Some(gain),
                Some(tau_heating),
                Some(tau_cooling),
            ] => Some(Some(Body {
                ambient,
                gain,
                tau_heating,
                tau_cooling,
            })),
            _ => None,
        }
    }

    fn fits(&self) -> Result<(), &'static str> {
        Ok(())
    }
}
