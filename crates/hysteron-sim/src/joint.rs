//! PID gains from a model, by simulation of the whole loop around it: the *joint tuning*.

mod course;
mod plant;
mod target;

use course::{Course, Noise};
use hysteron::control::{Gains, RelayTest, Scheme};
use hysteron::{Error, Model, Result};
use plant::{Outer, Plant, Reach};

pub use plant::UNKNOWN;
pub use target::{TargetLoop, usual_safety};

/// Where the relay's two drives lie between the limits.
const DRIVES: [f64; 2] = [0.25, 0.75];
/// Samples within which the relay test has to come to its end, and latencies of a plant that is
/// late: nine swings take some 18.
const PATIENCE: usize = 20_000;
const LATENCIES: usize = 40;
/// Factors on the gain that are tried, from the largest down by halves. That of a slow body, which
/// a relay hardly moves within a sample, has to shrink a thousandfold.
const LARGEST: f64 = 16.0;
const HALVINGS: i32 = 14;
/// Factors on the integral time that are tried, as powers of two. A relay swings through the whole
/// hysteresis, which an inverse takes away: then the integral may be faster. Of a slow body the
/// period of the relay is a few samples: then it has to be slower.
const TIMES: std::ops::RangeInclusive<i32> = -5..=7;
/// The gain margin that is kept at least (Åström & Hägglund 2006: 2 to 5), and the largest that is
/// looked for.
const MARGIN: f64 = 2.0;
const WIDEST: f64 = 32.0;
/// A loop is calm where its drive travels at most so many times as far as without feedback, or as
/// far as the drives are wide.
const RESTLESS: f64 = 3.0;

/// Gains, and the factor that they may grow by before the simulated loop is restless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tuned {
    /// The gains.
    pub gains: Gains,
    /// The factor, from 2 to 32; larger than it must be where noise bounds the gain.
    pub margin: f64,
}

/// Gains for the loop of `scheme` around `model`, with the inverse of the model in the loop where
/// `inverse` says so. A relay test on the model (Åström & Hägglund 1984) gives the first (Tyreus &
/// Luyben 1992). Then the whole loop, with the noise of the fit, runs up and down through the
/// model's range, while the drive is disturbed. Of the integral times around the first one, each
/// with the largest gain that may double before the loop is restless, those gains are taken that
/// err least, also when they are doubled (after Åström & Hägglund 2006: the least error after a
/// disturbance, under a bound of the robustness).
///
/// Through the proportional part, noise moves the drive by at most a twentieth of its range (a
/// standard deviation).
///
/// A model without stages answers at once, and does not know how fast the plant is. Its feedback is
/// an integral, made for a plant that is ten times as late. A plant with a resonance may still need
/// less: tune it by a test.
///
/// An inner loop is taken as [SIMC](Gains::from_step) makes it: a lag as long as its dead time.
///
/// # Errors
/// [`Error::Control`] for a model that does not follow a relay, or whose loop is never calm.
///
/// ```
/// use hysteron::{Model, Operator, Plane, Sign, control::Scheme};
/// use hysteron_sim::joint;
/// let plane = Plane::new(1.0, 10.0, 8)?;
/// let model = Model::new(Operator::Mkp, plane, vec![0.1; 36], 0.0, Sign::Positive)?;
/// let tuned = joint::tune(&model, &Scheme::new(0.05, (0.0, 10.0)), true)?;
/// assert!(tuned.margin >= 2.0 && tuned.gains.integral_s > 0.0);
/// # Ok::<(), hysteron::Error>(())
/// ```
pub fn tune(model: &Model, scheme: &Scheme, inverse: bool) -> Result<Tuned> {
    let outer = Outer::of(model, scheme);
    let reach = Reach::of(model, &outer, DRIVES.map(|share| outer.drive(share)))?;
    let first = relay(model, &outer, &reach)?;
    let course = Course::new(model, &outer, reach.samples);
    let alone = course.run(None, true, Noise::None, f64::INFINITY)?.travel;
    let most = RESTLESS * alone.max(course.usual_travel());
    // Without noise: what noise does to the drive is bounded by itself, and no oscillation.
    let is_calm = |gains: Gains| {
        let run = course.run(Some(gains), inverse, Noise::None, most)?;
        Ok::<_, Error>(run.travel <= most)
    };
    let error = |gains: Gains| {
        let run = course.run(Some(gains), inverse, Noise::OfFit, f64::INFINITY)?;
        Ok::<_, Error>(run.error)
    };
    let mut best: Option<(f64, Gains)> = None;
    let times: Vec<f64> = match outer.knows_time {
        true => TIMES
            .map(|power| first.integral_s * 2f64.powi(power))
            .collect(),
        false => vec![outer.scheme.interval_s],
    };
    for integral_s in times {
        for factor in (0..=HALVINGS).map(|n| LARGEST * 0.5f64.powi(n)) {
            let gains = Gains {
                gain: first.gain * factor / MARGIN,
                integral_s,
                ..first
            };
            let double = times_gain(gains, MARGIN);
            if course.noise(gains) <= course.loudest() && is_calm(double)? {
                let wrong = error(gains)?.max(error(double)?);
                if best.is_none_or(|(least, _)| wrong < least) {
                    best = Some((wrong, gains));
                }
                break;
            }
        }
    }
    let (_, gains) = best.ok_or_else(|| {
        let what = "the loop around the model is restless, or moved by noise, with the smallest \
                    gains";
        Error::Control(what.into())
    })?;
    let (mut margin, step) = (MARGIN, std::f64::consts::SQRT_2);
    while margin < WIDEST && is_calm(times_gain(gains, margin * step))? {
        margin *= step;
    }
    Ok(Tuned { gains, margin })
}

