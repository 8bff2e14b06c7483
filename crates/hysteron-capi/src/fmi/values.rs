//! The variables of a block by their value references, as in the FMU's description.

use super::block::{Block, Inputs, Kind};
use super::instance::{Instance, Phase};
use super::settings::SETTINGS;
use super::{Problem, Result};

const TIME: u32 = 0;
/// The input, or the target.
const SIGNAL: u32 = 1;
/// The output, or the input found.
const RESULT: u32 = 2;
/// `clipped`, or `status`.
const FLAG: u32 = 3;
const HEADING: u32 = 4;
const TOLERANCE: u32 = 5;
const START_ON: u32 = 6;
/// Of a model that depends on a load.
const LOAD: u32 = 7;
/// Of a model with a thermal body.
const TEMPERATURE: u32 = 8;
/// Of a controller: the reading, the change of the reference until the drive acts, manual operation
/// and its drive.
const MEASURED: u32 = 9;
const AHEAD: u32 = 10;
const MANUAL: u32 = 11;
const MANUAL_DRIVE: u32 = 12;
/// The first of its settings.
const SETTING: u32 = 13;

/// The place of a variable among the settings of a controller.
fn setting(kind: Kind, reference: u32) -> Option<usize> {
    let place = reference.checked_sub(SETTING)? as usize;
    (kind == Kind::Controller && place < SETTINGS).then_some(place)
}

/// A type of the FMU's variables.
pub(crate) trait Value: Copy {
    fn get(instance: &Instance, reference: u32) -> Result<Self>;
    fn set(self, inputs: &mut Inputs, block: &Block, reference: u32) -> Result<()>;
}

impl Value for f64 {
    fn get(instance: &Instance, reference: u32) -> Result<Self> {
        let inputs = instance.inputs();
        match (reference, instance.block().kind) {
            (TIME, _) => Ok(instance.time()),
            (SIGNAL, _) => Ok(inputs.signal),
            (RESULT, _) => Ok(instance.outputs()?.signal),
            (TOLERANCE, Kind::Inverse | Kind::Controller) => Ok(inputs.tolerance),
            (MEASURED, Kind::Controller) => Ok(inputs.measured),
            (AHEAD, Kind::Controller) => Ok(inputs.ahead),
            (MANUAL_DRIVE, Kind::Controller) => Ok(inputs.manual_drive),
            (LOAD, _) if instance.block().is_loaded() => Ok(inputs.load),
            (TEMPERATURE, _) if instance.block().has_body() => Ok(instance.outputs()?.temperature),
            (_, kind) => match setting(kind, reference) {
                Some(place) => Ok(*{ inputs.settings }.numbers()[place]),
                None => unknown("floating-point", reference),
            },
        }
    }

    fn set(self, inputs: &mut Inputs, block: &Block, reference: u32) -> Result<()> {
        match (reference, block.kind) {
            // The step refuses numbers that are not finite, with a message.
            (SIGNAL, _) => inputs.signal = self,
            (LOAD, _) if block.is_loaded() => inputs.load = self,
            (TEMPERATURE, _) if block.has_body() => return output(reference),
            // Written so that NaN fails the comparison.
            (MEASURED, Kind::Controller) => inputs.measured = self,
            (AHEAD, Kind::Controller) => inputs.ahead = self,
            (MANUAL_DRIVE, Kind::Controller) => inputs.manual_drive = self,
            (TOLERANCE, Kind::Inverse | Kind::Controller) if self >= 0.0 && self.is_finite() => {
                inputs.tolerance = self
            }
            (TOLERANCE, Kind::Inverse | Kind::Controller) => {
                return Err(Problem(format!(
                    "`tolerance` is {self}: a finite number from 0 on is needed"
                )));
            }
            (TIME | RESULT, _) => return output(reference),
            (_, kind) => match setting(kind, reference) {
                Some(place) => *inputs.settings.numbers()[place] = self,
                None => return unknown("floating-point", reference),
            },
        }
        Ok(())
    }
}

impl Value for i32 {
    fn get(instance: &Instance, reference: u32) -> Result<Self> {
        match (reference, instance.block().kind) {
            (FLAG, _) => Ok(instance.outputs()?.flag),
            (HEADING, Kind::Inverse | Kind::Controller) => Ok(instance.inputs().heading),
            _ => unknown("integer", reference),
        }
    }

    fn set(self, inputs: &mut Inputs, block: &Block, reference: u32) -> Result<()> {
        match (reference, block.kind, self) {
            (HEADING, Kind::Inverse | Kind::Controller, -1..=1) => inputs.heading = self,
            (HEADING, Kind::Inverse | Kind::Controller, _) => {
                return Err(Problem(format!(
                    "`heading` is {self}: -1, 0 or 1 is needed"
                )));
            }
            (FLAG, _, _) => return output(reference),
            _ => return unknown("integer", reference),
        }
        Ok(())
    }
}

impl Value for bool {
    fn get(instance: &Instance, reference: u32) -> Result<Self> {
        match (reference, instance.block().kind) {
            (START_ON, _) => Ok(instance.inputs().start_on),
            (MANUAL, Kind::Controller) => Ok(instance.inputs().manual),
            _ => unknown("boolean", reference),
        }
    }

    fn set(self, inputs: &mut Inputs, block: &Block, reference: u32) -> Result<()> {
        match (reference, block.kind) {
            (START_ON, _) => inputs.start_on = self,
            (MANUAL, Kind::Controller) => inputs.manual = self,
            _ => return unknown("boolean", reference),
        }
        Ok(())
    }
}

impl Instance {
    /// Sets all of the values or none.
    pub(crate) fn set<T: Value>(&mut self, values: impl Iterator<Item = (u32, T)>) -> Result<()> {
        self.expect(&[Phase::Instantiated, Phase::Initialising, Phase::Stepping])?;
        let mut inputs = self.run.inputs;
        for (reference, value) in values {
            value.set(&mut inputs, &self.block, reference)?;
        }
        if self.run.phase == Phase::Stepping && inputs.start_on != self.run.inputs.start_on {
            return Err(Problem::new(
                "`start_on` acts at the start: it is fixed from there on",
            ));
        }
        self.run.inputs = inputs;
        Ok(())
    }
}

fn unknown<T>(kind: &str, reference: u32) -> Result<T> {
    Err(Problem(format!(
        "there is no {kind} variable with the value reference {reference}"
    )))
}

fn output<T>(reference: u32) -> Result<T> {
    Err(Problem(format!(
        "the variable with the value reference {reference} is an output and cannot be set"
    )))
}
