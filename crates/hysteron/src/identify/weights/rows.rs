//! The rows of `W`, sample by sample. A row has the factors of the turning points before the
//! current branch, which are constant along it, and three factors of the branch itself.

use crate::error::Result;
use crate::identify::initial::Initial;
use crate::model::OperatorState;
use hysteron_core::Model;

/// A non-zero element of `W`: its column and its value.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Term {
    pub(crate) place: u32,
    pub(crate) factor: f64,
}

impl Term {
    /// Marks an Everett corner that is always zero and so has no column.
    pub(crate) const NOWHERE: u32 = u32::MAX;
}

/// Steps through an input and gives the row of the current sample.
pub(crate) struct Rows<'a> {
    blank: &'a Model<f64, Vec<f64>>,
    place: &'a [u32],
    state: OperatorState,
    /// Number of turning points that `memory` was computed from.
    held: usize,
    memory: Vec<Term>,
}

impl<'a> Rows<'a> {
    pub(crate) fn new(
        blank: &'a Model<f64, Vec<f64>>,
        place: &'a [u32],
        from: Initial,
    ) -> Result<Self> {
        let state = from.state(blank)?;
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

    /// Moves to the next sample. Returns true if this sample is on another branch. Then
    /// [`Rows::memory`] still belongs to the branch before, and [`Rows::remember`] must follow.
    #[inline]
    pub(crate) fn leaves_branch(&mut self, input: f64) -> Result<bool> {
        self.blank.step(&mut self.state, input)?;
        Ok(self.state.held() != self.held)
    }

    /// Computes [`Rows::memory`] for the current branch.
    pub(crate) fn remember(&mut self) {
        self.held = self.state.held();
        memory_terms(&self.state, self.place, &mut self.memory);
    }

    pub(crate) fn state(&self) -> &OperatorState {
        &self.state
    }

    /// The factors of the turning points before the branch. A column may occur more than once.
    pub(crate) fn memory(&self) -> &[Term] {
        &self.memory
    }

    /// The factors of the branch itself, at the current sample.
    #[inline]
    pub(crate) fn branch(&self) -> [Term; 3] {
        branch_terms(&self.state, self.place)
    }

    /// Adds the factors of the turning points, times `sum`, to `sums`.
    pub(crate) fn add_memory(&self, sum: f64, sums: &mut [f64]) {
        for term in &self.memory {
            sums[term.place as usize] += term.factor * sum;
        }
    }
}

/// Writes the factors of the turning points before the branch that `state` is on to `memory`.
pub(crate) fn memory_terms(state: &OperatorState, place: &[u32], memory: &mut Vec<Term>) {
    memory.clear();
    state.memory_terms(|index, factor| {
        let place = place[index];
        if place != Term::NOWHERE && factor != 0.0 {
            memory.push(Term { place, factor });
        }
    });
}

/// The factors of the branch that `state` is on.
#[inline]
pub(crate) fn branch_terms(state: &OperatorState, place: &[u32]) -> [Term; 3] {
    state
        .branch_terms()
        .map(|(index, factor)| match place[index] {
            // Any column will do, because the factor is zero.
            Term::NOWHERE => Term {
                place: 0,
                factor: 0.0,
            },
            place => Term { place, factor },
        })
}
