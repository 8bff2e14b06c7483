//! What units say of a quantity.

use super::quantity::Quantity::{self, *};
use crate::recording::Measures;

/// What a column in this unit may be; nothing for a unit that is not known.
pub(super) fn may_measure(unit: &str) -> &'static [Quantity] {
    match Measures::by(unit) {
        None => &[],
        Some(Measures::Time) => &[Time],
        Some(Measures::Temperature) => &[Temperature],
        Some(Measures::Voltage) => &[Voltage],
        Some(Measures::Current) => &[Current],
        Some(Measures::Power) => &[Power],
        Some(Measures::Field) => &[Field],
        Some(Measures::Pressure) => &[Pressure],
        Some(Measures::Length) => &[Displacement],
        Some(Measures::Angle) => &[Angle],
        Some(Measures::Strain) => &[Strain],
        Some(Measures::Share) => &[Share, Strain],
        Some(Measures::Polarization) => &[Polarization],
        Some(Measures::Flux) => &[Flux],
        Some(Measures::Resistance) => &[Resistance],
        Some(Measures::Force) => &[Force],
        Some(Measures::Mass) => &[Load],
        Some(Measures::Stress) => &[Stress],
    }
}
