//! Makes the band hold what it promises: 95 % of what was left out of a fit.

use crate::error::Result;
use crate::identify::weights::problem::Problem;
use crate::model::{INTERVAL, LoadPart, Operators, Sign, Start, add_variance};

/// Share of the samples that the band holds.
const SHARE: f64 = 0.95;

/// Sets the noise of the band, and shrinks the `factors` where they are too wide, so that the band
/// holds 95 % of the `errors` of fits that left each sample's branch out (jackknife+, Barber et al.
/// 2021). Returns the noise. `sensor` is the least it can be.
pub(super) fn calibrate(
    factors: &mut [LoadPart],
    errors: &[f64],
    sensor: f64,
    problem: &Problem,
    sign: Sign,
) -> Result<f64> {
    let variance = variance(factors, problem, sign)?;
    let standard = |error: &f64| (error / INTERVAL).powi(2);
    let missing = errors.iter().zip(&variance).map(|(e, v)| standard(e) - v);
    let noise = quantile(missing.collect()).max(0.0).sqrt();
    if noise > sensor {
        return Ok(noise);
    }
    let ratios = errors.iter().zip(&variance);
    let ratios = ratios.map(|(e, v)| (standard(e) - sensor * sensor).max(0.0) / v.max(1e-300));
    let scale = quantile(ratios.collect()).clamp(0.0, 1.0).sqrt();
    for factor in factors {
        factor.offset *= scale;
        factor.weights.iter_mut().for_each(|mu| *mu *= scale);
    }
    Ok(sensor)
}

/// The variance of the output from the factors, at each sample.
fn variance(factors: &[LoadPart], problem: &Problem, sign: Sign) -> Result<Vec<f64>> {
    let options = &problem.options;
    let experiment = &problem.experiment;
    let mut variance = vec![0.0; experiment.input.len()];
    for factor in factors {
        let plane = *problem.regressor.plane();
        let weights = factor.weights.clone();
        let operators = Operators::new(options.operator, plane, weights, factor.offset, sign)?;
        for range in &experiment.recordings {
            let mut state = match options.start {
                Start::On => operators.saturated(),
                _ => operators.start(),
            };
            let own = &mut variance[range.clone()];
            add_variance(
                &operators,
                &mut state,
                &experiment.input[range.clone()],
                own,
            )?;
        }
    }
    Ok(variance)
}

/// The value that [`SHARE`] of the values do not exceed.
pub(super) fn quantile(mut values: Vec<f64>) -> f64 {
    let place = ((values.len() as f64 * SHARE).ceil() as usize).clamp(1, values.len()) - 1;
    *values.select_nth_unstable_by(place, f64::total_cmp).1
}
