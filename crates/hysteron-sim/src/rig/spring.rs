//! The NiTi tension spring: two-moduli design (Waram 1993) over a cross-section divided into rings.
//!
//! The wire is twisted, so its stress is zero at the axis and largest at the surface. The
//! transformation temperatures grow with the stress. Each ring is one material point. The spread of
//! their transformation temperatures makes the loops of the whole spring smooth. The stress is that
//! of the elastic bar, `τ(r) = τ_max · 2r/d` with `τ_max = 8FD/(πd³)`; the curvature of the coil
//! (Wahl's factor) and the stress that a stiffer ring takes from a softer one are left out.

use super::error::{RigError, check};
use core::f64::consts::PI;

/// Geometry and elastic constants of the spring. The default is the spring of the chapter's Table
/// 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// Wire diameter `d`, mm. Default 0.75 (the chapter's Table 1).
    pub wire_diameter_mm: f64,
    /// Mean coil diameter `D`, mm. Default 5.25: Table 1 gives 6, read as the outer diameter, less
    /// one wire.
    pub coil_diameter_mm: f64,
    /// Active coils `n`. Default 10. Table 1 does not give it: it is chosen so that the stroke
    /// under 6 N comes near the 13.5 mm that the chapter tells of with its Fig. 15.
    pub active_coils: f64,
    /// Young's modulus of austenite, GPa. Default 67 (Brinson 1993).
    pub austenite_modulus_gpa: f64,
    /// Young's modulus of martensite, GPa. Default 26.3 (Brinson 1993).
    pub martensite_modulus_gpa: f64,
    /// Poisson's ratio `ν` of both phases. Default 0.33 (Dynalloy, Flexinol technical data).
    pub poisson_ratio: f64,
    /// Rings of equal thickness that stand for the cross-section. Default 8.
    pub rings: usize,
}

impl Default for Spring {
    fn default() -> Self {
        Self {
            wire_diameter_mm: 0.75,
            coil_diameter_mm: 5.25,
            active_coils: 10.0,
            austenite_modulus_gpa: 67.0,
            martensite_modulus_gpa: 26.3,
            poisson_ratio: 0.33,
            rings: 8,
        }
    }
}

/// One ring of the cross-section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Von Mises equivalent stress `√3 τ` for each newton of load, MPa/N, at the radius that halves
    /// the ring's area.
    pub stress_mpa_per_n: f64,
    /// Polar second moment of area `J`, mm⁴.
    pub polar_moment_mm4: f64,
    /// Share of the cross-section's area; the shares sum to 1.
    pub area_share: f64,
}

impl Spring {
    /// Refuses dimensions and constants that are not those of a coil spring.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] names the first one that does not fit.
    pub fn check(&self) -> Result<(), RigError> {
        let d = self.wire_diameter_mm;
        check("wire diameter (mm)", d, 0.01, 10.0)?;
        check(
            "mean coil diameter (mm)",
            self.coil_diameter_mm,
            2.0 * d,
            1e3,
        )?;
        check("active coils", self.active_coils, 0.1, 1e4)?;
        check(
            "austenite modulus (GPa)",
            self.austenite_modulus_gpa,
            1.0,
            1e3,
        )?;
        // A stiffer martensite would make the spring sink on heating.
        let most = self.austenite_modulus_gpa;
        check(
            "martensite modulus (GPa)",
            self.martensite_modulus_gpa,
            1.0,
            most,
        )?;
        check("Poisson's ratio", self.poisson_ratio, 0.0, 0.5)?;
        check("number of rings", self.rings as f64, 1.0, 1000.0)
    }

    /// The rings of the cross-section, from the axis to the skin.
    pub fn cross_section(&self) -> impl Iterator<Item = Ring> {
        let Self {
            wire_diameter_mm: d,
            coil_diameter_mm: coil,
            rings,
            ..
        } = *self;
        // τ_max = 8FD/(πd³), here for F = 1 N.
        let tau_max = 8.0 * coil / (PI * d.powi(3));
        let moment = PI * d.powi(4) / 32.0;
        (0..rings).map(move |k| {
            let inner = k as f64 / rings as f64;
            let outer = (k + 1) as f64 / rings as f64;
            let middle = ((inner * inner + outer * outer) / 2.0).sqrt();
            Ring {
                stress_mpa_per_n: 3f64.sqrt() * tau_max * middle,
                polar_moment_mm4: moment * (outer.powi(4) - inner.powi(4)),
                area_share: outer * outer - inner * inner,
            }
        })
    }

    /// Shear modulus at the martensite fraction `xi`, MPa: both phases share the strain (Voigt).
    #[must_use]
    pub fn shear_modulus_mpa(&self, xi: f64) -> f64 {
        let shear = |young_gpa: f64| 1e3 * young_gpa / (2.0 * (1.0 + self.poisson_ratio));
        let austenite = shear(self.austenite_modulus_gpa);
        austenite + xi * (shear(self.martensite_modulus_gpa) - austenite)
    }

    /// Deflection in mm under `load_n` (N), given each ring's polar moment (mm⁴) and martensite
    /// fraction.
    ///
    /// The torque `F D/2` balances over the rings, `θ' = (F D/2) / Σ G(ξ_k) J_k`, and the wire's
    /// twist over its length `πDn` moves the load by `(D/2) θ' πDn`. For one phase that is the
    /// textbook's `8FD³n/(Gd⁴)`.
    pub fn deflection_mm(&self, load_n: f64, rings: impl Iterator<Item = (f64, f64)>) -> f64 {
        let stiffness: f64 = rings.map(|(j, xi)| self.shear_modulus_mpa(xi) * j).sum();
        let arm = self.coil_diameter_mm / 2.0;
        arm * (load_n * arm / stiffness) * self.wire_length_mm()
    }

    /// Length of the active wire `πDn`, mm.
    #[must_use]
    pub fn wire_length_mm(&self) -> f64 {
        PI * self.coil_diameter_mm * self.active_coils
    }
}
