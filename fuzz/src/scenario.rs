//! Scenarios: read or refused with words; one that is read has references of a size that can be.

use crate::worded;
use hysteron_sim::track::Scenario;
use std::path::Path;

pub fn read(text: &str) {
    // Files that it names are not there.
    match Scenario::parse(text, Path::new("/nonexistent")) {
        Ok(scenario) => assert!(scenario.references().iter().all(|y| y.is_finite())),
        Err(error) => worded(&error),
    }
}
