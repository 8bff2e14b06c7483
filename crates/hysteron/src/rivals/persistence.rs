//! What was measured one cycle before.

use super::path::{Branch, Leg, Measured, legs_beyond, measured};
use crate::error::{Error, Result};
use crate::series::range;

/// Ends of cycles that differ by less than this share of the range are the same. Smaller reversals
/// within a cycle are part of it.
const SAME: f64 = 0.1;

/// The last cycle of a recording.
#[derive(Debug, Clone)]
pub(crate) struct Persistence {
    rising: Branch,
    falling: Branch,
    /// How far ends of cycles may differ.
    same: f64,
}

impl Persistence {
    /// Keeps the last rising and the last falling branch, which have to share both ends.
    pub(super) fn fit(recordings: &[Measured<'_>]) -> Result<Self> {
        let Some(&last) = recordings.last() else {
            return Err(Error::Fit("there is no recording to fit".into()));
        };
        let (low, high) = range(last.input);
        let same = SAME * (high - low);
        let mut branches = measured(last, SAME);
        // A cycle that was cut off at the end of the recording is no cycle.
        let is_whole = |b: &Branch| (b.end - b.reversal).abs() >= (high - low) - 2.0 * same;
        branches.retain(is_whole);
        let of = |rises: bool| branches.iter().rev().find(|b| b.rises == rises).cloned();
        match (of(true), of(false)) {
            (Some(rising), Some(falling)) => Ok(Self {
                rising,
                falling,
                same,
            }),
            _ => Err(Error::Fit(
                "the recording has no whole cycle that could be repeated".into(),
            )),
        }
    }

    /// The legs of an input that repeats the cycle.
    ///
    /// # Errors
    /// [`Error::Fit`] if a branch does not repeat the cycle.
    pub(super) fn legs(&self, input: &[f64]) -> Result<Vec<Leg>> {
        let legs = legs_beyond(input, SAME);
        for (n, leg) in legs.iter().enumerate() {
            let branch = self.branch(leg);
            // The recording may begin and end within a cycle.
            let begins = n == 0 || (leg.reversal - branch.reversal).abs() <= self.same;
            let ends = n + 1 == legs.len() || (leg.end - branch.end).abs() <= self.same;
            if !(begins && ends && self.within(leg, branch)) {
                return Err(Error::Fit(format!(
                    "the branch from {} to {} does not repeat the cycle from {} to {}",
                    leg.reversal, leg.end, branch.reversal, branch.end
                )));
            }
        }
        Ok(legs)
    }

    pub(super) fn at(&self, leg: &Leg, x: f64) -> f64 {
        self.branch(leg).curve.at(x)
    }

    fn branch(&self, leg: &Leg) -> &Branch {
        match leg.rises {
            true => &self.rising,
            false => &self.falling,
        }
    }

    fn within(&self, leg: &Leg, branch: &Branch) -> bool {
        let low = branch.reversal.min(branch.end) - self.same;
        let high = branch.reversal.max(branch.end) + self.same;
        [leg.reversal, leg.end]
            .iter()
            .all(|x| (low..=high).contains(x))
    }
}
