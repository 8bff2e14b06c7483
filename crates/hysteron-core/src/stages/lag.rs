//! Lag: the whole output follows with a time constant.

use crate::scalar::Real;
use crate::stages::constant::{Constant, Constants, Declared, Range, Unit, one};
use crate::stages::stage::Stage;

/// A first-order lag of the whole output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lag<T> {
    /// The time constant in seconds; 0 for no lag.
    pub tau: T,
}

/// The output of the lag.
pub(crate) type Memory<T> = [T; 1];
/// `e^(−dt/τ)`.
pub(crate) type Factors<T> = [T; 1];

impl<T: Real> Lag<T> {
    /// No lag.
    pub const NONE: Self = Lag { tau: T::ZERO };
}

impl<'a, T: Real> Constants<'a, T> for Lag<T> {
    const DECLARED: &'static [Declared] = &[Declared {
        name: "lag",
        about: "the whole output follows with a time constant",
        constants: &[Constant {
            name: "lag",
            unit: Unit::Second,
            range: Range::TimeOrNone,
            meaning: "one time constant",
        }],
    }];

    fn lists(&self) -> impl Iterator<Item = &[T]> {
        let list = match self.tau != T::ZERO {
            true => core::slice::from_ref(&self.tau),
            false => &[],
        };
        [list].into_iter()
    }

    fn of_lists(mut next: impl FnMut() -> &'a [T]) -> Option<Self> {
        let tau = one(next())?.unwrap_or(T::ZERO);
        Some(Self { tau })
    }

    fn fits(&self) -> Result<(), &'static str> {
        Ok(())
    }
}

impl<T: Real> Stage<T> for Lag<T> {
    type Memory = Memory<T>;
    type Factors = Factors<T>;

    fn is_there(&self) -> bool {
        self.tau != T::ZERO
    }

    fn is_timed(&self) -> bool {
        self.is_there()
    }

    fn factors(&self, dt: T) -> Factors<T> {
        [(-dt / self.tau).exp()]
    }

    fn rest(&self, sum: T) -> Memory<T> {
        [sum]
    }

    fn forward(&self, [lagged]: &mut Memory<T>, [fade]: &Factors<T>, sum: T) -> T {
        *lagged = sum + (*lagged - sum) * *fade;
        *lagged
    }

    fn inverse(&self, [lagged]: &Memory<T>, [fade]: &Factors<T>, output: T) -> T {
        (output - *lagged * *fade) / (T::ONE - *fade)
    }

    fn settled(&self, sum: T) -> T {
        sum
    }

    fn drift(&self, fade: &[T]) -> T {
        fade.iter()
            .fold(T::ZERO, |sum, &fade| sum + T::ONE / (T::ONE - fade))
    }

    fn steepest(&self, [fade]: &Factors<T>) -> T {
        T::ONE - *fade
    }
}
