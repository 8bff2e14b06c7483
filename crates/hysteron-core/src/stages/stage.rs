//! What a stage behind the operators has to do.

use crate::scalar::Real;

/// A stage behind the operators. It turns their sum, or what the stage before made of it, into
/// another number. For one sample it is monotone, and so it has an inverse.
pub(crate) trait Stage<T: Real> {
    /// What it remembers from one sample to the next.
    type Memory: AsRef<[T]>;
    /// What is left of the past after a time step. All zeros: nothing is left, as at rest.
    type Factors: Default;

    /// Whether it has any effect.
    fn is_there(&self) -> bool;
    /// Whether it depends on time.
    fn is_timed(&self) -> bool;
    /// The factors for a time step of `dt` seconds, 0 or more.
    fn factors(&self, dt: T) -> Self::Factors;
    /// What it remembers where `x` has always been.
    fn rest(&self, x: T) -> Self::Memory;
    /// The output for `x`.
    fn forward(&self, memory: &mut Self::Memory, factors: &Self::Factors, x: T) -> T;
    /// The `x` for which [`Stage::forward`] gives `y` in this sample. Not finite where the stage
    /// cannot move in the sample.
    fn inverse(&self, memory: &Self::Memory, factors: &Self::Factors, y: T) -> T;
    /// The output at rest, where `x` has always been.
    fn settled(&self, x: T) -> T;
    /// The steepest slope of the output over `x` in a sample with these factors.
    fn steepest(&self, factors: &Self::Factors) -> T;
    /// The slope of the output at `x` in a sample with these factors.
    fn slope(&self, factors: &Self::Factors, x: T) -> T {
        let _ = x;
        self.steepest(factors)
    }
    /// How many roundings of its output are in the output at most, because what it remembers is
    /// rounded in each sample.
    fn drift(&self, factors: &[T]) -> T {
        let _ = factors;
        T::ZERO
    }
    /// The size of the numbers that it adds to its output, whose rounding the output then has.
    fn size(&self) -> T {
        T::ZERO
    }
}
