//! The fast forward model against the definition, sample by sample.

use crate::given::{Input, Setup};
use arbitrary::Arbitrary;
use hysteron_core::{Definition, Error};

#[derive(Arbitrary, Debug)]
pub struct Walk {
    setup: Setup,
    inputs: Vec<Input>,
}

impl Walk {
    pub fn check(&self) {
        let Some(plane) = self.setup.plane() else {
            return;
        };
        let weights = self.setup.weights(plane.levels());
        let Some((model, mut state)) = self.setup.build(&weights) else {
            return;
        };
        let mut states = vec![0.0; weights.len()];
        let plain = Definition::new(plane, self.setup.operator(), &weights, &mut states);
        let mut plain = plain.expect("what makes a model makes a definition");
        // As in the core's tests; the second term is for weights so small that products with them
        // are subnormal.
        let size: f64 = weights.iter().map(|mu| mu.abs()).sum();
        let rounding = 1e-12 * size + f64::MIN_POSITIVE;
        for input in &self.inputs {
            let input = input.on(&plane);
            let before = state.clone();
            match (model.step(&mut state, input), plain.step(input)) {
                (Ok(fast), Ok(plain)) => {
                    let off = (fast.output - plain).abs();
                    assert!(off <= rounding, "{off:e} of {size:e} at {input:e}");
                    assert!(state.corners() <= 2 * plane.levels());
                }
                (fast, plain) => {
                    assert!(!input.is_finite(), "{input:e}");
                    assert_eq!(fast.err(), Some(Error::InputNotFinite { index: 0 }));
                    assert!(plain.is_err());
                    assert_eq!(state, before);
                }
            }
        }
    }
}
