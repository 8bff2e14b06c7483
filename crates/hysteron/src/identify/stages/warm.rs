//! Finds the drive at which a body was at rest before each recording, together with the body.
//!
//! A wire that was warm, or a drive that begins with the recording, moves the output for some time
//! constants as no drive in the recording does. A body that is sought without this fits the
//! beginning badly, and all else with it.

use crate::error::Result;
use crate::identify::options::FitOptions;
use crate::identify::stages::body::{GRID, LOOK, Search};
use crate::identify::stages::latent::Heated;
use crate::identify::stages::nelder_mead::minimise;
use crate::identify::warm_start::with_none;
use crate::model::FirstOrder;
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::range;

/// Rests of a first look, as shares of the range of drives; the first drive itself is another.
const LOOKS: [f64; 3] = [0.0, 0.5, 1.0];

/// First edge of the simplex over a time constant and a rest, its last size and its steps. A
/// hundredth of all drives is less than readings tell.
const EDGE: f64 = 0.3;
const TOLERANCE: f64 = 0.01;
const STEPS: usize = 60;

/// A rest has to reduce the error beside a common time constant to this part: whatever a model does
/// wrong at the beginning, it makes a little better.
const WORTH: f64 = 0.9;

/// Weights and rests are found in turn, so often at most, and as long as the error falls to this
/// part.
const ROUNDS: usize = 6;
const FALLS: f64 = 0.9;

/// What a first look found.
pub(super) struct Look {
    /// The error at rest with the first drives, and with the best of a few rests.
    pub(super) at_first: f64,
    pub(super) rested: f64,
    /// The logarithms of the common time constants there.
    tau_at_first: f64,
    tau_rested: f64,
    /// The best rest as a share of the range of drives; `None` for the first drives.
    share: Option<f64>,
}

/// The recordings with the rests that are found beside a common time constant, on a coarse plane.
///
/// # Errors
/// As the search for a body.
pub(super) fn rested(
    recordings: &[Recording],
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<Vec<Recording>> {
    let coarse = FitOptions {
        levels: options.levels.min(LOOK),
        ..options.clone()
    };
    let search = Search::new(recordings, &coarse, progress)?;
    let look = search.look()?;
    let (mut tau, mut rest) = (look.tau_at_first, None);
    if let Some(share) = look.share {
        let alone = |tau: &[f64; 1]| search.rmse_inside(tau, common);
        let ([at_first], without) = minimise([tau], EDGE, TOLERANCE, STEPS, alone)?;
        let beside = |[tau, share]: &[f64; 2]| match (0.0..=1.0).contains(share) {
            true => search
                .of(&search.resting(*share))
                .rmse_inside(&[*tau], common),
            false => Ok(f64::INFINITY),
        };
        let start = [look.tau_rested, share];
        let ([rested, share], with) = minimise(start, EDGE, TOLERANCE, STEPS, beside)?;
        (tau, rest) = match with <= WORTH * without {
            true => (rested, Some(share)),
            false => (at_first, None),
        };
    }
    let body = FirstOrder {
        tau_heating: tau.exp(),
        tau_cooling: tau.exp(),
        ..FirstOrder::default()
    };
    let begun = rest.map_or_else(|| recordings.to_vec(), |share| search.resting(share));
    search.rested(begun, Heated::unbound(body))
}

impl Search<'_> {
    /// A look with a common time constant on a coarse grid, and there with a few rests. A wrong rest
    /// makes the body look slower than it is, so the next shorter time constant is tried as well.
    pub(super) fn look(&self) -> Result<Look> {
        let ([tau], rmse) = self.best_of_grid(common)?;
        let mut look = Look {
            at_first: rmse,
            rested: rmse,
            tau_at_first: tau,
            tau_rested: tau,
            share: None,
        };
        for share in LOOKS {
            let resting = self.resting(share);
            let search = self.of(&resting);
            for tau in [tau, tau - GRID.ln()] {
                let rmse = search.rmse_inside(&[tau], common)?;
                if rmse < look.rested {
                    (look.rested, look.tau_rested, look.share) = (rmse, tau, Some(share));
                }
            }
        }
        Ok(look)
    }

    /// The recordings with the rests that models behind the body tell, beginning with those of
    /// `begun`.
    pub(super) fn rested(&self, begun: Vec<Recording>, heated: Heated) -> Result<Vec<Recording>> {
        let (mut now, mut kept) = (begun, None::<(f64, Vec<Recording>)>);
        for round in 0..ROUNDS {
            let model = self.of(&now).model(heated, None)?;
            let rmse = model.fit.as_ref().map_or(f64::INFINITY, |fit| fit.rmse);
            if kept
                .as_ref()
                .is_some_and(|(least, _)| rmse >= FALLS * least)
            {
                break;
            }
            let told = model.all_rested(self.recordings)?.into_owned();
            let is_told = now.iter().zip(&told).all(|(a, b)| a.rest == b.rest);
            // The first rests are a guess. Those kept were told by a model.
            if round > 0 || is_told {
                kept = Some((rmse, now));
            }
            now = told;
            if is_told {
                break;
            }
        }
        Ok(kept.map_or(now, |(_, told)| told))
    }

    /// The recordings with a rest at this share of the range of drives. One that is known stays.
    fn resting(&self, share: f64) -> Vec<Recording> {
        let ranges = self.recordings.iter().map(|one| range(&one.input));
        let all = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (low, high) = with_none(all.unwrap_or_default());
        let rest = low + share * (high - low);
        let each = self.recordings.iter().cloned();
        let at = |one: Recording| Recording {
            rest: one.rest.or(Some(rest)),
            ..one
        };
        each.map(at).collect()
    }
}

fn common([tau]: &[f64; 1]) -> [f64; 2] {
    [*tau; 2]
}
