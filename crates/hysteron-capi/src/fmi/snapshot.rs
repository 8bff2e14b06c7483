//! Saved states, in memory and as bytes.

use super::block::{Block, Inputs, Kind, Outputs};
use super::instance::{Instance, Phase, Run};
use super::{Problem, Result, checksum};
use crate::handles::Table;
use hysteron_core::{STATE_NUMBERS, StageState, Status};
use std::sync::{Mutex, PoisonError};

/// A run at some time, and the checksum of its model.
#[derive(Debug)]
pub(crate) struct Saved {
    model: u64,
    run: Mutex<Run>,
}

pub(crate) static SAVED: Table<Saved> = Table::new(9);

impl Saved {
    fn run(&self) -> Run {
        self.run
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        for handle in self.saved.drain(..) {
            // A state that was freed already needs nothing.
            let _ = SAVED.remove(handle, "state");
        }
    }
}

impl Instance {
    /// Saves the run, over an older one where `handle` is not 0.
    pub(crate) fn save(&mut self, handle: u64) -> Result<u64> {
        if handle == 0 {
            return self.keep(self.run.clone());
        }
        let saved = SAVED.get(handle, "FMUstate")?;
        self.owns(&saved)?;
        *saved.run.lock().unwrap_or_else(PoisonError::into_inner) = self.run.clone();
        Ok(handle)
    }

    fn keep(&mut self, run: Run) -> Result<u64> {
        let handle = SAVED.insert(Saved {
            model: self.block.checksum,
            run: Mutex::new(run),
        })?;
        self.saved.push(handle);
        Ok(handle)
    }

    /// A state of another instance is accepted if it is of the same model.
    fn owns(&self, saved: &Saved) -> Result<()> {
        match saved.model == self.block.checksum {
            true => Ok(()),
            false => Err(Problem::new("the state belongs to another model")),
        }
    }

    pub(crate) fn saved(&self, handle: u64) -> Result<Run> {
        let saved = SAVED.get(handle, "FMUstate")?;
        self.owns(&saved)?;
        Ok(saved.run())
    }

    pub(crate) fn restore(&mut self, handle: u64) -> Result<()> {
        self.run = self.saved(handle)?;
        Ok(())
    }

    pub(crate) fn forget(&mut self, handle: u64) -> Result<()> {
        SAVED.remove(handle, "FMUstate")?;
        self.saved.retain(|other| *other != handle);
        Ok(())
    }

    pub(crate) fn serialised(&self, handle: u64) -> Result<Vec<u8>> {
        self.is_serial()?;
        Ok(self.saved(handle)?.bytes(&self.block))
    }

    /// A loop remembers more than the bytes have.
    fn is_serial(&self) -> Result<()> {
        match self.block.kind {
            Kind::Controller => Err(Problem::new(
                "the states of a controller cannot be serialised, as its description says",
            )),
            Kind::Forward | Kind::Inverse => Ok(()),
        }
    }

    pub(crate) fn deserialise(&mut self, bytes: &[u8]) -> Result<u64> {
        self.is_serial()?;
        let run = Run::of_bytes(&self.block, bytes)?;
        self.keep(run)
    }
}

/// The first word: the kind of data and the version of the format.
const MARK: u64 = u64::from_le_bytes(*b"hysfmu03");
const PHASES: [Phase; 4] = [
    Phase::Instantiated,
    Phase::Initialising,
    Phase::Stepping,
    Phase::Terminated,
];

