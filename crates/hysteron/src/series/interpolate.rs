//! A series at other times.

/// Linear interpolation of a series at the times `wanted`; NaN outside its own times. Only finite
/// samples count. They are sorted by time, and of several samples at one time the last counts.
pub(crate) fn interpolate(times: &[f64], values: &[f64], wanted: &[f64]) -> Vec<f64> {
    let samples = times.iter().zip(values).map(|(t, y)| (*t, *y));
    let mut samples: Vec<_> = samples
        .filter(|(t, y)| t.is_finite() && y.is_finite())
        .collect();
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let at = |&t: &f64| {
        let after = samples.partition_point(|sample| sample.0 <= t);
        match (after.checked_sub(1).map(|n| samples[n]), samples.get(after)) {
            (Some((t0, y0)), _) if t0 == t => y0,
            (Some((t0, y0)), Some((t1, y1))) => y0 + (y1 - y0) * ((t - t0) / (t1 - t0)),
            _ => f64::NAN,
        }
    };
    wanted.iter().map(at).collect()
}
