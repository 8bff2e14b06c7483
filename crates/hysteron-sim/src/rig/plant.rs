//! The plant: current in, temperature and displacement out.

use super::error::{RigError, check};
use super::spring::{Ring, Spring};
use super::thermal::{Body, Wire};
use super::transformation::{Direction, MaterialPoint, Transformation};

/// Largest current that a step accepts, A: at this the wire would glow.
const MAX_CURRENT_A: f64 = 10.0;
/// Longest time that one step may span, s.
const MAX_STEP_S: f64 = 1e5;

/// What the rig is made of and where it stands. The default is the chapter's section 5.2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rig {
    /// The phase transformation of the alloy.
    pub transformation: Transformation,
    /// The spring.
    pub spring: Spring,
    /// Thermal and electrical constants of its wire.
    pub wire: Wire,
    /// Room temperature, °C, from −50 to 200. Default 22.
    pub room_degc: f64,
    /// Load that hangs on the spring, N, from 0 to 1000. Default 6.
    pub load_n: f64,
    /// Pre-deformation, mm, from 0 to 20: how far the spring was stretched, when it was cold,
    /// beyond what the load stretches it. Default 0.
    ///
    /// Martensite keeps it and austenite takes it back, the term `ε_L ξ` of Brinson 1993, so it
    /// makes the stroke longer and leaves the temperatures as they are. That the load stretches new
    /// martensite as far again on each cooling (stress-assisted two-way effect) is taken for
    /// granted.
    pub predeformation_mm: f64,
}

impl Default for Rig {
    fn default() -> Self {
        Self {
            transformation: Transformation::default(),
            spring: Spring::default(),
            wire: Wire::default(),
            room_degc: 22.0,
            load_n: 6.0,
            predeformation_mm: 0.0,
        }
    }
}

/// The simulated plant in motion. It is a stand-in for an experiment, made from published laws of
/// the material; it is not a hysteresis model of this toolkit.
///
/// ```
/// use hysteron_sim::rig::{Plant, Rig};
///
/// let mut plant = Plant::new(Rig::default())?;
/// plant.step(2.0, 30.0)?; // 2 A for 30 s
/// assert!(plant.temperature_degc() > 60.0);
/// assert!(plant.displacement_mm() > 5.0);
/// # Ok::<(), hysteron_sim::rig::RigError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Plant {
    rig: Rig,
    body: Body,
    cold_deflection_mm: f64,
    temperature_degc: f64,
    shift_k: f64,
    rings: Vec<(Ring, MaterialPoint)>,
}

impl Plant {
    /// A plant at rest at room temperature, cooled to it from complete austenite under its load.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] names the first number of `rig` that does not fit.
    pub fn new(rig: Rig) -> Result<Self, RigError> {
        rig.transformation.check()?;
        rig.spring.check()?;
        rig.wire.check()?;
        check_room(rig.room_degc)?;
        check_load(rig.load_n)?;
        check_predeformation(rig.predeformation_mm)?;
        let cooled = |ring: Ring| {
            let sigma = ring.stress_mpa_per_n * rig.load_n;
            let point =
                MaterialPoint::cooled_from_austenite(&rig.transformation, rig.room_degc, sigma);
            (ring, point)
        };
        let mut plant = Self {
            rig,
            body: Body::new(
                &rig.wire,
                rig.spring.wire_diameter_mm,
                rig.spring.wire_length_mm(),
            ),
            cold_deflection_mm: 0.0,
            temperature_degc: rig.room_degc,
            shift_k: 0.0,
            rings: rig.spring.cross_section().map(cooled).collect(),
        };
        plant.cold_deflection_mm = plant.deflection_mm();
        Ok(plant)
    }

