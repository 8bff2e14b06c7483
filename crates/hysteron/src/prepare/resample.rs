//! Resamples a recording to equal time steps.

use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use crate::series::noise::median_of;

/// Steps that differ from the median by at most this share of it count as equal. A filter is not
/// affected.
const JITTER: f64 = 0.1;

/// By default the number of samples grows at most by this factor, however short the median step is.
const GROWTH: f64 = 4.0;

/// A step that gives more samples than this is taken as a typing error.
const MOST_SAMPLES: f64 = 1e8;

/// The median step. If it would make far too many samples, the average step instead.
pub(super) fn step_of(time: &[f64]) -> f64 {
    let duration = time[time.len() - 1] - time[0];
    let median = median_of(time.windows(2).map(|pair| pair[1] - pair[0]).collect());
    median.max(duration / (GROWTH * time.len() as f64))
}

/// Checks that the median step does not multiply the number of samples: over a long pause there is
/// nothing to filter.
pub(super) fn fits(time: &[f64]) -> Result<()> {
    let duration = time[time.len() - 1] - time[0];
    let median = median_of(time.windows(2).map(|pair| pair[1] - pair[0]).collect());
    let samples = duration / median;
    if median > 0.0 && samples > GROWTH * time.len() as f64 {
        let what = format!(
            "the time has gaps: at the median step of {median} s there would be {samples:.0} \
             samples instead of {}",
            time.len()
        );
        let remedy = Remedy::new(
            "cut the recording at its gaps (several files make one experiment), or turn the filter \
             off ({}), or give a step ({})",
            [Setting::word("low-pass", "off"), Setting::any("resample")],
        );
        return Err(Error::Preparation(what).remedied(remedy));
    }
    Ok(())
}

/// Whether any step differs from the median.
pub(super) fn irregular(time: &[f64]) -> bool {
    let steps = || time.windows(2).map(|pair| pair[1] - pair[0]);
    let median = median_of(steps().collect());
    steps().any(|step| (step - median).abs() > JITTER * median)
}

/// Interpolates all series linearly at every `step` from the first sample on. Of several samples at
/// the same time the last one counts.
pub(super) fn resample(recording: &mut Recording, step: f64) -> Result<()> {
    let Some(old) = recording.time.take() else {
        return Ok(());
    };
    let start = old[0];
    let steps = (old[old.len() - 1] - start) / step;
    if steps > MOST_SAMPLES {
        return Err(Error::Preparation(format!(
            "a step of {step} s makes {steps:.1e} samples: take a longer one"
        )));
    }
    // The last sample stays, although rounding may place it slightly before the end.
    let count = (steps * (1.0 + 1e-12) + 1e-9).floor() as usize + 1;
    let time: Vec<f64> = (0..count).map(|n| start + step * n as f64).collect();
    let at_new_times = |values: &[f64]| at_times(&old, values, &time);
    recording.input = at_new_times(&recording.input);
    recording.output = at_new_times(&recording.output);
    recording.load = recording.load.as_deref().map(at_new_times);
    recording.time = Some(time);
    // These samples are no rows of the file.
    if let Some(source) = &mut recording.source {
        source.places = None;
    }
    Ok(())
}

/// The values at other times, by lines between those of the `old` times; beyond their end, the last
/// one.
pub(super) fn at_times(old: &[f64], values: &[f64], new: &[f64]) -> Vec<f64> {
    let mut n = 0;
    let interpolate = |&now: &f64| {
        while n + 1 < old.len() && old[n + 1] <= now {
            n += 1;
        }
        match old.get(n + 1) {
            Some(next) => {
                let part = ((now - old[n]) / (next - old[n])).clamp(0.0, 1.0);
                values[n] + (values[n + 1] - values[n]) * part
            }
            None => values[n],
        }
    };
    new.iter().map(interpolate).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_filled_by_lines_and_all_series_stay_in_step() {
        let mut recording =
            Recording::new(vec![0.0, 1.0, 1.5, 4.0, 5.0], vec![5.0, 4.0, 9.0, 1.0, 0.0]).unwrap();
        recording.time = Some(vec![10.0, 11.0, 11.0, 14.0, 15.0]);
        recording.load = Some(vec![2.0; 5]);
        assert!(irregular(recording.time.as_deref().unwrap()));
        assert_eq!(step_of(recording.time.as_deref().unwrap()), 1.0);
        resample(&mut recording, 1.0).unwrap();
        assert_eq!(
            recording.time.as_deref().unwrap(),
            [10.0, 11.0, 12.0, 13.0, 14.0, 15.0]
        );
        let third = 2.5 / 3.0;
        let expected = [0.0, 1.5, 1.5 + third, 1.5 + 2.0 * third, 4.0, 5.0];
        for (found, expected) in recording.input.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12);
        }
        assert_eq!(recording.output[5], 0.0);
        assert_eq!(recording.load, Some(vec![2.0; 6]));
        recording.check().unwrap();
        assert!(matches!(
            resample(&mut recording, 1e-12),
            Err(Error::Preparation(_))
        ));
    }

    #[test]
    fn rounded_times_are_regular() {
        let rounded: Vec<f64> = (0..900)
            .map(|n| (f64::from(n) * 0.000135 * 1e6).round() / 1e6)
            .collect();
        assert!(!irregular(&rounded));
        // Half of the samples have the time of the sample before, so the median step is zero.
        let repeated: Vec<f64> = (0..900).map(|n| f64::from(n / 3)).collect();
        assert!(irregular(&repeated));
        assert!(step_of(&repeated) > 0.05);
    }
}
