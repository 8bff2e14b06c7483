//! PI/RLS: what is built without a hysteresis model. The gains of a PI follow a linear model of the
//! first order that is estimated while the loop runs: an indirect self-tuning regulator (Åström &
//! Wittenmark 1995, chapters 2, 3 and 11).
//!
//! The model is `y(n) = a y(n−1) + b u(n−1) + c`, estimated by recursive least squares with
//! forgetting. From its gain `k` and time constant `τ` follow the gains of SIMC (Skogestad 2003)
//! for a closed loop with the time constant that the tuning test asked for, or one that is so many
//! times faster. It begins with the model whose gains are those of the test, so that it has all
//! that the PID has.

use super::Scenario;
use hysteron::control::{Action, Gains, Scheme};

/// What an interval counts relative to the next one: fifty of them count.
const FORGETTING: f64 = 0.98;
/// Deviation of gain and time constant that is expected at the beginning, relative.
const DOUBT: f64 = 0.1;
/// Beyond so many times its first trace the covariance grows no further: nothing is forgotten then.
const LARGEST_DOUBT: f64 = 10.0;
/// Time between estimates, as a share of the time constant of the closed loop.
const INTERVAL: f64 = 0.25;
/// A prediction that errs by less than this share of the scenario's tolerance teaches nothing.
const DEAD_ZONE: f64 = 0.25;
/// The gains stay within this factor of those of the test.
const BOUND: f64 = 4.0;
/// The integral time of SIMC is at most so many time constants of the closed loop.
const SLOWEST_INTEGRAL: f64 = 4.0;

/// The estimator, and the rule that makes gains of what it finds.
#[derive(Debug, Clone)]
pub(super) struct SelfTuning {
    /// The gains that it begins with, and the time constant of the model that they are of, s.
    first: Gains,
    first_lag_s: f64,
    /// Wanted time constant of the closed loop, s.
    closed_s: f64,
    /// Time between estimates, s, and the samples in it. A quarter of the time constant of the
    /// closed loop: from sample to sample, noise is larger than what moves, and makes lags look
    /// short.
    interval_s: f64,
    samples: u32,
    commands: (f64, f64),
    /// Output and command per unit of the estimate.
    units: (f64, f64),
    dead_zone: f64,
    /// Sums of output and command over the samples of this interval, and whether all are sound.
    sums: (f64, f64, u32, bool),
    /// Output and command of the last two sound intervals in a row, the latest first.
    before: [Option<(f64, f64)>; 2],
    /// `a`, `b` and `c`, and their covariance.
    theta: Option<[f64; 3]>,
    covariance: [[f64; 3]; 3],
}

impl SelfTuning {
    /// A tuner that begins with the model whose gains are those `of_test`. `None` where these have
    /// no integral, or where the scenario has no tolerance, so that no noise is known.
    pub(super) fn new(scenario: &Scenario, scheme: &Scheme, of_test: Gains) -> Option<Self> {
        let dt = scenario.interval_s;
        let latency = scheme.delay.unwrap_or(1) as f64 * dt + scheme.filter_s;
        let lag_s = of_test.integral_s;
        let of_the_test = (lag_s / SLOWEST_INTEGRAL).max(latency);
        let closed_s = of_the_test / scenario.shared.speed.unwrap_or(1.0);
        let samples = (INTERVAL * closed_s / dt).round().max(1.0);
        let (low, high) = scheme.commands;
        let gain = lag_s / (of_test.gain * of_the_test);
        let output = gain * (high - low);
        let dead_zone = DEAD_ZONE * scenario.shared.tolerance / output.abs();
        let fine = output.is_finite() && output != 0.0 && dead_zone.is_finite() && dead_zone > 0.0;
        let variance = DOUBT * DOUBT;
        fine.then_some(Self {
            first: Gains {
                gain: of_test.gain * of_the_test / closed_s,
                integral_s: lag_s.min(SLOWEST_INTEGRAL * closed_s),
                derivative_s: 0.0,
            },
            first_lag_s: lag_s,
            closed_s,
            interval_s: samples * dt,
            samples: samples as u32,
            commands: scheme.commands,
            units: (output, high - low),
            dead_zone,
            sums: (0.0, 0.0, 0, true),
            before: [None; 2],
            theta: None,
            covariance: [
                [variance, 0.0, 0.0],
                [0.0, variance, 0.0],
                [0.0, 0.0, variance],
            ],
        })
    }

