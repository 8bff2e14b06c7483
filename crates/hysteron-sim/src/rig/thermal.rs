//! The wire as one thermal body: heated by its own resistance, cooled by still air, held up by the
//! latent heat.
//!
//! `(m c + m L |dξ/dT|) dT/dt = I² R(ξ) − h(T) A (T − T_room)`, with `ξ` the martensite fraction
//! averaged over the cross-section.

use super::convection::still_air;
use super::error::{RigError, check};
use core::f64::consts::PI;

/// Thermal and electrical constants of the wire. The default is NiTi as in Dynalloy's technical
/// data of Flexinol.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wire {
    /// Density, kg/m³. Default 6450 (6.45 g/cm³).
    pub density_kg_per_m3: f64,
    /// Specific heat `c`, J/(kg·K). Default 837 (0.2 cal/(g·°C)).
    pub specific_heat_j_per_kg_k: f64,
    /// Latent heat of the whole transformation `L`, J/kg. Default 24 200 (5.78 cal/g).
    pub latent_heat_j_per_kg: f64,
    /// Resistivity of martensite, µΩ·cm. Default 76.
    pub martensite_resistivity_uohm_cm: f64,
    /// Resistivity of austenite, µΩ·cm. Default 82.
    pub austenite_resistivity_uohm_cm: f64,
    /// Longest step of the integration, s. Default 0.05, the temperature then moves by less than
    /// 0.2 K in a step.
    pub substep_s: f64,
}

impl Default for Wire {
    fn default() -> Self {
        Self {
            density_kg_per_m3: 6450.0,
            specific_heat_j_per_kg_k: 837.0,
            latent_heat_j_per_kg: 24_200.0,
            martensite_resistivity_uohm_cm: 76.0,
            austenite_resistivity_uohm_cm: 82.0,
            substep_s: 0.05,
        }
    }
}

impl Wire {
    /// Refuses constants that are not those of a metal wire.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] names the first one that does not fit.
    pub fn check(&self) -> Result<(), RigError> {
        check("density (kg/m³)", self.density_kg_per_m3, 1e3, 3e4)?;
        check(
            "specific heat (J/(kg·K))",
            self.specific_heat_j_per_kg_k,
            100.0,
            1e4,
        )?;
        check("latent heat (J/kg)", self.latent_heat_j_per_kg, 0.0, 1e6)?;
        for (what, rho) in [
            (
                "martensite resistivity (µΩ·cm)",
                self.martensite_resistivity_uohm_cm,
            ),
            (
                "austenite resistivity (µΩ·cm)",
                self.austenite_resistivity_uohm_cm,
            ),
        ] {
            check(what, rho, 1.0, 1e4)?;
        }
        check("integration step (s)", self.substep_s, 1e-5, 0.1)
    }
}

/// The thermal body that a [`Wire`] of some diameter and length is: extensive quantities in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Body {
    diameter_m: f64,
    surface_m2: f64,
    heat_capacity_j_per_k: f64,
    latent_heat_j: f64,
    martensite_ohm: f64,
    austenite_ohm: f64,
}

impl Body {
    pub(crate) fn new(wire: &Wire, diameter_mm: f64, length_mm: f64) -> Self {
        let diameter_m = diameter_mm * 1e-3;
        let length = length_mm * 1e-3;
        let area = PI * diameter_m * diameter_m / 4.0;
        let mass = wire.density_kg_per_m3 * area * length;
        let ohm = |uohm_cm: f64| uohm_cm * 1e-8 * length / area;
        Self {
            diameter_m,
            surface_m2: PI * diameter_m * length,
            heat_capacity_j_per_k: mass * wire.specific_heat_j_per_kg_k,
            latent_heat_j: mass * wire.latent_heat_j_per_kg,
            martensite_ohm: ohm(wire.martensite_resistivity_uohm_cm),
            austenite_ohm: ohm(wire.austenite_resistivity_uohm_cm),
        }
    }

    /// Electrical resistance at the martensite fraction `xi`, Ω: both phases in proportion.
    pub(super) fn resistance_ohm(&self, xi: f64) -> f64 {
        self.austenite_ohm + xi * (self.martensite_ohm - self.austenite_ohm)
    }

    /// Heat that flows into the wire, W: what the current makes less what the air takes.
    pub(crate) fn net_power_w(&self, current_a: f64, xi: f64, t_degc: f64, room_degc: f64) -> f64 {
        let h = still_air(self.diameter_m, t_degc, room_degc);
        current_a * current_a * self.resistance_ohm(xi) - h * self.surface_m2 * (t_degc - room_degc)
    }

    /// Heat content, J, at the temperature `t_degc` and the martensite fraction `xi`, over that of
    /// austenite at 0 °C: martensite has less by the latent heat.
    pub(crate) fn heat_j(&self, t_degc: f64, xi: f64) -> f64 {
        self.heat_capacity_j_per_k * t_degc - self.latent_heat_j * xi
    }

    /// The temperature, °C, at the heat content `heat_j` and the martensite fraction `xi`.
    pub(crate) fn temperature_degc(&self, heat_j: f64, xi: f64) -> f64 {
        (heat_j + self.latent_heat_j * xi) / self.heat_capacity_j_per_k
    }

    /// Heat that raises the temperature by 1 K where `ξ` changes by `slope` (1/K), J/K.
    pub(super) fn capacity_j_per_k(&self, slope: f64) -> f64 {
        self.heat_capacity_j_per_k + self.latent_heat_j * slope.abs()
    }
}
