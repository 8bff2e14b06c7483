//! Makes the band hold what it promises: 95 % of what was left out of a fit.

use crate::error::Result;
use crate::identify::weights::problem::Problem;
use crate::model::{INTERVAL, LoadPart, Operators, Sign, add_variance};

/// Share of the samples that the band holds.
const SHARE: f64 = 0.95;

/// Variance of the output that the band needs beyond that of the factors, so that it holds 95 % of
/// the errors on new branches (jackknife+, Barber et al. 2021). `sensor` is the least noise.
///
/// `errors` are those of fits that left the sample's unit out, with the number of the sample,
/// ascending, and the number of units.
pub(super) fn calibrate(
    factors: &[LoadPart],
    (errors, units): (impl Iterator<Item = (usize, f64)>, usize),
    sensor: f64,
    problem: &Problem,
    sign: Sign,
) -> Result<f64> {
    let mut values = variance(factors, problem, sign)?;
    // Each value takes the place of a variance that is no longer needed.
    let mut count = 0;
    for (n, error) in errors {
        values[count] = missing(error, values[n]);
        count += 1;
    }
    values.truncate(count);
    Ok(quantile(values, units).sqrt().max(sensor))
}

/// The variance that a band with `variance` misses to hold `error`.
pub(super) fn missing(error: f64, variance: f64) -> f64 {
    (error / INTERVAL).powi(2) - variance
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
            let mut state = options.initial().state(&operators.core)?;
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

/// What 95 % of the samples of a new unit need at most, from samples of `units` others; at least
/// zero.
///
/// The share is a little larger than 95 %, because the units are few and differ. With the share
/// `95 % · (1 + 1 / units)` it would hold for any units (Dunn, Wasserman and Ramdas 2023). That
/// is the worst case, in which one unit has all large errors. Half of it is added here.
pub(super) fn quantile(mut values: Vec<f64>, units: usize) -> f64 {
    let share = SHARE * (1.0 + 0.5 / units.max(1) as f64);
    let count = values.len();
    let Some(last) = count.checked_sub(1) else {
        return 0.0;
    };
    let place = (count as f64 * share).ceil() as usize - 1;
    let (_, value, _) = values.select_nth_unstable_by(place.min(last), f64::total_cmp);
    value.max(0.0)
}
