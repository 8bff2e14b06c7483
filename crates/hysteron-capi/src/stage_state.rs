//! What body, creep and lag remember, as a structure of numbers.

use crate::fault::{Result, guard};
use crate::pointer::Arguments;
use crate::state::STATES;
use hysteron_core::{MAX_CREEP, StageState};

/// The largest number of creep terms.
pub const HYSTERON_CREEP_TERMS: usize = 4;

const _: () = assert!(HYSTERON_CREEP_TERMS == MAX_CREEP);

/// What body, creep and lag remember from one sample to the next. All zeros: there was no sample
/// yet. A copy of it is a saved state.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct HysteronStageState {
    /// 1 after the first sample, 0 before it. Body, creep and lag are at rest with that sample.
    pub started: f64,
    /// The temperature; without a thermal body, the input itself.
    pub temperature: f64,
    /// The output of each creep term.
    pub creep: [f64; HYSTERON_CREEP_TERMS],
    /// The sum of the operators after creep and lag.
    pub lagged: f64,
}

impl HysteronStageState {
    pub(crate) fn core(&self) -> Result<StageState<f64>> {
        Ok(StageState::from_numbers(&self.numbers())?)
    }

    fn numbers(&self) -> [f64; MAX_CREEP + 3] {
        let [a, b, c, d] = self.creep;
        [self.started, self.temperature, a, b, c, d, self.lagged]
    }
}

impl From<[f64; MAX_CREEP + 3]> for HysteronStageState {
    fn from(numbers: [f64; MAX_CREEP + 3]) -> Self {
        let [started, temperature, a, b, c, d, lagged] = numbers;
        Self {
            started,
            temperature,
            creep: [a, b, c, d],
            lagged,
        }
    }
}

/// Saves what body, creep and lag remember. Together with `hysteron_state_save` it is the whole
/// state. A model without stages needs it not.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_save_stages(
    state: u64,
    stages: *mut HysteronStageState,
) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let stages = unsafe { Arguments::default().out(stages, "stages")? };
        let running = STATES.get(state, "state")?;
        stages.set(running.state().stage_numbers().into());
        Ok(())
    })
}

/// Restores, bit for bit, what `hysteron_state_save_stages` gave. Call it after
/// `hysteron_state_restore`, which puts body, creep and lag at rest with the next sample.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_restore_stages(
    state: u64,
    stages: *const HysteronStageState,
) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate; every bit pattern is a value of each field.
        let stages = unsafe { Arguments::default().value(stages, "stages")? };
        let running = STATES.get(state, "state")?;
        running.moved(|_, state| {
            *state = state.clone().with_stage_numbers(&stages.numbers())?;
            Ok(())
        })
    })
}

/// Writes the temperature after the last sample: the input itself for a model without a thermal
/// body, and the bottom of the plane before the first sample.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_state_temperature(state: u64, temperature: *mut f64) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let temperature = unsafe { Arguments::default().out(temperature, "temperature")? };
        temperature.set(STATES.get(state, "state")?.state().temperature());
        Ok(())
    })
}
