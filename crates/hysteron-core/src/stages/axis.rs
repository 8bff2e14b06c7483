//! Load, registration and spacing: what stands between the temperature and the operators' uniform
//! grid.

use crate::error::Error;
use crate::plane::Plane;
use crate::scalar::Real;
use crate::stages::constant::{Constant, Constants, Declared, Range, Unit};
use crate::stages::loaded::Loaded;
use crate::stages::registration::Registration;
use crate::target::Direction;

/// What a load `σ` does: curves over the load, piecewise linear between the loads `loads`.
///
/// - It shifts and scales the axis of the operators: `a(σ) · T − s(σ)`. Under stress a shape-memory
///   alloy transforms at a higher temperature (Clausius and Clapeyron), so `s` rises with the load.
/// - It changes stroke and offset: the output is `o(σ) + g(σ) · h`.
///
/// A curve that is empty has no effect: `s = o = 0`, `a = g = 1`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load<'a, T> {
    /// The loads at which the curves are known, ascending; empty without a load.
    pub loads: &'a [T],
    /// The shift `s` at each of these loads, in the unit of the temperature.
    pub shifts: &'a [T],
    /// The scale `a` of the axis, above zero.
    pub scales: &'a [T],
    /// The gain `g`, above zero.
    pub gains: &'a [T],
    /// The offset `o`, in the unit of the output.
    pub offsets: &'a [T],
}

impl<T: Real> Load<'_, T> {
    /// No load.
    pub const NONE: Self = Load {
        loads: &[],
        shifts: &[],
        scales: &[],
        gains: &[],
        offsets: &[],
    };

    /// The curves at a load. Beyond the outermost loads they are those of the nearest one.
    ///
    /// ```
    /// use hysteron_core::Load;
    /// let load = Load { loads: &[0.0, 100.0], shifts: &[0.0, 10.0], ..Load::NONE };
    /// let at = load.at(Some(50.0))?;
    /// assert_eq!((at.shift, at.scale), (5.0, 1.0));
    /// # Ok::<(), hysteron_core::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Load`] where a load is needed and `load` is `None` or not finite.
    pub fn at(&self, load: Option<T>) -> Result<Loaded<T>, Error> {
        let (Some(&first), Some(&last)) = (self.loads.first(), self.loads.last()) else {
            return Ok(Loaded::NONE);
        };
        let load = load.filter(|load| load.is_finite()).ok_or(Error::Load)?;
        let load = load.clamp(first, last);
        let of = |values: &[T], none: T| match values {
            [] => none,
            values => between(self.loads, |k| values[k], load),
        };
        let row = self.loads.partition_point(|known| *known <= load).max(1) - 1;
        let part = match self.loads.get(row + 1) {
            Some(next) => (load - self.loads[row]) / (*next - self.loads[row]),
            None => T::ZERO,
        };
        Ok(Loaded {
            scale: of(self.scales, T::ONE),
            shift: of(self.shifts, T::ZERO),
            gain: of(self.gains, T::ONE),
            offset: of(self.offsets, T::ZERO),
            row,
            part,
        })
    }

    /// The load at which the shift is `shift`: the inverse of the curve. Beyond its ends it is the
    /// outermost load. `None` for a curve that is empty, or does not rise or fall all the way.
    ///
    /// ```
    /// use hysteron_core::Load;
    /// let load = Load { loads: &[0.0, 100.0], shifts: &[5.0, 15.0], ..Load::NONE };
    /// assert_eq!(load.of_shift(10.0), Some(50.0));
    /// assert_eq!(load.of_shift(99.0), Some(100.0));
    /// ```
    #[must_use]
    pub fn of_shift(&self, shift: T) -> Option<T> {
        let (first, last) = (*self.shifts.first()?, *self.shifts.last()?);
        let rises = last > first;
        let ordered = |pair: &[T]| pair[0] != pair[1] && (pair[1] > pair[0]) == rises;
        if self.shifts.len() < 2 || !self.shifts.windows(2).all(ordered) {
            return None;
        }
        let before = |knot: &T| (*knot < shift) == rises;
        let k = self.shifts.partition_point(before);
        let Some(k) = k.checked_sub(1) else {
            return self.loads.first().copied();
        };
        if k + 1 == self.shifts.len() {
            return self.loads.last().copied();
        }
        let (from, to) = (self.loads[k], self.loads[k + 1]);
        let part = (shift - self.shifts[k]) / (self.shifts[k + 1] - self.shifts[k]);
        Some((from + part * (to - from)).clamp(from, to))
    }

    /// The nearest shift that one of the loads known has; any shift, where they tell no load.
    pub(crate) fn within(&self, shift: T) -> T {
        match (self.of_shift(shift), self.shifts) {
            (Some(_), [first, .., last]) => shift.clamp(first.min(*last), first.max(*last)),
            _ => shift,
        }
    }
}

