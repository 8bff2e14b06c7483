//! A job and what it found, as bytes. A transport that has no threads runs the job in a session
//! elsewhere.

use super::fault::Fault;
use super::id::Id;
use super::job::{Finished, Job, Watch};
use super::saved::SavedFit;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use hysteron::{HoldOut, Origin, Quantity, Recording, Source, UndoneLag};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::Arc;

#[derive(Serialize, Deserialize)]
struct CarriedJob {
    id: Id,
    fitted: Vec<Id>,
    recordings: Vec<CarriedRecording>,
    options: BTreeMap<String, String>,
    part: Option<CarriedPart>,
    others: Vec<CarriedRecording>,
    words: String,
    validated: Vec<Id>,
    samples: BTreeMap<Id, u64>,
}

#[derive(Serialize, Deserialize)]
enum CarriedPart {
    Branches(f64),
    Rows(Vec<RangeInclusive<usize>>),
}

/// A recording. Its numbers are base64 of their bytes: exact, and read in no time.
#[derive(Serialize, Deserialize)]
struct CarriedRecording {
    time: Option<String>,
    input: String,
    output: String,
    load: Option<String>,
    /// Names and units of input, output and load.
    quantities: [(String, Option<String>); 3],
    simulated: bool,
    source: Option<Source>,
    undone: Option<UndoneLag>,
}

#[derive(Serialize, Deserialize)]
struct CarriedFinished {
    id: Id,
    found: Result<SavedFit, Fault>,
}

impl Job {
    /// The job as bytes, for [`Job::from_bytes`] of the same version.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let recordings = |all: &[Recording]| all.iter().map(CarriedRecording::new).collect();
        let part = self.hold_out.as_ref().and_then(HoldOut::part);
        let part = part.and_then(|part| match part {
            HoldOut::Branches(share) => Some(CarriedPart::Branches(*share)),
            HoldOut::Rows(rows) => Some(CarriedPart::Rows(rows.clone())),
            HoldOut::Recordings(_) | HoldOut::Both(..) => None,
        });
        let others = self.hold_out.iter().flat_map(HoldOut::recordings);
        let carried = CarriedJob {
            id: self.id,
            fitted: self.fitted.clone(),
            recordings: recordings(&self.recordings),
            options: self.options.clone(),
            part,
            others: others.map(CarriedRecording::new).collect(),
            words: self.words.clone(),
            validated: self.validated.clone(),
            samples: self.samples.clone(),
        };
        serde_json::to_vec(&carried).unwrap_or_default()
    }

    /// The job of [`Job::to_bytes`]. It gives what the job itself would give.
    ///
    /// # Errors
    /// [`Fault`] 104 for any other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Fault> {
        let job: CarriedJob = serde_json::from_slice(bytes).map_err(torn)?;
        let recordings = |all: Vec<CarriedRecording>| {
            let all = all.into_iter().map(CarriedRecording::recording);
            all.collect::<Result<Vec<_>, _>>()
        };
        let part = job.part.map(|part| match part {
            CarriedPart::Branches(share) => HoldOut::Branches(share),
            CarriedPart::Rows(rows) => HoldOut::Rows(rows),
        });
        Ok(Self {
            id: job.id,
            fitted: job.fitted,
            recordings: recordings(job.recordings)?,
            options: job.options,
            hold_out: HoldOut::together(part, recordings(job.others)?),
            words: job.words,
            validated: job.validated,
            samples: job.samples,
            watch: Arc::new(Watch::default()),
        })
    }
}

impl Finished {
    /// What was found as bytes, for [`Finished::from_bytes`] of the same version.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let found = match &self.found {
            Ok(fitted) => SavedFit::new(fitted).ok_or_else(|| Fault::defect("a fit has no model")),
            Err(fault) => Err(fault.clone()),
        };
        let carried = CarriedFinished { id: self.id, found };
        serde_json::to_vec(&carried).unwrap_or_default()
    }

    /// What [`Finished::to_bytes`] wrote.
    ///
    /// # Errors
    /// [`Fault`] 104 for any other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Fault> {
        let carried: CarriedFinished = serde_json::from_slice(bytes).map_err(torn)?;
        let found = carried.found.and_then(SavedFit::fitted).map(Box::new);
        let id = carried.id;
        Ok(Self { id, found })
    }
}

impl CarriedRecording {
    fn new(recording: &Recording) -> Self {
        let quantity = |of: &Quantity| (of.name.clone(), of.unit.clone());
        Self {
            time: recording.time.as_deref().map(text),
            input: text(&recording.input),
            output: text(&recording.output),
            load: recording.load.as_deref().map(text),
            quantities: [
                quantity(&recording.input_quantity),
                quantity(&recording.output_quantity),
                quantity(&recording.load_quantity),
            ],
            simulated: recording.origin == Origin::Simulated,
            source: recording.source.clone(),
            undone: recording.undone,
        }
    }

    fn recording(self) -> Result<Recording, Fault> {
        let [input, output, load] = self.quantities.map(|(name, unit)| Quantity { name, unit });
        let recording = Recording {
            time: self.time.as_deref().map(numbers).transpose()?,
            load: self.load.as_deref().map(numbers).transpose()?,
            input_quantity: input,
            output_quantity: output,
            load_quantity: load,
            origin: match self.simulated {
                true => Origin::Simulated,
                false => Origin::Measured,
            },
            source: self.source,
            undone: self.undone,
            rest: None,
            input: numbers(&self.input)?,
            output: numbers(&self.output)?,
        };
        recording.check()?;
        Ok(recording)
    }
}

fn text(numbers: &[f64]) -> String {
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    STANDARD.encode(bytes)
}

fn numbers(text: &str) -> Result<Vec<f64>, Fault> {
    let bytes = STANDARD.decode(text).map_err(torn)?;
    let (numbers, []) = bytes.as_chunks() else {
        return Err(torn("a number is cut off"));
    };
    Ok(numbers.iter().map(|x| f64::from_le_bytes(*x)).collect())
}

fn torn(error: impl std::fmt::Display) -> Fault {
    Fault::defect(&format!("a job cannot be read: {error}"))
}
