//! What the stages remember, as a structure of numbers.

use crate::fault::{Result, guard};
use crate::pointer::Arguments;
use crate::state::STATES;
use hysteron_core::{STATE_NUMBERS, StageState};

/// How many numbers the stages behind the operators remember.
pub const HYSTERON_BEHIND: usize = 5;

const _: () = assert!(2 + HYSTERON_BEHIND == STATE_NUMBERS);

/// What the stages remember from one sample to the next. All zeros: there was no sample yet. A copy
/// of it is a saved state.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct HysteronStageState {
    /// 1 after the first sample, 0 before it. The stages are at rest with that sample.
    pub started: f64,
    /// The temperature; without a thermal body, the input itself.
    pub temperature: f64,
    /// What each stage behind the operators remembers.
    pub behind: [f64; HYSTERON_BEHIND],
}

impl HysteronStageState {
    pub(crate) fn core(&self) -> Result<StageState<f64>> {
        Ok(StageState::from_numbers(&self.numbers())?)
    }

    fn numbers(&self) -> [f64; STATE_NUMBERS] {
        let mut numbers = [self.started; STATE_NUMBERS];
        numbers[1] = self.temperature;
        numbers[2..].copy_from_slice(&self.behind);
        numbers
    }
}

impl From<[f64; STATE_NUMBERS]> for HysteronStageState {
    fn from(numbers: [f64; STATE_NUMBERS]) -> Self {
        let [started, temperature, behind @ ..] = numbers;
        Self {
            started,
            temperature,
            behind,
        }
    }
}

/// Saves what the stages remember. Together with `hysteron_state_save` it is the whole
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
/// `hysteron_state_restore`, which puts the stages at rest with the next sample.
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
