//! Whether data are in the units of the model. Numbers in another unit would be believed as they are.

use crate::error::{Error, Result};
use crate::model::Model;
use crate::recording::{Measures, Quantity, Recording};

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
        let Some((expected, found)) = units(self, data) else {
            return Ok(());
        };
        if spelt(expected) == spelt(found) {
            return Ok(());
        }
        let kinds = [expected, found].map(|unit| Measures::by(unit).map(kind));
        let others = kinds.iter().all(Option::is_some) && kinds[0] != kinds[1];
        let what_to_do = match others {
            true => {
                "that is another quantity: take another column, or a recording of this actuator"
                    .into()
            }
            false => {
                format!("convert the column to {expected}, and name that unit in its header")
            }
        };
        Err(Error::Fit(format!(
            "the {what} is in {expected}, `{}` of the data in {found}: {what_to_do}",
            data.name
        )))
    }
}

/// What is converted into each other is of one kind.
fn kind(measures: Measures) -> Measures {
    match measures {
        Measures::Pressure => Measures::Stress,
        Measures::Share => Measures::Strain,
        Measures::Mass => Measures::Force,
        other => other,
    }
}

/// The units of two quantities, if both are known. The end of a name is a unit only if it measures
/// what the other one does: `voltage_in` is no length.
fn units<'a>(one: &'a Quantity, other: &'a Quantity) -> Option<(&'a str, &'a str)> {
    let of_name = |quantity: &'a Quantity| {
        let (name, unit) = quantity.name.rsplit_once('_')?;
        (!name.is_empty() && Measures::by(unit).is_some()).then_some(unit)
    };
    let of = |quantity: &'a Quantity| quantity.unit.as_deref().or_else(|| of_name(quantity));
    let (a, b) = (of(one)?, of(other)?);
    let alike = Measures::by(a) == Measures::by(b);
    (alike || one.unit.is_some() && other.unit.is_some()).then_some((a, b))
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
    use crate::model::{Plane, Sign, Start};
    use hysteron_core::Operator;

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
            (
                Quantity::with_unit("drive", "V"),
                Quantity::named("voltage_in"),
            ),
            (Quantity::named("voltage_V"), Quantity::named("voltage_in")),
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

    #[test]
    fn a_unit_of_another_quantity_is_not_converted() {
        let refused = |one: &str, other: &str| {
            let [one, other] = [one, other].map(|unit| Quantity::with_unit("x", unit));
            one.check_unit("input", &other).unwrap_err().to_string()
        };
        for (one, other) in [("degC", "V"), ("mm", "N")] {
            assert!(
                refused(one, other).contains("another quantity"),
                "{one} {other}"
            );
        }
        for (one, other) in [("MPa", "bar"), ("%", "mm/mm"), ("N", "kg")] {
            assert!(refused(one, other).contains("convert"), "{one} {other}");
        }
    }

    #[test]
    fn no_model_is_judged_on_data_in_another_unit() {
        let plane = Plane::new(1.0, 4.0, 4).unwrap();
        let mut model =
            Model::new(Operator::Mkp, plane, vec![1.0; 10], 0.0, Sign::Positive).unwrap();
        let input: Vec<f64> = (0..40).map(|n| 2.0 + (f64::from(n) * 0.3).sin()).collect();
        let mut recording = Recording::new(input.clone(), input).unwrap();
        for unit in ["degC", "degF"] {
            model.input = Quantity::with_unit("T", "degC");
            recording.input_quantity = Quantity::with_unit("T", unit);
            let is_taken = unit == "degC";
            let ran = crate::forward(&model, &recording, Start::Off).is_ok();
            let judged = crate::evaluate_from(&model, &recording, Start::Off).is_ok();
            assert_eq!([ran, judged], [is_taken; 2], "{unit}");
        }
    }
}