/// From the temperature `T` (or voltage, or current) to the input `x` of the operators:
/// `x = W(R(a(σ) · T − s(σ)))`.
///
/// `R` is the [`Registration`], which may differ between rising and falling input. `W` is piecewise
/// linear. It takes corner `k` of `spacing` to level `k` of the plane, for `k = 0…K` (level 0 is the
/// bottom of the plane). Levels are then close together where the output moves.
///
/// ```
/// use hysteron_core::{Axis, Direction, Loaded, Plane};
/// let plane = Plane::new(1.0, 2.0, 2)?; // its bottom is 0
/// let axis = Axis { spacing: &[20.0, 28.0, 30.0], ..Axis::PLAIN };
/// assert_eq!(axis.forward(&plane, Loaded::NONE, Direction::Rising, 28.0), 1.0);
/// assert_eq!(axis.backward(&plane, Loaded::NONE, Direction::Rising, 1.5), 29.0);
/// # Ok::<(), hysteron_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis<'a, T> {
    /// What the load does.
    pub load: Load<'a, T>,
    /// At which temperature each threshold is passed, on the way up and on the way down.
    pub registration: Registration<'a, T>,
    /// The `K + 1` corners of the grid, ascending; empty for equal spacing.
    pub spacing: &'a [T],
}

