//! The thermal body in front of the operators. It turns a drive into the temperature that moves the
//! operators.

use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use serde::{Deserialize, Serialize};

/// A lumped thermal body: `T' = (T∞ − T)/τ` with `T∞ = ambient + gain · drive`. It has one time
/// constant for heating (`T∞ > T`) and one for cooling.
///
/// If no temperature was measured, gain and ambient temperature cannot be identified. They are then
/// 1 and 0, and the temperature is in units of the drive that holds it constant. The drive must be
/// proportional to the heating power, as a duty cycle is. Of a current or a voltage, give the
/// square.
///
/// The drive of a sample is the one that was held since the sample before.
///
/// ```
/// use hysteron::FirstOrder;
/// let body = FirstOrder { tau_heating: 2.0, tau_cooling: 4.0, ..FirstOrder::default() };
/// let temperature = body.respond(&[0.0, 1.0, 3.0], &[0.0, 0.0, 1.0])?;
/// assert_eq!(temperature, [0.0, 0.0, 1.0 - (-1.0_f64).exp()]);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct FirstOrder {
    /// Temperature at rest without a drive.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub ambient: f64,
    /// Temperature at rest per unit of the drive; above zero.
    pub gain: f64,
    /// Time constant of heating in seconds; above zero.
    pub tau_heating: f64,
    /// Time constant of cooling in seconds; above zero.
    pub tau_cooling: f64,
}

impl Default for FirstOrder {
    /// A body with time constants of one second, in units of the drive.
    fn default() -> Self {
        Self {
            ambient: 0.0,
            gain: 1.0,
            tau_heating: 1.0,
            tau_cooling: 1.0,
        }
    }
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl FirstOrder {
    /// The constants for the core.
    pub(crate) fn core(&self) -> hysteron_core::Body<f64> {
        hysteron_core::Body {
            ambient: self.ambient,
            gain: self.gain,
            tau_heating: self.tau_heating,
            tau_cooling: self.tau_cooling,
        }
    }

    /// The temperature at rest under a constant `drive`.
    #[must_use]
    pub fn rest(&self, drive: f64) -> f64 {
        self.core().rest(drive)
    }

    /// The temperature `dt` seconds after it was `temperature`, if `drive` is held in between.
    ///
    /// This is exact for any step length.
    ///
    /// # Errors
    /// [`Error::Thermal`] for numbers that are not finite, a negative `dt`, or a body with a
    /// parameter that is not above zero.
    pub fn step(&self, temperature: f64, dt: f64, drive: f64) -> Result<f64> {
        if let Some((name, value)) = self.fault() {
            return Err(Error::Thermal(format!(
                "the body's {name} is {value}, but must be {}",
                range_of(name)
            )));
        }
        if !(dt >= 0.0 && dt.is_finite() && drive.is_finite()) {
            return Err(Error::Thermal(format!(
                "drive {drive} after {dt} s: times must not go back and both must be finite numbers"
            )));
        }
        let body = self.core();
        Ok(body.step(temperature, drive, body.decay(dt)))
    }

    /// The temperature at each time (seconds) under `drive`, which has as many samples. The body
    /// starts at rest with the first drive.
    ///
    /// # Errors
    /// As [`FirstOrder::step`], and for series of different lengths.
    pub fn respond(&self, time: &[f64], drive: &[f64]) -> Result<Vec<f64>> {
        self.respond_from(None, time, drive)
    }

    /// As [`FirstOrder::respond`], at rest with another drive at first.
    fn respond_from(&self, rest: Option<f64>, time: &[f64], drive: &[f64]) -> Result<Vec<f64>> {
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
        let (mut temperature, mut last) = (self.rest(rest.unwrap_or(u)), first);
        let samples = time.iter().zip(drive);
        samples
            .map(|(&t, &u)| {
                temperature = self.step(temperature, t - std::mem::replace(&mut last, t), u)?;
                Ok(temperature)
            })
            .collect()
    }

    /// The recording with the body's temperature as its input. The body starts at rest with the
    /// first drive, or with [`Recording::rest`].
    ///
    /// # Errors
    /// [`Error::Thermal`] for a recording without time, and as [`FirstOrder::respond`].
    pub fn behind(&self, recording: &Recording) -> Result<Recording> {
        let time = recording.time.as_ref().ok_or_else(needs_time)?;
        Ok(Recording {
            input: self.respond_from(recording.rest, time, &recording.input)?,
            rest: None,
            ..recording.clone()
        })
    }

    /// The name and value of the first parameter that cannot be; `None` if all are valid.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64)> {
        let valid =
            |(name, value): &(&str, f64)| value.is_finite() && (*name == "ambient" || *value > 0.0);
        [
            ("ambient", self.ambient),
            ("gain", self.gain),
            ("tau_heating", self.tau_heating),
            ("tau_cooling", self.tau_cooling),
        ]
        .into_iter()
        .find(|parameter| !valid(parameter))
    }
}

