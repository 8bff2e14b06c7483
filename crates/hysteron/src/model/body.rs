//! The thermal body in front of the operators. It turns a drive into the temperature that moves the
//! operators.

use crate::error::{Error, Result};
use crate::model::Model;
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A lumped thermal body: `θ' = (g u − θ)/τ`, with one time constant for heating (`g u > θ`) and
/// one for cooling.
///
/// `θ` is the temperature above the surroundings. If no temperature was measured, the gain cannot
/// be identified. It is then 1, and `θ` is in units of the drive that holds it constant. The drive
/// must be proportional to the heating power, as a duty cycle is. Of a current or a voltage, give
/// the square.
///
/// ```
/// let body = hysteron::FirstOrder { gain: 1.0, tau_heating: 2.0, tau_cooling: 4.0 };
/// let temperature = body.respond(&[0.0, 1.0, 3.0], &[0.0, 1.0, 1.0])?;
/// assert_eq!(temperature, [0.0, 0.0, 1.0 - (-1.0_f64).exp()]);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct FirstOrder {
    /// Temperature at rest per unit of the drive; above zero.
    pub gain: f64,
    /// Time constant of heating in seconds; above zero.
    pub tau_heating: f64,
    /// Time constant of cooling in seconds; above zero.
    pub tau_cooling: f64,
}

/// State of a body: the last drive, and the temperature at that time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThermalState {
    drive: f64,
    temperature: f64,
}

impl ThermalState {
    /// Temperature above the surroundings.
    #[must_use]
    pub fn temperature(&self) -> f64 {
        self.temperature
    }
}

impl FirstOrder {
    /// A body at rest under a constant `drive`.
    #[must_use]
    pub fn at_rest(&self, drive: f64) -> ThermalState {
        ThermalState {
            drive,
            temperature: self.gain * drive,
        }
    }

    /// The temperature `dt` seconds after the last sample, when the drive changes to `drive`.
    ///
    /// This is exact for a drive that is held between samples, for any step length. The temperature
    /// moves towards its rest value and never beyond it, so one time constant holds for the whole
    /// step.
    ///
    /// # Errors
    /// [`Error::Thermal`] for numbers that are not finite, a negative `dt`, or a body with a
    /// parameter that is not above zero; then the state is unchanged.
    pub fn step(&self, state: &mut ThermalState, dt: f64, drive: f64) -> Result<f64> {
        if let Some((name, value)) = self.fault() {
            return Err(Error::Thermal(format!(
                "the body's {name} is {value}, but must be a finite number above zero"
            )));
        }
        if !(dt >= 0.0 && dt.is_finite() && drive.is_finite()) {
            return Err(Error::Thermal(format!(
                "drive {drive} after {dt} s: times must not go back and both must be finite numbers"
            )));
        }
        let rest = self.gain * state.drive;
        let tau = match rest > state.temperature {
            true => self.tau_heating,
            false => self.tau_cooling,
        };
        let temperature = rest + (state.temperature - rest) * (-dt / tau).exp();
        *state = ThermalState { drive, temperature };
        Ok(temperature)
    }

    /// The temperature at each time (seconds) under `drive`, which has as many samples. The body
    /// starts at rest with the first drive.
    ///
    /// # Errors
    /// As [`FirstOrder::step`], and for series of different lengths.
    pub fn respond(&self, time: &[f64], drive: &[f64]) -> Result<Vec<f64>> {
        if time.len() != drive.len() {
            return Err(Error::Thermal(format!(
                "{} times, but {} samples of the drive",
                time.len(),
                drive.len()
            )));
        }
        let (Some(&first), Some(&u)) = (time.first(), drive.first()) else {
            return Ok(Vec::new());
        };
        let mut state = self.at_rest(u);
        let mut last = first;
        let samples = time.iter().zip(drive);
        samples
            .map(|(&t, &u)| self.step(&mut state, t - std::mem::replace(&mut last, t), u))
            .collect()
    }

