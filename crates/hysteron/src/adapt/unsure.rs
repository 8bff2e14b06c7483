//! Whether it still matters how the operators began, which nobody has told.

use super::refit::Core;
use super::window::TURN;
use crate::error::Result;
use crate::model::OperatorState;
use crate::series::Turning;

/// The other way to begin matters where it makes a difference of this share of the range. The first
/// full stroke ends that.
const MATTERS: f64 = 0.05;

/// After so many turning points, of which the first sample is one, it is taken as known: a loop
/// inside the plane never tells.
const TURNS: usize = 4;

/// The operators as they were if they had begun all on, beside those that began all off.
#[derive(Debug, Clone)]
pub(super) struct Unsure {
    on: OperatorState,
    turning: Turning,
    turns: usize,
}

impl Unsure {
    /// Before the first sample. `on` is the state with all operators on, of a plane of so many
    /// levels.
    pub(super) fn new(on: OperatorState, levels: usize) -> Self {
        Self {
            on,
            turning: Turning::new(TURN * levels as f64),
            turns: 0,
        }
    }

    /// Goes on to where `state` of `core` is, from the usual start. Returns whether it still matters.
    ///
    /// # Errors
    /// As [`crate::Model::step`].
    pub(super) fn step(&mut self, core: &Core, state: &OperatorState) -> Result<bool> {
        core.rebase(&mut self.on)?;
        let other = core.step(&mut self.on, state.input())?.output;
        self.turns += usize::from(self.turning.push(self.on.position()).is_some());
        let (low, high) = core.output_range();
        let difference = (other - core.output(state)).abs();
        Ok(difference > MATTERS * (high - low) && self.turns < TURNS)
    }
}
