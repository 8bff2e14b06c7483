//! Where the operators begin in recordings that are learned from.

use crate::error::Result;
use crate::evaluate::OTHER_START;
use crate::identify::find_rest;
use crate::model::{Model, Start, Surroundings};
use crate::recording::{Recording, no_recordings};

/// Where the operators begin, and the fixed model from there.
pub(super) struct Begun {
    /// The model, which knows that start.
    pub(super) model: Model,
    /// Its start, of that model.
    pub(super) start: Start,
    /// The start that was taken.
    pub(super) taken: Start,
    /// The outputs of the model.
    pub(super) output: Vec<f64>,
    /// Their squared error.
    squares: f64,
}

impl Begun {
    /// The start that is `asked` for. An unknown one is that of the fit, or the one of the `others`
    /// that leaves the fixed model the least errors, if these are much less ([`OTHER_START`]).
    ///
    /// # Errors
    /// [`crate::Error::Fit`] for no recordings, and as [`Model::run_in`].
    pub(super) fn new(
        model: &Model,
        recordings: &[Recording],
        asked: Start,
        others: &[Start],
    ) -> Result<Self> {
        if asked != Start::Unknown {
            return Self::at(model, recordings, asked);
        }
        let mut best = Self::at(model, recordings, Start::Fitted)?;
        let mut enough = best.squares / OTHER_START.powi(2);
        for start in others {
            let other = Self::at(model, recordings, *start)?;
            if other.squares < enough {
                (enough, best) = (other.squares, other);
            }
        }
        Ok(best)
    }

    fn at(model: &Model, recordings: &[Recording], taken: Start) -> Result<Self> {
        let (model, start) = match taken {
            // One rest stands for all recordings, as one start does in a model.
            Start::Rest => {
                let first = recordings.first().ok_or_else(no_recordings)?;
                let (rested, _) = find_rest(model, first)?;
                (model.clone().starting_from(&rested)?, Start::Fitted)
            }
            Start::Fitted if model.fitted().is_none() => (model.clone(), Start::Off),
            start => (model.clone(), start),
        };
        let output = run_from(&model, start, recordings)?;
        let measured = recordings.iter().flat_map(|r| &r.output);
        Ok(Self {
            squares: measured.zip(&output).map(|(y, h)| (y - h).powi(2)).sum(),
            model,
            start,
            taken,
            output,
        })
    }
}

/// The outputs of a model that starts so in each recording.
pub(super) fn run_from(model: &Model, start: Start, recordings: &[Recording]) -> Result<Vec<f64>> {
    let mut all = Vec::new();
    for recording in recordings {
        let mut state = model.state_at(start);
        let (begin, around) = (all.len(), Surroundings::from_recording(model, recording));
        all.resize(begin + recording.len(), 0.0);
        model.run_in(&mut state, &recording.input, around, &mut all[begin..])?;
    }
    Ok(all)
}
