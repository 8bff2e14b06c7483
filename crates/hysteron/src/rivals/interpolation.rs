//! Interpolation over the input and the last reversal.

use super::path::{Branch, Leg, Measured, all_measured};
use crate::series::{NOISE, range};

/// Branches of one direction with the same reversal, up to noise.
#[derive(Debug, Clone)]
struct Bundle {
    reversal: f64,
    branches: Vec<Branch>,
}

impl Bundle {
    /// The mean of the branches that reach this input.
    fn at(&self, x: f64) -> Option<f64> {
        let reaching = || self.branches.iter().filter(|b| b.curve.covers(x));
        let count = reaching().count();
        let sum: f64 = reaching().map(|branch| branch.curve.at(x)).sum();
        (count > 0).then(|| sum / count as f64)
    }

    /// The mean of all branches, each level beyond its ends.
    fn beyond(&self, x: f64) -> f64 {
        let sum: f64 = self.branches.iter().map(|branch| branch.curve.at(x)).sum();
        sum / self.branches.len() as f64
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Interpolation {
    rising: Vec<Bundle>,
    falling: Vec<Bundle>,
}

impl Interpolation {
    pub(super) fn fit(recordings: &[Measured<'_>]) -> Self {
        let inputs: Vec<(f64, f64)> = recordings.iter().map(|r| range(r.input)).collect();
        let low = inputs.iter().map(|r| r.0).fold(f64::INFINITY, f64::min);
        let high = inputs.iter().map(|r| r.1).fold(f64::NEG_INFINITY, f64::max);
        let all = all_measured(recordings);
        let (rising, falling): (Vec<_>, Vec<_>) = all.into_iter().partition(|b| b.rises);
        let bundles = |own| bundles(own, NOISE * (high - low));
        let (rising, falling) = (bundles(rising), bundles(falling));
        // Where one direction was never travelled, the other one is all that is known.
        match (rising.is_empty(), falling.is_empty()) {
            (true, _) => Self {
                rising: falling.clone(),
                falling,
            },
            (_, true) => Self {
                falling: rising.clone(),
                rising,
            },
            _ => Self { rising, falling },
        }
    }

    pub(super) fn at(&self, leg: &Leg, x: f64) -> f64 {
        let bundles = match leg.rises {
            true => &self.rising,
            false => &self.falling,
        };
        between(bundles, leg.reversal, x)
    }
}

/// Bundles in ascending order of their reversals.
fn bundles(mut branches: Vec<Branch>, same: f64) -> Vec<Bundle> {
    branches.sort_by(|a, b| a.reversal.total_cmp(&b.reversal));
    let mut found: Vec<Bundle> = Vec::new();
    for branch in branches {
        match found.last_mut() {
            Some(last) if branch.reversal - last.branches[0].reversal <= same => {
                last.branches.push(branch);
            }
            _ => found.push(Bundle {
                reversal: branch.reversal,
                branches: vec![branch],
            }),
        }
    }
    for bundle in &mut found {
        let sum: f64 = bundle.branches.iter().map(|b| b.reversal).sum();
        bundle.reversal = sum / bundle.branches.len() as f64;
    }
    found
}

/// The output at `x` after a reversal, from the nearest bundles on both sides that reach `x`.
fn between(bundles: &[Bundle], reversal: f64, x: f64) -> f64 {
    let here = bundles.partition_point(|bundle| bundle.reversal <= reversal);
    let reach = |bundle: &Bundle| Some((bundle.reversal, bundle.at(x)?));
    let below = bundles[..here].iter().rev().find_map(reach);
    let above = bundles[here..].iter().find_map(reach);
    match (below, above) {
        (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (reversal - a.0) / (b.0 - a.0),
        (Some(only), None) | (None, Some(only)) => only.1,
        (None, None) => {
            let far = |bundle: &&Bundle| (bundle.reversal - reversal).abs();
            let nearest = bundles.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
            nearest.map_or(f64::NAN, |bundle| bundle.beyond(x))
        }
    }
}
