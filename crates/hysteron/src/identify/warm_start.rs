//! Recordings that begin warm, or with the drive: the drive at which the body was at rest before.

use crate::error::Result;
use crate::identify::rest::least;
use crate::model::{Model, Start};
use crate::recording::{Quantity, Recording};
use crate::series::range;
use std::borrow::Cow;

/// A body was at rest with another drive if the squared error at the beginning of the recording is
/// at most this part of that without it.
const CLEAR: f64 = 0.5;

/// So many time constants are the beginning. After them, 5 % are left of where the body began.
const BEGINNING: f64 = 3.0;

/// A constant error that explains so many beginnings much better is another offset.
const LATER: f64 = 2.0;

/// Fewer samples tell nothing of one number.
const FEWEST: usize = 8;

impl Model {
    /// The recording with the drive at which the body was at rest before it ([`Recording::rest`]),
    /// where the first drive clearly was not it: the wire was warm, or the drive began with the
    /// recording. As it is for a model without a body, and where a rest is known.
    ///
    /// ```
    /// use hysteron::{FirstOrder, Model, Operator, Plane, Recording, Sign, Surroundings};
    /// let plane = Plane::new(0.0, 1.0, 4)?;
    /// let mut model = Model::new(Operator::Mkp, plane, vec![1.0; 10], 0.0, Sign::Positive)?;
    /// model.thermal = Some(FirstOrder::default());
    /// let time: Vec<f64> = (0..100).map(|n| 0.1 * f64::from(n)).collect();
    /// let warm = Surroundings { time: Some(&time), load: None, rest: Some(0.75) };
    /// let output = model.simulate_in(&[0.25; 100], warm)?;
    /// let mut recording = Recording::new(vec![0.25; 100], output)?;
    /// recording.time = Some(time);
    /// let rest = model.rested(&recording)?.rest.unwrap_or_default();
    /// assert!((rest - 0.75).abs() < 0.05);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Model::run_in`].
    pub fn rested<'r>(&self, recording: &'r Recording) -> Result<Cow<'r, Recording>> {
        self.rested_from(Start::Fitted, recording)
    }

    /// As [`Model::rested`], where the operators began so.
    pub(crate) fn rested_from<'r>(
        &self,
        start: Start,
        recording: &'r Recording,
    ) -> Result<Cow<'r, Recording>> {
        Ok(match rest_before(self, start, recording)? {
            None => Cow::Borrowed(recording),
            rest => Cow::Owned(Recording {
                rest,
                ..recording.clone()
            }),
        })
    }

    /// As [`Model::rested`], of all recordings.
    pub(crate) fn all_rested<'r>(
        &self,
        recordings: &'r [Recording],
    ) -> Result<Cow<'r, [Recording]>> {
        if self.thermal.is_none() {
            return Ok(Cow::Borrowed(recordings));
        }
        let each = recordings.iter();
        let each = each.map(|recording| Ok(self.rested(recording)?.into_owned()));
        Ok(Cow::Owned(each.collect::<Result<_>>()?))
    }
}

/// The drive of [`Model::rested`]; `None` for the first one, and where nothing is to be found.
fn rest_before(model: &Model, start: Start, recording: &Recording) -> Result<Option<f64>> {
    let (Some(body), Some(time)) = (model.thermal, &recording.time) else {
        return Ok(None);
    };
    let beginning = BEGINNING * body.tau_heating.max(body.tau_cooling);
    let samples = |seconds: f64| time.partition_point(|t| *t <= time[0] + seconds);
    let (head, more) = (samples(beginning), samples(LATER * beginning));
    let lacks_load = model.load.is_some() && recording.load.is_none();
    // Of a recording that is hardly more than its beginning, a rest would explain all.
    let is_short = head < FEWEST || 2 * head > recording.len();
    if is_short || recording.rest.is_some() || lacks_load {
        return Ok(None);
    }
    let errors = |rest, samples| -> Result<Vec<f64>> {
        let part = Recording {
            rest,
            ..recording.part(0..samples)
        };
        let (output, _) = model.run_over(&mut model.state_at(start), &part)?;
        let pairs = output.iter().zip(&part.output);
        Ok(pairs.map(|(h, y)| y - h).collect())
    };
    let squares = |errors: &[f64]| errors.iter().map(|error| error * error).sum::<f64>();
    let ((low, high), (bottom, top)) = (model.drive_range(), range(&recording.input));
    let drives = with_none((low.min(bottom), high.max(top)));
    let (rest, least) = least(drives, |rest| Ok(squares(&errors(Some(rest), head)?)))?;
    let at_first = errors(None, more)?;
    if least >= CLEAR * squares(&at_first[..head]) {
        return Ok(None);
    }
    // Another offset looks like a rest at first, and stays. So may the operators that a rest turned
    // on, but these a rest explains as well.
    let mean = at_first.iter().sum::<f64>() / at_first.len() as f64;
    let offset: Vec<f64> = at_first.iter().map(|error| error - mean).collect();
    let is_offset = squares(&offset) < CLEAR * squares(&errors(Some(rest), more)?);
    Ok((!is_offset).then_some(rest))
}

/// A range of drives with no drive at all, where that is near: of a drive that is counted from
/// elsewhere, zero says nothing.
pub(super) fn with_none((low, high): (f64, f64)) -> (f64, f64) {
    let (least, most) = (low.min(0.0), high.max(0.0));
    match most - least <= 2.0 * (high - low) {
        true => (least, most),
        false => (low, high),
    }
}

/// What is said of the drives at which a body was at rest; `None` where each was the first one.
#[must_use]
pub fn rested_words(rests: &[Option<f64>], input: &Quantity) -> Option<String> {
    let found = rests.iter().enumerate();
    let found = found.filter_map(|(n, rest)| Some((n, input.text((*rest)?))));
    let found: Vec<String> = match rests {
        [_] => found.map(|(_, rest)| rest).collect(),
        _ => found
            .map(|(n, rest)| format!("{rest} before recording {}", n + 1))
            .collect(),
    };
    (!found.is_empty()).then(|| {
        let found = found.join(", ");
        format!(
            "the body did not begin at rest with its first drive: it was at rest with {found}, \
             found from the beginning; to simulate, give this rest"
        )
    })
}
