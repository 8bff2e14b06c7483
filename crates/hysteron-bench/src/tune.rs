//! PID gains from a model, by simulation of the loop around it.

use crate::error::Result;
use hysteron::control::{Compensator, Controller, Gains, Reading, Reference, RelayTest, Scheme};
use hysteron::{Error, Model, Sample};
use std::collections::VecDeque;

/// Where the relay's two drives lie between the limits.
const DRIVES: [f64; 2] = [0.25, 0.75];
/// Samples within which the relay test has to come to its end.
const PATIENCE: usize = 20_000;
/// Factors on the gains that are tried: the largest with which the loop is calm is the margin.
/// Those of a slow body, which a relay hardly moves within a sample, have to shrink a thousandfold.
const LARGEST: f64 = 16.0;
const HALVINGS: i32 = 14;
/// The gain margin that is kept at least (Åström & Hägglund 2006: 2 to 5).
const MARGIN: f64 = 2.0;
/// Samples of a simulated run.
const SAMPLES: usize = 600;
/// A loop is calm where its drive travels at most so many times as far as without feedback, or as
/// far as the drives are wide.
const RESTLESS: f64 = 3.0;

/// Gains, and the factor that they may grow by before the simulated loop is restless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tuned {
    /// The gains.
    pub gains: Gains,
    /// The factor.
    pub margin: f64,
}

/// The model in the place of the plant, each drive seen `delay` samples after it was given.
struct Plant<'a> {
    model: &'a Model,
    state: hysteron::State,
    waiting: VecDeque<f64>,
    dt: f64,
}

impl<'a> Plant<'a> {
    fn new(model: &'a Model, (scheme, rest): (&Scheme, f64)) -> Self {
        Self {
            model,
            state: model.start(),
            waiting: std::iter::repeat_n(rest, scheme.due().saturating_sub(1)).collect(),
            dt: scheme.interval_s,
        }
    }

    fn step(&mut self, drive: f64) -> Result<f64> {
        self.waiting.push_back(drive);
        let sample = Sample {
            input: self.waiting.pop_front().unwrap_or(drive),
            dt: Some(self.dt),
            load: None,
        };
        Ok(self.model.step(&mut self.state, sample)?.output)
    }
}

/// Gains for the loop of `scheme` around `model`. A relay test on the model (Åström & Hägglund
/// 1984) gives the first (Tyreus & Luyben 1992). Then the whole loop, with the inverse where it has
/// one and the noise of the fit, runs up and down through the model's range, and the gains are
/// lowered until they may double.
///
/// # Errors
/// [`Error::Control`] for a model that does not follow a relay, or whose loop is never calm.
pub fn tune(model: &Model, scheme: &Scheme, inverse: bool) -> Result<Tuned> {
    let first = relay(model, scheme)?;
    let run = |gains: Option<Gains>| travel(model, scheme, gains, inverse);
    let (low, high) = scheme.drives;
    let calm = RESTLESS * run(None)?.max(high - low);
    for factor in (0..=HALVINGS).map(|n| LARGEST * 0.5f64.powi(n)) {
        let scaled = |factor: f64| Gains {
            gain: first.gain * factor,
            ..first
        };
        if run(Some(scaled(factor)))? <= calm {
            let kept = (factor / MARGIN).min(1.0);
            return Ok(Tuned {
                gains: scaled(kept),
                margin: factor / kept,
            });
        }
    }
    Err(untuned(
        "the loop around the model is restless with the smallest gains",
    ))
}

fn untuned(why: &str) -> crate::Error {
    let text =
        format!("{why}: give `proportional` and `integral_s` in place of tuning = \"model\"");
    Error::Control(text).into()
}

