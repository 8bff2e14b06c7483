//! The strokes of the input, and what a sample counts in them.

use super::window::TURN;
use crate::series::Turning;

/// A stroke is worth so many samples, each by its part of the way; and a sample at least this.
const STROKE: f64 = 50.0;
pub(super) const LEAST: f64 = 0.3;

/// Finds where the input turns, and how far it goes between.
#[derive(Debug, Clone)]
pub(super) struct Strokes {
    turning: Turning,
    tolerance: f64,
    /// The way since the input turned.
    now: f64,
    /// The ways of the two strokes before.
    before: [f64; 2],
}

impl Strokes {
    /// Strokes on a plane of so many levels. At first they are taken to go through all of it.
    pub(super) fn new(levels: usize) -> Self {
        let tolerance = TURN * levels as f64;
        Self {
            turning: Turning::new(tolerance),
            tolerance,
            now: 0.0,
            before: [levels as f64; 2],
        }
    }

    /// Goes on by a distance. Returns what the sample counts for the stroke to come: errors of
    /// neighbouring samples are alike, the more so the denser they are.
    pub(super) fn go(&mut self, distance: f64) -> f64 {
        self.now += distance;
        let [last, before] = self.before;
        (STROKE * distance / last.max(before)).clamp(LEAST, 1.0)
    }

    /// Whether the input is seen to have turned, now that it is at `position`.
    pub(super) fn turned(&mut self, position: f64) -> bool {
        let turned = self.turning.push(position).is_some();
        if turned {
            self.before = [self.now.max(self.tolerance), self.before[0]];
            self.now = 0.0;
        }
        turned
    }

    /// Begins a stroke anew, wherever the input is.
    pub(super) fn restart(&mut self) {
        self.turning = Turning::new(self.tolerance);
        self.now = 0.0;
    }
}