fn times_gain(gains: Gains, factor: f64) -> Gains {
    let gain = gains.gain * factor;
    Gains { gain, ..gains }
}

fn relay(model: &Model, outer: &Outer, reach: &Reach) -> Result<Gains> {
    let drives = DRIVES.map(|share| outer.drive(share));
    let [from, to] = reach.outputs;
    let middle = 0.5 * (from + to);
    let sign = if to < from { -1.0 } else { 1.0 };
    let mut plant = Plant::new(model, outer, drives[0]);
    let mut test = RelayTest::new(drives.into(), sign * middle, 0.0)?;
    for _ in 0..PATIENCE.max(LATENCIES * outer.latency()) {
        test.push(sign * plant.step(test.command())?);
        if test.is_done() {
            break;
        }
    }
    let found = test.oscillation().filter(|(gain, _)| gain.is_finite());
    let (gain, period) = found.ok_or_else(|| {
        let what = "the model does not follow a relay between 1/4 and 3/4 of the drives";
        Error::Control(what.into())
    })?;
    let gains = Gains::from_oscillation(gain, period * outer.scheme.interval_s);
    Ok(Gains {
        gain: sign * gains.gain,
        ..gains
    })
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

    #[test]
    fn a_plant_that_is_late_is_tuned_too() {
        let plane = Plane::new(1.0, 10.0, 8).unwrap();
        let model = Model::new(Operator::Mkp, plane, vec![0.1; 36], 0.0, Sign::Positive).unwrap();
        for delay in [40, 120, 300] {
            let scheme = Scheme {
                delay: Some(delay),
                ..Scheme::new(0.05, (0.0, 10.0))
            };
            assert!(tune(&model, &scheme, true).unwrap().margin >= MARGIN);
        }
    }

    /// A body of 2 s before the operators.
    fn heated() -> Model {
        let plane = Plane::new(1.0, 10.0, 8).unwrap();
        let plain = Model::new(Operator::Mkp, plane, vec![0.1; 36], 0.0, Sign::Positive).unwrap();
        let mut file: serde_json::Value = serde_json::from_str(&plain.to_json()).unwrap();
        file["version"] = 2.into();
        file["thermal"] = serde_json::json!({
            "kind": "first-order", "ambient": 0.0, "gain": 1.0,
            "tau_heating": 2.0, "tau_cooling": 2.0,
        });
        Model::from_json(&file.to_string()).unwrap()
    }

    #[test]
    fn feedback_of_a_slow_body_is_strong_enough_for_a_disturbance() {
        for dt in [0.02, 0.2] {
            let scheme = Scheme::new(dt, (0.0, 12.0));
            let model = heated();
            let tuned = tune(&model, &scheme, true).unwrap();
            let outer = Outer::of(&model, &scheme);
            let course = Course::new(&model, &outer, 2000);
            let error = |pid| {
                course
                    .run(pid, true, Noise::OfFit, f64::INFINITY)
                    .unwrap()
                    .error
            };
            let (alone, with) = (error(None), error(Some(tuned.gains)));
            assert!(with < 0.25 * alone, "{dt}: {tuned:?}, {with} for {alone}");
        }
    }

    #[test]
    fn where_nothing_says_how_fast_the_plant_is_the_feedback_is_an_integral() {
        let plane = Plane::new(1.0, 10.0, 8).unwrap();
        let model = Model::new(Operator::Mkp, plane, vec![0.1; 36], 0.0, Sign::Positive).unwrap();
        let scheme = Scheme::new(0.05, (0.0, 10.0));
        let tuned = tune(&model, &scheme, true).unwrap();
        assert_eq!(tuned.gains.integral_s, scheme.interval_s);
        // Its proportional part does little: the model moves by 0.4 for each unit of the drive.
        assert!(0.4 * tuned.gains.gain < 0.2, "{tuned:?}");
        let later = Scheme {
            delay: Some(4),
            ..scheme
        };
        assert!(tune(&model, &later, true).unwrap().gains.gain < 0.5 * tuned.gains.gain);
    }
}
