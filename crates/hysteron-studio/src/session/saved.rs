//! The session as a file: recordings with their columns, fits with their models.

use super::fault::Fault;
use super::fitted::Fitted;
use super::fitting::{FILES, held_part, part};
use super::id::{Id, LAST};
use super::job::build;
use super::judged::Judged;
use super::opened::{Opened, Part, Purpose, plain_name};
use super::prepare::Steps;
use super::state::{MOST, Session};
use base64::Engine;
use base64::display::Base64Display;
use base64::engine::general_purpose::STANDARD;
use hysteron::{Budget, Errors, HeldOut, Model};
use serde::de::Visitor;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::sync::Arc;

const FORMAT: &str = "hysteron-studio";
const VERSION: u64 = 1;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File<'f> {
    format: String,
    version: u64,
    #[serde(borrow)]
    files: Vec<SavedFile<'f>>,
    fits: Vec<SavedFit>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedFile<'f> {
    id: Id,
    name: String,
    roles: Part,
    mend: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    steps: Option<Steps>,
    purpose: Purpose,
    marked: Vec<(usize, usize)>,
    /// The bytes of the file in base64. Neither is copied, because they are large.
    #[serde(borrow)]
    bytes: Base64<'f>,
}

/// Bytes in base64: as a text that was read, or still to be written.
enum Base64<'f> {
    Text(Cow<'f, str>),
    Bytes(&'f [u8]),
}

impl Serialize for Base64<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Text(text) => to.serialize_str(text),
            Self::Bytes(bytes) => to.collect_str(&Base64Display::new(bytes, &STANDARD)),
        }
    }
}

impl<'de: 'f, 'f> Deserialize<'de> for Base64<'f> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Borrowed;
        impl<'de> Visitor<'de> for Borrowed {
            type Value = Cow<'de, str>;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("bytes in base64")
            }
            fn visit_borrowed_str<E>(self, text: &'de str) -> Result<Self::Value, E> {
                Ok(Cow::Borrowed(text))
            }
            fn visit_str<E>(self, text: &str) -> Result<Self::Value, E> {
                Ok(Cow::Owned(text.to_owned()))
            }
        }
        from.deserialize_str(Borrowed).map(Self::Text)
    }
}

impl Base64<'_> {
    fn length(&self) -> u64 {
        match self {
            Self::Text(text) => text.len() as u64,
            Self::Bytes(bytes) => bytes.len() as u64,
        }
    }

    fn decoded(&self) -> Result<Vec<u8>, base64::DecodeError> {
        match self {
            Self::Text(text) => STANDARD.decode(&**text),
            Self::Bytes(bytes) => Ok(bytes.to_vec()),
        }
    }
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
    #[serde(default)]
    inverse: Option<Errors>,
    #[serde(default)]
    verdict: Vec<(String, String)>,
    input: (f64, f64),
    output: (f64, f64),
    dt: Option<f64>,
    #[serde(default)]
    tested_on: u64,
    #[serde(default)]
    samples: BTreeMap<Id, u64>,
    model: Value,
}

impl SavedFit {
    pub(super) fn new(fit: &Fitted) -> Option<Self> {
        Some(Self {
            id: fit.id,
            files: fit.files.clone(),
            validated: fit.validated.clone(),
            options: fit.options.clone(),
            hold_out: fit.words.clone(),
            advice: fit.judged.advice.clone(),
            inverse: fit.judged.inverse,
            verdict: fit.judged.verdict.clone(),
            input: fit.input,
            output: fit.output,
            dt: fit.dt,
            tested_on: fit.tested_on,
            samples: fit.samples.clone(),
            model: serde_json::from_str(&fit.model.to_json()).ok()?,
        })
    }

