//! What the stages remember, as a structure of numbers.

use hysteron_core::STATE_NUMBERS;

/// How many numbers the stages behind the operators remember.
pub const HYSTERON_BEHIND: usize = 8;

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
    pub(crate) fn numbers(&self) -> [f64; STATE_NUMBERS] {
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
