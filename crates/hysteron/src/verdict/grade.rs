//! What a model is good for, and what says so.

use super::Verdict;
use super::cause::{self, Cause};
use crate::rivals::{SMALL, wins};
use serde::Serialize;

/// Errors up to this, in percent, are good.
pub(super) const GOOD: f64 = 1.0;
/// So are errors up to this many deviations of the noise: no model predicts that.
const OF_NOISE: f64 = 1.5;
/// Errors up to this, in percent, are usable.
pub(super) const USABLE: f64 = 5.0;

/// What a model is good for.
///
/// The error counts, in percent of the range of the output, on data that the model was not fitted
/// to. One step less where a simple predictor errs less. At most `Usable` where few branches or
/// points that are unlike each other were recorded, loads left out are predicted badly, or what
/// comes late was found at one speed. `Poor` where a fifth of the inputs is outside the plane or
/// the output does not move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// At most 1 %, or hardly more than the noise of the readings: good enough to drive by its
    /// inverse alone.
    Good,
    /// At most 5 %: useful beside a controller that measures the output.
    Usable,
    /// More: not to be driven by.
    Poor,
    /// Not known, as it was tested only on what it was fitted to.
    Untested,
}

/// What an error was measured on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Basis {
    /// Another recording than the one fitted.
    OtherRecording,
    /// What the user held out of the fit.
    HeldOut,
    /// Branches that the fit left out one after the other to choose its options.
    BranchesLeftOut,
    /// Parts of branches, where there are too few whole ones.
    PartsLeftOut,
    /// The data fitted: it says nothing of others.
    Fitted,
}

impl Verdict {
    /// Finds the grade and puts the causes in order.
    pub(super) fn judge(&mut self) {
        // Of an output that does not move, any error is too much.
        let percent = self.percent.unwrap_or(match self.rmse > 0.0 {
            true => f64::INFINITY,
            false => 0.0,
        });
        // What a few numbers explain is no noise.
        let explained = self
            .causes
            .iter()
            .any(|cause| matches!(cause, Cause::Part(_) | Cause::Elsewhere { .. }));
        let by_error = match percent {
            _ if self.rmse <= OF_NOISE * self.noise && percent <= USABLE && !explained => {
                Grade::Good
            }
            p if p <= GOOD => Grade::Good,
            p if p <= USABLE => Grade::Usable,
            _ => Grade::Poor,
        };
        let rival = self.rival.as_ref();
        let better = rival.filter(|(_, rival)| wins(*rival, percent));
        let rival_wins = better.is_some();
        self.causes
            .extend(better.map(|(name, percent)| Cause::Rival {
                name: name.clone(),
                percent: *percent,
            }));
        let outside = self
            .causes
            .iter()
            .any(|cause| matches!(cause, Cause::Outside { share } if *share > cause::OUTSIDE));
        let guessed = self.causes.iter().any(|cause| {
            let few = matches!(cause, Cause::FewBranches { .. } | Cause::FewPoints { .. });
            few || matches!(cause, Cause::LoadsLeftOut { .. } | Cause::OneSpeed { .. })
        });
        self.grade = match (by_error, rival_wins) {
            _ if outside => Grade::Poor,
            (Grade::Good, _) if guessed => Grade::Usable,
            (Grade::Good, true) => Grade::Usable,
            (Grade::Usable, true) => Grade::Poor,
            (grade, _) => grade,
        };
        // A good fit is a promise only where something was left out; a bad one needs no test.
        if self.basis == Basis::Fitted && self.grade != Grade::Poor {
            self.grade = Grade::Untested;
        }
        if percent > SMALL && !explained {
            self.causes.extend(cause::of_noise(self.noise, self.rmse));
        }
        self.causes
            .sort_by(|a, b| b.weight().total_cmp(&a.weight()));
    }
}
