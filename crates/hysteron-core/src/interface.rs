//! The state as the staircase on the plane, as in Fig. 6 of the chapter.

use crate::branch::Turn;
use crate::error::Error;
use crate::memory::Memory;
use crate::operator::mkp;
use crate::plane::Plane;
use crate::scalar::Real;
use crate::state::State;

/// Which of the three sets of the plane an operator belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Region {
    /// `S_min`: the operator is fully off.
    Min,
    /// `S_bon`: the operator lies on the boundary, in an intermediate state.
    Boundary,
    /// `S_max`: the operator is fully on.
    Max,
}

impl<T: Real, S: Memory<Turn<T>>> State<T, S> {
    /// The state `γ_ij` in `[0, 1]` of operator `(i, j)`, `1 ≤ i ≤ j ≤ K`.
    ///
    /// Applies equation (5) to each turning point: `O(n)` for `n` of them.
    ///
    /// # Errors
    /// [`Error::Operator`] for indices out of range.
    pub fn gamma(&self, i: usize, j: usize) -> Result<T, Error> {
        if i < 1 || i > j || j > self.levels() {
            return Err(Error::Operator { i, j });
        }
        Ok(self
            .turning_points()
            .fold(T::ZERO, |gamma, x| mkp(gamma, x, i, j)))
    }

    /// The set that operator `(i, j)` is in.
    ///
    /// # Errors
    /// As [`State::gamma`].
    pub fn region(&self, i: usize, j: usize) -> Result<Region, Error> {
        let gamma = self.gamma(i, j)?;
        Ok(if gamma <= T::ZERO {
            Region::Min
        } else if gamma >= T::ONE {
            Region::Max
        } else {
            Region::Boundary
        })
    }

    /// The staircase between the operators that are on and those that are off.
    ///
    /// Gives its vertices `(α, β)` in the input's unit, from the left edge of the plane to the
    /// diagonal.
    pub fn staircase<'a>(&'a self, plane: &'a Plane<T>) -> impl Iterator<Item = (T, T)> + 'a {
        let mut vertex = (T::ZERO, T::ZERO);
        let last = self.turning_points().count() - 1;
        self.turning_points()
            .enumerate()
            .flat_map(move |(n, x)| {
                // A maximum is a height β of the staircase, a minimum a position α along it.
                if n % 2 == 0 {
                    vertex.1 = x;
                } else {
                    vertex.0 = x;
                }
                let end = (n == last).then_some((x, x));
                [Some(vertex), end]
            })
            .flatten()
            .map(|(alpha, beta)| (plane.denormalise(alpha), plane.denormalise(beta)))
    }
}