/// What a parameter of the body has to be, in words.
pub(crate) fn range_of(parameter: &str) -> &'static str {
    match parameter {
        "ambient" => "a finite number",
        _ => "a finite number above zero",
    }
}

pub(crate) fn needs_time() -> Error {
    let what =
        "the model depends on time: it needs the time of each sample, which does not go back";
    let remedy = Remedy::new("give it ({})", [Setting::any("time")]);
    Error::Thermal(what.into()).remedied(remedy)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const BODY: FirstOrder = FirstOrder {
        ambient: 20.0,
        gain: 2.0,
        tau_heating: 3.0,
        tau_cooling: 7.0,
    };

    /// A drive that changes every 5 s, sampled every 5/`parts` s.
    fn held(parts: usize) -> (Vec<f64>, Vec<f64>) {
        let drive = [1.0, 4.0, 0.0, 0.5, 3.0, 0.0];
        let samples = 0..1 + (drive.len() - 1) * parts;
        let time = samples.clone().map(|n| 5.0 * n as f64 / parts as f64);
        (
            time.collect(),
            samples.map(|n| drive[n.div_ceil(parts)]).collect(),
        )
    }

    #[test]
    fn a_held_drive_may_be_sampled_at_any_rate() {
        let (time, drive) = held(1);
        let coarse = BODY.respond(&time, &drive).unwrap();
        for parts in [2, 7, 500] {
            let (time, drive) = held(parts);
            let fine = BODY.respond(&time, &drive).unwrap();
            for (n, theta) in coarse.iter().enumerate() {
                // A few roundings of numbers up to 30 for each of up to 3000 samples.
                assert!((fine[n * parts] - theta).abs() < 3000.0 * 100.0 * f64::EPSILON);
            }
        }
    }

    #[test]
    fn heating_and_cooling_have_their_own_time_constants() {
        let time: Vec<f64> = (0..2).map(f64::from).collect();
        let heated = BODY.respond(&time, &[0.0, 1.0]).unwrap();
        assert!((heated[1] - (22.0 - 2.0 * (-1.0 / 3.0_f64).exp())).abs() < 1e-14);
        let cooled = BODY.respond(&time, &[1.0, 0.0]).unwrap();
        assert!((cooled[1] - (20.0 + 2.0 * (-1.0 / 7.0_f64).exp())).abs() < 1e-14);
    }

    #[test]
    fn what_cannot_be_is_refused() {
        for (dt, drive) in [
            (-0.1, 1.0),
            (f64::NAN, 1.0),
            (f64::INFINITY, 1.0),
            (2.0, f64::NAN),
        ] {
            assert!(BODY.step(20.0, dt, drive).is_err());
        }
        assert!(BODY.respond(&[0.0], &[]).is_err());
        assert!(BODY.respond(&[], &[]).unwrap().is_empty());
    }
}