    /// The recording with the body's temperature as its input.
    ///
    /// # Errors
    /// [`Error::Thermal`] for a recording without time, and as [`FirstOrder::respond`].
    pub fn behind(&self, recording: &Recording) -> Result<Recording> {
        let time = recording.time.as_ref().ok_or_else(needs_time)?;
        Ok(Recording {
            input: self.respond(time, &recording.input)?,
            ..recording.clone()
        })
    }

    /// The name and value of the first parameter that is not a finite number above zero; `None` if
    /// all are valid.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64)> {
        [
            ("gain", self.gain),
            ("tau_heating", self.tau_heating),
            ("tau_cooling", self.tau_cooling),
        ]
        .into_iter()
        .find(|(_, value)| !(*value > 0.0 && value.is_finite()))
    }
}

impl Model {
    /// The recording as the operators see it: behind the thermal body, if the model has one.
    ///
    /// # Errors
    /// [`Error::Thermal`] for a recording without time if there is a body.
    pub fn behind_body<'r>(&self, recording: &'r Recording) -> Result<Cow<'r, Recording>> {
        match &self.thermal {
            None => Ok(Cow::Borrowed(recording)),
            Some(body) => Ok(Cow::Owned(body.behind(recording)?)),
        }
    }
}

pub(crate) fn needs_time() -> Error {
    let what = "the model has a thermal body, whose temperature depends on time";
    let remedy = Remedy::new("give that too ({})", [Setting::any("time")]);
    Error::Thermal(what.into()).remedied(remedy)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const BODY: FirstOrder = FirstOrder {
        gain: 2.0,
        tau_heating: 3.0,
        tau_cooling: 7.0,
    };

    /// A drive that changes every 5 s, sampled every 5/`parts` s.
    fn held(parts: usize) -> (Vec<f64>, Vec<f64>) {
        let drive = [1.0, 4.0, 0.0, 0.5, 3.0, 0.0];
        let samples = 0..drive.len() * parts;
        let time = samples.clone().map(|n| 5.0 * n as f64 / parts as f64);
        (time.collect(), samples.map(|n| drive[n / parts]).collect())
    }

    #[test]
    fn a_held_drive_may_be_sampled_at_any_rate() {
        let (time, drive) = held(1);
        let coarse = BODY.respond(&time, &drive).unwrap();
        for parts in [2, 7, 500] {
            let (time, drive) = held(parts);
            let fine = BODY.respond(&time, &drive).unwrap();
            for (n, theta) in coarse.iter().enumerate() {
                // One rounding for each of up to 3000 samples.
                assert!((fine[n * parts] - theta).abs() < 3000.0 * 8.0 * f64::EPSILON);
            }
        }
    }

    #[test]
    fn heating_and_cooling_have_their_own_time_constants() {
        let time: Vec<f64> = (0..3).map(f64::from).collect();
        let heated = BODY.respond(&time, &[0.0, 1.0, 1.0]).unwrap();
        assert_eq!(heated[2], 2.0 - 2.0 * (-1.0 / 3.0_f64).exp());
        let cooled = BODY.respond(&time, &[1.0, 0.0, 0.0]).unwrap();
        assert_eq!(cooled[2], 2.0 * (-1.0 / 7.0_f64).exp());
    }

    #[test]
    fn what_cannot_be_is_refused_and_leaves_the_state() {
        let mut state = BODY.at_rest(0.5);
        let before = state;
        for (dt, drive) in [
            (-0.1, 1.0),
            (f64::NAN, 1.0),
            (f64::INFINITY, 1.0),
            (2.0, f64::NAN),
        ] {
            assert!(BODY.step(&mut state, dt, drive).is_err());
            assert_eq!(state, before);
        }
        assert!(BODY.respond(&[0.0], &[]).is_err());
        assert!(BODY.respond(&[], &[]).unwrap().is_empty());
    }
}
