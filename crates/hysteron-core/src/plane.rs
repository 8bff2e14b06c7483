//! The discrete Preisach plane of equation (3).

use crate::error::Error;
use crate::scalar::Real;

/// The largest number of levels of a plane. The number of operators then fits 31 bits.
pub const MAX_LEVELS: usize = 46_340;

/// Number of operators on a plane of `levels` levels, `N = K(K + 1)/2`.
#[must_use]
pub const fn operator_count(levels: usize) -> usize {
    levels * (levels + 1) / 2
}

/// Index of operator `(i, j)`, `1 ≤ i ≤ j`, among the weights, from 0: row by row, `j = 1…K`, and
/// within a row `i = 1…j`.
///
/// An `i` or `j` of 0 gives the same index as 1.
#[must_use]
pub const fn operator_index(i: usize, j: usize) -> usize {
    j * j.saturating_sub(1) / 2 + i.saturating_sub(1)
}

/// All operators `(i, j)` of a plane of `levels` levels, in the order of the weights: `j = 1…K`,
/// and within each row `i = 1…j`.
///
/// There are [`operator_count`]`(levels)` of them; the one at position `n` has
/// [`operator_index`]`(i, j) = n`.
///
/// ```
/// use hysteron_core::operators;
/// let all: Vec<_> = operators(3).collect();
/// assert_eq!(all, [(1, 1), (1, 2), (2, 2), (1, 3), (2, 3), (3, 3)]);
/// ```
pub fn operators(levels: usize) -> impl Iterator<Item = (usize, usize)> {
    (1..=levels).flat_map(|j| (1..=j).map(move |i| (i, j)))
}

/// Which end of the plane an input was clipped to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clipped {
    /// The input lay below `T_min − ΔT`. It acts as that value: every operator is off.
    Low,
    /// The input lay above `T_max`. It acts as that value: every operator is on.
    High,
}

/// `K` levels over `[T_min, T_max]`, spaced by `ΔT = (T_max − T_min)/(K − 1)` (equation 3).
///
/// ```
/// use hysteron_core::Plane;
/// let plane = Plane::new(20.0, 80.0, 20)?; // Table 2 of the chapter, degC
/// assert_eq!(plane.operators(), 210);
/// assert!((plane.step() - 3.16_f64).abs() < 0.003);
/// assert_eq!(plane.level(1), 20.0);
/// # Ok::<(), hysteron_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane<T> {
    min: T,
    max: T,
    levels: usize,
    step: T,
    per_unit: T,
    bottom: T,
}

impl<T: Real> Plane<T> {
    /// A plane of `levels` levels (2 to [`MAX_LEVELS`]) over `[min, max]`, in the input's unit.
    ///
    /// # Errors
    /// [`Error::Levels`], or [`Error::Range`] where `min` and `max` are not finite, are not in
    /// order, or are so close that neighbouring levels coincide.
    pub fn new(min: T, max: T, levels: usize) -> Result<Self, Error> {
        if !(2..=MAX_LEVELS).contains(&levels) {
            return Err(Error::Levels(levels));
        }
        let steps = T::from_index(levels - 1);
        let step = (max - min) / steps;
        let mut per_unit = steps / (max - min);
        // Rounded up, so that T_max normalises to K and no less. In a very wide range the addition
        // has no effect; `reaches` refuses that range.
        for _ in 0..2 {
            if (max - min) * per_unit < steps {
                per_unit = per_unit + per_unit * T::EPSILON;
            }
        }
        let reaches = (max - min) * per_unit >= steps;
        let bottom = min - step;
        // Levels are several rounding units apart, so that no two coincide.
        let largest = max.max(-max).max(min.max(-min));
        let distinct = step > largest * T::EPSILON * T::from_index(4);
        if !(step.is_finite() && per_unit.is_finite() && bottom.is_finite() && distinct && reaches)
        {
            return Err(Error::Range);
        }
        Ok(Self {
            min,
            max,
            levels,
            step,
            per_unit,
            bottom,
        })
    }

    /// `T_min`, the lowest level.
    #[must_use]
    pub fn min(&self) -> T {
        self.min
    }

    /// `T_max`, the highest level.
    #[must_use]
    pub fn max(&self) -> T {
        self.max
    }

    /// `K`, the number of levels.
    #[must_use]
    pub fn levels(&self) -> usize {
        self.levels
    }

    /// `ΔT`, the distance between levels.
    #[must_use]
    pub fn step(&self) -> T {
        self.step
    }

    /// `1/ΔT`, rounded so that `T_max` normalises to `K` and no less.
    #[must_use]
    pub fn per_unit(&self) -> T {
        self.per_unit
    }

    /// `N = K(K + 1)/2`, the number of operators.
    #[must_use]
    pub fn operators(&self) -> usize {
        operator_count(self.levels)
    }

    /// `T_min − ΔT`, where the lowest ridge begins. The active input range is `[bottom, max]`.
    #[must_use]
    pub fn bottom(&self) -> T {
        self.bottom
    }

    /// Level `k`, `α_k = β_k = T_min + (k − 1) ΔT`; level 0 is [`Plane::bottom`].
    #[must_use]
    pub fn level(&self, k: usize) -> T {
        self.denormalise(T::from_index(k))
    }

    /// The normalised input `x = (T − T_min)/ΔT + 1`, limited to `[0, K]`.
    #[must_use]
    #[inline(always)]
    pub fn normalise(&self, input: T) -> T {
        let x = (input - self.min) * self.per_unit + T::ONE;
        x.clamp(T::ZERO, T::from_index(self.levels))
    }

    /// The end of the active range that `input` lies beyond; `None` within the range.
    #[must_use]
    pub fn clipped(&self, input: T) -> Option<Clipped> {
        if input > self.max {
            Some(Clipped::High)
        } else if input < self.bottom {
            Some(Clipped::Low)
        } else {
            None
        }
    }

    /// The input at the normalised position `x`: `T = T_min + (x − 1) ΔT`.
    #[must_use]
    pub fn denormalise(&self, x: T) -> T {
        if x >= T::from_index(self.levels) {
            self.max
        } else {
            self.min + (x - T::ONE) * self.step
        }
    }

    /// The smallest change of the input that a relay model surely sees, in the input's unit.
    ///
    /// A relay switches only where the input moves. A relay whose level is the present input needs
    /// such a change to switch.
    #[must_use]
    pub fn nudge(&self) -> T {
        let size = self.max.max(-self.max).max(self.bottom.max(-self.bottom));
        size * (T::EPSILON + T::EPSILON)
    }

    /// The highest level at or below `input`, 0 for none. On a rising input, relays up to this
    /// level switch on.
    pub(crate) fn level_at_or_below(&self, input: T) -> usize {
        let near = self.normalise(input).floor_index();
        // The levels decide, because the normalised position is rounded.
        if near < self.levels && self.level(near + 1) <= input {
            near + 1
        } else if near > 0 && self.level(near) > input {
            near - 1
        } else {
            near
        }
    }

    /// The lowest level at or above `input`, `K + 1` for none. On a falling input, relays from this
    /// level on switch off.
    pub(crate) fn level_at_or_above(&self, input: T) -> usize {
        let below = self.level_at_or_below(input);
        if below > 0 && self.level(below) >= input {
            below
        } else {
            below + 1
        }
    }
}
