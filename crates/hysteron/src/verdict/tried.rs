//! What a fit looked for or has, so that it is no advice any more.

use crate::identify::AFTER;
use crate::model::{FitSummary, Model};
use crate::recording::Recording;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Tried {
    pub(super) creep: bool,
    pub(super) thermal: bool,
    pub(super) sensor_lag: bool,
}

impl Tried {
    pub(super) fn by(model: &Model, recordings: &[Recording]) -> Self {
        let looked_for = |fit: &FitSummary| fit.other.contains_key(AFTER);
        Self {
            creep: model.fit.as_ref().is_some_and(looked_for),
            thermal: model.thermal.is_some(),
            sensor_lag: recordings
                .iter()
                .any(|recording| recording.undone.is_some()),
        }
    }
}
