//! From the choices of single pilots to a few that serve all of them.

use super::choice::{FleetKind, FleetShared};
use super::share::HARM;
use super::signs::{Signs, Usual, ratio};
use crate::error::Result;
use crate::identify::Chosen;
use crate::series::noise::median_of;

/// A choice serves a pilot if the error on what is left out is at most so many times that of its
/// own choice.
const SERVES: f64 = 1.15;

/// A larger error does not count for more: one pilot that nothing serves does not choose for all.
const CLIPPED: f64 = 2.0;

/// So many kinds at most.
const MOST: usize = 4;

/// Among choices that serve as well up to this factor, the cheapest is taken.
const AS_WELL: f64 = 1.02;

/// What the pilots would have with each other's choices.
#[derive(Default)]
pub(super) struct Palette {
    candidates: Vec<Chosen>,
    /// For each candidate, the signs of each pilot with it.
    signs: Vec<Vec<Signs>>,
    /// Those with their own choices.
    own: Vec<f64>,
}

impl Palette {
    /// Adds a pilot and the error with its own choice.
    pub(super) fn add(&mut self, own: f64) {
        self.own.push(own);
    }

    /// Adds the choice of a pilot, if it is new.
    pub(super) fn suggest(&mut self, chosen: Chosen) {
        let anywhere = chosen.resting_anywhere();
        for chosen in [Some(chosen), anywhere].into_iter().flatten() {
            if !self.candidates.contains(&chosen) {
                self.candidates.push(chosen);
                self.signs.push(Vec::new());
            }
        }
    }

    /// Fills the table: the signs of a pilot that was `tested` with a candidate.
    pub(super) fn fill(
        &mut self,
        tested: impl Fn(usize, &Chosen) -> Result<Signs> + Sync + Send,
    ) -> Result<()> {
        let pilots = self.own.len();
        let known = |candidate: usize| self.signs[candidate].len()..pilots;
        let missing: Vec<(usize, usize)> = (0..self.candidates.len())
            .flat_map(|candidate| known(candidate).map(move |pilot| (candidate, pilot)))
            .collect();
        let found = crate::parallel::map(missing.len(), |n| {
            let (candidate, pilot) = missing[n];
            tested(pilot, &self.candidates[candidate])
        })?;
        for ((candidate, _), signs) in missing.into_iter().zip(found) {
            self.signs[candidate].push(signs);
        }
        Ok(())
    }

    fn ratio(&self, candidate: usize, pilot: usize) -> f64 {
        ratio(self.signs[candidate][pilot].error, self.own[pilot])
    }

    /// The candidates that serve the pilots, each the one that helps most beside those before it
    /// (the greedy way to k medians). The errors are in logarithms: what counts is a factor. Each
    /// further one costs every actuator another fit, so it has to serve two more pilots, or one
    /// that would come to harm.
    fn served(&self) -> Vec<usize> {
        let mut found = Vec::new();
        let mut errors = vec![CLIPPED.ln(); self.own.len()];
        while found.len() < MOST {
            let with = |candidate: usize| {
                let pilots = errors.iter().enumerate();
                pilots.map(move |(pilot, error)| error.min(self.ratio(candidate, pilot).ln()))
            };
            let is_worth = |candidate: &usize| {
                let served = errors.iter().zip(with(*candidate));
                let served = served.filter(|(old, new)| **old > SERVES.ln() && *new <= SERVES.ln());
                let served: Vec<f64> = served.map(|(old, _)| *old).collect();
                served.len() > 1 || served.iter().any(|old| *old > HARM.ln())
            };
            let rated = (0..self.candidates.len()).filter(is_worth);
            let rated: Vec<(usize, f64)> = rated.map(|n| (n, with(n).sum())).collect();
            let least = rated
                .iter()
                .fold(f64::INFINITY, |least, rated| least.min(rated.1));
            let as_well = least + AS_WELL.ln() * errors.len() as f64;
            let best = rated.iter().filter(|rated| rated.1 <= as_well);
            let Some(&(best, _)) = best.min_by_key(|rated| cost(&self.candidates[rated.0])) else {
                break;
            };
            errors = with(best).collect();
            found.push(best);
        }
        found
    }

