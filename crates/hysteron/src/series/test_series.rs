//! Series for tests.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// White Gaussian noise of standard deviation 1.
pub(crate) fn gaussian(seed: u64, count: usize) -> Vec<f64> {
    StandardNormal
        .sample_iter(ChaCha8Rng::seed_from_u64(seed))
        .take(count)
        .collect()
}

/// A sine of amplitude 40.
pub(crate) fn swings() -> Vec<f64> {
    (0..2000)
        .map(|n| 40.0 * (f64::from(n) * 0.02).sin())
        .collect()
}
