//! The material of simulated actuators: relays whose weights are a bell on the plane.

use hysteron::operators;

/// Levels of the relays of an actuator: finer than a fit sees.
pub(crate) const FINE: usize = 80;
/// Range of the input.
pub(crate) const RANGE: (f64, f64) = (20.0, 90.0);

/// Weights with a mean and a spread for the middle of a relay's two levels, and for half of their
/// distance. A relay moves the output by twice its weight, and all of them by `stroke`.
pub(crate) fn bell(
    (middle, spread): (f64, f64),
    (half, width): (f64, f64),
    stroke: f64,
) -> Vec<f64> {
    let level = |n: usize| RANGE.0 + (n as f64 - 0.5) * (RANGE.1 - RANGE.0) / FINE as f64;
    let density = operators(FINE).map(|(i, j)| {
        let (middle, half) = (
            (0.5 * (level(i) + level(j)) - middle) / spread,
            (0.5 * (level(j) - level(i)) - half) / width,
        );
        (-0.5 * (middle * middle + half * half)).exp()
    });
    let density: Vec<f64> = density.collect();
    let all: f64 = density.iter().sum();
    density.iter().map(|d| 0.5 * stroke * d / all).collect()
}
