//! Refuses recordings with loads at which a model was not identified.

use crate::error::{Error, Result};
use crate::model::LoadDependence;
use crate::recording::Recording;
use crate::remedy::Remedy;

impl LoadDependence {
    /// Refuses a recording with loads outside the range, and tells how many and where.
    ///
    /// # Errors
    /// [`Error::Recording`] with the first such sample.
    pub(super) fn check(&self, recording: &Recording) -> Result<()> {
        let loads = recording.load.iter().flatten().enumerate();
        let mut outside = loads.filter(|(_, load)| !self.knows(**load));
        let Some((first, load)) = outside.next() else {
            return Ok(());
        };
        let (low, high) = self.range();
        let name = &self.quantity.name;
        let problem = format!(
            "{} of {} samples have a {name} outside the range {low} to {high} that the model was \
             identified at, the first is {}, with {load}",
            1 + outside.count(),
            recording.len(),
            recording.named(first)
        );
        let words = "leave these rows out, or fit a model to a recording that has such loads too; \
             if nearly all are outside, look at the unit of the load and at its column";
        let error = Error::Recording {
            path: recording.source.as_ref().map(|source| source.path.clone()),
            row: None,
            column: Some(recording.load_quantity.name.clone()),
            problem,
        };
        Err(error.remedied(Remedy::new(words, [])))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::model::{Model, Start};
    use crate::recording::Recording;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    #[test]
    fn loads_outside_are_counted_and_the_first_is_named() {
        let model = Model::from_json(
            r#"{"format": "hysteron-model", "version": 2, "operator": "mkp",
                "plane": {"min": 1, "max": 2, "levels": 2}, "weights": [1, 1, 1],
                "output": {"offset": 2}, "load": {"min": 0, "max": 9, "parts": [
                    {"offset": 0, "weights": [1, 0, 1]}, {"offset": 4, "weights": [1, 2, 1]}]}}"#,
        )
        .unwrap();
        for seed in 0..50 {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let most = f64::from(random.next_u32() % 12);
            let mut load = || most * f64::from(random.next_u32()) / f64::from(u32::MAX);
            let loads: Vec<f64> = (0..30).map(|_| load()).collect();
            let mut recording = Recording::new(vec![1.5; 30], vec![3.0; 30]).unwrap();
            recording.load = Some(loads.clone());
            let outside = loads.iter().filter(|load| **load > 9.09).count();
            let found = crate::forward(&model, &recording, Start::Fitted);
            let Some(first) = loads.iter().position(|load| *load > 9.09) else {
                assert!(found.is_ok(), "seed {seed}");
                continue;
            };
            let said = found.unwrap_err().to_string();
            let expected = format!(
                "{outside} of 30 samples have a load outside the range 0 to 9 that the model was \
                 identified at, the first is sample {}, with {}: leave these rows out",
                first + 1,
                loads[first]
            );
            assert!(said.contains(&expected), "seed {seed}: {said}");
        }
    }
}
