//! A straight line through all samples.

use super::path::Measured;

#[derive(Debug, Clone)]
pub(crate) struct Line {
    /// Means of input and output.
    centre: (f64, f64),
    slope: f64,
}

impl Line {
    /// Least squares over all samples; a level line for a constant input.
    pub(super) fn fit(recordings: &[Measured<'_>]) -> Self {
        let pairs = || {
            let all = recordings.iter();
            all.flat_map(|r| r.input.iter().copied().zip(r.output.iter().copied()))
        };
        let count = pairs().count() as f64;
        let mean = |of: fn((f64, f64)) -> f64| pairs().map(of).sum::<f64>() / count;
        let centre = (mean(|pair| pair.0), mean(|pair| pair.1));
        let (mut xx, mut xy) = (0.0, 0.0);
        for (x, y) in pairs() {
            xx += (x - centre.0) * (x - centre.0);
            xy += (x - centre.0) * (y - centre.1);
        }
        let slope = if xx > 0.0 { xy / xx } else { 0.0 };
        Self { centre, slope }
    }

    pub(super) fn at(&self, x: f64) -> f64 {
        self.centre.1 + self.slope * (x - self.centre.0)
    }
}
