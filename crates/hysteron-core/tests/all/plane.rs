//! The numbers of a plane.

use crate::common::{levels, plane, rng};

#[test]
fn step_and_steps_per_unit_are_reciprocal() {
    for seed in 0..1000 {
        let mut rng = rng(80_000 + seed);
        let k = levels(&mut rng, 1000);
        let plane = plane(&mut rng, k);
        assert!((plane.per_unit() * plane.step() - 1.0).abs() <= 4.0 * f64::EPSILON);
        // Rounded so that the ends of the range are reached.
        assert!((plane.max() - plane.min()) * plane.per_unit() >= (k - 1) as f64);
        assert_eq!(plane.normalise(plane.max()), k as f64);
    }
}
