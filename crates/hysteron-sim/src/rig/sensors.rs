//! The two sensors of the rig and their noise.
//!
//! The chapter gives each sensor's accuracy (section 7). It is read as noise: Gaussian, its
//! standard deviation a third of the accuracy, and drawn again when it falls outside ± accuracy, so
//! that no reading is worse than specified. A slow drift, the thermocouple's lag and the LVDT's
//! resolution are left out.

use super::error::{RigError, check};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// A sensor that is true up to its accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Largest error of a reading, in the unit of what is measured; 0 for a perfect sensor.
    pub accuracy: f64,
}

impl Sensor {
    /// The chapter's thermocouple: ±1 °C.
    pub const THERMOCOUPLE: Self = Self { accuracy: 1.0 };
    /// The chapter's displacement transducer (LVDT): ±0.5 mm, 1 % of its 50 mm range.
    pub const LVDT: Self = Self { accuracy: 0.5 };

    /// Refuses an accuracy that is negative or not finite.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`].
    pub fn check(&self) -> Result<(), RigError> {
        check("accuracy of a sensor", self.accuracy, 0.0, 1e6)
    }

    /// One reading of the value `truth`.
    pub fn read(&self, truth: f64, noise: &mut ChaCha8Rng) -> f64 {
        loop {
            let sigmas: f64 = StandardNormal.sample(noise);
            if sigmas.abs() <= 3.0 {
                return truth + self.accuracy * sigmas / 3.0;
            }
        }
    }
}
