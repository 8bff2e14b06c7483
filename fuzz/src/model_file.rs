//! Model files: read or refused with words; what is read is written and read again without a
//! change, and runs.

use crate::worded;
use hysteron::{Model, Sample, Target, Wanted};

pub fn read(text: &str) {
    match Model::from_json(text) {
        Ok(model) => runs(&model),
        Err(error) => worded(&error),
    }
}

fn runs(model: &Model) {
    let text = model.to_json();
    let again = Model::from_json(&text).expect("a model that was written can be read");
    assert_eq!(again.to_json(), text);
    let plane = model.plane();
    let mut state = model.start();
    let dt = Some(1.0);
    let load = model.load.as_ref().map(|load| load.range().0);
    for input in [
        plane.max(),
        plane.min(),
        0.5 * plane.min() + 0.5 * plane.max(),
    ] {
        let sample = Sample { input, dt, load };
        let output = model
            .step(&mut state, sample)
            .expect("a finite input")
            .output;
        assert!(output.is_finite(), "{output} at {input}");
    }
    if let Ok(inverse) = model.inverse() {
        let (low, high) = model.output_range();
        let wanted = Wanted {
            dt,
            load,
            ..Target::new(0.5 * low + 0.5 * high).into()
        };
        let solution = inverse.step(&mut state, wanted);
        assert!(solution.expect("a finite target").input.is_finite());
    }
}
