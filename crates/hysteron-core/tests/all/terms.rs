//! The terms of a state over the Everett table, for identification.

use crate::common::{build, inputs, levels, plane, rng, weights};
use hysteron_core::Operator;

#[test]
fn their_sum_is_the_output() {
    for seed in 0..100 {
        let mut rng = rng(600 + seed);
        let k = levels(&mut rng, 60);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let (model, mut state) = build(plane, Operator::Mkp, &weights);
        let scale: f64 = weights.iter().sum();
        for input in inputs(&mut rng, &plane, 400) {
            let output = model.step(&mut state, input).unwrap().output;
            let mut sum = 0.0;
            state.everett_terms(|index, factor| sum += factor * model.table()[index]);
            // The bound of the fast model against the definition.
            assert!((sum - output).abs() <= 1e-12 * scale, "seed {seed}");
        }
    }
}
