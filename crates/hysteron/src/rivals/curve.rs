//! Output over input along one branch.

/// Points in ascending order of the input, one for each value.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    points: Vec<(f64, f64)>,
}

impl Curve {
    /// The mean output at each value of the input. There is at least one point.
    pub(super) fn new(mut points: Vec<(f64, f64)>) -> Self {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut merged: Vec<(f64, f64)> = Vec::with_capacity(points.len());
        for same in points.chunk_by(|a, b| a.0 == b.0) {
            let sum: f64 = same.iter().map(|point| point.1).sum();
            merged.push((same[0].0, sum / same.len() as f64));
        }
        Self { points: merged }
    }

    pub(super) fn covers(&self, x: f64) -> bool {
        let ends = (self.points.first(), self.points.last());
        matches!(ends, (Some(low), Some(high)) if (low.0..=high.0).contains(&x))
    }

    /// Linear between the points, level beyond them.
    pub(super) fn at(&self, x: f64) -> f64 {
        let after = self.points.partition_point(|point| point.0 <= x);
        let before = after.checked_sub(1).map(|k| self.points[k]);
        match (before, self.points.get(after)) {
            (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0),
            (Some(only), None) => only.1,
            (None, Some(only)) => only.1,
            (None, None) => f64::NAN,
        }
    }
}