fn relay(model: &Model, scheme: &Scheme) -> Result<Gains> {
    let (low, high) = scheme.drives;
    let drives = DRIVES.map(|share| low + share * (high - low));
    // The middle of what the outputs at the two drives are, from both sides.
    let mut plant = Plant::new(model, (scheme, low));
    let mut ends = [0.0; 2];
    for (drive, end) in [drives[0], drives[1], drives[0], drives[1]]
        .into_iter()
        .zip([0, 1, 0, 1])
    {
        for _ in 0..SAMPLES {
            ends[end] = plant.step(drive)?;
        }
    }
    let middle = 0.5 * (ends[0] + ends[1]);
    let falls = ends[1] < ends[0];
    let sign = if falls { -1.0 } else { 1.0 };
    let mut test = RelayTest::new(drives.into(), sign * middle, 0.0)?;
    for _ in 0..PATIENCE {
        test.push(sign * plant.step(test.command())?);
        if test.is_done() {
            break;
        }
    }
    let found = test.oscillation().filter(|(gain, _)| gain.is_finite());
    let (gain, period) = found.ok_or_else(|| {
        untuned("the model does not follow a relay between 1/4 and 3/4 of the drives")
    })?;
    let gains = Gains::from_oscillation(gain, period * scheme.interval_s);
    Ok(Gains {
        gain: sign * gains.gain,
        ..gains
    })
}

/// How far the drive travels while the output is to go up and down once through the middle of the
/// model's range.
fn travel(model: &Model, scheme: &Scheme, pid: Option<Gains>, inverse: bool) -> Result<f64> {
    let mut controller = Controller::new(Scheme {
        compensator: Some(Compensator::fixed(model)?).filter(|_| inverse || pid.is_none()),
        pid,
        gate: None,
        slew: None,
        ..scheme.clone()
    })?;
    let rest = controller.rest_drive();
    let mut plant = Plant::new(model, (scheme, rest));
    let (low, high) = model.output_range();
    let noise = model.fit.as_ref().map_or(0.0, |fit| fit.rmse);
    let reference = |n: usize| {
        let phase = std::f64::consts::TAU * n as f64 / SAMPLES as f64;
        0.5 * (low + high) - 0.4 * (high - low) * phase.cos()
    };
    let (mut drive, mut travelled) = (rest, 0.0);
    for n in 0..SAMPLES {
        // A fixed sequence that looks like noise of this standard deviation.
        let turns = (n as f64 * 12.9898).sin() * 43758.5453;
        let wrong = noise * 12f64.sqrt() * (turns - turns.floor() - 0.5);
        let reading = Reading {
            output: plant.step(drive)? + wrong,
            input: None,
        };
        let target = Reference {
            output: reference(n),
            heading: None,
        };
        let next: Vec<f64> = (1..=scheme.due()).map(|k| reference(n + k)).collect();
        let action = controller.step_ahead(target, &next, reading)?;
        travelled += (action.drive - drive).abs();
        drive = action.drive;
    }
    Ok(travelled)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use hysteron::{Operator, Plane, Sign};

    #[test]
    fn a_model_is_tuned_with_the_margin_that_is_stated() {
        for (weight, sign) in [
            (0.1, Sign::Positive),
            (3.0, Sign::Positive),
            (1.0, Sign::Negative),
        ] {
            for levels in [3, 8, 20] {
                let plane = Plane::new(1.0, 10.0, levels).unwrap();
                let weights = vec![weight; levels * (levels + 1) / 2];
                let model = Model::new(Operator::Mkp, plane, weights, 1.0, sign).unwrap();
                for (delay, inverse) in [(1, false), (1, true), (3, true)] {
                    let scheme = Scheme {
                        delay: Some(delay),
                        ..Scheme::new(0.05, (0.0, 10.0))
                    };
                    let tuned = tune(&model, &scheme, inverse).unwrap();
                    assert!(tuned.margin >= MARGIN, "{tuned:?}");
                    assert!(tuned.gains.gain * sign.factor() > 0.0, "{tuned:?}");
                    assert!(tuned.gains.integral_s > 0.0);
                }
            }
        }
    }
}
