//! The fit of one actuator with what the pilots chose, or by itself where that does not serve it.

use super::choice::{FleetAlone, FleetKind, FleetShared};
use super::one::{Fitted, Ready};
use super::options::FleetOptions;
use super::signs::{Signs, ratio};
use crate::error::{Error, Result};
use crate::identify::Chosen;
use crate::progress::Progress;
use std::cmp::Ordering;

/// With a larger error on what is left out, in multiples of that of its own choice, an actuator has
/// its own choice.
pub(super) const HARM: f64 = 1.3;

/// In a fleet of several kinds, one that is served best by so few levels chooses by itself as well:
/// that takes no longer than to try the kinds, whose signs tell them apart less surely.
const FAST: usize = 20;

/// A model with the choice of a kind.
struct Shared {
    kind: usize,
    signs: Signs,
    fitted: Fitted,
}

impl Shared {
    fn order(&self, other: &Self) -> Ordering {
        self.signs.error.total_cmp(&other.signs.error)
    }
}

impl Ready {
    /// What the actuator chooses by itself, and its error on what is left out, in percent.
    pub(super) fn own_choice(
        &self,
        options: &FleetOptions<'_>,
        progress: Progress<'_>,
    ) -> Result<(Chosen, f64)> {
        let fit = options.fit.without_bootstrap().testing();
        let (model, _) = self.fitted(&fit, options, progress)?;
        let chosen = Chosen::of(&model, self.recording());
        Ok((chosen, Signs::new(&model).error))
    }

    /// The signs of the actuator with this choice.
    pub(super) fn tested_with(
        &self,
        chosen: &Chosen,
        options: &FleetOptions<'_>,
        progress: Progress<'_>,
    ) -> Signs {
        let fit = options.fit.sharing(chosen).without_bootstrap();
        let fitted = self.fitted(&fit, options, progress);
        fitted.map_or(Signs::NONE, |(model, _)| Signs::new(&model))
    }

    /// The model with the choice that serves the actuator: that of one of the kinds, or its own.
    pub(super) fn fitted_sharing(
        &self,
        shared: &FleetShared,
        options: &FleetOptions<'_>,
        progress: Progress<'_>,
    ) -> Result<Fitted> {
        // The kind of a single pilot is only tried for who is not of the others.
        let common = shared.kinds.iter().filter(|kind| kind.pilots > 1).count();
        let single = shared.kinds.len() == 1;
        // With several kinds, the bootstrap waits until one is chosen.
        let of_kind = |(kind, about): (usize, &FleetKind)| {
            let fit = options.fit.sharing(&about.chosen);
            let fit = match single {
                true => fit,
                false => fit.without_bootstrap(),
            };
            let fitted = self.fitted(&fit, options, progress).ok()?;
            let signs = Signs::new(&fitted.0);
            Some(Shared {
                kind,
                signs,
                fitted,
            })
            .filter(|_| signs.error.is_finite())
        };
        let mut kinds = shared.kinds.iter().enumerate();
        let tried = kinds.by_ref().take(common).filter_map(of_kind);
        let mut best = tried.min_by(Shared::order);
        let usual = |best: &Shared| shared.kinds[best.kind].usual.has(&best.signs);
        if !best.as_ref().is_some_and(usual) {
            best = best
                .into_iter()
                .chain(kinds.filter_map(of_kind))
                .min_by(Shared::order);
        }
        progress.tell("fits", f64::NAN)?;
        let chooses_fast = |best: &Shared| shared.kinds[best.kind].chosen.levels <= FAST;
        let is_sure = |best: &Shared| usual(best) && (single || !chooses_fast(best));
        let alone = match best.as_ref().is_some_and(is_sure) {
            true => None,
            false => Some(self.fitted(&options.fit.testing(), options, progress)),
        };
        let (mut best, alone) = match (best, alone) {
            (Some(best), alone) => (best, alone.and_then(Result::ok)),
            (None, Some(alone)) => return Ok(recorded(alone?, None)),
            (None, None) => return Err(Error::Fit("there is no choice".into())),
        };
        let harm = |alone: &Fitted| ratio(best.signs.error, Signs::new(&alone.0).error) > HARM;
        if let Some(alone) = alone.filter(harm) {
            return Ok(recorded(alone, Some(best.signs.error)));
        }
        if options.fit.has_bootstrap() && !single {
            let fit = options.fit.sharing(&shared.kinds[best.kind].chosen);
            best.fitted = self.fitted(&fit, options, progress)?;
        }
        shared.record(&mut best.fitted.0, best.kind);
        Ok(best.fitted)
    }
}

/// A model with its own choice, whose record says so. With the choice of the pilots it has an error
/// of `shared` percent.
fn recorded((mut model, held_out): Fitted, shared: Option<f64>) -> Fitted {
    let own = Signs::new(&model).error;
    FleetAlone::record(&mut model, shared, own);
    (model, held_out)
}
