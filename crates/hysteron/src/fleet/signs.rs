//! By what an actuator shows whether it is of a kind: its error on what is left out, and its loop.

use super::shape::Shape;
use crate::model::Model;

/// Smaller errors, in percent of the range, are equal: no sensor tells them apart.
const SMALLEST: f64 = 0.01;

/// A sign is unusual for a kind if it is further from those of its pilots than this share of the
/// range that they span. For 16 with a normal distribution, the limits are 4.4 deviations away.
const BEYOND: f64 = 0.75;

/// Signs of which no closer ones are unusual, however near to each other those of the pilots are:
/// logarithms of error, width and slope, then position and open share.
const LEAST: [f64; Signs::COUNT] = [0.26, 0.4, 0.4, 0.1, 0.1];

/// A smaller error is no harm. Only one below half of those of the pilots shows another kind.
const BELOW: f64 = 0.69;

/// An error in multiples of another.
pub(super) fn ratio(error: f64, other: f64) -> f64 {
    error.max(SMALLEST) / other.max(SMALLEST)
}

/// The signs of an actuator, from a model of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Signs {
    /// Error on what is left out, in percent of the measured range.
    pub(super) error: f64,
    values: [f64; Signs::COUNT],
}

impl Signs {
    const COUNT: usize = 5;

    /// Of an actuator that no fit succeeds for.
    pub(super) const NONE: Self = Self {
        error: f64::INFINITY,
        values: [f64::NAN; Self::COUNT],
    };

    /// The signs of an actuator with this model.
    pub(super) fn new(model: &Model) -> Self {
        let shape = Shape::new(model);
        let plane = model.plane();
        let range = plane.max() - plane.min();
        let number = |number: Option<f64>| number.unwrap_or(f64::NAN);
        let fit = model.fit.as_ref();
        let open = fit.map_or(0, |fit| fit.open_at_start);
        let tested = fit.and_then(|fit| fit.validation.as_ref());
        let error = tested.map_or(f64::INFINITY, |tested| tested.nrmse_percent);
        Self::of(
            error,
            [
                (number(shape.width) / range).abs().max(1e-3).ln(),
                (number(shape.slope) * range / shape.stroke).abs().ln(),
                (number(shape.position) - plane.min()) / range,
                open as f64 / plane.operators() as f64,
            ],
        )
    }

    pub(super) fn of(error: f64, others: [f64; Signs::COUNT - 1]) -> Self {
        let [width, slope, position, open] = others;
        let values = [error.max(SMALLEST).ln(), width, slope, position, open];
        Self { error, values }
    }
}

/// Limits of the signs of a kind.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Usual([(f64, f64); Signs::COUNT]);

impl Usual {
    /// Of the signs of some pilots.
    pub(super) fn new(pilots: &[Signs]) -> Self {
        let mut limits = [(f64::NEG_INFINITY, f64::INFINITY); Signs::COUNT];
        for (n, limits) in limits.iter_mut().enumerate() {
            let values = pilots.iter().map(|signs| signs.values[n]);
            let values = values.filter(|value| value.is_finite());
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |all, value| {
                (all.0.min(value), all.1.max(value))
            });
            if low <= high {
                let beyond = BEYOND * (high - low);
                let below = if n == 0 { BELOW } else { LEAST[n] };
                *limits = (low - beyond.max(below), high + beyond.max(LEAST[n]));
            }
        }
        Self(limits)
    }

    /// Whether an actuator with these signs is of the kind. What it does not show is usual.
    pub(super) fn has(&self, signs: &Signs) -> bool {
        let mut pairs = signs.values.iter().zip(&self.0);
        let all = pairs.all(|(value, (low, high))| value.is_nan() || (low..=high).contains(&value));
        all && signs.error.is_finite()
    }

    /// The limits of the error, in percent.
    pub(super) fn error(&self) -> (f64, f64) {
        let (low, high) = self.0[0];
        (low.exp(), high.exp())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_far_from_all_pilots_is_unusual() {
        let pilot = |error, width: f64| Signs::of(error, [width, 0.0, 0.5, 0.0]);
        let usual = Usual::new(&[pilot(1.0, -1.0), pilot(1.2, -1.1), pilot(1.1, -1.05)]);
        assert!(usual.has(&pilot(1.5, -1.4)));
        // Above 1.3 times the largest error, below half of the smallest, and narrower by a third.
        for other in [pilot(1.7, -1.0), pilot(0.4, -1.0), pilot(1.1, -1.6)] {
            assert!(!usual.has(&other), "{other:?}");
        }
        assert!(usual.has(&pilot(1.1, f64::NAN)));
        assert!(!usual.has(&Signs::NONE));
    }

    #[test]
    fn errors_below_every_sensor_are_equal() {
        assert!((ratio(1e-9, 1e-3) - 1.0).abs() < 1e-12);
        assert!((ratio(0.3, 0.1) - 3.0).abs() < 1e-12);
        let usual = Usual::new(&[Signs::of(1e-5, [0.0; 4]), Signs::of(1e-7, [0.0; 4])]);
        assert!(usual.has(&Signs::of(0.0, [0.0; 4])));
    }
}
