//! By how much a target may be missed that the C reports as reached, in the unit of the output.

use super::real::{CReal, Number, unfit};
use super::stages::CSampling;
use hysteron::{Error, Model, Operator, Result};
use hysteron_core::{Ring, Stages, operator_index};

/// What rounding may amount to where a target counts as reached, as a part of the range of outputs.
/// The status allows no more.
const MOST: f64 = 1e-3;

/// The rounding of the inverse, over all its targets, drives and loads, in the unit of the output.
///
/// # Errors
/// [`Error::Export`] where the digits of the number type do not keep a thousandth of the range of
/// outputs.
pub(super) fn missed<T: Number>(model: &Model, sampling: &CSampling) -> Result<f64> {
    let epsilon = T::DISTANCE;
    let stages = model.stages();
    let most = |curve: &[f64], without: f64| match curve {
        [] => without,
        curve => curve.iter().fold(0.0, |most, v| f64::max(most, v.abs())),
    };
    let load = stages.axis.load;
    let of_load = most(load.gains, 1.0);
    // A ring overshoots to twice a step.
    let overshoot = match stages.behind.ring == Ring::NONE {
        true => 1.0,
        false => 2.0,
    };
    let gain = of_load * stages.behind.steepest_at_rest() * overshoot;
    let Slopes { total, steepest } = Slopes::new(model);
    let (low, high) = model.output_range();
    let offset = most(load.offsets, 0.0);
    let target = low.abs().max(high.abs()) + offset;
    let axis = Axis::new(model, &stages, sampling);
    let of_digits = 4.0 * epsilon * gain * total;
    let of_stages = stages.behind.size();
    let of_offsets = 8.0 * epsilon * (model.offset().abs() + offset + target + of_stages);
    let of_axis = 8.0 * epsilon * axis.size / model.plane().step();
    // What is left of the past is rounded in each sample, and that adds up.
    let rates = sampling.dt.map(|dt| stages.rates(dt).to_numbers());
    let [heating, cooling, faded @ ..] = rates.unwrap_or_default();
    let drifted = |factor: f64| epsilon / 2.0 / (1.0 - factor);
    let of_body = match stages.body {
        Some(_) => drifted(heating.max(cooling)) * axis.heated / model.plane().step(),
        None => 0.0,
    };
    let of_past = epsilon / 2.0 * (1.0 + stages.behind.drift(&faded));
    let needed = of_digits + of_offsets + gain * (steepest * (of_axis + of_body) + total * of_past);
    let bottom = match model.operator() {
        Operator::Mkp => 0.0,
        Operator::Kp | Operator::Relay => -0.5 * total,
    };
    let ends = [bottom, bottom + total].map(|sum| stages.behind.settled(of_load * sum));
    let range = ends[1] - ends[0];
    // False for NaN.
    let kept = needed <= MOST * range;
    if !kept && range > 0.0 {
        let what = format!(
            "its rounding of {needed:.1e} in outputs of a range of {range:.1e}, more than a \
             thousandth,"
        );
        return Err(match T::REAL {
            CReal::Float => unfit(&what),
            CReal::Double => Error::Export(format!("{what} does not fit double precision")),
        });
    }
    // The status allows what would be needed if all operators moved together.
    Ok((needed.max(of_digits + of_offsets + gain * total * of_axis)).min(MOST * range))
}

/// How fast the operators' sum moves, over all loads.
struct Slopes {
    /// The range of the sum.
    total: f64,
    /// The largest change while the input moves by a level: the operators with one upper threshold
    /// move together, and those with one lower threshold. Zero for relays, which the inverse leads
    /// over their level in any case.
    steepest: f64,
}

impl Slopes {
    fn new(model: &Model) -> Self {
        let own = [model.weights()];
        let parts: Vec<&[f64]> = match model.load.as_ref().map(|load| load.parts()) {
            Some(parts) if parts.len() > 1 => parts.iter().map(|part| &*part.weights).collect(),
            _ => own.to_vec(),
        };
        let levels = model.plane().levels();
        let steepest = |weights: &[f64]| {
            let upper = |j: usize| (1..=j).map(|i| weights[operator_index(i, j)]).sum::<f64>();
            let lower = |i: usize| {
                (i..=levels)
                    .map(|j| weights[operator_index(i, j)])
                    .sum::<f64>()
            };
            let most = |k: usize| f64::max(upper(k), lower(k));
            (1..=levels).map(most).fold(0.0, f64::max)
        };
        let total = |weights: &[f64]| weights.iter().sum::<f64>();
        let largest = |of: &dyn Fn(&[f64]) -> f64| parts.iter().map(|w| of(w)).fold(0.0, f64::max);
        // The output of a KP operator or a relay moves from −μ to μ.
        let (span, moves) = match model.operator() {
            Operator::Mkp => (1.0, 1.0),
            Operator::Kp => (2.0, 2.0),
            Operator::Relay => (2.0, 0.0),
        };
        Self {
            total: span * largest(&total),
            steepest: moves * largest(&steepest),
        }
    }
}

/// The largest numbers that the operators' input is made from, in units of the plane's axis.
struct Axis {
    /// All of them together.
    size: f64,
    /// The temperature behind a thermal body.
    heated: f64,
}

impl Axis {
    fn new(model: &Model, stages: &Stages<'_, f64>, sampling: &CSampling) -> Self {
        let plane = model.plane();
        let magnitude = |ends: [f64; 2]| ends[0].abs().max(ends[1].abs());
        let load = stages.axis.load;
        let spacing = stages.axis.spacing;
        let corners = match spacing {
            [first, .., last] => magnitude([*first, *last]),
            _ => magnitude([plane.bottom(), plane.max()]),
        };
        let gaps = spacing
            .windows(2)
            .map(|pair| plane.step() / (pair[1] - pair[0]));
        let slope = gaps.fold(0.0, f64::max);
        let slope = if spacing.is_empty() { 1.0 } else { slope };
        let registration = stages.axis.registration;
        let slope = slope * registration.steepest();
        let rows = registration.rising.iter().chain(registration.falling);
        let corners = rows.fold(corners, |most, t| f64::max(most, t.abs()));
        let shift = load
            .shifts
            .iter()
            .fold(0.0, |most, v| f64::max(most, v.abs()));
        let (mut least, mut scale) = (1.0_f64, 1.0_f64);
        if let [first, ..] = load.scales {
            let ends = (*first, *first);
            (least, scale) = load
                .scales
                .iter()
                .fold(ends, |(a, b), v| (a.min(*v), b.max(*v)));
        }
        let wanted = (corners + shift) / least;
        let (low, high) = sampling.drive.unwrap_or_else(|| model.drive_range());
        let (driven, heated) = stages.body.map_or((0.0, 0.0), |body| {
            let driven =
                body.ambient.abs() + body.gain * magnitude([low, high]) + stages.latent.heat;
            (driven, magnitude([body.rest(low), body.rest(high)]))
        });
        Self {
            size: (scale * (wanted + driven) + shift + registration.size()) * slope
                + plane.bottom().abs()
                + plane.max().abs(),
            heated: scale * heated.max(wanted) * slope,
        }
    }
}
