//! What the stages remember, and the sample and the factors that change it.

use crate::error::Error;
use crate::scalar::Real;
use crate::stages::behind;
use crate::stages::body::Decay;

/// What the stages remember from one sample to the next.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StageState<T> {
    /// `false` before the first sample. At that sample the stages are at rest.
    pub(crate) started: bool,
    pub(crate) temperature: T,
    pub(crate) behind: behind::Memory<T>,
}

/// How many numbers a [`StageState`] has.
pub const STATE_NUMBERS: usize = 2 + behind::MEMORY;

impl<T: Real> StageState<T> {
    /// The temperature after the last sample; 0 before the first one.
    #[must_use]
    pub fn temperature(&self) -> T {
        self.temperature
    }

    /// Whether there was a sample.
    #[must_use]
    pub fn is_started(&self) -> bool {
        self.started
    }

    /// The state as numbers, for saving: 0 or 1 for whether there was a sample, the temperature, and
    /// what each stage behind the operators remembers; zeros for stages that are not there.
    #[must_use]
    pub fn to_numbers(&self) -> [T; STATE_NUMBERS] {
        let mut numbers = [T::ZERO; STATE_NUMBERS];
        numbers[0] = if self.started { T::ONE } else { T::ZERO };
        numbers[1] = self.temperature;
        for (number, place) in self.behind.numbers().zip(&mut numbers[2..]) {
            *place = *number;
        }
        numbers
    }

    /// The state that [`StageState::to_numbers`] gave.
    ///
    /// # Errors
    /// [`Error::InputNotFinite`] with the index of a number that is not finite.
    pub fn from_numbers(numbers: &[T; STATE_NUMBERS]) -> Result<Self, Error> {
        if let Some(index) = numbers.iter().position(|number| !number.is_finite()) {
            return Err(Error::InputNotFinite { index });
        }
        let mut behind = behind::Memory::default();
        for (place, number) in behind.numbers_mut().zip(&numbers[2..]) {
            *place = *number;
        }
        Ok(Self {
            started: numbers[0] != T::ZERO,
            temperature: numbers[1],
            behind,
        })
    }
}

/// One sample. A plain number converts to a sample with that input only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample<T> {
    /// The input; with a thermal body, the drive that was held since the sample before.
    pub input: T,
    /// Time since the sample before, in seconds; needed by stages that depend on it.
    pub dt: Option<T>,
    /// The load; needed by a model that depends on one.
    pub load: Option<T>,
}

impl<T> From<T> for Sample<T> {
    fn from(input: T) -> Self {
        Self {
            input,
            dt: None,
            load: None,
        }
    }
}

/// How many factors [`Rates`] has.
pub const RATE_NUMBERS: usize = 2 + behind::FACTORS;

/// The factors of all stages for one time step ([`crate::Stages::rates`]). For a fixed sample time they
/// are computed once.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rates<T> {
    pub(crate) decay: Decay<T>,
    pub(crate) behind: behind::Factors<T>,
}

impl<T: Real> Rates<T> {
    /// The factors as numbers, for programs that carry them as constants: heating, cooling, those of
    /// each stage behind the operators.
    #[must_use]
    pub fn to_numbers(&self) -> [T; RATE_NUMBERS] {
        let mut numbers = [T::ZERO; RATE_NUMBERS];
        numbers[0] = self.decay.heating;
        numbers[1] = self.decay.cooling;
        for (number, place) in self.behind.numbers().zip(&mut numbers[2..]) {
            *place = *number;
        }
        numbers
    }
}
