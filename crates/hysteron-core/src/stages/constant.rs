//! What a stage declares of itself: name, constants, their units and ranges.
//!
//! Every surface carries the constants of all stages by this table alone: as named lists of
//! numbers. So a stage that joins the table is in all of them.

use crate::scalar::Real;

/// A stage, as its file declares it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Declared {
    /// Its name.
    pub name: &'static str,
    /// What it does, in one sentence.
    pub about: &'static str,
    /// Its constants.
    pub constants: &'static [Constant],
}

/// A constant of a stage: a list of numbers. A list without numbers has no effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constant {
    /// Its name, which no constant of another stage has.
    pub name: &'static str,
    /// The unit of its numbers.
    pub unit: Unit,
    /// What the numbers may be.
    pub range: Range,
    /// What they are, with how many there have to be.
    pub meaning: &'static str,
}

impl Constant {
    /// The line in an FMU's text of version 2 that holds this constant. Those of the body share one.
    /// `None` for a constant that this version does not have.
    #[must_use]
    pub fn line_of_version_2(&self) -> Option<&'static str> {
        match self.name {
            "ambient" | "gain" | "tau_heating" | "tau_cooling" => Some("body"),
            "creep_taus" => Some("taus"),
            "loads" | "shifts" | "scales" | "gains" | "offsets" | "spacing" | "creep" | "lag" => {
                Some(self.name)
            }
            _ => None,
        }
    }
}

/// The unit of a constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// A number without a unit.
    One,
    /// Seconds.
    Second,
    /// Cycles a second.
    Hertz,
    /// The unit of the input that the operators see: of the temperature, with a body.
    Temperature,
    /// That unit per unit of the drive.
    TemperaturePerDrive,
    /// The unit of the load.
    Load,
    /// The unit of the output.
    Output,
}

/// How large and how small the numbers of a constant may be.
///
/// Within these ranges no step overflows, and no stage hides what another one does behind the
/// rounding of its digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Range {
    /// A number in the unit of an input, a load or an output. Its square and products with factors
    /// stay numbers, because it is no larger than [`Real::LARGEST`].
    Size,
    /// As [`Range::Size`], from 0 on.
    Amount,
    /// A slope, which is divided by as well: neither it nor its inverse is too large.
    Slope,
    /// A part of the output: from 0 to a million. `float` has 2²³ parts of a number, so beyond a
    /// million it no longer holds the output beside that part of it.
    Share,
    /// A factor: about one, and not so small that the largest is out of reach.
    Factor,
    /// A time constant in seconds: up to some 30 years, and as far below a second. A longer one is
    /// none that an experiment shows.
    Time,
    /// A time constant, or 0 for none.
    TimeOrNone,
    /// A frequency in hertz, within the inverses of time constants.
    Frequency,
    /// A damping ratio, from one that rings for some thousand cycles to the critical one. With more
    /// damping a lag tells the same.
    Damping,
}

const FACTOR: usize = 1_000_000;
const SECONDS: usize = 1_000_000_000;
const UNDAMPED: usize = 10_000;

impl Range {
    /// Whether a number is in the range. No range has NaN.
    #[must_use]
    pub fn has<T: Real>(self, value: T) -> bool {
        let factor = T::from_index(FACTOR);
        let seconds = T::from_index(SECONDS);
        let within = |low: T, high: T| value >= low && value <= high;
        match self {
            Self::Size => within(-T::LARGEST, T::LARGEST),
            Self::Amount => within(T::ZERO, T::LARGEST),
            Self::Slope => within(T::ONE / T::LARGEST, T::LARGEST),
            Self::Share => within(T::ZERO, factor),
            Self::Factor => within(T::ONE / factor, factor),
            Self::Time => within(T::ONE / seconds, seconds),
            Self::TimeOrNone => value == T::ZERO || Self::Time.has(value),
            Self::Frequency => Self::Time.has(value),
            Self::Damping => within(T::ONE / T::from_index(UNDAMPED), T::ONE),
        }
    }

    /// Whether a constant of this range acts through a step of time alone, so that its factors stand
    /// for it.
    #[must_use]
    pub fn is_timed(self) -> bool {
        matches!(self, Self::Time | Self::TimeOrNone | Self::Frequency)
    }

    /// The range in words, for `f64`.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Size => "numbers up to 1e140",
            Self::Amount => "numbers from 0 to 1e140",
            Self::Slope => "numbers from 1e-140 to 1e140",
            Self::Share => "numbers from 0 to 1e6",
            Self::Factor => "numbers from 1e-6 to 1e6",
            Self::Time => "times from 1e-9 s to 1e9 s",
            Self::TimeOrNone => "0, or a time from 1e-9 s to 1e9 s",
            Self::Frequency => "frequencies from 1e-9 Hz to 1e9 Hz",
            Self::Damping => "numbers from 1e-4 to 1",
        }
    }
}

/// A stage that declares its constants, and lends or takes them as lists in the order declared.
pub(crate) trait Constants<'a, T: Real>: Sized {
    /// What it declares.
    const DECLARED: &'static [Declared];

    /// The numbers of each constant.
    fn lists(&self) -> impl Iterator<Item = &[T]>;

    /// The stage of these lists; `None` where a list that has to have one number has several, or
    /// one that others need is missing.
    fn of_lists(next: impl FnMut() -> &'a [T]) -> Option<Self>;

    /// How the constants have to fit each other. [`Range`] is checked apart.
    ///
    /// # Errors
    /// The name of a constant or of the stage.
    fn fits(&self) -> Result<(), &'static str>;
}

/// A number as a list; none for a list without numbers.
pub(crate) fn one<T: Copy>(list: &[T]) -> Option<Option<T>> {
    match list {
        [] => Some(None),
        [number] => Some(Some(*number)),
        _ => None,
    }
}

/// What rounding of digits may amount to where a target counts as reached, as a part of the range of
/// outputs: a thousandth.
pub(super) fn thousandth<T: Real>(range: T) -> T {
    range * (T::ONE / T::from_index(1000))
}

/// From what to what the exact inverse of a ring may alternate, as a part of the range of sums: so
/// little that operators and drive hardly notice.
pub(super) fn little<T: Real>() -> T {
    T::ONE / T::from_index(128)
}
