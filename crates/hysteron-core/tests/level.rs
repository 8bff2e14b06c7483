//! The offset, which the method on increments learns apart from the weights.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Learner, OPERATORS, options, rng, unit_plane};
use hysteron_core::{Adaptation, Method, Outcome};
use rand::RngExt;

#[test]
fn a_level_that_learning_made_worse_is_taken_back_and_said() {
    for operator in OPERATORS {
        let mut rng = rng(70);
        // Increments are longer than the plane, so none ends and only the offset is learned. A gain
        // near 2 follows noise so closely that the mean square error is about ten times that of a
        // constant offset.
        let method = Method::Increments {
            gain: 1.9,
            span: 8.0,
        };
        let guards = Adaptation {
            offset_share: 10.0,
            trial: 50,
            ..options(method)
        };
        let mut learner = Learner::new(unit_plane(2), operator, &[1.0, 2.0, 4.0], guards);
        let (mut moved, mut taken_back) = (0, 0);
        for n in 0..1000 {
            let input = if n % 2 == 0 { 10.0 } else { 80.0 };
            let (model, mut there) = (&learner.model, learner.state.clone());
            let output = model.step(&mut there, input).unwrap().output;
            let noise = rng.random_range(-1.0..1.0);
            let learning = learner.step(input, output + noise).unwrap();
            if learning.outcome == Outcome::RolledBack {
                taken_back += 1;
                assert_eq!(learner.estimator.offset(), 0.0, "sample {n}");
            }
            moved += usize::from(learner.estimator.offset() != 0.0);
        }
        // Each trial ends with a roll-back. The first sample only starts the learning.
        assert_eq!(taken_back, (1000 - 1) / 50, "{operator:?}");
        assert!(moved > 900, "{moved}");
    }
}
