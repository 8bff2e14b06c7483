//! What units say of a quantity.

use super::quantity::Quantity::{self, *};

/// Units as they are written in brackets, below a name, or at its end. Where the case tells units
/// apart it counts.
const UNITS: &[(&[&str], &[Quantity])] = &[
    (
        &[
            "s", "sec", "ms", "us", "µs", "μs", "ns", "min", "h", "hr", "sek", "seg",
        ],
        &[Time],
    ),
    (
        &[
            "C", "°C", "degC", "deg C", "℃", "K", "°F", "degF", "Celsius", "celsius",
        ],
        &[Temperature],
    ),
    (&["V", "mV", "kV", "volt", "Volt"], &[Voltage]),
    (&["A", "mA", "kA", "µA"], &[Current]),
    (&["W", "mW", "kW"], &[Power]),
    (
        &[
            "A/m", "kA/m", "Oe", "kOe", "V/m", "kV/m", "kV/cm", "kV/mm", "V/mm",
        ],
        &[Field],
    ),
    (&["bar", "mbar", "psi", "Pa", "kPa", "hPa"], &[Pressure]),
    (
        &["mm", "cm", "m", "um", "µm", "μm", "nm", "in", "inch", "mil"],
        &[Displacement],
    ),
    (&["deg", "°", "rad", "mrad", "grad"], &[Angle]),
    (&["mm/mm", "m/m", "microstrain", "µm/m", "µε"], &[Strain]),
    (&["%", "percent", "pct"], &[Drive, Strain]),
    (
        &[
            "C/m2", "C/m^2", "C/m²", "uC/cm2", "µC/cm2", "µC/cm²", "uC/cm^2",
        ],
        &[Polarization],
    ),
    (
        &["T", "mT", "Tm", "T m", "Wb", "G", "Gs", "A m2", "emu"],
        &[Flux],
    ),
    (&["Ohm", "ohm", "Ω", "mΩ", "kΩ"], &[Resistance]),
    (
        &["N", "mN", "kN", "lbf", "kgf", "Nm", "N m", "mNm"],
        &[Force],
    ),
    (&["kg", "g"], &[Load]),
    (
        &["MPa", "GPa", "N/mm2", "N/mm^2", "N/mm²", "ksi"],
        &[Stress],
    ),
];

/// What a unit may measure; nothing for one that is not known.
pub(super) fn may_measure(unit: &str) -> &'static [Quantity] {
    let unit = unit.trim();
    let found = UNITS.iter().find(|(known, _)| known.contains(&unit));
    found.map_or(&[], |(_, quantities)| quantities)
}
