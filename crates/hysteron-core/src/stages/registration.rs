//! The registration: at which temperature each threshold is passed, by rising and by falling
//! input.

use crate::scalar::Real;
use crate::stages::constant::{Constant, Constants, Declared, Range, Unit};
use crate::stages::loaded::Loaded;
use crate::target::Direction;

/// Two curves over the temperature, which move with the load: one for the thresholds of rising and
/// one for those of falling input.
///
/// At a load, threshold `knots[m]` is passed at the temperature `rising[m]` on the way up and at
/// `falling[m]` on the way down. Between the knots the curves are piecewise linear, and beyond them
/// the axis goes on as it is, degree for degree. Between the loads they are straight. With
/// `x↑ = B⁻¹(T, σ)` by `rising` and `x↓ = A⁻¹(T, σ)` by `falling`, an operator is a generalised play
/// with two input curves (Krasnosel'skii and Pokrovskii 1989, part 1):
///
/// ```text
/// γ ← max(r_j(x↑), min(γ, r_i(x↓)))
/// ```
///
/// No threshold of falling input is passed above that of rising input, so `x↑ ≤ x↓`. Then all
/// operators do what they would do for one input `x ← max(x↑, min(x, x↓))`: at `x`, those that `x↑`
/// may switch on are on as long as `x ≥ x↑`, and those that `x↓` may switch off are off as long as
/// `x ≤ x↓`. The operators' input is all the memory that this needs. With equal curves it is `x↑`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Registration<'a, T> {
    /// Two or more positions on the axis of the operators, ascending; empty for `x = a T − s`.
    pub knots: &'a [T],
    /// The temperatures `a T − s` of rising input at these knots, ascending: one row of them for
    /// each of the loads, one alone without loads.
    pub rising: &'a [T],
    /// The same for falling input, at each knot at most that of rising input; empty for the same
    /// temperatures.
    pub falling: &'a [T],
}

/// One of the two curves at one load.
#[derive(Clone, Copy)]
pub(crate) struct Registered<'a, T> {
    knots: &'a [T],
    /// The row of the load below, and how far the load is on the way to the next one.
    rows: &'a [T],
    part: T,
}

impl<'a, T: Real> Registration<'a, T> {
    /// No registration: both curves are the axis itself.
    pub const NONE: Self = Registration {
        knots: &[],
        rising: &[],
        falling: &[],
    };

    /// The curve of a direction at a load; `None` without a registration.
    pub(crate) fn at(&self, loaded: Loaded<T>, direction: Direction) -> Option<Registered<'a, T>> {
        let rows = match (direction, self.falling) {
            (Direction::Falling, [_, ..]) => self.falling,
            _ => self.rising,
        };
        Some(Registered {
            knots: self.knots,
            rows: rows.get(loaded.row * self.knots.len()..)?,
            part: loaded.part,
        })
        .filter(|_| !self.knots.is_empty())
    }

    /// The steepest slope of a position over `a T − s`, at any load: between two loads no slope is
    /// steeper than at both. 1 without a registration.
    ///
    /// ```
    /// use hysteron_core::Registration;
    /// let rising = &[5.0, 5.5];
    /// let registration = Registration { knots: &[0.0, 2.0], rising, falling: &[] };
    /// assert_eq!(registration.steepest(), 4.0);
    /// ```
    #[must_use]
    pub fn steepest(&self) -> T {
        let rows = [self.rising, self.falling].into_iter();
        let rows = rows.flat_map(|rows| rows.chunks_exact(self.knots.len().max(1)));
        let slopes = rows.flat_map(|row| {
            let pieces = self.knots.windows(2).zip(row.windows(2));
            pieces.map(|(x, t)| (x[1] - x[0]) / (t[1] - t[0]))
        });
        slopes.fold(T::ONE, T::max)
    }

    /// The size of its knots, whose rounding a position has: that of the first and the last.
    #[must_use]
    pub fn size(&self) -> T {
        match self.knots {
            [first, .., last] => first.max(-*first) + last.max(-*last),
            _ => T::ZERO,
        }
    }

    /// Whether the curves fit each other and the `loads`.
    pub(crate) fn fits_loads(&self, loads: usize) -> Result<(), &'static str> {
        let count = self.knots.len();
        let rows = count * loads.max(1);
        if count == 1 || !ascending(self.knots) {
            return Err("knots");
        }
        let row_ascends = |rows: &[T]| {
            rows.chunks(count.max(1)).all(|row| {
                let pairs = self.knots.windows(2).zip(row.windows(2));
                let mut slopes = pairs.map(|(x, t)| (x[1] - x[0]) / (t[1] - t[0]));
                ascending(row) && slopes.all(|slope| Range::Slope.has(slope))
            })
        };
        if self.rising.len() != rows || !row_ascends(self.rising) {
            return Err("rising");
        }
        let pairs = || self.falling.iter().zip(self.rising);
        let fits = self.falling.is_empty()
            || self.falling.len() == rows
                && row_ascends(self.falling)
                && pairs().all(|(falling, rising)| falling <= rising);
        if fits { Ok(()) } else { Err("falling") }
    }
}