    /// The gains to begin with.
    pub(super) fn first(&self) -> Gains {
        self.first
    }

    /// Takes what the loop did at a sample. New gains, where it has learned from it.
    pub(super) fn push(&mut self, action: &Action) -> Option<Gains> {
        let (output, command) = (action.filtered.output, action.command);
        // The drive of an inner loop is often at a limit; what the model is of is the command.
        let (low, high) = self.commands;
        let sound = output.is_finite() && command > low && command < high;
        let (outputs, commands, count, all) = &mut self.sums;
        *all &= sound;
        *outputs += output / self.units.0;
        *commands += (command - low) / self.units.1;
        *count += 1;
        if *count < self.samples {
            return None;
        }
        let each = 1.0 / f64::from(*count);
        let now = all.then_some((*outputs * each, *commands * each));
        self.sums = (0.0, 0.0, 0, true);
        let [last, earlier] = self.before;
        self.before = [now, last];
        let (((y, _), (last, u)), (_, v)) = now.zip(last).zip(earlier)?;
        // Behind a dead time of one interval, a mean over an interval answers the two before it.
        self.learn(y, [last, 0.5 * (u + v), 1.0])
            .then(|| self.gains())
    }

    /// A step of recursive least squares. Whether something was learned.
    fn learn(&mut self, y: f64, phi: [f64; 3]) -> bool {
        let a = (-self.interval_s / self.first_lag_s).exp();
        let first = [a, 1.0 - a, y - a * phi[0] - (1.0 - a) * phi[1]];
        let theta = self.theta.get_or_insert(first);
        let error = y - dot(*theta, phi);
        if error.abs() <= self.dead_zone {
            return false;
        }
        let p_phi = self.covariance.map(|row| dot(row, phi));
        let trace = (0..3).map(|i| self.covariance[i][i]).sum::<f64>();
        let forgetting = match trace < 3.0 * LARGEST_DOUBT * DOUBT * DOUBT {
            true => FORGETTING,
            false => 1.0,
        };
        let noise = self.dead_zone * self.dead_zone;
        let below = forgetting * noise + dot(p_phi, phi);
        for i in 0..3 {
            theta[i] += p_phi[i] / below * error;
            for j in 0..3 {
                let kept = self.covariance[i][j] - p_phi[i] * p_phi[j] / below;
                self.covariance[i][j] = kept / forgetting;
            }
        }
        true
    }

