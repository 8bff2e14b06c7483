//! Finds jumps, and removes bursts: wrong readings that jump away and come back.

use crate::series::spread::{quantile, usual_span};

/// A jump is so many times larger than all but the largest steps,
const TIMES: f64 = 8.0;
/// of which there are this share.
const LARGE: f64 = 0.02;
/// It is also larger than this share of the usual range.
const SMALLEST: f64 = 0.05;

/// Two jumps that cancel each other to this share may be so much smaller: the series may go on
/// steeply between them.
const CANCELS: f64 = 0.25;
const PAIR: f64 = 0.5;

/// A burst has at most this share of the samples, and between these numbers of them.
const LONGEST: usize = 50;
const BURST: std::ops::RangeInclusive<usize> = 8..=100;

/// What a series does from one sample to the next.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Steps {
    /// All but the largest steps are no larger.
    usual: f64,
    /// The largest step that is no jump.
    largest: f64,
}

/// The steps of a series; `None` for one that moves in seldom steps, where a jump is the usual way.
pub(crate) fn steps(values: &[f64]) -> Option<Steps> {
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let usual = quantile(steps, 1.0 - LARGE);
    (usual > 0.0).then(|| Steps {
        usual,
        largest: (TIMES * usual).max(SMALLEST * usual_span(values)),
    })
}

/// The samples before which the series jumps.
pub(crate) fn jumps(values: &[f64]) -> Vec<usize> {
    let Some(Steps { largest, .. }) = steps(values) else {
        return Vec::new();
    };
    let jump = |n: &usize| (values[*n] - values[n - 1]).abs() > largest;
    (1..values.len()).filter(jump).collect()
}

/// Replaces bursts by linear interpolation between their neighbours, in place. Returns the indices
/// of the samples replaced. The [`steps`] are those of this series, or of one like it.
pub(crate) fn remove_bursts(values: &mut [f64], steps: Steps) -> Vec<usize> {
    let Steps { usual, largest } = steps;
    let longest = (values.len() / LONGEST).clamp(*BURST.start(), *BURST.end());
    let mut removed = Vec::new();
    let mut n = 1;
    while n < values.len() {
        let (before, jump) = (values[n - 1], values[n] - values[n - 1]);
        n += 1;
        if jump.abs() <= PAIR * largest {
            continue;
        }
        // It comes back to where the series would have gone by then.
        let start = n - 1;
        let back = |end: &usize| {
            let allowed = usual * (end - start + 1) as f64;
            let after = values[*end] - before;
            let step = values[*end] - values[end - 1];
            let comes_back = after.abs() <= allowed.max(largest).min(0.5 * jump.abs());
            let cancels = (step + jump).abs() <= CANCELS * jump.abs();
            step.abs() > PAIR * largest && cancels
                || step.abs().min(jump.abs()) > largest && comes_back
        };
        let Some(end) = (n..values.len().min(start + longest + 1)).find(back) else {
            continue;
        };
        let (after, length) = (values[end], (end - start + 1) as f64);
        for (k, value) in (1_u32..).zip(&mut values[start..end]) {
            *value = before + (after - before) * f64::from(k) / length;
        }
        removed.extend(start..end);
        n = end + 1;
    }
    removed
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::series::test_series::swings;

    #[test]
    fn bursts_of_either_sign_go_and_steps_stay() {
        let clean = swings();
        let mut read = clean.clone();
        let (up, dropout, mixed) = (100..107, 500..530, 900..906);
        up.clone().for_each(|n| read[n] += 60.0);
        dropout.clone().for_each(|n| read[n] = -150.0);
        mixed
            .clone()
            .for_each(|n| read[n] += if n % 2 == 0 { 70.0 } else { -70.0 });
        let expected: Vec<usize> = up.chain(dropout).chain(mixed).collect();
        let of_read = steps(&read).unwrap();
        assert_eq!(remove_bursts(&mut read, of_read), expected);
        for (n, (found, truth)) in read.iter().zip(&clean).enumerate() {
            // Over 30 samples, 0.6 rad, the sagitta of the sine is 40 (1 − cos 0.3).
            assert!((found - truth).abs() < 2.0, "{n}: {found} for {truth}");
        }
        // On a steep way, by less than half of what it goes on meanwhile.
        let steep: Vec<f64> = (0..600)
            .map(|n| f64::from(300 - (n - 300_i32).abs()))
            .collect();
        let mut read = steep.clone();
        read[100..112].iter_mut().for_each(|x| *x += 18.0);
        let expected: Vec<usize> = (100..112).collect();
        let of_read = steps(&read).unwrap();
        assert_eq!(remove_bursts(&mut read, of_read), expected);
        assert_eq!(read, steep);
        let square: Vec<f64> = (0..300).map(|n| f64::from(n / 10 % 2)).collect();
        let mut cut = clean.clone();
        cut[1000..].iter_mut().for_each(|x| *x += 100.0);
        for series in [clean, square, cut, vec![1.0; 9], vec![]] {
            let mut after = series.clone();
            if let Some(steps) = steps(&series) {
                assert_eq!(remove_bursts(&mut after, steps), [0; 0]);
                assert_eq!(after, series);
            }
        }
    }

    #[test]
    fn a_jump_is_where_the_series_goes_on_elsewhere() {
        let mut cut = swings();
        cut[1000..].iter_mut().for_each(|x| *x += 100.0);
        assert_eq!(jumps(&cut), [1000]);
        assert_eq!(jumps(&swings()), [0; 0]);
    }
}