impl<T: Real> Axis<'_, T> {
    /// No load, no registration and equal spacing: `x = T`.
    pub const PLAIN: Self = Axis {
        load: Load::NONE,
        registration: Registration::NONE,
        spacing: &[],
    };

    /// The input of the operators to which a `temperature` leads them from below, or from above.
    #[must_use]
    pub fn forward(
        &self,
        plane: &Plane<T>,
        loaded: Loaded<T>,
        direction: Direction,
        temperature: T,
    ) -> T {
        let effective = loaded.scale * temperature - loaded.shift;
        let effective = match self.registration.at(loaded, direction) {
            None => effective,
            Some(curve) => curve.forward(effective),
        };
        self.placed(plane, effective)
    }

    /// The input of the operators at a position on the axis.
    pub(crate) fn placed(&self, plane: &Plane<T>, position: T) -> T {
        match self.spacing {
            [] => position,
            corners => between(corners, |k| plane.level(k), position),
        }
    }

    /// The input of the operators at a `temperature`, where it was `held` before. It stays where the
    /// temperature is on the way from one curve of the [`Registration`] to the other.
    ///
    /// ```
    /// use hysteron_core::{Axis, Loaded, Plane, Registration};
    /// let plane = Plane::new(1.0, 2.0, 2)?;
    /// let (rising, falling) = (&[5.0, 7.0][..], &[1.0, 3.0][..]);
    /// let registration = Registration { knots: &[0.0, 2.0], rising, falling };
    /// let axis = Axis { registration, ..Axis::PLAIN };
    /// let after = |held, temperature| axis.seen(&plane, Loaded::NONE, held, temperature);
    /// assert_eq!(after(0.0, 6.0), 1.0); // it rises
    /// assert_eq!(after(1.0, 4.0), 1.0); // it turns, and stays
    /// assert_eq!(after(1.0, 1.5), 0.5); // it falls
    /// # Ok::<(), hysteron_core::Error>(())
    /// ```
    #[must_use]
    pub fn seen(&self, plane: &Plane<T>, loaded: Loaded<T>, held: T, temperature: T) -> T {
        let least = self.forward(plane, loaded, Direction::Rising, temperature);
        if self.registration.falling.is_empty() {
            return least;
        }
        let most = self.forward(plane, loaded, Direction::Falling, temperature);
        least.max(held.min(most))
    }

    /// The slope of the operators' input over `a T − s` in a direction, at an input of the operators.
    pub(crate) fn slope(
        &self,
        plane: &Plane<T>,
        loaded: Loaded<T>,
        direction: Direction,
        input: T,
    ) -> T {
        let (position, spaced) = match self.spacing {
            [] => (input, T::ONE),
            corners => {
                let k = plane.normalise(input).floor_index();
                let k = k.min(corners.len() - 2);
                let slope = plane.step() / (corners[k + 1] - corners[k]);
                (inverse_between(corners, plane, input), slope)
            }
        };
        match self.registration.at(loaded, direction) {
            None => spaced,
            Some(curve) => spaced * curve.slope_at(position),
        }
    }

    /// The mean distance between levels, in the unit of `a T − s`.
    pub(crate) fn level(&self, plane: &Plane<T>) -> T {
        match self.spacing {
            [low, .., high] => (*high - *low) / T::from_index(plane.levels()),
            _ => plane.step(),
        }
    }

    /// The temperature that leads the operators to an input, from below or from above. The inverse of
    /// [`Axis::forward`].
    #[must_use]
    pub fn backward(
        &self,
        plane: &Plane<T>,
        loaded: Loaded<T>,
        direction: Direction,
        input: T,
    ) -> T {
        let position = match self.spacing {
            [] => input,
            corners => inverse_between(corners, plane, input),
        };
        let effective = match self.registration.at(loaded, direction) {
            None => position,
            Some(curve) => curve.backward(position),
        };
        (effective + loaded.shift) / loaded.scale
    }

    /// The temperature that leads the operators from the input `held` to another one. Where that is
    /// the same, every temperature between the two curves does it: the last one on the way of a
    /// `heading`, else the one nearest to `now`.
    pub(crate) fn towards(
        &self,
        plane: &Plane<T>,
        loaded: Loaded<T>,
        (held, now): (T, T),
        heading: Option<Direction>,
        input: T,
    ) -> T {
        let by = |direction| self.backward(plane, loaded, direction, input);
        if self.registration.falling.is_empty() || input > held {
            return by(Direction::Rising);
        }
        let lowest = by(Direction::Falling);
        match heading {
            _ if input < held => lowest,
            Some(Direction::Falling) => lowest,
            Some(Direction::Rising) => by(Direction::Rising),
            None => now.clamp(lowest, by(Direction::Rising).max(lowest)),
        }
    }

    /// How far `x` may be from the exact one by rounding, on the way there and back. The temperature
    /// comes from numbers of the size `size`.
    pub(crate) fn rounding(&self, plane: &Plane<T>, loaded: Loaded<T>, size: T) -> T {
        let magnitude = |v: T| v.max(-v);
        let effective = loaded.scale * size + magnitude(loaded.shift);
        let widest = |steepest: T, pair: &[T]| steepest.max(plane.step() / (pair[1] - pair[0]));
        let slope = match self.spacing {
            [] => T::ONE,
            corners => corners.windows(2).fold(T::ZERO, widest),
        };
        let ends = magnitude(plane.max()) + magnitude(plane.bottom());
        let slope = slope * self.registration.steepest();
        let effective = effective + self.registration.size();
        T::from_index(8) * T::EPSILON * (effective * slope + ends)
    }

    /// Whether the spacing fits the plane.
    pub(crate) fn fits_plane(&self, plane: &Plane<T>) -> Result<(), &'static str> {
        // Corners that are several rounding units apart do not coincide; those that both are about
        // zero have a slope of their own.
        let apart = |pair: &[T]| {
            let size = pair[0].max(-pair[0]).max(pair[1].max(-pair[1]));
            pair[1] - pair[0] > size * T::EPSILON * T::from_index(4)
                && Range::Slope.has(plane.step() / (pair[1] - pair[0]))
        };
        let placed = self.spacing.len() == plane.levels() + 1 && self.spacing.windows(2).all(apart);
        if !(self.spacing.is_empty() || placed) {
            return Err("spacing");
        }
        let sizes = [plane.bottom(), plane.max()].map(|end| Range::Size.has(end));
        match sizes == [true; 2] && Range::Slope.has(plane.step()) {
            true => Ok(()),
            false => Err("plane"),
        }
    }
}

