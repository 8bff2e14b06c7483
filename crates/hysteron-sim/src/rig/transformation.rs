//! The phase transformation of one material point: martensite ⇄ austenite, with partial loops.
//!
//! - **Major branches**: cosines between the transformation temperatures (Liang & Rogers 1990,
//!   Brinson 1993).
//! - **Stress** shifts the transformation temperatures, `Mₛ(σ) = Mₛ + σ/C_M`, `Aₛ(σ) = Aₛ + σ/C_A`.
//!   Equivalently, the point is driven by the temperatures `θ_M = T − σ/C_M` (cooling) and `θ_A = T
//!   − σ/C_A` (heating), so a change of load drives the same law as a change of temperature.
//! - **Partial loops** scale the major branch between the turning point that was left and the one
//!   that the branch returns to, `ξ = ξ_to + (ξ_from − ξ_to) · (f(θ) − f(θ_to)) / (f(θ_from) −
//!   f(θ_to))`. When the branch leads to complete transformation this is the multiplicative rule of
//!   Ivshin & Pence 1994, `ξ = ξ_from · f(θ)/f(θ_from)` on heating and the same for `1 − ξ` on
//!   cooling.
//!
//! Ivshin & Pence apply their rule to nested reversals too; nested loops then do not close. Real
//! alloys remember their turning points (Šittner et al. 2000, as the chapter's section 2 says;
//! Tanaka et al. 1995 and Bo & Lagoudas 1999 build it into their laws), so the rule is here applied
//! between remembered turning points. Unlike a Preisach model the law has no congruent loops: the
//! height of a loop depends on where it lies.

use super::error::{RigError, check};
use core::f64::consts::PI;

/// Constants of the transformation. The default is the NiTi of Brinson 1993 (Table 1, after Dye
/// 1990 and Liang 1990).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transformation {
    /// Martensite finish temperature without stress, °C. Default 9.
    pub martensite_finish_degc: f64,
    /// Martensite start temperature without stress, °C. Default 18.4.
    pub martensite_start_degc: f64,
    /// Austenite start temperature without stress, °C. Default 34.5.
    pub austenite_start_degc: f64,
    /// Austenite finish temperature without stress, °C. Default 49.
    pub austenite_finish_degc: f64,
    /// Stress that shifts the martensite temperatures by 1 K, `C_M`, MPa/K. Default 8.
    pub martensite_slope_mpa_per_k: f64,
    /// Stress that shifts the austenite temperatures by 1 K, `C_A`, MPa/K. Default 13.8.
    pub austenite_slope_mpa_per_k: f64,
}

impl Default for Transformation {
    fn default() -> Self {
        Self {
            martensite_finish_degc: 9.0,
            martensite_start_degc: 18.4,
            austenite_start_degc: 34.5,
            austenite_finish_degc: 49.0,
            martensite_slope_mpa_per_k: 8.0,
            austenite_slope_mpa_per_k: 13.8,
        }
    }
}

/// Which way the transformation is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Towards austenite: the temperature rises or the stress falls.
    Heating,
    /// Towards martensite: the temperature falls or the stress rises.
    Cooling,
}

impl Transformation {
    /// Refuses temperatures out of order and slopes that are not positive.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] names the first constant that does not fit.
    pub fn check(&self) -> Result<(), RigError> {
        let (mf, ms) = (self.martensite_finish_degc, self.martensite_start_degc);
        let (a_s, af) = (self.austenite_start_degc, self.austenite_finish_degc);
        check("martensite finish temperature (degC)", mf, -200.0, 500.0)?;
        check("martensite start temperature (degC)", ms, mf + 0.1, 500.0)?;
        check("austenite start temperature (degC)", a_s, mf, 500.0)?;
        check(
            "austenite finish temperature (degC)",
            af,
            a_s.max(ms) + 0.1,
            500.0,
        )?;
        let (cm, ca) = (
            self.martensite_slope_mpa_per_k,
            self.austenite_slope_mpa_per_k,
        );
        check("martensite stress slope (MPa/K)", cm, 0.1, 1e6)?;
        check("austenite stress slope (MPa/K)", ca, 0.1, 1e6)
    }

    /// Driving temperatures at the temperature `t` (°C) and the stress `sigma` (MPa).
    fn drive(&self, t: f64, sigma: f64) -> Drive {
        Drive {
            heating: t - sigma / self.austenite_slope_mpa_per_k,
            cooling: t - sigma / self.martensite_slope_mpa_per_k,
        }
    }

    /// Martensite fraction on the major branch and its slope (1/K) at the driving temperature
    /// `theta` (°C).
    #[must_use]
    pub fn major(&self, direction: Direction, theta: f64) -> (f64, f64) {
        let (start, end) = match direction {
            Direction::Heating => (self.austenite_start_degc, self.austenite_finish_degc),
            Direction::Cooling => (self.martensite_finish_degc, self.martensite_start_degc),
        };
        if theta <= start {
            (1.0, 0.0)
        } else if theta >= end {
            (0.0, 0.0)
        } else {
            let phase = PI * (theta - start) / (end - start);
            let slope = -0.5 * PI / (end - start) * phase.sin();
            (0.5 * (1.0 + phase.cos()), slope)
        }
    }
}

