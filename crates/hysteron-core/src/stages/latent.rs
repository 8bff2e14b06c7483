//! Heat that is bound: the operators take it while they switch on, and give it back.

use crate::branch::Turn;
use crate::everett::Split;
use crate::memory::Memory;
use crate::model::Model;
use crate::scalar::Real;
use crate::search::Branch;
use crate::stages::axis::Axis;
use crate::stages::constant::{Constant, Constants, Declared, Range, Unit, one};
use crate::stages::loaded::Loaded;
use crate::state::State;
use crate::target::Direction;

/// Heat that is bound to the share `h = Σ μ γ / Σ μ` of the operators' sum. A body that would come
/// to the temperature `T*` comes to the `T` with
///
/// ```text
/// T + λ (h(T) − h_before) = T*
/// ```
///
/// so `λ` is how much warmer the body would be if a transformation from one end to the other bound
/// nothing. The left side rises with `T` at least as fast as `T` does: there is one solution, and
/// heat is neither lost nor made, however long the step and however steep the operators are. At the
/// first sample nothing is bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Latent<T> {
    /// `λ`, in degrees; 0 for none.
    pub heat: T,
}

impl<T: Real> Latent<T> {
    /// No heat is bound.
    pub const NONE: Self = Latent { heat: T::ZERO };

    /// The temperature of a body that would come to `unbound` if nothing were bound.
    ///
    /// Between neighbouring turning points, grid lines and knots of the registration the left side
    /// is straight over the position. So a bisection of each finds the piece, and a line the
    /// solution: `O(log K)` values of the Everett function.
    pub(super) fn bound<C, S>(
        self,
        model: &Model<T, C>,
        state: &State<T, S>,
        (axis, loaded): (&Axis<'_, T>, Loaded<T>),
        unbound: T,
    ) -> T
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let (plane, here, total) = (model.plane(), state.branch_position(), model.total());
        if self.heat == T::ZERO || total == T::ZERO {
            return unbound;
        }
        let to = plane.normalise(axis.seen(plane, loaded, state.input(), unbound));
        if to == here.x {
            return unbound;
        }
        let rising = to > here.x;
        let direction = match rising {
            true => Direction::Rising,
            false => Direction::Falling,
        };
        let taken = |y: T| self.heat * ((y - here.y) / total);
        let degrees = |x| axis.backward(plane, loaded, direction, plane.denormalise(x));
        let left = |x, y| degrees(x) + taken(y);
        let branch = Branch::find(state, usize::from(!rising), |turn| {
            (left(turn.x, turn.y) >= unbound) == rising
        });
        let grid = model.grid();
        let sum = |x| branch.began.along(grid, x);
        let above = |x| left(x, sum(x)) >= unbound;
        let top = T::from_index(plane.levels());
        let end = branch.end.min(top);
        if above(end) != rising {
            // Beyond the plane nothing more is bound.
            return unbound - taken(sum(end));
        }
        let mut piece = match rising {
            true => (branch.start, end),
            false => (end, branch.start),
        };
        narrow(&mut piece, plane.levels() + 1, T::from_index, above);
        // The two triangles of a cell meet where both positions have the same part.
        let middle = Split::new(T::HALF * piece.0 + T::HALF * piece.1, grid.levels).cell;
        let part = Split::new(branch.began.x, grid.levels).part;
        narrow(&mut piece, 1, |_| T::from_index(middle) + part, above);
        let knots = axis.registration.knots;
        let knot = |m: usize| plane.normalise(axis.placed(plane, knots[m]));
        narrow(&mut piece, knots.len(), knot, above);
        let (near, far) = piece;
        let (from, to) = (degrees(near), degrees(far));
        let (low, high) = (left(near, sum(near)), left(far, sum(far)));
        match high > low {
            true => (from + (unbound - low) * ((to - from) / (high - low))).clamp(from, to),
            false => from,
        }
    }

    /// The temperature that a body would have if nothing were bound on the way to `temperature`: the
    /// inverse of [`Latent::bound`].
    pub(super) fn unbound<C, S>(
        self,
        model: &Model<T, C>,
        state: &State<T, S>,
        (axis, loaded): (&Axis<'_, T>, Loaded<T>),
        temperature: T,
    ) -> T
    where
        C: AsRef<[T]>,
        S: Memory<Turn<T>>,
    {
        let (plane, here, total) = (model.plane(), state.branch_position(), model.total());
        if self.heat == T::ZERO || total == T::ZERO {
            return temperature;
        }
        let to = plane.normalise(axis.seen(plane, loaded, state.input(), temperature));
        if to == here.x {
            return temperature;
        }
        let branch = match to > here.x {
            true => Branch::find(state, 0, |maximum| maximum.x >= to),
            false => Branch::find(state, 1, |minimum| minimum.x <= to),
        };
        let sum = branch.began.along(model.grid(), to);
        temperature + self.heat * ((sum - here.y) / total)
    }
}

/// Makes the `piece` as short as the ascending places in it allow, so that what is `above` is still
/// at its end and not at its start.
fn narrow<T: Real>(
    piece: &mut (T, T),
    count: usize,
    place: impl Fn(usize) -> T,
    above: impl Fn(T) -> bool,
) {
    let (mut low, mut high) = (0, count);
    while low < high {
        let middle = low + (high - low) / 2;
        let x = place(middle);
        let is_inside = piece.0 < x && x < piece.1;
        if x >= piece.1 || is_inside && above(x) {
            high = middle;
            piece.1 = piece.1.min(x);
        } else {
            low = middle + 1;
            piece.0 = piece.0.max(x);
        }
    }
}

impl<'a, T: Real> Constants<'a, T> for Latent<T> {
    const DECLARED: &'static [Declared] = &[Declared {
        name: "latent",
        about: "the heat that the operators bind while they switch on",
        constants: &[Constant {
            name: "latent",
            unit: Unit::Temperature,
            range: Range::Amount,
            meaning: "how much warmer the body would be if a whole stroke bound no heat",
        }],
    }];

    fn lists(&self) -> impl Iterator<Item = &[T]> {
        let list = match self.heat == T::ZERO {
            true => &[][..],
            false => core::slice::from_ref(&self.heat),
        };
        core::iter::once(list)
    }

    fn of_lists(mut next: impl FnMut() -> &'a [T]) -> Option<Self> {
        let heat = one(next())?.unwrap_or(T::ZERO);
        Some(Self { heat })
    }

    fn fits(&self) -> Result<(), &'static str> {
        Ok(())
    }
}
