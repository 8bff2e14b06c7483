//! A row of the log: a sample, and the answer to it.

use crate::at::At;
use crate::error::Result;
use crate::plan::Plan;
use crate::protocol::{Header, Sample};
use hysteron::TableReader;
use hysteron::control::LoopStatus;
use std::path::Path;

/// What a sample is answered with.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Answer {
    pub(crate) drive: f64,
    /// What was due; NaN in other modes than control.
    pub(crate) reference: f64,
    /// What the model expected; NaN without one.
    pub(crate) expected: f64,
    /// Whether a limit or the slew changed the drive.
    pub(crate) limited: bool,
    pub(crate) status: LoopStatus,
    pub(crate) learner_used: bool,
}

impl Answer {
    /// No drive.
    pub(crate) fn nothing() -> Self {
        Self {
            drive: f64::NAN,
            reference: f64::NAN,
            expected: f64::NAN,
            limited: false,
            status: LoopStatus::default(),
            learner_used: false,
        }
    }

    /// The row: `drive` acted up to the sample, and `command` was sent. `word` is the status where
    /// the answer does not say it.
    pub(crate) fn row(
        &self,
        header: &Header,
        sample: &Sample,
        at: At,
        (drive, command): (f64, &str),
        (word, learner): (Option<&'static str>, &str),
    ) -> Vec<String> {
        let readings = || header.columns.iter().zip(&sample.readings);
        let output = readings().find(|(column, _)| column.name == OUTPUT);
        let output = output.map_or(f64::NAN, |(_, value)| *value);
        let mut row = vec![
            number(at.time),
            or_empty(self.reference),
            number(drive),
            command.to_owned(),
            number(output),
        ];
        let others = readings().filter(|(column, _)| column.name != OUTPUT);
        row.extend(others.map(|(_, value)| number(*value)));
        row.push(or_empty(self.expected));
        row.push(self.words(output, word));
        row.push(learner.to_owned());
        row.push(at.number.to_string());
        row
    }

    /// What was odd: of the reading, and of the drive that answers it, which a `word` may say.
    fn words(&self, output: f64, word: Option<&'static str>) -> String {
        let answered = word.is_none();
        let words = [
            (output.is_nan(), "missing"),
            (self.status.rejected && output.is_finite(), "rejected"),
            (self.status.stuck, "stuck"),
            (answered && self.limited, "limited"),
            (answered && self.status.out_of_reach, "out-of-reach"),
        ];
        let found = words.iter().filter(|(is, _)| *is).map(|(_, word)| *word);
        let found: Vec<&str> = found.chain(word).collect();
        match found.is_empty() {
            true => "ok".into(),
            false => found.join("+"),
        }
    }
}

/// The column that every device has.
const OUTPUT: &str = "output";

/// The names of the columns of a log.
pub(crate) fn columns(header: &Header) -> Vec<String> {
    let first = ["time", "reference", "drive", "command", OUTPUT];
    let own = header.columns.iter().map(|column| column.name.as_str());
    let own = own.filter(|name| *name != OUTPUT);
    let last = ["output_model", "status", "learner", "sample"];
    first
        .into_iter()
        .chain(own)
        .chain(last)
        .map(str::to_owned)
        .collect()
}

fn number(value: f64) -> String {
    match value.is_nan() {
        true => "nan".into(),
        false => value.to_string(),
    }
}

fn or_empty(value: f64) -> String {
    match value.is_nan() {
        true => String::new(),
        false => value.to_string(),
    }
}

/// Lets a controller run through the rows of a log, so that its model is where the actuator is and
/// its learner knows what it knew. The last sample; `None` for a log without rows.
pub(crate) fn replay(plan: &mut Plan, rows: &Path) -> Result<Option<At>> {
    let mut table = TableReader::open(rows)?;
    let place = |name: &str| table.header().iter().position(|column| column == name);
    let places = ["time", "drive", OUTPUT, "sample"].map(place);
    let columns: Vec<_> = table.columns().collect();
    let mut last: Option<At> = None;
    while table.advance()? {
        let value = |place: Option<usize>| {
            let column = place.and_then(|place| columns.get(place));
            column
                .and_then(|column| table.value(*column))
                .unwrap_or(f64::NAN)
        };
        let [time, drive, output, number] = places.map(value);
        let dt = last.map_or(plan.header.dt, |last| time - last.time);
        plan.recall(dt, drive, output)?;
        last = Some(At {
            number: number as u64,
            time,
        });
    }
    Ok(last)
}