impl Run {
    /// Words of 8 bytes, little-endian, in the order in which [`Run::of_bytes`] reads them.
    fn bytes(&self, block: &Block) -> Vec<u8> {
        let points = self.state.operators.turning_points();
        let points: Vec<u64> = points.map(f64::to_bits).collect();
        let head = [
            MARK,
            block.checksum,
            self.phase as u64,
            self.time.to_bits(),
            self.stop.unwrap_or(f64::INFINITY).to_bits(),
            self.inputs.signal.to_bits(),
            self.inputs.load.to_bits(),
            i64::from(self.inputs.heading) as u64,
            self.inputs.tolerance.to_bits(),
            u64::from(self.inputs.start_on),
            self.outputs.signal.to_bits(),
            i64::from(self.outputs.flag) as u64,
            self.outputs.temperature.to_bits(),
        ];
        let stages = self.state.stages.to_numbers().map(f64::to_bits);
        let operators = [self.state.operators.input().to_bits(), points.len() as u64];
        let words = head
            .into_iter()
            .chain(stages)
            .chain(operators)
            .chain(points)
            .chain(self.state.under_way.inputs().map(f64::to_bits));
        let mut bytes: Vec<u8> = words.flat_map(u64::to_le_bytes).collect();
        bytes.extend(checksum(&bytes).to_le_bytes());
        bytes
    }

    fn of_bytes(block: &Block, bytes: &[u8]) -> Result<Self> {
        let broken = || Problem::new("the serialised state is cut or changed");
        let (words, cut) = bytes.as_chunks::<8>();
        let words: Vec<u64> = words.iter().map(|word| u64::from_le_bytes(*word)).collect();
        let [
            mark,
            model,
            phase,
            time,
            stop,
            signal,
            load,
            heading,
            band,
            start_on,
            result,
            flag,
            temperature,
            rest @ ..,
            sum,
        ] = words.as_slice()
        else {
            return Err(broken());
        };
        let Some((stages, [input, count, points @ ..])) = rest.split_first_chunk::<STATE_NUMBERS>()
        else {
            return Err(broken());
        };
        if *mark != MARK {
            return Err(Problem::new(
                "the serialised state is of another kind or version",
            ));
        }
        let whole = checksum(&bytes[..8 * (words.len() - 1)]) == *sum;
        let of_operators = usize::try_from(*count).ok();
        let split = of_operators.and_then(|count| points.split_at_checked(count));
        let Some((points, under_way)) = split.filter(|_| whole && cut.is_empty()) else {
            return Err(broken());
        };
        if *model != block.checksum {
            return Err(Problem::new(
                "the serialised state belongs to another model",
            ));
        }
        // From here on, data can be wrong only if somebody forged the checksum. They must do no
        // harm either.
        let one = |word: &u64, most: i32| {
            i32::try_from(*word as i64)
                .ok()
                .filter(|n| (-1..=most).contains(n))
                .ok_or_else(broken)
        };
        let number = |word: &u64| f64::from_bits(*word);
        let points: Vec<f64> = points.iter().map(number).collect();
        let mut state = block.start(false)?;
        block
            .model
            .restore(&mut state.operators, &points, number(input))?;
        state.stages = StageState::from_numbers(&stages.map(f64::from_bits))?;
        let under_way: Vec<f64> = under_way.iter().map(number).collect();
        if !under_way.iter().all(|input| input.is_finite()) || !state.under_way.restore(&under_way)
        {
            return Err(broken());
        }
        let run = Self {
            phase: *usize::try_from(*phase)
                .ok()
                .and_then(|n| PHASES.get(n))
                .ok_or_else(broken)?,
            time: number(time),
            stop: Some(number(stop)).filter(|stop| *stop != f64::INFINITY),
            inputs: Inputs {
                signal: number(signal),
                load: number(load),
                heading: one(heading, 1)?,
                tolerance: number(band),
                start_on: *start_on == 1,
                ..block.inputs()
            },
            outputs: Outputs {
                signal: number(result),
                flag: one(flag, Status::Limited.number().into())?,
                temperature: number(temperature),
            },
            state,
        };
        let numbers = [run.time, run.outputs.signal, run.outputs.temperature];
        // Written so that NaN fails the comparison.
        match run.inputs.tolerance >= 0.0 && numbers.iter().all(|number| number.is_finite()) {
            true => Ok(run),
            false => Err(broken()),
        }
    }
}
