//! The options of the estimator of the shift.

use crate::error::Error;
use crate::model::Model;
use crate::scalar::Real;
use crate::stages::Stages;

/// The settings of a [`ShiftEstimator`](crate::ShiftEstimator).
///
/// | Option | Range | For |
/// | --- | --- | --- |
/// | `noise` | above 0 | standard deviation of the error of a reading, model error included |
/// | `spread` | above 0 | standard deviation of the shift at the start and after a jump |
/// | `walk` | from 0 | how far the shift may walk while the temperature moves by a level |
/// | `reach` | above 0 | the largest shift, to either side |
/// | `dead_zone` | from 0 | errors up to this are noise |
/// | `movement` | from 0 | levels between two samples that are learned from |
/// | `gate`, `burst` | as in [`Adaptation`](crate::Adaptation) | wrong readings and jumps |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShiftOptions<T> {
    /// Standard deviation of the error of a reading, in the output's unit.
    ///
    /// The model's own error counts too. It is the same over about a level, so readings closer
    /// together than a level count for less.
    pub noise: T,
    /// Standard deviation of the shift at the start and after a jump, in the unit of the
    /// temperature.
    pub spread: T,
    /// Standard deviation of the change of the shift while the temperature moves by one level, in
    /// the unit of the temperature. With 0 a shift that was found stays, until a jump.
    pub walk: T,
    /// The largest shift to either side, in the unit of the temperature.
    pub reach: T,
    /// Errors up to this teach nothing, in the output's unit; a larger one counts by the amount
    /// beyond it.
    pub dead_zone: T,
    /// How far the temperature has to be from the last sample learned from, in levels.
    pub movement: T,
    /// The largest surprise that is learned from, as a multiple of the usual one: from 2, or 0 to
    /// accept every reading.
    pub gate: T,
    /// So many refused readings in a row that agree are a jump of the load, from 1.
    pub burst: u32,
}

impl<T: Real> ShiftOptions<T> {
    /// Options for `model` between `stages`.
    ///
    /// A reading errs by 5 % of the model's range. The shift reaches half of the plane's width, or
    /// the whole range of the shifts of the load, whichever is more; half of that is its standard
    /// deviation. It walks by a tenth of a level per level.
    #[must_use]
    pub fn usual<C: AsRef<[T]>>(model: &Model<T, C>, stages: &Stages<'_, T>) -> Self {
        let level = stages.axis.level(model.plane());
        let half = level * T::from_index(model.plane().levels()) / T::from_index(2);
        let mut shifts = (T::INFINITY, -T::INFINITY);
        for &shift in stages.axis.load.shifts {
            shifts = (shifts.0.min(shift), shifts.1.max(shift));
        }
        let reach = half.max(shifts.1 - shifts.0);
        Self {
            noise: stages.range(model) / T::from_index(20),
            spread: reach / T::from_index(2),
            walk: level / T::from_index(10),
            reach,
            dead_zone: T::ZERO,
            movement: T::ONE / T::from_index(20),
            gate: T::from_index(12),
            burst: 8,
        }
    }

    /// Checks the ranges of all options.
    ///
    /// # Errors
    /// [`Error::Adaptation`] with the name of the first option out of range.
    pub fn check(&self) -> Result<(), Error> {
        let from_zero = |value: T| value >= T::ZERO && value.is_finite();
        // The estimator uses the squares. They must not underflow or overflow either.
        let squares = |value: T| {
            value > T::ZERO && {
                let square = value * value;
                square > T::ZERO && square.is_finite()
            }
        };
        let require = |fine: bool, option| match fine {
            true => Ok(()),
            false => Err(Error::Adaptation { option }),
        };
        require(squares(self.noise), "noise")?;
        require(squares(self.spread), "spread")?;
        require(
            from_zero(self.walk) && from_zero(self.walk * self.walk),
            "walk",
        )?;
        require(self.reach > T::ZERO && self.reach.is_finite(), "reach")?;
        require(from_zero(self.dead_zone), "dead_zone")?;
        require(from_zero(self.movement), "movement")?;
        let shut = self.gate >= T::from_index(2) && self.gate.is_finite();
        require(shut || self.gate == T::ZERO, "gate")?;
        require(self.burst > 0, "burst")
    }
}
