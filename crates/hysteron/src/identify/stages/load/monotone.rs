//! The nearest monotone values.

/// The nearest monotone values: neighbours in the wrong order take their mean (pool adjacent
/// violators, Barlow et al. 1972).
pub(super) fn make_monotone(values: &mut [f64], falls: bool) {
    let sign = if falls { -1.0 } else { 1.0 };
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for value in values.iter() {
        let mut pool = (sign * value, 1);
        while let Some(&(mean, count)) = pools.last().filter(|(mean, _)| *mean > pool.0) {
            let total = count + pool.1;
            pool = (
                (mean * count as f64 + pool.0 * pool.1 as f64) / total as f64,
                total,
            );
            pools.pop();
        }
        pools.push(pool);
    }
    let all = pools
        .into_iter()
        .flat_map(|(mean, count)| vec![sign * mean; count]);
    values
        .iter_mut()
        .zip(all)
        .for_each(|(value, pooled)| *value = pooled);
}
