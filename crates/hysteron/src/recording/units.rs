//! Units as people write them, and what they measure.

/// What a unit measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Measures {
    Time,
    Temperature,
    Voltage,
    Current,
    Power,
    Field,
    Pressure,
    Length,
    Angle,
    Strain,
    Share,
    Polarization,
    Flux,
    Resistance,
    Force,
    Mass,
    Stress,
}

use Measures::{
    Angle, Current, Field, Flux, Force, Length, Mass, Polarization, Power, Pressure, Resistance,
    Share, Strain, Stress, Temperature, Time, Voltage,
};

/// Units as they are written in brackets, below a name, or at its end. Where the case tells units
/// apart it counts.
const UNITS: &[(Measures, &[&str])] = &[
    (
        Time,
        &[
            "s", "sec", "ms", "us", "µs", "μs", "ns", "min", "h", "hr", "sek", "seg",
        ],
    ),
    (
        Temperature,
        &[
            "C", "°C", "degC", "deg C", "℃", "K", "F", "°F", "degF", "Celsius", "celsius",
        ],
    ),
    (Voltage, &["V", "mV", "kV", "volt", "Volt"]),
    (Current, &["A", "mA", "kA", "µA"]),
    (Power, &["W", "mW", "kW"]),
    (
        Field,
        &[
            "A/m", "kA/m", "Oe", "kOe", "V/m", "kV/m", "kV/cm", "kV/mm", "V/mm",
        ],
    ),
    (Pressure, &["bar", "mbar", "psi", "Pa", "kPa", "hPa"]),
    (
        Length,
        &["mm", "cm", "m", "um", "µm", "μm", "nm", "in", "inch", "mil"],
    ),
    (Angle, &["deg", "°", "rad", "mrad", "grad"]),
    (Strain, &["mm/mm", "m/m", "microstrain", "µm/m", "µε"]),
    (Share, &["%", "percent", "pct"]),
    (
        Polarization,
        &[
            "C/m2", "C/m^2", "C/m²", "uC/cm2", "µC/cm2", "µC/cm²", "uC/cm^2",
        ],
    ),
    (
        Flux,
        &["T", "mT", "Tm", "T m", "Wb", "G", "Gs", "A m2", "emu"],
    ),
    (Resistance, &["Ohm", "ohm", "Ω", "mΩ", "kΩ"]),
    (Force, &["N", "mN", "kN", "lbf", "kgf", "Nm", "N m", "mNm"]),
    (Mass, &["kg", "g"]),
    (Stress, &["MPa", "GPa", "N/mm2", "N/mm^2", "N/mm²", "ksi"]),
];

impl Measures {
    /// What a unit measures; `None` for one that is not known.
    pub(crate) fn by(unit: &str) -> Option<Self> {
        let unit = unit.trim();
        let found = UNITS.iter().find(|(_, known)| known.contains(&unit));
        found.map(|(measures, _)| *measures)
    }
}