    /// Lets the constant current `current_a` (A, from −10 to 10) flow for `dt_s` (s, from 0 to 100
    /// 000).
    ///
    /// The result does not depend on how the caller divides time, up to the error of the
    /// integration, because the plant takes steps of its own within `dt_s`, none longer than
    /// [`Wire::substep_s`].
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] if either number is not finite or outside its range.
    pub fn step(&mut self, current_a: f64, dt_s: f64) -> Result<(), RigError> {
        check("current (A)", current_a, -MAX_CURRENT_A, MAX_CURRENT_A)?;
        check("time step (s)", dt_s, 0.0, MAX_STEP_S)?;
        let steps = (dt_s / self.rig.wire.substep_s).ceil();
        for _ in 0..steps as u64 {
            self.substep(current_a, dt_s / steps);
        }
        Ok(())
    }

    /// Changes the load to `load_n` (N, from 0 to 1000) at constant temperature. The heat of the
    /// transformation that this drives is left out.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] if the load is not finite or outside its range.
    pub fn set_load_n(&mut self, load_n: f64) -> Result<(), RigError> {
        check_load(load_n)?;
        self.rig.load_n = load_n;
        self.transform(self.temperature_degc);
        Ok(())
    }

    /// Changes the room temperature to `room_degc` (°C, from −50 to 200).
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] if the temperature is not finite or outside its range.
    pub fn set_room_degc(&mut self, room_degc: f64) -> Result<(), RigError> {
        check_room(room_degc)?;
        self.rig.room_degc = room_degc;
        Ok(())
    }

    /// Changes the pre-deformation to `predeformation_mm` (mm, from 0 to 20), see
    /// [`Rig::predeformation_mm`].
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] if the number is not finite or outside its range.
    pub fn set_predeformation_mm(&mut self, predeformation_mm: f64) -> Result<(), RigError> {
        check_predeformation(predeformation_mm)?;
        self.rig.predeformation_mm = predeformation_mm;
        Ok(())
    }

    /// Raises all four transformation temperatures to `shift_k` (K, from −50 to 50) above those of
    /// [`Rig::transformation`], at constant temperature. The heat of the transformation that this
    /// drives is left out.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] if the number is not finite or outside its range.
    pub fn set_transformation_shift_k(&mut self, shift_k: f64) -> Result<(), RigError> {
        check(
            "shift of the transformation temperatures (K)",
            shift_k,
            -50.0,
            50.0,
        )?;
        self.shift_k = shift_k;
        self.transform(self.temperature_degc);
        Ok(())
    }

    /// What the plant is made of, with its present load, pre-deformation and room temperature.
    #[must_use]
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// Temperature of the wire, °C.
    #[must_use]
    pub fn temperature_degc(&self) -> f64 {
        self.temperature_degc
    }

    /// How far the load is lifted above where it hung when the plant was new and cold, mm. Under
    /// the load of that time it is never below zero; a heavier load can pull it below.
    #[must_use]
    pub fn displacement_mm(&self) -> f64 {
        self.cold_deflection_mm - self.deflection_mm()
    }

    /// Martensite fraction averaged over the cross-section's area, from 0 to 1.
    #[must_use]
    pub fn martensite_fraction(&self) -> f64 {
        let share = |(ring, point): &(Ring, MaterialPoint)| ring.area_share * point.fraction();
        self.rings.iter().map(share).sum()
    }

    /// Electrical resistance of the active wire, Ω.
    #[must_use]
    pub fn resistance_ohm(&self) -> f64 {
        self.body.resistance_ohm(self.martensite_fraction())
    }

    fn deflection_mm(&self) -> f64 {
        let rings = self
            .rings
            .iter()
            .map(|(ring, point)| (ring.polar_moment_mm4, point.fraction()));
        let (all, martensite) =
            self.rings
                .iter()
                .fold((0.0, 0.0), |(all, martensite), (ring, point)| {
                    let j = ring.polar_moment_mm4;
                    (all + j, martensite + j * point.fraction())
                });
        self.rig.spring.deflection_mm(self.rig.load_n, rings)
            + self.rig.predeformation_mm * martensite / all
    }

    /// One step of the classical Runge–Kutta method of order 4. The caller has checked the current
    /// and keeps `h` (s) at most [`Wire::substep_s`].
    pub(crate) fn substep(&mut self, current_a: f64, h: f64) {
        let t = self.temperature_degc;
        let power = |xi, t| self.body.net_power_w(current_a, xi, t, self.rig.room_degc);
        // The current is constant, so the temperature moves one way within a step; the branch is
        // that of its start.
        let direction = if power(self.martensite_fraction(), t) >= 0.0 {
            Direction::Heating
        } else {
            Direction::Cooling
        };
        let rate = |t: f64| {
            let (xi, slope) = self.ahead(direction, t);
            power(xi, t) / self.body.capacity_j_per_k(slope)
        };
        let k1 = rate(t);
        let k2 = rate(t + 0.5 * h * k1);
        let k3 = rate(t + 0.5 * h * k2);
        let k4 = rate(t + h * k3);
        self.transform(t + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4));
    }

    /// Mean martensite fraction and its slope (1/K) at `t` (°C), reached in `direction`.
    fn ahead(&self, direction: Direction, t: f64) -> (f64, f64) {
        let law = &self.rig.transformation;
        self.rings
            .iter()
            .fold((0.0, 0.0), |(xi, slope), (ring, point)| {
                let sigma = ring.stress_mpa_per_n * self.rig.load_n;
                let (ring_xi, ring_slope) = point.ahead(law, direction, t - self.shift_k, sigma);
                (
                    xi + ring.area_share * ring_xi,
                    slope + ring.area_share * ring_slope,
                )
            })
    }

    fn transform(&mut self, t: f64) {
        self.temperature_degc = t;
        for (ring, point) in &mut self.rings {
            let sigma = ring.stress_mpa_per_n * self.rig.load_n;
            point.advance(&self.rig.transformation, t - self.shift_k, sigma);
        }
    }
}

fn check_predeformation(predeformation_mm: f64) -> Result<(), RigError> {
    check("pre-deformation (mm)", predeformation_mm, 0.0, 20.0)
}

fn check_room(room_degc: f64) -> Result<(), RigError> {
    check("room temperature (degC)", room_degc, -50.0, 200.0)
}

/// The stress shifts the start of the martensite (8 MPa/K) faster than the end of the austenite
/// (13.8 MPa/K): from some 500 MPa at the skin, 10 N on the default spring, partial loops of the
/// outer rings are too steep to be trusted, and beyond 580 MPa the law turns over.
fn check_load(load_n: f64) -> Result<(), RigError> {
    check("load (N)", load_n, 0.0, 1000.0)
}
