//! The only place that touches the model: what the figures need of it, in their terms.

use hysteron::Model;
use hysteron::Quantity;

/// A model's plane, weights and operator states on the half `α ≤ β`.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    model: &'a Model,
}

impl<'a> Source<'a> {
    pub(crate) fn new(model: &'a Model) -> Self {
        Self { model }
    }

    /// `T_min`.
    pub(crate) fn min(self) -> f64 {
        self.model.plane().min()
    }

    /// `T_max`.
    pub(crate) fn max(self) -> f64 {
        self.model.plane().max()
    }

    /// `K`.
    pub(crate) fn levels(self) -> usize {
        self.model.plane().levels()
    }

    /// `ΔT`; with a single level, whatever keeps a picture of the plane from collapsing.
    pub(crate) fn step(self) -> f64 {
        let step = self.model.plane().step();
        if step.is_finite() && step > 0.0 {
            step
        } else {
            1.0
        }
    }

    /// `T_min + (k − 1) ΔT`.
    pub(crate) fn level(self, k: usize) -> f64 {
        self.min() + (k as f64 - 1.0) * self.step()
    }

    /// All weights, row by row: `j = 1…K`, within a row `i = 1…j`.
    pub(crate) fn weights(self) -> &'a [f64] {
        self.model.weights()
    }

    /// The states `γ` after the inputs `history` from all-off, in the order of the weights.
    pub(crate) fn states(self, history: &[f64]) -> Vec<f64> {
        // Inputs that are not finite never come this far; were one to, the plane is drawn all off.
        let off = || vec![0.0; self.weights().len()];
        self.model
            .operator_states(history)
            .unwrap_or_else(|_| off())
    }

    /// What the model's input is.
    pub(crate) fn input(self) -> &'a Quantity {
        &self.model.input
    }

    /// What the model's output is.
    pub(crate) fn output(self) -> &'a Quantity {
        &self.model.output
    }

    /// How many weights differ from zero, beyond rounding.
    pub(crate) fn weights_not_zero(self) -> usize {
        let zero = self.zero();
        self.weights().iter().filter(|μ| μ.abs() > zero).count()
    }

    /// The magnitude below which a weight counts as zero: rounding of a solver, not a contribution.
    pub(crate) fn zero(self) -> f64 {
        1e-9 * self
            .weights()
            .iter()
            .fold(0.0, |largest: f64, μ| largest.max(μ.abs()))
    }
}
