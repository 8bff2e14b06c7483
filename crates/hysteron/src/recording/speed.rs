//! Whether all of a recording was made at one speed. What depends on the speed is not seen in it.

use crate::recording::Recording;
use crate::series::clear_branch_spans;
use crate::series::coarse::goes_by_jumps;

/// So many branches tell that there is one speed.
const BRANCHES: usize = 4;

/// The faster tenth of the branches is less than this many times as fast as the slower one.
pub(crate) const ONE: f64 = 1.5;

/// The speed of the input along a branch in the middle, per second, if all are about as fast;
/// `None` without time, and where the input jumps.
pub(crate) fn one_speed(recordings: &[Recording]) -> Option<f64> {
    let mut speeds = Vec::new();
    for recording in recordings {
        let time = recording.time.as_ref()?;
        if goes_by_jumps(&recording.input) {
            return None;
        }
        for samples in clear_branch_spans(&recording.input) {
            let (first, last) = (samples.start.saturating_sub(1), samples.end - 1);
            let way = (recording.input[last] - recording.input[first]).abs();
            let took = time[last] - time[first];
            speeds.extend((took > 0.0).then_some(way / took));
        }
    }
    speeds.sort_unstable_by(f64::total_cmp);
    let tenth = speeds.len() / 10;
    let (slow, fast) = (*speeds.get(tenth)?, *speeds.get(speeds.len() - 1 - tenth)?);
    let is_one = speeds.len() >= BRANCHES && fast < ONE * slow;
    is_one.then(|| speeds[speeds.len() / 2])
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn speeds_of_branches_are_compared() {
        let triangle = |n: usize| f64::from(100 - 10 * (n as i32 % 20 - 10).abs());
        let input: Vec<f64> = (0..200).map(triangle).collect();
        let mut recording = Recording::new(input.clone(), input).unwrap();
        assert_eq!(one_speed(std::slice::from_ref(&recording)), None);
        recording.time = Some((0..200).map(|n| 2.0 * f64::from(n)).collect());
        let speed = one_speed(std::slice::from_ref(&recording)).unwrap();
        assert!((speed - 5.0).abs() < 0.5, "{speed}");
        // The second half is twice as fast.
        recording.time = Some((0..200).map(|n| f64::from((2 * n).min(100 + n))).collect());
        assert_eq!(one_speed(&[recording]), None);
    }
}