    /// SIMC for the model, within bounds.
    fn gains(&self) -> Gains {
        let Some([a, b, _]) = self.theta else {
            return self.first;
        };
        // No slower than the first model by the bound, and no faster than an estimate can tell.
        let slowest = BOUND * self.first_lag_s.max(self.interval_s);
        let fastest = (self.first_lag_s / BOUND).min(self.interval_s);
        let kept = |lag_s: f64| (-self.interval_s / lag_s).exp();
        let a = a.clamp(kept(fastest), kept(slowest));
        let lag_s = -self.interval_s / a.ln();
        // Of the first model this is one.
        let relative = lag_s / self.first_lag_s * (1.0 - a) / b;
        // An estimate with the wrong sign is one of almost no gain.
        let relative = match relative > 0.0 {
            true => relative.clamp(1.0 / BOUND, BOUND),
            false => BOUND,
        };
        Gains {
            gain: self.first.gain * relative,
            integral_s: lag_s.min(SLOWEST_INTEGRAL * self.closed_s),
            derivative_s: 0.0,
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use hysteron::control::{LoopStatus, Reading};
    use std::path::Path;

    const GAINS: Gains = Gains {
        gain: 2.0,
        integral_s: 4.0,
        derivative_s: 0.0,
    };

    fn tuner(tolerance: f64) -> Option<SelfTuning> {
        let text = format!(
            "title = \"\"\nduration_s = 100\ninterval_s = 0.05\nsettle_s = 0\nseeds = 1\n\
             plant = {{ kind = \"preisach\" }}\n\
             model = {{ levels = 10, range = [8, 150], rates = [200, 200] }}\n\
             loop = {{ tolerance = {tolerance} }}\n\
             [[reference]]\nkind = \"constant\"\nvalue = 36\n"
        );
        let scenario = Scenario::parse(&text, Path::new("")).unwrap();
        SelfTuning::new(&scenario, &Scheme::new(0.05, (-10.0, 10.0)), GAINS)
    }

    fn action(output: f64, command: f64) -> Action {
        Action {
            command,
            drive: command,
            prediction: f64::NAN,
            filtered: Reading {
                output,
                input: None,
            },
            status: LoopStatus::default(),
        }
    }

    /// The gains after 2000 s of a lag with an offset, under a square of two periods that no
    /// interval is a multiple of.
    fn after(tuner: &mut SelfTuning, gain: f64, lag_s: f64) -> Gains {
        let (mut y, mut gains) = (7.0, tuner.first());
        let mut before = [0.0; 5];
        for n in 0..40_000 {
            let command = f64::from((n / 83) % 2) + f64::from((n / 190) % 2);
            gains = tuner.push(&action(y, command)).unwrap_or(gains);
            // An interval, which is five samples, passes until a command acts.
            y += 0.05 / lag_s * (gain * before[0] + 7.0 - y);
            before.rotate_left(1);
            before[4] = command;
        }
        gains
    }

    #[test]
    fn gains_are_those_of_the_lag_that_is_there() {
        // The closed loop has a time constant of 1 s, that of the test: 4 s / 4.
        for (gain, lag_s) in [(2.0, 4.0), (1.0, 4.0), (4.0, 6.0), (1.5, 2.0)] {
            let found = after(&mut tuner(0.05).unwrap(), gain, lag_s);
            let expected = (lag_s / gain, lag_s.min(4.0));
            // A command acts on average half a sample after its reading, a tenth of the interval.
            assert!(
                (found.gain / expected.0 - 1.0).abs() < 0.1,
                "{gain} {lag_s} {found:?}"
            );
            assert!(
                (found.integral_s / expected.1 - 1.0).abs() < 0.1,
                "{gain} {lag_s} {found:?}"
            );
        }
    }

    #[test]
    fn gains_stay_within_their_bounds_whatever_is_read() {
        for (gain, lag_s) in [(1e6, 4.0), (1e-4, 4.0), (-2.0, 4.0), (2.0, 1e3)] {
            let mut tuner = tuner(0.05).unwrap();
            let found = after(&mut tuner, gain, lag_s);
            let relative = found.gain / GAINS.gain;
            assert!(
                (1.0 / BOUND..=BOUND).contains(&relative),
                "{gain} {lag_s} {found:?}"
            );
            assert!(found.check().is_ok() && found.integral_s > 0.0 && found.integral_s <= 4.0);
        }
    }

    #[test]
    fn nothing_is_learned_within_the_dead_zone_at_a_limit_or_without_readings() {
        // So large a tolerance that no error of the first model counts.
        assert_eq!(after(&mut tuner(1e6).unwrap(), 1.0, 2.0), GAINS);
        for bad in [action(f64::NAN, 1.0), action(3.0, 10.0), action(3.0, -10.0)] {
            let mut tuner = tuner(0.05).unwrap();
            let read = |n: i32| match n % 4 {
                0 => bad,
                _ => action(f64::from(n % 7), 1.0),
            };
            assert!((0..1000).all(|n| tuner.push(&read(n)).is_none()));
        }
        assert!(tuner(0.0).is_none());
    }
}
