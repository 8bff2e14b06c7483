//! Thermal cycles of one recording.

use crate::result::Result;
use hysteron::{Direction, PrepareOptions, Progress, Recording, Step, Turning, prepare};

/// The recording after lost signs and spikes are repaired, and its cycles from one highest input to
/// the next.
pub(crate) fn cycles(raw: &Recording) -> Result<(Recording, Vec<Recording>)> {
    let steps = PrepareOptions {
        signs: true,
        spikes: Step::Value(4.0),
        ..PrepareOptions::all(Step::Off)
    };
    let (whole, _) = prepare(raw, &steps, Progress::NONE)?;
    let ((low, high), _) = whole.ranges();
    let cold = |t: &f64| *t < whole.input[0] - 0.02 * (high - low);
    let begin = whole.input.iter().position(cold).unwrap_or(0);
    let mut turning = Turning::new(0.2 * (high - low));
    let mut bounds = vec![begin];
    for &t in &whole.input {
        if let Some((n, Direction::Falling)) = turning.push(t)
            && n > begin
        {
            bounds.push(n);
        }
    }
    let part = |b: &[usize]| whole.only(|n| (b[0]..b[1]).contains(&n));
    let cycles = bounds.windows(2).filter_map(part).collect();
    Ok((whole, cycles))
}
