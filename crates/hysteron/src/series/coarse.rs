//! Series that jump from reading to reading: set points, or few rows on a stroke.

use crate::series::noise::noise;
use crate::series::range;

/// A step of more than this share of the range is a jump: fewer than seven rows to a stroke.
const JUMP: f64 = 0.15;

/// From one jump in so many steps on, most readings have one among their neighbours.
const SELDOM: usize = 8;

/// The steps of a series that are jumps, and those that are none.
fn steps(values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (low, high) = range(values);
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    steps.partition(|step| *step > JUMP * (high - low))
}

/// Whether a series makes most of its way in jumps.
pub(crate) fn goes_by_jumps(values: &[f64]) -> bool {
    let (far, near) = steps(values);
    far.iter().sum::<f64>() > near.iter().sum()
}

/// Standard deviation of the white noise of an output, as far as it can be told: 0 where an answer
/// to the input cannot be told from noise.
pub(crate) fn noise_behind(input: &[f64], output: &[f64]) -> f64 {
    match hides_noise(input) {
        true => 0.0,
        false => noise(output),
    }
}

/// Whether the noise of what follows this input cannot be told from neighbours: these are elsewhere.
fn hides_noise(values: &[f64]) -> bool {
    let (far, _) = steps(values);
    SELDOM * far.len() > values.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn set_points_are_told_from_ramps() {
        let ramp = |n: u32| f64::from(n % 40).min(f64::from(40 - n % 40));
        let ramps: Vec<f64> = (0..400).map(ramp).collect();
        assert!(!goes_by_jumps(&ramps) && !hides_noise(&ramps));
        // Places in no order, for one row or for twenty.
        let place = |n: u32| f64::from(7 * n % 20);
        let short: Vec<f64> = (0..400).map(place).collect();
        assert!(goes_by_jumps(&short) && hides_noise(&short));
        let long: Vec<f64> = (0..400).map(|n| place(n / 20)).collect();
        assert!(goes_by_jumps(&long) && !hides_noise(&long));
    }
}