/// Whether numbers ascend, by several rounding units: so do those between two rows of them.
fn ascending<T: Real>(numbers: &[T]) -> bool {
    numbers.windows(2).all(|pair| {
        let size = pair[0].max(-pair[0]).max(pair[1].max(-pair[1]));
        pair[1] - pair[0] > size * T::EPSILON * T::from_index(16)
    })
}

impl<T: Real> Registered<'_, T> {
    /// The position on the axis of the operators at a temperature.
    pub(crate) fn forward(&self, temperature: T) -> T {
        self.from(|m| self.temperature(m), |m| self.knots[m], temperature)
    }

    /// The temperature at a position: the inverse of [`Registered::forward`].
    pub(crate) fn backward(&self, position: T) -> T {
        self.from(|m| self.knots[m], |m| self.temperature(m), position)
    }

    /// The slope of the position over the temperature, at a position.
    pub(crate) fn slope_at(&self, position: T) -> T {
        let last = self.knots.len() - 1;
        if position < self.knots[0] || position >= self.knots[last] {
            return T::ONE;
        }
        self.slope(self.knots.partition_point(|knot| *knot <= position) - 1)
    }

    /// The temperature at knot `m`.
    fn temperature(&self, m: usize) -> T {
        let low = self.rows[m];
        match self.rows.get(self.knots.len() + m) {
            Some(next) if self.part != T::ZERO => low + self.part * (*next - low),
            _ => low,
        }
    }

    /// The slope of piece `m`.
    fn slope(&self, m: usize) -> T {
        (self.knots[m + 1] - self.knots[m]) / (self.temperature(m + 1) - self.temperature(m))
    }

    /// The piecewise linear function from `x(m)` to `y(m)`, of slope one beyond its ends.
    fn from(&self, x: impl Fn(usize) -> T, y: impl Fn(usize) -> T, at: T) -> T {
        let last = self.knots.len() - 1;
        if at <= x(0) {
            return y(0) + (at - x(0));
        }
        if at >= x(last) {
            return y(last) + (at - x(last));
        }
        let (mut low, mut high) = (0, last);
        while low + 1 < high {
            let middle = low + (high - low) / 2;
            match x(middle) <= at {
                true => low = middle,
                false => high = middle,
            }
        }
        let slope = (y(high) - y(low)) / (x(high) - x(low));
        y(low) + (at - x(low)) * slope
    }
}

impl<'a, T: Real> Constants<'a, T> for Registration<'a, T> {
    const DECLARED: &'static [Declared] = &[Declared {
        name: "registration",
        about: "moves the thresholds of rising and of falling input, each along a curve",
        constants: &[
            Constant {
                name: "knots",
                unit: Unit::Temperature,
                range: Range::Size,
                meaning: "two or more positions on the axis of the operators, ascending",
            },
            Constant {
                name: "rising",
                unit: Unit::Temperature,
                range: Range::Size,
                meaning: "where rising input passes each knot, ascending: a row for each load",
            },
            Constant {
                name: "falling",
                unit: Unit::Temperature,
                range: Range::Size,
                meaning: "the same for falling input, nowhere above `rising`; none for the same",
            },
        ],
    }];

    fn lists(&self) -> impl Iterator<Item = &[T]> {
        [self.knots, self.rising, self.falling].into_iter()
    }

    fn of_lists(mut next: impl FnMut() -> &'a [T]) -> Option<Self> {
        Some(Self {
            knots: next(),
            rising: next(),
            falling: next(),
        })
    }

    /// The loads are those of another stage: see [`Registration::fits_loads`].
    fn fits(&self) -> Result<(), &'static str> {
        Ok(())
    }
}