impl<'a, T: Real> Constants<'a, T> for Axis<'a, T> {
    const DECLARED: &'static [Declared] = &[
        Declared {
            name: "load",
            about: "shifts and scales the axis of the operators; changes stroke and offset",
            constants: &[
                Constant {
                    name: "loads",
                    unit: Unit::Load,
                    range: Range::Size,
                    meaning: "the loads at which the curves are known, ascending",
                },
                Constant {
                    name: "shifts",
                    unit: Unit::Temperature,
                    range: Range::Size,
                    meaning: "the shift of the axis at each load, or none at all",
                },
                Constant {
                    name: "scales",
                    unit: Unit::One,
                    range: Range::Factor,
                    meaning: "the scale of the axis at each load, or none at all",
                },
                Constant {
                    name: "gains",
                    unit: Unit::One,
                    range: Range::Factor,
                    meaning: "the factor of the sum at each load, or none at all",
                },
                Constant {
                    name: "offsets",
                    unit: Unit::Output,
                    range: Range::Size,
                    meaning: "what is added to the output at each load, or none at all",
                },
            ],
        },
        <Registration<'_, T> as Constants<T>>::DECLARED[0],
        Declared {
            name: "spacing",
            about: "places the levels where the output moves",
            constants: &[Constant {
                name: "spacing",
                unit: Unit::Temperature,
                range: Range::Size,
                meaning: "the K + 1 corners of the grid, ascending",
            }],
        },
    ];

    fn lists(&self) -> impl Iterator<Item = &[T]> {
        let Load {
            loads,
            shifts,
            scales,
            gains,
            offsets,
        } = self.load;
        let of_load = [loads, shifts, scales, gains, offsets].into_iter();
        of_load
            .chain(self.registration.lists())
            .chain([self.spacing])
    }

    fn of_lists(mut next: impl FnMut() -> &'a [T]) -> Option<Self> {
        let load = Load {
            loads: next(),
            shifts: next(),
            scales: next(),
            gains: next(),
            offsets: next(),
        };
        Some(Self {
            load,
            registration: Registration::of_lists(&mut next)?,
            spacing: next(),
        })
    }

    fn fits(&self) -> Result<(), &'static str> {
        let load = self.load;
        // Curves are divided by these distances.
        let ascends = |pair: &[T]| Range::Slope.has(pair[1] - pair[0]);
        if !load.loads.windows(2).all(ascends) {
            return Err("loads");
        }
        let curves = [
            ("shifts", load.shifts),
            ("scales", load.scales),
            ("gains", load.gains),
            ("offsets", load.offsets),
        ];
        let fits = |curve: &[T]| curve.is_empty() || curve.len() == load.loads.len();
        match curves.into_iter().find(|(_, curve)| !fits(curve)) {
            None => self.registration.fits_loads(load.loads.len()),
            Some((name, _)) => Err(name),
        }
    }
}

/// The piecewise linear function with the values `y(k)` at `xs[k]`. Beyond the ends it goes on
/// with the slope of the outermost piece. At a knot it is exact.
pub(crate) fn between<T: Real>(xs: &[T], y: impl Fn(usize) -> T, x: T) -> T {
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
