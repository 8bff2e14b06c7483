//! The model as the chapter defines it, equation (2): every operator at every sample, `O(K²)`.
//!
//! It is plain on purpose: the tests compare the fast model with it.

use crate::error::Error;
use crate::operator::Operator;
use crate::operator::{mkp, relay};
use crate::plane::Plane;
use crate::plane::{operator_count, operator_index};
use crate::scalar::Real;

/// The model by its definition, over weights and operator states of the caller.
///
/// ```
/// use hysteron_core::{Definition, Operator, Plane};
/// let plane = Plane::new(0.0, 1.0, 2)?;
/// let mut states = [0.0; 3];
/// let mut plain = Definition::new(plane, Operator::Mkp, &[1.0, 2.0, 4.0], &mut states)?;
/// assert_eq!(plain.step(1.0)?, 7.0);
/// assert_eq!(plain.step(0.0)?, 3.0); // operator (1, 2) remembers
/// # Ok::<(), hysteron_core::Error>(())
/// ```
#[derive(Debug)]
pub struct Definition<'a, T> {
    plane: Plane<T>,
    operator: Operator,
    weights: &'a [T],
    states: &'a mut [T],
    previous: T,
}

impl<'a, T: Real> Definition<'a, T> {
    /// A model with all operators off.
    ///
    /// `weights` and `states` have exactly `K(K + 1)/2` elements each, row by row
    /// ([`operators`](crate::operators)).
    ///
    /// # Errors
    /// [`Error::WeightCount`] or [`Error::MemoryTooSmall`] for any other length.
    pub fn new(
        plane: Plane<T>,
        operator: Operator,
        weights: &'a [T],
        states: &'a mut [T],
    ) -> Result<Self, Error> {
        let expected = operator_count(plane.levels());
        if weights.len() != expected {
            return Err(Error::WeightCount {
                expected,
                found: weights.len(),
            });
        }
        if states.len() != expected {
            return Err(Error::MemoryTooSmall {
                needed: expected,
                found: states.len(),
            });
        }
        states.fill(T::ZERO);
        Ok(Self {
            plane,
            operator,
            weights,
            states,
            previous: plane.bottom(),
        })
    }

    /// Moves to `input` and returns the output `H = Σ μ_ij γ_ij`, with the operators' own outputs.
    ///
    /// # Errors
    /// [`Error::InputNotFinite`]; the states then stay as they are.
    pub fn step(&mut self, input: T) -> Result<T, Error> {
        if !input.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        let x = self.plane.normalise(input);
        let mut sum = T::ZERO;
        for j in 1..=self.plane.levels() {
            for i in 1..=j {
                let n = operator_index(i, j);
                let gamma = self.states[n];
                let gamma = match self.operator {
                    Operator::Mkp | Operator::Kp => mkp(gamma, x, i, j),
                    Operator::Relay => relay(gamma, self.previous, input, &self.plane, i, j),
                };
                self.states[n] = gamma;
                sum = sum + self.weights[n] * self.operator.output(gamma);
            }
        }
        self.previous = input;
        Ok(sum)
    }

    /// The states `γ_ij` in `[0, 1]`, in the order of the weights.
    #[must_use]
    pub fn states(&self) -> &[T] {
        self.states
    }
}