    /// What is shared, and for each pilot its best error in multiples of that of its own choice;
    /// `None` where no choice serves more than one.
    pub(super) fn shared(&self) -> Option<(FleetShared, Vec<f64>)> {
        let served = self.served();
        let pilots = 0..self.own.len();
        let best = |pilot: usize| {
            let error = |candidate: &&usize| self.signs[**candidate][pilot].error;
            let best = served.iter().min_by(|a, b| error(a).total_cmp(&error(b)));
            best.copied()
        };
        let best: Vec<usize> = pilots.clone().filter_map(best).collect();
        let ratios = pilots.zip(&best).map(|(p, best)| self.ratio(*best, p));
        let ratios: Vec<f64> = ratios.collect();
        let kinds = served.iter().filter_map(|&candidate| {
            let members = best.iter().zip(&ratios);
            let members = members.filter(|(best, r)| **best == candidate && Self::serves(**r));
            let members = members.count();
            (members > 0).then(|| self.kind(candidate, members))
        });
        let mut kinds: Vec<FleetKind> = kinds.collect();
        kinds.sort_by_key(|kind| std::cmp::Reverse(kind.pilots));
        let shared = FleetShared {
            pilots: self.own.len(),
            worst: ratios.iter().copied().fold(0.0, f64::max),
            kinds,
        };
        let any = shared.kinds.first().is_some_and(|kind| kind.pilots > 1);
        any.then_some((shared, ratios))
    }

    /// The kind with this choice, which is the best for so many pilots. What is usual for it, all
    /// that it serves tell.
    fn kind(&self, candidate: usize, pilots: usize) -> FleetKind {
        let served = (0..self.own.len()).filter(|p| Self::serves(self.ratio(candidate, *p)));
        let signs: Vec<Signs> = served.map(|pilot| self.signs[candidate][pilot]).collect();
        let usual = Usual::new(&signs);
        FleetKind {
            chosen: self.candidates[candidate].clone(),
            pilots,
            left_out_percent: median_of(signs.iter().map(|signs| signs.error).collect()),
            usual_percent: usual.error(),
            usual,
        }
    }

    /// Whether the choices serve this pilot.
    pub(super) fn serves(ratio: f64) -> bool {
        ratio <= SERVES
    }
}

/// What the fit of an actuator costs, in some unit.
fn cost(chosen: &Chosen) -> usize {
    let finds_rest = chosen.start == crate::model::Start::Rest && chosen.rest.is_none();
    chosen.levels.pow(2) * if finds_rest { 8 } else { 1 } * if chosen.heated { 8 } else { 1 }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// The palette of pilots that choose these levels, with `error(pilot, levels)`.
    fn shared(
        own: &[usize],
        error: impl Fn(usize, usize) -> f64 + Sync + Send,
    ) -> Option<FleetShared> {
        let mut palette = Palette::default();
        for (pilot, &levels) in own.iter().enumerate() {
            palette.add(error(pilot, levels));
            palette.suggest(Chosen::with_levels(levels));
        }
        let tested =
            |pilot: usize, chosen: &Chosen| Ok(Signs::of(error(pilot, chosen.levels), [0.0; 4]));
        palette.fill(tested).unwrap();
        palette.shared().map(|(shared, _)| shared)
    }

    fn levels(shared: &FleetShared) -> Vec<(usize, usize)> {
        let kinds = shared.kinds.iter();
        kinds
            .map(|kind| (kind.chosen.levels, kind.pilots))
            .collect()
    }

    #[test]
    fn among_choices_as_good_the_cheapest_is_taken() {
        // All choices serve all, up to a hundredth.
        let found = shared(&[28, 14, 20], |_, levels| 1.0 + 1e-3 * levels as f64).unwrap();
        assert_eq!(levels(&found), [(14, 3)]);
        // The cheapest is worse by a tenth, which still serves, but others are better.
        let found = shared(
            &[28, 14, 20],
            |_, levels| if levels == 14 { 1.1 } else { 1.0 },
        );
        assert_eq!(levels(&found.unwrap()), [(20, 3)]);
    }

    #[test]
    fn each_kind_has_its_choice() {
        let own = [10, 20, 10, 20, 10, 20, 10];
        let error = |pilot: usize, levels: usize| match levels == own[pilot] {
            true => 0.5 + 0.01 * pilot as f64,
            false => 1.0,
        };
        let found = shared(&own, error).unwrap();
        assert_eq!(levels(&found), [(10, 4), (20, 3)]);
        // From half of the smallest error to 1.3 times the largest.
        let (low, high) = found.kinds[0].usual_percent;
        assert!((low - 0.25).abs() < 0.01, "{low}");
        assert!((high - 0.56 * 1.3).abs() < 0.01, "{high}");
    }

    #[test]
    fn pilots_that_have_nothing_in_common_share_nothing() {
        let own = [5, 7, 10, 14, 20];
        let error = |pilot: usize, levels: usize| if levels == own[pilot] { 0.1 } else { 9.0 };
        assert_eq!(shared(&own, error), None);
        assert_eq!(shared(&[], error), None);
    }

    #[test]
    fn errors_below_every_sensor_are_equal() {
        let found = shared(&[10, 20], |_, levels| 1e-3 / levels as f64).unwrap();
        assert_eq!(levels(&found), [(10, 2)]);
    }
}