    /// The fit, each of whose words is one that the session itself could have written.
    pub(super) fn fitted(self) -> Result<Fitted, Fault> {
        build(&self.options)?;
        let words = match held_part(&self.hold_out) {
            "" if matches!(self.hold_out.as_str(), "" | FILES) => self.hold_out,
            words if words == self.hold_out => part(words)?,
            words => format!("{} {FILES}", part(words)?),
        };
        for ids in [&self.files, &self.validated] {
            if ids.iter().collect::<BTreeSet<_>>().len() < ids.len() {
                return Err(Fault::session("a fit names a file twice".into()));
            }
        }
        let model = Model::from_json(&self.model.to_string())?;
        let record = model.fit.as_ref().and_then(|fit| fit.other.get("hold_out"));
        let judged = Judged {
            held_out: record.and_then(HeldOut::from_record),
            inverse: self.inverse,
            advice: self.advice,
            verdict: self.verdict,
        };
        Ok(Fitted {
            id: self.id,
            model: Arc::new(model),
            files: self.files,
            validated: self.validated,
            options: self.options,
            words,
            judged,
            samples: self.samples,
            input: self.input,
            output: self.output,
            dt: self.dt,
            tested_on: self.tested_on,
            courses: BTreeMap::new(),
            bands: BTreeMap::new(),
            held: BTreeMap::new(),
            reached: None,
        })
    }
}

/// Whether bytes begin as a session file does, with blanks or without.
pub(super) fn is_session(bytes: &[u8]) -> bool {
    let mut head = bytes
        .iter()
        .copied()
        .filter(|byte| !byte.is_ascii_whitespace());
    format!("{{\"format\":\"{FORMAT}\"")
        .bytes()
        .all(|byte| head.next() == Some(byte))
}

impl Session {
    /// Writes the session, with little memory of its own.
    pub(crate) fn write_to(&self, out: impl Write) -> std::io::Result<()> {
        fn saved(file: &Opened) -> SavedFile<'_> {
            SavedFile {
                id: file.id,
                name: file.name.clone(),
                roles: file.roles.clone(),
                mend: file.mend,
                steps: file.steps.clone(),
                purpose: file.purpose,
                marked: file.marked.clone(),
                bytes: Base64::Bytes(&file.bytes),
            }
        }
        let saved = File {
            format: FORMAT.into(),
            version: VERSION,
            files: self.files.iter().map(saved).collect(),
            fits: self.fits.iter().filter_map(SavedFit::new).collect(),
        };
        Ok(serde_json::to_writer(out, &saved)?)
    }

    /// Puts a saved session in the place of this one. Returns the number of its first file.
    pub(crate) fn restore(&mut self, bytes: &[u8]) -> Result<Id, Fault> {
        let bad = |problem: &dyn std::fmt::Display| Fault::session(problem.to_string());
        if !self.running.is_empty() {
            return Err(Fault::missing("a fit is running", "cancel it first"));
        }
        let saved: File = serde_json::from_slice(bytes).map_err(|error| bad(&error))?;
        if saved.version != VERSION {
            return Err(bad(&format!("version {} is not known", saved.version)));
        }
        if saved.fits.len() > MOST {
            return Err(bad(&format!("there are more than {MOST} fits")));
        }
        let mut new = Session::within(self.memory.clone());
        for file in saved.files {
            let name = plain_name(&file.name);
            let mut held = Budget::of(&self.memory);
            let taken = held.resize(file.bytes.length() / 4 * 3, &name);
            taken.map_err(|_| Fault::too_large(&name, self.room()))?;
            let bytes = file.bytes.decoded().map_err(|error| bad(&error))?;
            let mut opened = Opened::new(file.id, name, bytes, held)?;
            (opened.mend, opened.purpose) = (file.mend, file.purpose);
            opened.steps = file.steps.map(Steps::checked).transpose()?;
            opened.set_roles(file.roles);
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
        if ids.last().is_some_and(|last| *last > LAST) {
            return Err(bad(&"a number is too large"));
        }
        // Numbers of this session are not given again: pages may still hold them.
        new.last = ids.last().copied().unwrap_or(0).max(self.last);
        let first = new.files.first().map_or(0, |file| file.id);
        *self = new;
        Ok(first)
    }
}
