//! The axis of the operators: the load shifts and scales it, the spacing places the levels on it.

use crate::error::Error;
use crate::plane::Plane;
use crate::scalar::Real;

/// From the temperature `T` (or voltage, or current) to the input `x` of the operators:
/// `x = W(a(σ) · T − s(σ))`.
///
/// `s` is the shift by the load `σ` and `a` the scale. Both are piecewise linear between the loads
/// `loads`. Under stress a shape-memory alloy transforms at a higher temperature (Clausius and
/// Clapeyron), so `s` rises with the load.
///
/// `W` is piecewise linear. It takes corner `k` of `spacing` to level `k` of the plane, for
/// `k = 0…K` (level 0 is the bottom of the plane). Levels are then close together where the output
/// moves.
///
/// ```
/// use hysteron_core::{Axis, Plane};
/// let plane = Plane::new(1.0, 2.0, 2)?; // its bottom is 0
/// let axis = Axis {
///     loads: &[0.0, 100.0],
///     shifts: &[0.0, 10.0],
///     spacing: &[20.0, 28.0, 30.0],
///     ..Axis::PLAIN
/// };
/// let placed = axis.at(Some(50.0))?;
/// assert_eq!(axis.forward(&plane, placed, 33.0), 1.0);
/// assert_eq!(axis.backward(&plane, placed, 1.0), 33.0);
/// # Ok::<(), hysteron_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis<'a, T> {
    /// The loads at which shift and scale are known, ascending; empty without a load.
    pub loads: &'a [T],
    /// The shift at each of these loads, in the unit of the temperature.
    pub shifts: &'a [T],
    /// The scale at each of these loads, above zero; empty for a scale of 1.
    pub scales: &'a [T],
    /// The `K + 1` corners of the grid, ascending; empty for equal spacing.
    pub spacing: &'a [T],
}

/// Shift and scale at one load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed<T> {
    /// The scale `a(σ)`.
    pub scale: T,
    /// The shift `s(σ)`.
    pub shift: T,
}

impl<T: Real> Axis<'_, T> {
    /// No load and equal spacing: `x = T`.
    pub const PLAIN: Self = Axis {
        loads: &[],
        shifts: &[],
        scales: &[],
        spacing: &[],
    };

    /// Shift and scale at a load. Beyond the outermost loads they are those of the nearest one.
    ///
    /// # Errors
    /// [`Error::Load`] where a load is needed and `load` is `None` or not finite.
    pub fn at(&self, load: Option<T>) -> Result<Placed<T>, Error> {
        if self.loads.is_empty() {
            return Ok(Placed {
                scale: T::ONE,
                shift: T::ZERO,
            });
        }
        let load = load.filter(|load| load.is_finite()).ok_or(Error::Load)?;
        let ends = [self.loads[0], self.loads[self.loads.len() - 1]];
        let load = load.clamp(ends[0], ends[1]);
        let scale = match self.scales {
            [] => T::ONE,
            scales => between(self.loads, |k| scales[k], load),
        };
        Ok(Placed {
            scale,
            shift: between(self.loads, |k| self.shifts[k], load),
        })
    }

    /// The input of the operators at a `temperature`.
    #[must_use]
    pub fn forward(&self, plane: &Plane<T>, placed: Placed<T>, temperature: T) -> T {
        let effective = placed.scale * temperature - placed.shift;
        match self.spacing {
            [] => effective,
            corners => between(corners, |k| plane.level(k), effective),
        }
    }

    /// The temperature at an input of the operators. The inverse of [`Axis::forward`].
    #[must_use]
    pub fn backward(&self, plane: &Plane<T>, placed: Placed<T>, input: T) -> T {
        let effective = match self.spacing {
            [] => input,
            corners => inverse_between(corners, plane, input),
        };
        (effective + placed.shift) / placed.scale
    }

    /// How far `x` may be from the exact one by rounding, on the way there and back.
    pub(crate) fn rounding(&self, plane: &Plane<T>, placed: Placed<T>, temperature: T) -> T {
        let magnitude = |v: T| v.max(-v);
        let effective = magnitude(placed.scale * temperature) + magnitude(placed.shift);
        let widest = |steepest: T, pair: &[T]| steepest.max(plane.step() / (pair[1] - pair[0]));
        let slope = match self.spacing {
            [] => T::ONE,
            corners => corners.windows(2).fold(T::ZERO, widest),
        };
        let ends = magnitude(plane.max()) + magnitude(plane.bottom());
        T::from_index(8) * T::EPSILON * (effective * slope + ends)
    }

    /// Checks lengths, order and finiteness.
    pub(crate) fn check(&self, plane: &Plane<T>) -> Result<(), Error> {
        let fault = |stage| Err(Error::Stage { stage });
        let finite = |values: &[T]| values.iter().all(|v| v.is_finite());
        let ascending = |values: &[T]| values.windows(2).all(|pair| pair[0] < pair[1]);
        if !(finite(self.loads) && ascending(self.loads)) {
            return fault("loads");
        }
        if self.shifts.len() != self.loads.len() || !finite(self.shifts) {
            return fault("shifts");
        }
        let positive = |scales: &[T]| finite(scales) && scales.iter().all(|a| *a > T::ZERO);
        if !(self.scales.is_empty() || self.scales.len() == self.loads.len())
            || !positive(self.scales)
        {
            return fault("scales");
        }
        // Corners that are several rounding units apart have finite slopes.
        let apart = |pair: &[T]| {
            let size = pair[0].max(-pair[0]).max(pair[1].max(-pair[1]));
            pair[1] - pair[0] > size * T::EPSILON * T::from_index(4)
        };
        let placed = self.spacing.len() == plane.levels() + 1
            && finite(self.spacing)
            && self.spacing.windows(2).all(apart);
        match self.spacing.is_empty() || placed {
            true => Ok(()),
            false => fault("spacing"),
        }
    }
}

/// The piecewise linear function with the values `y(k)` at `xs[k]`. Beyond the ends it goes on
/// with the slope of the outermost piece. At a knot it is exact.
fn between<T: Real>(xs: &[T], y: impl Fn(usize) -> T, x: T) -> T {
    let last = xs.len() - 1;
    if last == 0 {
        return y(0);
    }
    let above = xs.partition_point(|knot| *knot <= x);
    let k = above.clamp(1, last) - 1;
    if x == xs[k + 1] {
        return y(k + 1);
    }
    let slope = (y(k + 1) - y(k)) / (xs[k + 1] - xs[k]);
    y(k) + (x - xs[k]) * slope
}

/// The inverse of [`between`] for `y(k)` the levels of the plane.
fn inverse_between<T: Real>(xs: &[T], plane: &Plane<T>, y: T) -> T {
    let last = xs.len() - 1;
    let (mut k, mut end) = (0, last - 1);
    while k < end {
        let middle = k + (end - k).div_ceil(2);
        match plane.level(middle) <= y {
            true => k = middle,
            false => end = middle - 1,
        }
    }
    let (from, to) = (plane.level(k), plane.level(k + 1));
    if y == to {
        return xs[k + 1];
    }
    xs[k] + (y - from) * ((xs[k + 1] - xs[k]) / (to - from))
}
