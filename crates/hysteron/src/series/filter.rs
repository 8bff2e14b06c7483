//! Low-pass filter without phase shift, for series that are complete before filtering starts.
//!
//! A Butterworth filter of order 2 runs over the samples forward and then backward (the method of
//! `filtfilt` in SciPy and MATLAB). The two delays cancel and the attenuation doubles. So the gain
//! is 1 at zero frequency and ½ at the cut-off.
//!
//! At both ends the series is extended by point reflection through its end sample, so that a ramp
//! continues as a ramp. Each pass starts in the steady state for its first value.

use biquad::{Biquad, Coefficients, DirectForm2Transposed, Q_BUTTERWORTH_F64, Type};

/// Number of reflected samples at each end, in periods of the cut-off. Over this length the
/// transient decays to 10⁻¹⁰ of its size.
const PADDING_PERIODS: f64 = 6.0;

/// Why the low-pass filter refused its arguments.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilterError {
    /// The sampling rate is not a positive number.
    #[error("the sampling rate is {0} Hz, but must be positive and finite")]
    SampleRate(f64),
    /// The cut-off is not between 0 and half the sampling rate.
    #[error(
        "the cut-off is {cutoff} Hz, but must lie above 0 and below half the sampling rate, \
         {nyquist} Hz"
    )]
    Cutoff {
        /// The cut-off given, Hz.
        cutoff: f64,
        /// Half the sampling rate, Hz.
        nyquist: f64,
    },
    /// There are fewer than two samples.
    #[error("{0} sample(s): a filter needs at least 2")]
    TooShort(usize),
    /// A sample is NaN or infinite.
    #[error("sample number {0} (from 0) is not a finite number")]
    NotFinite(usize),
}

/// Removes everything faster than `cutoff` (Hz, below half the sampling rate) from `samples`, taken
/// at `sample_rate` (Hz).
///
/// The result has as many samples as the input. Constants and straight lines are not changed.
///
/// # Errors
/// [`FilterError`] names the argument that does not fit.
///
/// ```
/// let ramp_and_ripple = |n: usize| n as f64 * 0.1 + if n % 2 == 0 { 0.5 } else { -0.5 };
/// let noisy: Vec<f64> = (0..100).map(ramp_and_ripple).collect();
/// let smooth = hysteron::filter::low_pass(&noisy, 10.0, 0.5)?;
/// assert!((smooth[50] - 5.0).abs() < 0.01);
/// # Ok::<(), hysteron::filter::FilterError>(())
/// ```
pub fn low_pass(samples: &[f64], sample_rate: f64, cutoff: f64) -> Result<Vec<f64>, FilterError> {
    if !(sample_rate.is_finite() && sample_rate > 0.0) {
        return Err(FilterError::SampleRate(sample_rate));
    }
    let nyquist = sample_rate / 2.0;
    let refused = FilterError::Cutoff { cutoff, nyquist };
    if !(cutoff > 0.0 && cutoff < nyquist) {
        return Err(refused);
    }
    let (&[first, ..], &[.., last]) = (samples, samples) else {
        return Err(FilterError::TooShort(0));
    };
    if samples.len() < 2 {
        return Err(FilterError::TooShort(samples.len()));
    }
    if let Some(index) = samples.iter().position(|x| !x.is_finite()) {
        return Err(FilterError::NotFinite(index));
    }
    let section =
        Coefficients::from_normalized_params(Type::LowPass, cutoff / nyquist, Q_BUTTERWORTH_F64)
            .map_err(|_| refused)?;

    let padding = (PADDING_PERIODS * sample_rate / cutoff).ceil() as usize;
    let padding = padding.min(samples.len() - 1);
    // Filter only the distance from the line through the end points. Otherwise a ramp would be bent
    // in a recording that is too short for the transient to decay.
    let rise = (last - first) / (samples.len() - 1) as f64;
    let line = |n: usize| first + rise * n as f64;
    let level: Vec<f64> = (0..).zip(samples).map(|(n, x)| x - line(n)).collect();
    // Both end points lie on the line, so reflection through them only changes the sign.
    let before = level[1..=padding].iter().rev().map(|x| -x);
    let after = level[level.len() - 1 - padding..level.len() - 1]
        .iter()
        .rev()
        .map(|x| -x);
    let mut work: Vec<f64> = before.chain(level.iter().copied()).chain(after).collect();

    run(section, work.iter_mut());
    run(section, work.iter_mut().rev());
    let filtered = &work[padding..padding + samples.len()];
    Ok((0..).zip(filtered).map(|(n, x)| line(n) + x).collect())
}

/// One pass of the filter, in place. The gain is 1 at zero frequency. So filtering the distance
/// from the first sample, from an empty state, equals starting in the steady state for that sample.
fn run<'a>(section: Coefficients<f64>, samples: impl Iterator<Item = &'a mut f64>) {
    let mut state = DirectForm2Transposed::<f64>::new(section);
    let mut origin = None;
    for x in samples {
        let origin = *origin.get_or_insert(*x);
        *x = origin + state.run(*x - origin);
    }
}
