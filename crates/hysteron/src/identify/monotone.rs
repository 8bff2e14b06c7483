//! How much of its path an output moves against its input. Non-negative weights cannot follow that.

use crate::error::Result;
use crate::model::Sign;
use crate::recording::Recording;
use crate::series::coarse::noise_behind;
use crate::series::noise::furthest;
use crate::series::{headings, usual_tolerance};
use hysteron_core::Direction;

/// Above this share no monotone model can follow the output. An ideal loop has 0, a symmetric
/// butterfly loop 0.5.
pub const AGAINST_INPUT: f64 = 0.1;

/// The share of the output's path, from 0 to 1, on which it moves against the input, for outputs of
/// that `sign`. Movements of up to 1 % of the range are noise, on input and output, and on the
/// output those up to the furthest reading of its white noise ([`crate::noise`]), which is not told
/// where the input jumps.
///
/// Butterfly loops, changing loads and rate dependence make this share large. Hysteresis does not.
///
/// ```
/// use hysteron::{Recording, Sign, way_against_input};
/// let input: Vec<f64> = (0..200).map(|n| (f64::from(n) * 0.1).sin()).collect();
/// let butterfly = Recording::new(input.clone(), input.iter().map(|x| x * x).collect())?;
/// assert!(way_against_input(&butterfly, Sign::Positive)? > 0.4);
/// let line = Recording::new(input.clone(), input)?;
/// assert_eq!(way_against_input(&line, Sign::Positive)?, 0.0);
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::Recording`] for an invalid recording.
pub fn way_against_input(recording: &Recording, sign: Sign) -> Result<f64> {
    recording.check()?;
    let white = noise_behind(&recording.input, &recording.output);
    let tolerance = usual_tolerance(&recording.output).max(furthest(recording.len()) * white);
    let headings = headings(&recording.input, usual_tolerance(&recording.input));
    let (mut with, mut against) = (0.0, 0.0);
    let mut held = recording.output[0];
    for (&y, heading) in recording.output.iter().zip(headings) {
        // The output behind a play operator, so that noise within the tolerance does not move it.
        let next = held.clamp(y - tolerance, y + tolerance);
        let way = sign.factor() * (next - held);
        held = next;
        match heading {
            Some(Direction::Rising) if way < 0.0 => against -= way,
            Some(Direction::Falling) if way > 0.0 => against += way,
            _ => with += way.abs(),
        }
    }
    Ok(if against > 0.0 {
        against / (against + with)
    } else {
        0.0
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::series::test_series::gaussian;

    /// The share for loops of an output with white noise, in shares of its range.
    fn share(shape: fn(f64) -> f64, rate: f64, sigma: f64) -> f64 {
        let input: Vec<f64> = (0..5000).map(|n| (f64::from(n) * rate).sin()).collect();
        let pairs = input.iter().zip(gaussian(1, input.len()));
        let output = pairs.map(|(x, e)| shape(*x) + sigma * e).collect();
        way_against_input(&Recording::new(input, output).unwrap(), Sign::Positive).unwrap()
    }

    #[test]
    fn noise_is_no_movement() {
        for rate in [0.003, 0.02, 0.1] {
            for sigma in [0.0, 0.003, 0.02, 0.05] {
                let line = share(|x| 0.5 * x, rate, sigma);
                // Where the input turns slowly, noise goes on to push the output for a while.
                assert!(line < 0.5 * AGAINST_INPUT, "{line} at {rate}, {sigma}");
                let butterfly = share(|x| x * x, rate, sigma);
                assert!(butterfly > 0.4, "{butterfly} at {rate}, {sigma}");
            }
        }
    }
}
