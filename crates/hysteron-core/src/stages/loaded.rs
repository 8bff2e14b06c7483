//! What a load does, at one load.

use crate::scalar::Real;

/// The values of all curves at one load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loaded<T> {
    /// The scale `a(σ)`.
    pub scale: T,
    /// The shift `s(σ)`.
    pub shift: T,
    /// The gain `g(σ)`.
    pub gain: T,
    /// The offset `o(σ)`.
    pub offset: T,
    /// The row of the registration at the known load below.
    pub row: usize,
    /// How far the load is on the way to the next one, from 0 to 1.
    pub part: T,
}

impl<T: Real> Loaded<T> {
    /// Without a load.
    pub const NONE: Self = Loaded {
        scale: T::ONE,
        shift: T::ZERO,
        gain: T::ONE,
        offset: T::ZERO,
        row: 0,
        part: T::ZERO,
    };
}
