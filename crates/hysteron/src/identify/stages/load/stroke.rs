//! How stroke and offset go from one load to the next.

use crate::model::LoadCurves;
use serde::Serialize;

/// What the stroke follows between the loads.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Stroke {
    /// A power of the load whose exponent changes slowly: a parabola of the logarithms. A stroke
    /// that saturates is such one (Lagoudas et al. 2012). For loads above zero.
    Power,
    /// A line over the root of the load. For loads of zero or more.
    Root,
    /// A line over the load.
    Straight,
}

impl Stroke {
    /// Those that loads may follow. Of a load below zero nothing is known: a line.
    pub(super) fn possible(loads: &[f64]) -> &'static [Self] {
        let least = loads.iter().copied().fold(f64::INFINITY, f64::min);
        if least > 0.0 {
            &[Self::Power, Self::Root, Self::Straight]
        } else if least == 0.0 {
            &[Self::Root, Self::Straight]
        } else {
            &[Self::Straight]
        }
    }

    /// The curves at other `loads`. Beyond their own they are those of the nearest one.
    ///
    /// `reach` is the output of all operators at the gain 1, with its sign. Of the two ends of the
    /// output, that with all operators off and that with all on, the one that moves less with the
    /// load is straight over it: it is the elastic line of one phase.
    pub(super) fn at(self, curves: &LoadCurves, reach: f64, loads: &[f64]) -> LoadCurves {
        let known = &curves.loads;
        let straight = |values: &[f64], load: f64| interpolated(known, values, load);
        let all = |of: &dyn Fn(f64) -> f64| -> Vec<f64> {
            let within = |load: &f64| load.clamp(known[0], known[known.len() - 1]);
            loads.iter().map(|load| of(within(load))).collect()
        };
        let list = |values: &Vec<f64>| match values.is_empty() {
            true => Vec::new(),
            false => all(&|load| straight(values, load)),
        };
        let gains = match curves.gains.is_empty() {
            true => Vec::new(),
            false => all(&|load| self.gain(known, &curves.gains, load)),
        };
        let on = curves.offsets.iter().zip(&curves.gains);
        let on: Vec<f64> = on.map(|(offset, gain)| offset + reach * gain).collect();
        let offsets = match spread(&on) < spread(&curves.offsets) {
            false => list(&curves.offsets),
            true => list(&on)
                .iter()
                .zip(&gains)
                .map(|(on, gain)| on - reach * gain)
                .collect(),
        };
        LoadCurves {
            loads: loads.to_vec(),
            shifts: list(&curves.shifts),
            scales: list(&curves.scales),
            gains,
            offsets,
        }
    }

    fn gain(self, loads: &[f64], gains: &[f64], load: f64) -> f64 {
        match self {
            Self::Straight => interpolated(loads, gains, load),
            Self::Root => {
                let roots: Vec<f64> = loads.iter().map(|load| load.sqrt()).collect();
                interpolated(&roots, gains, load.sqrt())
            }
            Self::Power => {
                let x: Vec<f64> = loads.iter().map(|load| load.ln()).collect();
                let y: Vec<f64> = gains.iter().map(|gain| gain.ln()).collect();
                let at = load.ln();
                let k = x.partition_point(|x| *x <= at).clamp(1, x.len() - 1);
                // The mean bend of the two parabolas through these two loads and a third one.
                let slope = |k: usize| (y[k] - y[k - 1]) / (x[k] - x[k - 1]);
                let bend = |k: usize| (slope(k + 1) - slope(k)) / (x[k + 1] - x[k - 1]);
                let near = [k.checked_sub(1), Some(k)].into_iter().flatten();
                let bends: Vec<f64> = near
                    .filter(|k| (1..x.len() - 1).contains(k))
                    .map(bend)
                    .collect();
                let bend = bends.iter().sum::<f64>() / bends.len().max(1) as f64;
                let line = y[k - 1] + (at - x[k - 1]) * slope(k);
                let curved = line + bend * (at - x[k - 1]) * (at - x[k]);
                // Between the two loads, as the gains are.
                let ends = (y[k - 1].min(y[k]), y[k - 1].max(y[k]));
                curved.clamp(ends.0, ends.1).exp()
            }
        }
    }
}

/// Straight between the values at `xs`.
fn interpolated(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let Some(last) = xs.len().checked_sub(2) else {
        return ys[0];
    };
    let k = xs.partition_point(|knot| *knot <= x).clamp(1, last + 1) - 1;
    ys[k] + (x - xs[k]) / (xs[k + 1] - xs[k]) * (ys[k + 1] - ys[k])
}

fn spread(values: &[f64]) -> f64 {
    let (low, high) = crate::series::range(values);
    high - low
}
