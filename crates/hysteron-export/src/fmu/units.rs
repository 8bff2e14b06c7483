//! Units as FMI defines them: by SI base units, a factor and an offset.

use std::f64::consts::PI;

/// `value in SI = factor · value + offset`, in `base` units with exponents.
#[derive(Debug, PartialEq)]
pub(super) struct BaseUnit {
    pub(super) exponents: &'static [(&'static str, i32)],
    pub(super) factor: f64,
    pub(super) offset: f64,
}

const LENGTH: &[(&str, i32)] = &[("m", 1)];
const FORCE: &[(&str, i32)] = &[("kg", 1), ("m", 1), ("s", -2)];
const PRESSURE: &[(&str, i32)] = &[("kg", 1), ("m", -1), ("s", -2)];
const VOLTAGE: &[(&str, i32)] = &[("kg", 1), ("m", 2), ("s", -3), ("A", -1)];
const POWER: &[(&str, i32)] = &[("kg", 1), ("m", 2), ("s", -3)];
const CURRENT: &[(&str, i32)] = &[("A", 1)];
const INDUCTION: &[(&str, i32)] = &[("kg", 1), ("s", -2), ("A", -1)];
const MAGNETISATION: &[(&str, i32)] = &[("A", 1), ("m", -1)];
const FIELD: &[(&str, i32)] = &[("kg", 1), ("m", 1), ("s", -3), ("A", -1)];
const POLARISATION: &[(&str, i32)] = &[("A", 1), ("s", 1), ("m", -2)];
const TIME: &[(&str, i32)] = &[("s", 1)];
const TEMPERATURE: &[(&str, i32)] = &[("K", 1)];
const ANGLE: &[(&str, i32)] = &[("rad", 1)];

/// What a unit means, where it is known.
pub(super) fn base(unit: &str) -> Option<BaseUnit> {
    // Two signs look like µ.
    let plain = unit.replace(['µ', 'μ'], "u");
    let (exponents, factor) = match plain.as_str() {
        "K" => (TEMPERATURE, 1.0),
        "degC" | "°C" | "℃" | "deg C" => return Some(celsius()),
        "degF" | "°F" => return Some(fahrenheit()),
        "m" => (LENGTH, 1.0),
        "cm" => (LENGTH, 1e-2),
        "mm" => (LENGTH, 1e-3),
        "um" => (LENGTH, 1e-6),
        "nm" => (LENGTH, 1e-9),
        "N" => (FORCE, 1.0),
        "mN" => (FORCE, 1e-3),
        "kN" => (FORCE, 1e3),
        "Pa" => (PRESSURE, 1.0),
        "kPa" => (PRESSURE, 1e3),
        "MPa" => (PRESSURE, 1e6),
        "GPa" => (PRESSURE, 1e9),
        "bar" => (PRESSURE, 1e5),
        "V" => (VOLTAGE, 1.0),
        "mV" => (VOLTAGE, 1e-3),
        "kV" => (VOLTAGE, 1e3),
        "W" => (POWER, 1.0),
        "mW" => (POWER, 1e-3),
        "A" => (CURRENT, 1.0),
        "mA" => (CURRENT, 1e-3),
        "T" => (INDUCTION, 1.0),
        "mT" => (INDUCTION, 1e-3),
        "A/m" => (MAGNETISATION, 1.0),
        "kA/m" => (MAGNETISATION, 1e3),
        "V/m" => (FIELD, 1.0),
        "kV/mm" | "MV/m" => (FIELD, 1e6),
        "C/m2" | "C/m^2" | "C/m²" => (POLARISATION, 1.0),
        "uC/cm2" | "uC/cm^2" | "uC/cm²" => (POLARISATION, 1e-2),
        "s" => (TIME, 1.0),
        "ms" => (TIME, 1e-3),
        "min" => (TIME, 60.0),
        "h" => (TIME, 3600.0),
        "rad" => (ANGLE, 1.0),
        "deg" | "°" => (ANGLE, PI / 180.0),
        "1" => (&[][..], 1.0),
        "%" => (&[][..], 1e-2),
        _ => return None,
    };
    Some(BaseUnit {
        exponents,
        factor,
        offset: 0.0,
    })
}

fn celsius() -> BaseUnit {
    BaseUnit {
        exponents: TEMPERATURE,
        factor: 1.0,
        offset: 273.15,
    }
}

fn fahrenheit() -> BaseUnit {
    BaseUnit {
        exponents: TEMPERATURE,
        factor: 5.0 / 9.0,
        offset: 459.67 * 5.0 / 9.0,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::base;

    #[test]
    fn known_points_of_the_scales() {
        let si = |unit, value| {
            let unit = base(unit).unwrap();
            unit.factor * value + unit.offset
        };
        assert_eq!(si("°C", 0.0), 273.15);
        // Boiling water, to rounding.
        assert!((si("degF", 212.0) - 373.15_f64).abs() < 1e-12);
        assert_eq!(si("µm", 1.0), si("μm", 1.0));
        assert_eq!(si("um", 2.0), 2e-6);
        // 1 µC/cm² is 10 mC/m².
        assert_eq!(si("µC/cm²", 1.0), 0.01);
        assert!(base("furlong").is_none());
    }
}
