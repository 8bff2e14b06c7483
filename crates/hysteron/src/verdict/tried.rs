//! What a fit looked for or has, so that it is no advice any more.

use crate::identify::AFTER;
use crate::model::{FitSummary, Model};
use crate::recording::Recording;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Tried {
    pub(super) creep: bool,
    /// Whether a body was asked for, or looked for unasked.
    pub(super) thermal: bool,
    /// Whether the model has one.
    pub(super) body: bool,
    pub(super) sensor_lag: bool,
}

impl Tried {
    pub(super) fn by(model: &Model, recordings: &[Recording]) -> Self {
        // A lag alone may have been looked for. Older records do not tell.
        let looked_for =
            |fit: &FitSummary| fit.other.get(AFTER).is_some_and(|it| it["creep"] != false);
        Self {
            creep: !model.creep().is_empty() || model.fit.as_ref().is_some_and(looked_for),
            thermal: model.thermal.is_some()
                || model.fit.as_ref().is_some_and(FitSummary::found_no_body),
            body: model.thermal.is_some(),
            sensor_lag: recordings
                .iter()
                .any(|recording| recording.undone.is_some()),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::identify::{Choice, Dynamics, Fit};
    use crate::verdict::Verdict;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    /// A play, at several speeds, whose output comes late by so many samples, with this noise.
    fn play(seed: u64, lag: f64, noise: f64) -> Recording {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut share = || f64::from(random.next_u32()) / f64::from(u32::MAX);
        let mut input = vec![20.0_f64];
        for n in 0..40 {
            let last = input[input.len() - 1];
            let end = if n % 2 == 0 { 55.0 } else { 20.0 } + 25.0 * share();
            let count = ((end - last).abs() / [0.4, 0.8, 1.6][n % 3]).ceil();
            input.extend((1..=count as i32).map(|k| last + (end - last) * f64::from(k) / count));
        }
        let (mut rest, mut output) = (20.0_f64, 20.0);
        let follow = |x: &f64| {
            rest = rest.clamp(x - 5.0, x + 5.0);
            output += (rest - output) / (1.0 + lag);
            output + noise * (share() - 0.5)
        };
        let output = input.iter().map(follow).collect();
        let mut recording = Recording::new(input, output).unwrap();
        recording.time = Some((0..recording.len()).map(|n| n as f64).collect());
        recording
    }

    #[test]
    fn creep_was_tried_only_where_it_was_asked_for() {
        for seed in 0..2 {
            let recording = play(seed, 4.0, 0.01);
            let model = Fit::new().bootstrap(0).run(&recording).unwrap();
            assert!(model.lag() > 0.0, "seed {seed}");
            let recordings = std::slice::from_ref(&recording);
            assert!(!Tried::by(&model, recordings).creep, "seed {seed}");
            let asked = Fit::new().bootstrap(0).creep(Choice::Auto);
            let model = asked.run(&recording).unwrap();
            assert!(Tried::by(&model, recordings).creep, "seed {seed}");
        }
    }

    /// What else moves the output leaves room for a body, and there is none.
    #[test]
    fn a_body_that_was_not_found_is_no_advice() {
        for seed in 0..2 {
            let mut recording = play(seed, 0.0, 0.01);
            for (n, y) in recording.output.iter_mut().enumerate() {
                *y += 3.0 * (0.05 * n as f64).sin();
            }
            let model = Fit::new().bootstrap(0).run(&recording).unwrap();
            let tried = Tried::by(&model, std::slice::from_ref(&recording));
            assert!(tried.thermal && !tried.body, "seed {seed}");
            let next = Verdict::of_fit(&model, &recording).unwrap().next();
            let next = next.to_string();
            assert!(
                next.contains("`creep`") && !next.contains("`thermal`"),
                "{next}"
            );
            let unasked = Fit::new().bootstrap(0).dynamics(Dynamics::Off);
            let model = unasked.run(&recording).unwrap();
            let tried = Tried::by(&model, std::slice::from_ref(&recording));
            assert!(!tried.thermal, "seed {seed}");
            let next = Verdict::of_fit(&model, &recording).unwrap().next();
            assert!(next.to_string().contains("`thermal`"), "{next:?}");
        }
    }
}
