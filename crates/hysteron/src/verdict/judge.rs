//! Judges a model by its error and by what is behind it.

use super::cause::{self, Cause};
use super::grade::{GOOD, OF_NOISE, USABLE};
use super::{Basis, Grade, Verdict};
use crate::rivals::{SMALL, wins};

impl Verdict {
    /// Finds the grade and puts the causes in order.
    pub(super) fn judge(&mut self) {
        // Of an output that does not move, any error is too much.
        let percent = self.percent.unwrap_or(match self.rmse > 0.0 {
            true => f64::INFINITY,
            false => 0.0,
        });
        // An easy test is no better than what was fitted.
        let fitted = self.causes.iter().find_map(|cause| match cause {
            Cause::Easier { percent } => Some(*percent),
            _ => None,
        });
        let percent = percent.max(fitted.unwrap_or_default());
        let unrelated = self
            .causes
            .iter()
            .any(|cause| matches!(cause, Cause::Unrelated { .. }));
        // What a few numbers explain is no noise. Nor is an output that does something else.
        let explained = unrelated
            || self
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
            let unseen = matches!(cause, Cause::Clipped { .. } | Cause::HeldInput { .. });
            few || unseen || matches!(cause, Cause::LoadsLeftOut { .. } | Cause::OneSpeed { .. })
        });
        self.grade = match (by_error, rival_wins) {
            _ if outside || unrelated => Grade::Poor,
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
