//! How far a model moved while it learned.

use super::ShiftFound;
use super::learned::ROUNDING;
use crate::model::Model;
use hysteron_core::operators;
use serde::Serialize;

/// How far the model has changed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Drift {
    /// Sum of the weights before and after. For MKP it is the stroke from all operators off to all
    /// on; for KP and relay the stroke is twice this sum.
    pub weights: (f64, f64),
    /// Offset before and after.
    pub offset: (f64, f64),
    /// Sum of the absolute changes of the weights, over the sum before; infinite if that is zero.
    pub moved: f64,
    /// How far the output with all operators off moved, as a share of the range before.
    pub lift: f64,
    /// The stroke after over the stroke before, less 1.
    pub gain: f64,
    /// How far the operators moved along the input's axis, in the mean, as a share of the plane.
    pub shift: f64,
}

impl Drift {
    /// The largest of lift, gain and shift. A stroke that halves moved as far as one that doubles.
    #[must_use]
    pub fn largest(&self) -> f64 {
        let grown = 1.0 + self.gain;
        let gain = grown.max(grown.recip()) - 1.0;
        self.lift.abs().max(gain).max(self.shift.abs())
    }

    pub(super) fn between(before: &Model, after: &Model, found: Option<&ShiftFound>) -> Self {
        let sum = |model: &Model| model.weights().iter().sum::<f64>();
        let pairs = before.weights().iter().zip(after.weights());
        let moved: f64 = pairs.map(|(a, b)| (b - a).abs()).sum();
        let ((off, on), (off_after, on_after)) = (before.output_range(), after.output_range());
        let plane = before.plane();
        Self {
            weights: (sum(before), sum(after)),
            offset: (before.offset(), after.offset()),
            moved: moved / sum(before),
            lift: (off_after - off) / (on - off).abs(),
            gain: (on_after - off_after).abs() / (on - off).abs() - 1.0,
            shift: match found {
                Some(found) => found.shift / (plane.max() - plane.min()),
                None => (middle(after) - middle(before)) / plane.levels() as f64,
            },
        }
    }

    /// Whether the weights or the offset differ from those before.
    pub(super) fn is_change(&self) -> bool {
        self.moved > ROUNDING || self.lift.abs() > ROUNDING
    }
}

/// The mean threshold of a model's operators, in levels; 0 where all weights are zero.
fn middle(model: &Model) -> f64 {
    let (mut sum, mut weight) = (0.0, 0.0);
    for ((i, j), &mu) in operators(model.plane().levels()).zip(model.weights()) {
        sum += mu * 0.5 * (i + j) as f64;
        weight += mu;
    }
    if weight > 0.0 { sum / weight } else { 0.0 }
}
