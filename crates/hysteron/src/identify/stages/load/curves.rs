//! Curves over the load that are made from others, and inputs behind them.

use crate::error::Result;
use crate::model::{LoadCurves, Plane, Registration, Start};
use crate::recording::Recording;
use hysteron_core::Axis;

/// Knots for each pair of neighbouring loads, where a curve between them is not straight.
const FINE: usize = 6;

/// The loads with more of them between any two.
pub(super) fn fine(loads: &[f64]) -> Vec<f64> {
    let between = |pair: &[f64]| {
        let (low, high) = (pair[0], pair[1]);
        (0..FINE).map(move |n| low + (high - low) * n as f64 / FINE as f64)
    };
    let inner = loads.windows(2).flat_map(between);
    inner.chain(loads.last().copied()).collect()
}

/// The curves without gain and offset.
pub(super) fn moving_only(curves: &LoadCurves) -> LoadCurves {
    LoadCurves {
        gains: Vec::new(),
        offsets: Vec::new(),
        ..curves.clone()
    }
}

/// Curves over the same loads that change nothing.
pub(super) fn still(curves: &LoadCurves) -> LoadCurves {
    LoadCurves {
        loads: curves.loads.clone(),
        shifts: vec![0.0; curves.loads.len()],
        ..LoadCurves::default()
    }
}

/// The curves without what they are at load number `left`.
pub(super) fn without(curves: &LoadCurves, left: usize) -> LoadCurves {
    let others = |values: &[f64]| {
        let kept = values.iter().enumerate().filter(|(n, _)| *n != left);
        kept.map(|(_, value)| *value).collect()
    };
    LoadCurves {
        loads: others(&curves.loads),
        shifts: others(&curves.shifts),
        scales: others(&curves.scales),
        gains: others(&curves.gains),
        offsets: others(&curves.offsets),
    }
}

/// The inputs of a recording as the operators see them behind load and registration.
pub(super) fn positions(
    curves: &LoadCurves,
    registration: &Registration,
    recording: &Recording,
    start: Start,
) -> Result<Vec<f64>> {
    let axis = Axis {
        load: curves.core(),
        registration: registration.core(),
        spacing: &[],
    };
    // Without a spacing nothing is asked of it.
    let plane = Plane::new(0.0, 1.0, 2)?;
    let mut held = match start {
        Start::On => f64::INFINITY,
        _ => f64::NEG_INFINITY,
    };
    let load = recording.load.iter().flatten();
    let samples = recording.input.iter().zip(load);
    let positions = samples.map(|(t, load)| {
        held = axis.seen(&plane, curves.at(*load)?, held, *t);
        Ok(held)
    });
    positions.collect()
}
