//! The state that a model starts from.

use crate::error::Result;
use crate::model::operators::FittedStart;
use crate::model::{Model, Start, State};

impl Model {
    /// The state that the model starts from: the one that its fit kept, or else every operator off.
    /// The stages are at rest with the first input.
    #[must_use]
    pub fn start(&self) -> State {
        self.fitted().unwrap_or_else(|| self.off())
    }

    /// The state that the fit kept for before the first sample; `None` for every operator off.
    #[must_use]
    pub fn fitted(&self) -> Option<State> {
        let start = self.start.as_ref()?;
        let operators = self.operators().restore(&start.turning_points, start.input);
        Some(State::new(self, operators.ok()?))
    }

    /// A state with every operator off.
    #[must_use]
    pub fn off(&self) -> State {
        State::new(self, self.operators().start())
    }

    /// A state with every operator on, at the top of the plane.
    #[must_use]
    pub fn saturated(&self) -> State {
        State::new(self, self.operators().saturated())
    }

    /// The state in which a recording begins that starts so: off where `start` has to be found.
    pub(crate) fn state_at(&self, start: Start) -> State {
        match start {
            Start::Fitted => self.start(),
            Start::On => self.saturated(),
            Start::Off | Start::Rest | Start::Unknown => self.off(),
        }
    }

    /// The model `changed` from this one, with the start of a recording that this one began so.
    pub(crate) fn starts(&self, changed: Self, start: Start) -> Result<Self> {
        match start {
            Start::Off => changed.with_start(None),
            Start::Fitted => changed.with_start(self.start.clone()),
            _ => changed.starting_from(&self.state_at(start)),
        }
    }

    /// The same model, which starts from the turning points of `state`.
    pub(crate) fn starting_from(self, state: &State) -> Result<Self> {
        let start = FittedStart {
            turning_points: state.turning_points().collect(),
            input: state.input(),
        };
        self.with_start(Some(start))
    }

    /// The same model, which starts where `start` says.
    ///
    /// # Errors
    /// [`crate::Error::Core`] for turning points that are not nested.
    pub fn with_start(mut self, start: Option<FittedStart>) -> Result<Self> {
        if let Some(start) = &start {
            self.operators()
                .restore(&start.turning_points, start.input)?;
        }
        self.start = start;
        Ok(self)
    }
}
