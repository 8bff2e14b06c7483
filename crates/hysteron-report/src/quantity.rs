//! Names and units as axes and tables show them.

use crate::number::significant;
use hysteron::{Errors, Quantity};

/// A quantity that has a name, and a unit in its usual spelling.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Labelled {
    pub(crate) name: String,
    pub(crate) unit: Option<String>,
}

impl Labelled {
    /// The first of `candidates` that has a name, or `fallback` without a unit.
    pub(crate) fn first(candidates: [&Quantity; 2], fallback: &str) -> Self {
        candidates
            .into_iter()
            .find(|quantity| !quantity.name.trim().is_empty())
            .map_or_else(
                || Self {
                    name: fallback.to_owned(),
                    unit: None,
                },
                |quantity| Self {
                    name: quantity.name.trim().replace('_', " "),
                    unit: quantity
                        .unit
                        .as_deref()
                        .map(str::trim)
                        .filter(|unit| !unit.is_empty())
                        .map(spelled),
                },
            )
    }

    /// The same unit under another name.
    pub(crate) fn renamed(&self, name: &str) -> Self {
        Self {
            name: name.to_owned(),
            unit: self.unit.clone(),
        }
    }

    /// A difference of two values under another name: of temperatures in °C, it is in K.
    pub(crate) fn difference(&self, name: &str) -> Self {
        let mut difference = self.renamed(name);
        if difference.unit.as_deref() == Some("°C") {
            difference.unit = Some("K".into());
        }
        difference
    }

    /// Axis label: `temperature [°C]`; `factor` (for example `10⁻³`) stands before the unit.
    pub(crate) fn axis(&self, factor: Option<&str>) -> String {
        match (factor, self.unit.as_deref()) {
            (None, None) => self.name.clone(),
            (Some(factor), None) => format!("{} [{factor}]", self.name),
            (None, Some(unit)) => format!("{} [{unit}]", self.name),
            (Some(factor), Some(unit)) => format!("{} [{factor} {unit}]", self.name),
        }
    }

    /// A value with three significant digits and the unit.
    pub(crate) fn value(&self, value: f64) -> String {
        let number = significant(value, 3);
        match self.unit.as_deref() {
            Some(unit) if value.is_finite() => format!("{number}\u{a0}{unit}"),
            _ => number,
        }
    }

    /// `RMSE 0.12 mm, max 0.45 mm`.
    pub(crate) fn rmse_and_max(&self, errors: &Errors) -> String {
        let [rmse, max] = [errors.rmse, errors.max_abs].map(|error| self.value(error));
        format!("RMSE {rmse}, max {max}")
    }
}

/// Column headers spell units in ASCII; a figure need not.
fn spelled(unit: &str) -> String {
    match unit {
        "degC" | "deg_C" | "celsius" => "°C".into(),
        "degF" => "°F".into(),
        "deg" => "°".into(),
        "um" => "µm".into(),
        "us" => "µs".into(),
        "ohm" | "Ohm" => "Ω".into(),
        _ => unit.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quantity(name: &str, unit: Option<&str>) -> Quantity {
        Quantity {
            name: name.into(),
            unit: unit.map(Into::into),
        }
    }

    #[test]
    fn brackets_only_around_a_unit() {
        let none = quantity("", None);
        assert_eq!(
            Labelled::first([&quantity("strain", None), &none], "output").axis(None),
            "strain"
        );
        assert_eq!(
            Labelled::first([&quantity("temperature", Some("degC")), &none], "input").axis(None),
            "temperature [°C]"
        );
        assert_eq!(Labelled::first([&none, &none], "input").axis(None), "input");
        assert_eq!(
            Labelled::first([&quantity("x", Some("m")), &none], "input").axis(Some("10⁻⁶")),
            "x [10⁻⁶ m]"
        );
    }
}
