//! Limits of the inverse.

use crate::codes::HYSTERON_VALUE;
use crate::fault::{Fault, Result, guard};
use crate::model::MODELS;
use crate::pointer::Arguments;

/// Limits of the inverse. `hysteron_model_limits` writes those that a model has of its own.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronLimits {
    /// Lowest input, in its unit: the lowest drive of a model with a thermal body. `-INFINITY` for
    /// none.
    pub drive_min: f64,
    /// Highest input. `INFINITY` for none.
    pub drive_max: f64,
    /// Seconds in which a thermal body reaches the temperature it needs, from 0; the time step
    /// where that is longer. With a longer horizon noise of the target moves the drive less, and
    /// the output follows late.
    pub horizon: f64,
    /// Lowest temperature, as what comes next may need it: of the input itself without a thermal
    /// body. `-INFINITY` for none.
    pub temperature_min: f64,
    /// Highest temperature. `INFINITY` for none.
    pub temperature_max: f64,
}

impl HysteronLimits {
    /// No limits.
    pub(crate) const NONE: Self = Self {
        drive_min: f64::NEG_INFINITY,
        drive_max: f64::INFINITY,
        horizon: 0.0,
        temperature_min: f64::NEG_INFINITY,
        temperature_max: f64::INFINITY,
    };

    pub(crate) fn drive(&self) -> (f64, f64) {
        (self.drive_min, self.drive_max)
    }

    pub(crate) fn temperature(&self) -> (f64, f64) {
        (self.temperature_min, self.temperature_max)
    }

    fn checked(self) -> Result<Self> {
        let ordered =
            |(min, max): (f64, f64)| min <= max && min < f64::INFINITY && max > f64::NEG_INFINITY;
        let fault = |name| Err(Fault::Call(HYSTERON_VALUE, name));
        if !ordered(self.drive()) {
            return fault("drive_min");
        }
        if !ordered(self.temperature()) {
            return fault("temperature_min");
        }
        if !(self.horizon >= 0.0 && self.horizon.is_finite()) {
            return fault("horizon");
        }
        Ok(self)
    }
}

impl Arguments {
    /// Limits that may be null, checked. Take them last, so that shared memory is found first.
    ///
    /// # Safety
    /// `limits` is null or valid for a read.
    pub(crate) unsafe fn limits(
        &mut self,
        limits: *const HysteronLimits,
    ) -> Result<Option<HysteronLimits>> {
        if limits.is_null() {
            return Ok(None);
        }
        // SAFETY: the caller's promise; every bit pattern is a value of each field.
        unsafe { self.value(limits, "limits")? }.checked().map(Some)
    }
}

/// Writes the limits that the inverse of `model` has where none are given. The drive stays within
/// that of the recording fitted, and the horizon is 0. A model without a thermal body has no
/// limits.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_limits(model: u64, limits: *mut HysteronLimits) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let limits = unsafe { Arguments::default().out(limits, "limits")? };
        let (drive_min, drive_max) = MODELS.get(model, "model")?.drive_range();
        limits.set(HysteronLimits {
            drive_min,
            drive_max,
            ..HysteronLimits::NONE
        });
        Ok(())
    })
}
