//! The rows of `W`, sample by sample: the factors of the turning points before the branch, which
//! stay the same along it, and the three of the branch itself.

use crate::error::Result;
use crate::identify::weights::sparse::Initial;
use crate::model::OperatorState;
use hysteron_core::{Model, Turn, turn_capacity};

/// A non-zero element of `W`: its column and its value.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Term {
    pub(crate) place: u32,
    pub(crate) factor: f64,
}

impl Term {
    /// The place of an Everett corner that is always zero.
    pub(crate) const NOWHERE: u32 = u32::MAX;
}

/// Walks an input and knows the row of the present sample.
pub(crate) struct Rows<'a> {
    blank: &'a Model<f64, Vec<f64>>,
    place: &'a [u32],
    state: OperatorState,
    /// Turning points that `memory` was made of.
    held: usize,
    memory: Vec<Term>,
}

impl<'a> Rows<'a> {
    pub(crate) fn new(
        blank: &'a Model<f64, Vec<f64>>,
        place: &'a [u32],
        from: Initial,
    ) -> Result<Self> {
        let state = state_of(blank, from)?;
        let mut rows = Self {
            blank,
            place,
            state,
            held: 0,
            memory: Vec::new(),
        };
        rows.remember();
        Ok(rows)
    }

    /// Moves to the next sample; says whether that is on another branch, so that [`Rows::memory`],
    /// still that of the branch before, has to be made anew.
    #[inline]
    pub(crate) fn leaves_branch(&mut self, input: f64) -> Result<bool> {
        self.blank.step(&mut self.state, input)?;
        Ok(self.state.held() != self.held)
    }

    /// Makes [`Rows::memory`] that of the present branch.
    pub(crate) fn remember(&mut self) {
        self.held = self.state.held();
        self.memory.clear();
        self.state.memory_terms(|index, factor| {
            let place = self.place[index];
            if place != Term::NOWHERE && factor != 0.0 {
                self.memory.push(Term { place, factor });
            }
        });
    }

    pub(crate) fn state(&self) -> &OperatorState {
        &self.state
    }

    /// The factors of the turning points before the branch. A place may come more than once.
    pub(crate) fn memory(&self) -> &[Term] {
        &self.memory
    }

    /// The factors of the branch itself, at the present sample.
    #[inline]
    pub(crate) fn branch(&self) -> [Term; 3] {
        self.state.branch_terms().map(|(index, factor)| {
            match self.place[index] {
                // Zero times anything.
                Term::NOWHERE => Term {
                    place: 0,
                    factor: 0.0,
                },
                place => Term { place, factor },
            }
        })
    }

    /// Adds the factors of the turning points, `sum` times, to `sums`.
    pub(crate) fn add_memory(&self, sum: f64, sums: &mut [f64]) {
        for term in &self.memory {
            sums[term.place as usize] += term.factor * sum;
        }
    }
}

/// The state of a model before the first sample.
pub(crate) fn state_of(model: &Model<f64, Vec<f64>>, from: Initial) -> Result<OperatorState> {
    let memory = vec![Turn::default(); turn_capacity(model.plane().levels())];
    let mut state = model.state(memory)?;
    if from == Initial::On {
        model.reset_on(&mut state)?;
    }
    Ok(state)
}
