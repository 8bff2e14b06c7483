//! The mean of all branches at the same input: the best that a curve without hysteresis can do.

use super::path::{Branch, Measured, all_measured};

#[derive(Debug, Clone)]
pub(crate) struct MeanCurve {
    branches: Vec<Branch>,
}

impl MeanCurve {
    pub(super) fn fit(recordings: &[Measured<'_>]) -> Self {
        Self {
            branches: all_measured(recordings),
        }
    }

    /// The mean of rising and falling branches, each the mean over its own branches, so that many
    /// branches of one direction do not count more. Branches that do not reach this input count
    /// only where none does.
    pub(super) fn at(&self, x: f64) -> f64 {
        let mean = |which: &dyn Fn(&Branch) -> bool| {
            let (mut sum, mut count) = (0.0, 0.0);
            for branch in self.branches.iter().filter(|branch| which(branch)) {
                sum += branch.curve.at(x);
                count += 1.0;
            }
            (count > 0.0).then(|| sum / count)
        };
        let covering = |rises: bool| mean(&|b: &Branch| b.rises == rises && b.curve.covers(x));
        match (covering(true), covering(false)) {
            (Some(up), Some(down)) => 0.5 * (up + down),
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => mean(&|_| true).unwrap_or(f64::NAN),
        }
    }
}
