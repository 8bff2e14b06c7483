//! A straight line through pairs of numbers.

/// Least squares: the means of the pairs and the sums that the slope comes from.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    /// Means of both.
    pub(crate) centre: (f64, f64),
    /// Sum of `(x − mean)²`.
    pub(crate) spread: f64,
    /// Sum of `(x − mean)(y − mean)`.
    pub(crate) common: f64,
}

impl Line {
    pub(crate) fn through(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> Self {
        let count = pairs.clone().count() as f64;
        let mean = |of: fn((f64, f64)) -> f64| pairs.clone().map(of).sum::<f64>() / count;
        let centre = (mean(|pair| pair.0), mean(|pair| pair.1));
        let (mut spread, mut common) = (0.0, 0.0);
        for (x, y) in pairs {
            spread += (x - centre.0) * (x - centre.0);
            common += (x - centre.0) * (y - centre.1);
        }
        Self {
            centre,
            spread,
            common,
        }
    }

    /// Zero where all `x` are equal.
    pub(crate) fn slope(&self) -> f64 {
        if self.spread > 0.0 {
            self.common / self.spread
        } else {
            0.0
        }
    }

    pub(crate) fn at(&self, x: f64) -> f64 {
        self.inclined(self.slope(), x)
    }

    /// The line through the means with another slope, at `x`.
    pub(crate) fn inclined(&self, slope: f64, x: f64) -> f64 {
        self.centre.1 + slope * (x - self.centre.0)
    }
}