/// The two temperatures that drive the law, °C.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Drive {
    heating: f64,
    cooling: f64,
}

impl Drive {
    fn along(self, direction: Direction) -> f64 {
        match direction {
            Direction::Heating => self.heating,
            Direction::Cooling => self.cooling,
        }
    }
}

/// Where the point was, and the martensite fraction there.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Turn {
    drive: Drive,
    fraction: f64,
}

/// The state of one material point: where it is and the turning points that it remembers.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialPoint {
    here: Turn,
    direction: Direction,
    /// Even places: lower turning points, odd places: upper ones, each pair within the one before.
    /// The first two are complete martensite and complete austenite; the last one is where the
    /// present branch set out.
    turns: Vec<Turn>,
}

/// A branch followed up to some driving temperature.
struct Trace {
    from: Turn,
    /// How many turning points below `from` are not wiped out.
    kept: usize,
    fraction: f64,
    slope: f64,
}

impl MaterialPoint {
    /// A point cooled from complete austenite to the temperature `t` (°C) under the constant stress
    /// `sigma` (MPa).
    #[must_use]
    pub fn cooled_from_austenite(law: &Transformation, t: f64, sigma: f64) -> Self {
        let extreme = |theta, fraction| Turn {
            drive: Drive {
                heating: theta,
                cooling: theta,
            },
            fraction,
        };
        let drive = law.drive(t, sigma);
        let (fraction, _) = law.major(Direction::Cooling, drive.cooling);
        Self {
            here: Turn { drive, fraction },
            direction: Direction::Cooling,
            turns: vec![extreme(f64::NEG_INFINITY, 1.0), extreme(f64::INFINITY, 0.0)],
        }
    }

    /// Martensite fraction `ξ`, from 0 (austenite) to 1 (martensite).
    #[must_use]
    pub fn fraction(&self) -> f64 {
        self.here.fraction
    }

    /// Moves the point to the temperature `t` (°C) and the stress `sigma` (MPa).
    ///
    /// The path between is taken as monotone in each driving temperature; then its pace and its
    /// division into steps change nothing. Where the stress rises so much faster than the
    /// temperature that both transformations are driven at once, the reverse one goes first.
    pub fn advance(&mut self, law: &Transformation, t: f64, sigma: f64) {
        let drive = law.drive(t, sigma);
        if drive.heating > self.here.drive.heating {
            self.travel(law, Direction::Heating, drive.heating);
            self.here.drive.heating = drive.heating;
        }
        if drive.cooling < self.here.drive.cooling {
            self.travel(law, Direction::Cooling, drive.cooling);
        }
        self.here.drive = drive;
    }

    /// Martensite fraction and its slope over temperature (1/K, ≤ 0) that
    /// [`advance`](Self::advance) would reach at `t` (°C) in the given direction, with the state
    /// left as it is.
    #[must_use]
    pub fn ahead(
        &self,
        law: &Transformation,
        direction: Direction,
        t: f64,
        sigma: f64,
    ) -> (f64, f64) {
        let trace = self.trace(law, direction, law.drive(t, sigma).along(direction));
        (trace.fraction, trace.slope)
    }

    fn travel(&mut self, law: &Transformation, direction: Direction, theta: f64) {
        let trace = self.trace(law, direction, theta);
        self.turns.truncate(trace.kept);
        self.turns.push(trace.from);
        self.direction = direction;
        self.here.fraction = trace.fraction;
    }

    /// Follows the branch in `direction` to the driving temperature `theta`, wiping out the turning
    /// points it passes.
    fn trace(&self, law: &Transformation, direction: Direction, theta: f64) -> Trace {
        let mut kept = self.turns.len();
        let mut from = self.here;
        if direction == self.direction {
            kept -= 1;
            from = self.turns[kept];
        }
        let passed = |to: &Turn| match direction {
            Direction::Heating => theta >= to.drive.heating,
            Direction::Cooling => theta <= to.drive.cooling,
        };
        // The first two turning points lie at infinity, so at least one of them is always left to
        // go to.
        while kept > 2 && passed(&self.turns[kept - 1]) {
            kept -= 2;
            from = self.turns[kept];
        }
        let to = self.turns[kept - 1];
        let at = |theta| law.major(direction, theta);
        let (left, _) = at(from.drive.along(direction));
        let (end, _) = at(to.drive.along(direction));
        let (major, slope) = at(theta);
        // 0/0: the major branch is level between the two turning points, nothing transforms.
        let span = left - end;
        let scale = if span == 0.0 {
            0.0
        } else {
            (from.fraction - to.fraction) / span
        };
        let fraction = if span == 0.0 {
            from.fraction
        } else {
            to.fraction + scale * (major - end)
        };
        // A branch only ever goes on in its own direction, also when the stress has moved the two
        // driving temperatures apart.
        let reached = self.here.fraction;
        let fraction = match direction {
            Direction::Heating => fraction.clamp(0.0, reached),
            Direction::Cooling => fraction.clamp(reached, 1.0),
        };
        Trace {
            from,
            kept,
            fraction,
            slope: (scale * slope).min(0.0),
        }
    }
}
