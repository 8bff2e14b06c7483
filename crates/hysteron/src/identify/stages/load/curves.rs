//! Curves over the load that are made from others, and recordings behind them.

use crate::identify::changed::with_inputs;
use crate::model::LoadCurves;
use crate::recording::Recording;

/// Knots for each pair of neighbouring loads, where gain and offset between them are not straight.
const FINE: usize = 6;

/// The curves with more knots, where gain and offset between the loads are not straight.
pub(super) fn refined(curves: &LoadCurves, power: f64) -> LoadCurves {
    if power == 1.0 {
        return curves.clone();
    }
    let mut loads = Vec::new();
    for pair in curves.loads.windows(2) {
        let knot = |n: usize| pair[0] + (pair[1] - pair[0]) * n as f64 / FINE as f64;
        loads.extend((0..FINE).map(knot));
    }
    loads.extend(curves.loads.last());
    curves.resampled(&loads, power)
}

/// The curves without gain and offset.
pub(super) fn moving_only(curves: &LoadCurves) -> LoadCurves {
    LoadCurves {
        gains: Vec::new(),
        offsets: Vec::new(),
        ..curves.clone()
    }
}

/// The recordings with the load's shift taken off their inputs.
pub(in crate::identify::stages) fn behind(
    curves: &LoadCurves,
    recordings: &[Recording],
) -> Vec<Recording> {
    with_inputs(recordings, |recording| {
        let load = recording.load.iter().flatten();
        let pairs = recording.input.iter().zip(load);
        pairs
            .map(|(t, load)| match curves.at(*load) {
                Ok(at) => at.scale * t - at.shift,
                Err(_) => f64::NAN,
            })
            .collect()
    })
}
