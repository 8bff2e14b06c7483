//! The session as a file: recordings with their columns, fits with their models.

use super::Session;
use super::fault::Fault;
use super::fitted::Fitted;
use super::opened::{Opened, Part, plain_name};
use super::prepare::Steps;
use super::request::{Id, Purpose};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use hysteron::{HeldOut, Model};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::Arc;

const FORMAT: &str = "hysteron-studio";
const VERSION: u64 = 1;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    format: String,
    version: u64,
    files: Vec<SavedFile>,
    fits: Vec<SavedFit>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedFile {
    id: Id,
    name: String,
    roles: Part,
    mend: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    steps: Option<Steps>,
    purpose: Purpose,
    marked: Vec<(usize, usize)>,
    /// The bytes of the file in base64.
    bytes: String,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedFit {
    id: Id,
    files: Vec<Id>,
    validated: Vec<Id>,
    options: BTreeMap<String, String>,
    hold_out: String,
    advice: Vec<String>,
    input: (f64, f64),
    output: (f64, f64),
    dt: Option<f64>,
    model: Value,
}

impl SavedFit {
    pub(super) fn of(fit: &Fitted) -> Option<Self> {
        Some(Self {
            id: fit.id,
            files: fit.files.clone(),
            validated: fit.validated.clone(),
            options: fit.options.clone(),
            hold_out: fit.words.clone(),
            advice: fit.advice.clone(),
            input: fit.input,
            output: fit.output,
            dt: fit.dt,
            model: serde_json::from_str(&fit.model.to_json()).ok()?,
        })
    }

    pub(super) fn fitted(self) -> Result<Fitted, Fault> {
        let model = Model::from_json(&self.model.to_string())?;
        let record = model.fit.as_ref().and_then(|fit| fit.other.get("hold_out"));
        Ok(Fitted {
            id: self.id,
            held_out: record.and_then(HeldOut::from_record),
            model: Arc::new(model),
            files: self.files,
            validated: self.validated,
            options: self.options,
            words: self.hold_out,
            advice: self.advice,
            input: self.input,
            output: self.output,
            dt: self.dt,
            courses: BTreeMap::new(),
            reached: None,
        })
    }
}

/// Whether bytes begin as a session file does.
pub(super) fn is_session(bytes: &[u8]) -> bool {
    bytes.starts_with(format!("{{\"format\":\"{FORMAT}\"").as_bytes())
}

impl Session {
    pub(crate) fn to_json(&self) -> String {
        let file = |file: &Opened| SavedFile {
            id: file.id,
            name: file.name.clone(),
            roles: file.roles.clone(),
            mend: file.mend,
            steps: file.steps.clone(),
            purpose: file.purpose,
            marked: file.marked.clone(),
            bytes: STANDARD.encode(&file.bytes),
        };
        let saved = File {
            format: FORMAT.into(),
            version: VERSION,
            files: self.files.iter().map(file).collect(),
            fits: self.fits.iter().filter_map(SavedFit::of).collect(),
        };
        serde_json::to_string(&saved).unwrap_or_default()
    }

    /// Puts a saved session in the place of this one. Returns the number of its first file.
    pub(crate) fn restore(&mut self, bytes: &[u8]) -> Result<Id, Fault> {
        let bad = |problem: &dyn std::fmt::Display| Fault::session(problem.to_string());
        if !self.running.is_empty() {
            return Err(Fault::missing("a fit is running", "cancel it first"));
        }
        if bytes.len() as u64 > 2 * self.budget {
            return Err(Fault::too_large("the session", self.budget));
        }
        let saved: File = serde_json::from_slice(bytes).map_err(|error| bad(&error))?;
        if saved.version != VERSION {
            return Err(bad(&format!("version {} is not known", saved.version)));
        }
        let mut new = Session::new(self.budget);
        for file in saved.files {
            let bytes = STANDARD.decode(&file.bytes).map_err(|error| bad(&error))?;
            let left = new.room();
            if bytes.len() as u64 > left {
                return Err(Fault::too_large(&file.name, left));
            }
            let mut opened = Opened::new(file.id, plain_name(&file.name), bytes, left)?;
            (opened.mend, opened.purpose) = (file.mend, file.purpose);
            opened.steps = file.steps;
            opened.set_roles(file.roles, left);
            for span in file.marked {
                opened.mark(Some(span))?;
            }
            new.files.push(opened);
        }
        for fit in saved.fits {
            new.fits.push(fit.fitted()?);
        }
        let ids = new.files.iter().map(|file| file.id);
        let mut ids: Vec<Id> = ids.chain(new.fits.iter().map(|fit| fit.id)).collect();
        ids.sort_unstable();
        if ids.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err(bad(&"a number is given twice"));
        }
        // Numbers of this session are not given again: pages may still hold them.
        new.last = ids.last().copied().unwrap_or(0).max(self.last);
        let first = new.files.first().map_or(0, |file| file.id);
        *self = new;
        Ok(first)
    }
}
