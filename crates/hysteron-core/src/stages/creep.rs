//! Creep: the output goes on moving after the operators have come to rest.

use crate::scalar::Real;
use crate::stages::constant::{Constant, Constants, Declared, Range, Unit};
use crate::stages::stage::Stage;

/// The largest number of creep terms.
pub const MAX_CREEP: usize = 4;

/// Creep: `h + Σ_k c_k L_k[h]`, where `L_k` is a first-order lag of time constant `τ_k`.
///
/// Piezo stacks creep by 1 to 2 % a decade of time. A few time constants, spaced evenly on a
/// logarithmic scale, follow that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Creep<'a, T> {
    /// The coefficients `c_k`, 0 or more; at most [`MAX_CREEP`] of them, none for no creep.
    pub coefficients: &'a [T],
    /// The time constants `τ_k` in seconds, above zero; as many.
    pub taus: &'a [T],
}

/// The output of each lag.
pub(crate) type Memory<T> = [T; MAX_CREEP];
/// `e^(−dt/τ)` of each lag.
pub(crate) type Factors<T> = [T; MAX_CREEP];

impl<T: Real> Creep<'_, T> {
    /// No creep.
    pub const NONE: Self = Creep {
        coefficients: &[],
        taus: &[],
    };

    /// The gain at rest, `1 + Σ c_k`.
    #[must_use]
    pub fn gain(&self) -> T {
        self.coefficients.iter().fold(T::ONE, |sum, &c| sum + c)
    }
}

impl<'a, T: Real> Constants<'a, T> for Creep<'a, T> {
    const DECLARED: &'static [Declared] = &[Declared {
        name: "creep",
        about: "the output goes on moving after the operators rest",
        constants: &[
            Constant {
                name: "creep",
                unit: Unit::One,
                range: Range::Share,
                meaning: "the share of the sum that creeps, of each of up to 4 terms",
            },
            Constant {
                name: "creep_taus",
                unit: Unit::Second,
                range: Range::Time,
                meaning: "the time constant of each term",
            },
        ],
    }];

    fn lists(&self) -> impl Iterator<Item = &[T]> {
        [self.coefficients, self.taus].into_iter()
    }

    fn of_lists(mut next: impl FnMut() -> &'a [T]) -> Option<Self> {
        let (coefficients, taus) = (next(), next());
        Some(Self { coefficients, taus })
    }

    fn fits(&self) -> Result<(), &'static str> {
        let count = self.coefficients.len();
        match count <= MAX_CREEP && self.taus.len() == count {
            true => Ok(()),
            false => Err("creep"),
        }
    }
}

impl<T: Real> Stage<T> for Creep<'_, T> {
    type Memory = Memory<T>;
    type Factors = Factors<T>;

    fn is_there(&self) -> bool {
        !self.coefficients.is_empty()
    }

    fn is_timed(&self) -> bool {
        self.is_there()
    }

    fn factors(&self, dt: T) -> Factors<T> {
        let mut factors = Factors::default();
        for (factor, &tau) in factors.iter_mut().zip(self.taus) {
            *factor = (-dt / tau).exp();
        }
        factors
    }

    fn rest(&self, h: T) -> Memory<T> {
        [h; MAX_CREEP]
    }

    fn forward(&self, crept: &mut Memory<T>, fade: &Factors<T>, h: T) -> T {
        let mut sum = h;
        for ((crept, &fade), &c) in crept.iter_mut().zip(fade).zip(self.coefficients) {
            *crept = h + (*crept - h) * fade;
            sum = sum + c * *crept;
        }
        sum
    }

    fn inverse(&self, crept: &Memory<T>, fade: &Factors<T>, sum: T) -> T {
        let mut base = T::ZERO;
        for ((&crept, &fade), &c) in crept.iter().zip(fade).zip(self.coefficients) {
            base = base + c * fade * crept;
        }
        (sum - base) / self.steepest(fade)
    }

    fn settled(&self, h: T) -> T {
        self.gain() * h
    }

    fn drift(&self, fade: &[T]) -> T {
        let terms = self.coefficients.iter().zip(fade);
        terms.fold(T::ZERO, |sum, (&c, &fade)| sum + c / (T::ONE - fade))
    }

    fn steepest(&self, fade: &Factors<T>) -> T {
        let terms = self.coefficients.iter().zip(fade);
        terms.fold(T::ONE, |gain, (&c, &fade)| gain + c * (T::ONE - fade))
    }
}
