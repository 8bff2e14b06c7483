//! Whether data are in the units of the model. Numbers in another unit would be believed as they are.

use crate::error::{Error, Result};
use crate::model::Model;
use crate::recording::{Quantity, Recording};

/// Units at the end of a name, as in `temperature_C`.
const IN_NAMES: [&str; 22] = [
    "C", "degC", "F", "degF", "K", "nm", "um", "mm", "cm", "m", "in", "inch", "mV", "V", "mA", "A",
    "mN", "N", "kN", "Pa", "kPa", "MPa",
];

impl Model {
    /// Refuses a recording in other units than the model's. A unit that is missing on either side
    /// says nothing.
    ///
    /// # Errors
    /// [`Error::Fit`] that names both units.
    pub(crate) fn check_units(&self, recording: &Recording) -> Result<()> {
        self.input
            .check_unit("input of the model", &recording.input_quantity)?;
        self.output
            .check_unit("output of the model", &recording.output_quantity)
    }
}

impl Quantity {
    /// Refuses data that are meant as this quantity, `what` for a message, and have another unit.
    ///
    /// # Errors
    /// [`Error::Fit`] that names both units.
    pub(crate) fn check_unit(&self, what: &str, data: &Self) -> Result<()> {
        let (Some(expected), Some(found)) = (unit_of(self), unit_of(data)) else {
            return Ok(());
        };
        match spelt(expected) == spelt(found) {
            true => Ok(()),
            false => Err(Error::Fit(format!(
                "the {what} is in {expected}, `{}` of the data in {found}: convert the column to \
                 {expected}, and name that unit in its header",
                data.name
            ))),
        }
    }
}

/// The unit of a quantity, or the one that its name ends with.
fn unit_of(quantity: &Quantity) -> Option<&str> {
    let of_name = || {
        let (name, unit) = quantity.name.rsplit_once('_')?;
        (!name.is_empty() && IN_NAMES.contains(&unit)).then_some(unit)
    };
    quantity.unit.as_deref().or_else(of_name)
}

/// A unit without what people write differently: brackets, blanks, the sign of degrees.
fn spelt(unit: &str) -> String {
    let unit = unit.trim().trim_matches(['[', ']', '(', ')']).trim();
    let unit = unit
        .replace(['°', '˚', 'º'], "deg")
        .replace(['µ', 'μ'], "u");
    match unit.replace(' ', "").as_str() {
        "C" | "degC" | "Celsius" | "celsius" | "℃" => "degC".into(),
        "F" => "degF".into(),
        "inch" => "in".into(),
        other => other.into(),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn units_are_compared_however_they_are_written() {
        let same = [
            (Quantity::with_unit("T", "degC"), Quantity::named("T_C")),
            (
                Quantity::with_unit("T", "°C"),
                Quantity::with_unit("T", "C"),
            ),
            (
                Quantity::named("lift_mm"),
                Quantity::with_unit("lift", "[mm]"),
            ),
            (Quantity::named("lift"), Quantity::with_unit("lift", "in")),
            (Quantity::with_unit("x", "µm"), Quantity::named("x_um")),
            // No unit, but a name.
            (Quantity::with_unit("T", "degC"), Quantity::named("T_hot")),
        ];
        for (one, other) in same {
            assert!(one.check_unit("input", &other).is_ok(), "{one:?} {other:?}");
            assert!(other.check_unit("input", &one).is_ok(), "{one:?} {other:?}");
        }
        let other = [
            (Quantity::with_unit("T", "degC"), Quantity::named("T_F")),
            (
                Quantity::with_unit("T", "degC"),
                Quantity::with_unit("T", "K"),
            ),
            (Quantity::named("lift_mm"), Quantity::named("lift_um")),
        ];
        for (one, other) in other {
            let refused = one.check_unit("input", &other).unwrap_err().to_string();
            assert!(refused.contains("convert the column"), "{refused}");
        }
    }
}
