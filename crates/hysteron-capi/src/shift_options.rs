//! Options of the estimator of the shift.

use crate::fault::{Result, guard};
use crate::model::MODELS;
use crate::pointer::Arguments;
use hysteron::AdaptiveLoad;
use hysteron_core::ShiftOptions;

/// Options of the estimator of the shift: of a load that nobody measures.
/// `hysteron_shift_usual` writes those that follow from a model.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronShiftOptions {
    /// Standard deviation of a reading's error, model error included, in the output's unit; above
    /// 0.
    pub noise: f64,
    /// Standard deviation of the shift at the start and after a jump, in the unit of the
    /// temperature; above 0.
    pub spread: f64,
    /// Standard deviation of the change of the shift while the temperature moves by one level, in
    /// the unit of the temperature, from 0.
    pub walk: f64,
    /// The largest shift to either side, in the unit of the temperature; above 0.
    pub reach: f64,
    /// Errors up to this are noise, in the output's unit, from 0.
    pub dead_zone: f64,
    /// Levels between two samples that are learned from, from 0.
    pub movement: f64,
    /// Readings with a surprise above so many times the usual one are refused, from 2. 0: none is.
    pub gate: f64,
    /// So many refused readings in a row that agree are a jump of the load, from 1.
    pub burst: u32,
}

/// What the estimator of the shift found.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronShift {
    /// The shift of the axis from the load that it departs from, in the unit of the temperature.
    pub shift: f64,
    /// Standard deviation of the shift, as the filter believes it.
    pub deviation: f64,
    /// The load that the shift tells. `NAN` for a model whose shift says nothing of the load.
    /// Beyond the model's loads it is the outermost one.
    pub load: f64,
}

impl From<ShiftOptions<f64>> for HysteronShiftOptions {
    fn from(options: ShiftOptions<f64>) -> Self {
        Self {
            noise: options.noise,
            spread: options.spread,
            walk: options.walk,
            reach: options.reach,
            dead_zone: options.dead_zone,
            movement: options.movement,
            gate: options.gate,
            burst: options.burst,
        }
    }
}

impl From<HysteronShiftOptions> for ShiftOptions<f64> {
    fn from(options: HysteronShiftOptions) -> Self {
        Self {
            noise: options.noise,
            spread: options.spread,
            walk: options.walk,
            reach: options.reach,
            dead_zone: options.dead_zone,
            movement: options.movement,
            gate: options.gate,
            burst: options.burst,
        }
    }
}

impl Arguments {
    /// Options that may be null.
    ///
    /// # Safety
    /// `options` is null or valid for a read.
    pub(crate) unsafe fn shift_options(
        &mut self,
        options: *const HysteronShiftOptions,
    ) -> Result<Option<ShiftOptions<f64>>> {
        if options.is_null() {
            return Ok(None);
        }
        // SAFETY: the caller's promise; every bit pattern is a value of each field.
        let options = unsafe { self.value(options, "options")? };
        Ok(Some(options.into()))
    }
}

/// Writes the usual options for `model`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_shift_usual(
    model: u64,
    options: *mut HysteronShiftOptions,
) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let options = unsafe { Arguments::default().out(options, "options")? };
        let model = MODELS.get(model, "model")?;
        options.set(AdaptiveLoad::usual_options(&model).into());
        Ok(())
    })
}
