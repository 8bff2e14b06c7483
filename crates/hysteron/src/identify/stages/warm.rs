//! Finds the drive at which a body was at rest before each recording, together with the body.
//!
//! A wire that was warm, or a drive that begins with the recording, moves the output for some time
//! constants as no drive in the recording does. A body sought without it fits the beginning in place
//! of the rest.

use crate::error::Result;
use crate::identify::options::FitOptions;
use crate::identify::rest::with_rests;
use crate::identify::stages::body::{GRID, LOOK, Search};
use crate::identify::stages::latent::Heated;
use crate::identify::stages::nelder_mead::minimise;
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

/// Rests have to reduce the error of the fit to this part: whatever a model does wrong at the
/// beginning, they make a little better.
const WORTH: f64 = 0.9;

/// Weights and rests are found in turn, so often at most.
const ROUNDS: usize = 6;

/// A common time constant as its logarithm, and a common rest as a share of the range of drives.
type Point = (f64, Option<f64>);

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
    let ((_, at_first), (_, (mut tau, mut share))) = search.look()?;
    if let Some(first) = share {
        let resting = search.resting(None);
        let alone = |tau: &[f64; 1]| search.of(&resting).rmse_inside(tau, common);
        let ([at], without) = minimise([at_first], EDGE, TOLERANCE, STEPS, alone)?;
        let value = |[tau, share]: &[f64; 2]| match (0.0..=1.0).contains(share) {
            true => search
                .of(&search.resting(Some(*share)))
                .rmse_inside(&[*tau], common),
            false => Ok(f64::INFINITY),
        };
        let ([beside, rest], with) = minimise([tau, first], EDGE, TOLERANCE, STEPS, value)?;
        (tau, share) = match with <= WORTH * without {
            true => (beside, Some(rest)),
            false => (at, None),
        };
    }
    let body = FirstOrder {
        tau_heating: tau.exp(),
        tau_cooling: tau.exp(),
        ..FirstOrder::default()
    };
    let resting = search.resting(share);
    search.of(&resting).rested(Heated::unbound(body))
}

impl Search<'_> {
    /// The least error at a look with one time constant on a coarse grid, at rest with the first
    /// drives, and its logarithm; and the least one, and where it is, there or with one of a few rests for all
    /// recordings. What a wrong rest leaves takes longer than the body does, so the next shorter
    /// time constant is looked at as well.
    pub(super) fn look(&self) -> Result<((f64, f64), (f64, Point))> {
        let resting = self.resting(None);
        let ([first], at_first) = self.of(&resting).best_of_grid(common)?;
        let mut best = (at_first, (first, None));
        for share in LOOKS {
            let resting = self.resting(Some(share));
            let search = self.of(&resting);
            for tau in [first, first - GRID.ln()] {
                let rmse = search.rmse_inside(&[tau], common)?;
                if rmse < best.0 {
                    best = (rmse, (tau, Some(share)));
                }
            }
        }
        Ok(((at_first, first), best))
    }

    /// The recordings with the rests with which a model behind the body errs least. Weights and
    /// rests are found in turn, and each may make up for the other, so a later turn can be worse.
    pub(super) fn rested(&self, heated: Heated) -> Result<Vec<Recording>> {
        let (mut now, mut best) = (self.recordings.to_vec(), self.recordings.to_vec());
        let mut least = f64::INFINITY;
        for _ in 0..ROUNDS {
            let model = self.of(&now).model(heated, None)?;
            let rmse = model.fit.as_ref().map_or(f64::INFINITY, |fit| fit.rmse);
            if rmse >= WORTH * least {
                break;
            }
            (least, best) = (rmse, now.clone());
            now.iter_mut().for_each(|one| one.rest = None);
            now = with_rests(&model, &now)?.into_owned();
        }
        Ok(best)
    }

    /// The recordings, all with a rest at this share of the range of drives.
    fn resting(&self, share: Option<f64>) -> Vec<Recording> {
        let ranges = self.recordings.iter().map(|one| range(&one.input));
        let (low, high) = ranges.fold((0.0, 0.0), |all: (f64, f64), one| {
            (all.0.min(one.0), all.1.max(one.1))
        });
        let rest = share.map(|share| low + share * (high - low));
        let each = self.recordings.iter().cloned();
        each.map(|one| Recording { rest, ..one }).collect()
    }
}

fn common([tau]: &[f64; 1]) -> [f64; 2] {
    [*tau; 2]
}
