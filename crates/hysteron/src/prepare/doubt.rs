//! What in a recording cannot be believed, and cannot be mended either.
//!
//! A frozen channel and a block that comes twice are told by their readings alone. Rows in other
//! units, or with their columns exchanged, are told by what they do to a model of the others.

use super::disagree::disagreement;
use super::options::Step;
use super::single::without_wrong;
use crate::error::{Error, Result};
use crate::recording::{Recording, Rows, turned_in_gaps};
use crate::remedy::{Remedy, Setting};
use crate::series::frozen::frozen;
use crate::series::repeated::repeated;
use crate::series::spread::usual_span;
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};
use std::fmt;
use std::ops::Range;

/// A reason not to believe a recording. Rows are counted from 1, as samples of the recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Doubt {
    /// A series keeps one value, but for noise, while the other moves far; or exactly one for
    /// longer than half a branch before it goes on elsewhere.
    Frozen {
        /// Name of the series that stands still.
        series: String,
        /// The rows in which it does.
        rows: Rows,
        /// Name of the series that moves.
        other: String,
    },
    /// Rows are the same as earlier ones, bit by bit.
    Repeated {
        /// The later rows.
        rows: Rows,
        /// The earlier rows, or those of them that the first ones repeat.
        of: Rows,
    },
    /// Rows are missing between two, and the input turned meanwhile.
    Gap {
        /// Name of the input.
        series: String,
        /// The last row before the gap, and the first one after it.
        rows: Rows,
    },
    /// No model follows these rows together with the others.
    Disagree {
        /// Each stretch of them.
        rows: Vec<Rows>,
        /// The others, where these are one stretch too and nothing but their number tells which of
        /// the two are wrong.
        others: Option<Rows>,
        /// The error on the other rows of a model that has seen these too: a mean distance, in
        /// percent of the usual range of the output.
        with: f64,
        /// The error there of a model that has not, or that has seen them read in another way.
        without: f64,
        /// That way, in words: `with 25.4 times the displacement`.
        read: Option<String>,
    },
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frozen {
                series,
                rows,
                other,
            } => write!(
                f,
                "{series} stands still in rows {rows} while {other} moves: a frozen \
                 channel"
            ),
            Self::Repeated { rows, of } => {
                let all = rows.last - rows.first == of.last - of.first;
                let begin = if all {
                    "are"
                } else {
                    "stood there before, and begin as"
                };
                write!(
                    f,
                    "rows {rows} {begin} rows {of} once more, to the \
                     last digit"
                )
            }
            Self::Gap { series, rows } => {
                write!(f, "in rows {rows} is a gap in which {series} turned unseen")
            }
            Self::Disagree {
                rows,
                others,
                with,
                without,
                read,
            } => {
                let rows = rows.iter().map(Rows::to_string);
                let (how, causes) = match read {
                    Some(way) => (way.as_str(), ""),
                    None => (
                        "without them",
                        ". Other units, exchanged columns or another sensor do this",
                    ),
                };
                write!(
                    f,
                    "rows {} disagree with {}, {how} {without:.2} %{causes}",
                    rows.collect::<Vec<_>>().join(" and "),
                    match others {
                        Some(others) => format!(
                            "rows {others}, and either may be wrong: a model of both errs \
                             {with:.2} % of the range on the latter"
                        ),
                        None => format!(
                            "the others: a model that sees them errs {with:.2} % of the range on \
                             the others"
                        ),
                    }
                )
            }
        }
    }
}

/// The same fields for every doubt: `kind`, `rows` and `text`.
impl Serialize for Doubt {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Doubt", 3)?;
        fields.serialize_field("kind", self.kind())?;
        fields.serialize_field("rows", &self.rows())?;
        fields.serialize_field("text", &self.to_string())?;
        fields.end()
    }
}

impl Doubt {
    /// One word for it: `frozen`, `repeated`, `gap` or `disagree`.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Frozen { .. } => "frozen",
            Self::Repeated { .. } => "repeated",
            Self::Gap { .. } => "gap",
            Self::Disagree { .. } => "disagree",
        }
    }

    /// The stretches of rows in doubt, counted from 1.
    #[must_use]
    pub fn rows(&self) -> Vec<(usize, usize)> {
        match self {
            Self::Frozen { rows, .. } | Self::Repeated { rows, .. } | Self::Gap { rows, .. } => {
                vec![rows.ends()]
            }
            Self::Disagree { rows, .. } => rows.iter().map(|rows| rows.ends()).collect(),
        }
    }

    /// The same, of a recording that follows so many rows of others.
    #[must_use]
    pub(crate) fn after(mut self, before: usize) -> Self {
        let move_on = |rows: &mut Rows| *rows = rows.after(before);
        match &mut self {
            Self::Frozen { rows, .. } | Self::Gap { rows, .. } => move_on(rows),
            Self::Repeated { rows, of } => [rows, of].into_iter().for_each(move_on),
            Self::Disagree { rows, others, .. } => rows.iter_mut().chain(others).for_each(move_on),
        }
        self
    }

    /// What may help.
    #[must_use]
    pub fn remedy(&self) -> Remedy {
        if let Self::Gap { .. } = self {
            return Remedy::new(
                "cut the file there, since several files make one experiment; with {} it is \
                 believed",
                [Setting::on("believe")],
            );
        }
        if let Self::Disagree {
            others: Some(_), ..
        } = self
        {
            return Remedy::new(
                "find out which of the two is right, and fit that one alone, or bring both to one \
                 unit; with {} they are believed",
                [Setting::on("believe")],
            );
        }
        Remedy::new(
            "look at them. Cut the file there, in a file before them and one after them: several \
             files make one experiment; with {} they are believed",
            [Setting::on("believe")],
        )
    }
}

/// What in a recording is not to be believed unasked.
///
/// ```
/// let input: Vec<f64> = (0..2000).map(|n| (f64::from(n) * 0.02).sin()).collect();
/// let mut output: Vec<f64> = input.iter().map(|x| 3.0 * x).collect();
/// output[1200..1500].fill(1.0);
/// let recording = hysteron::Recording::new(input, output)?;
/// assert_eq!(hysteron::doubts(&recording)?[0].rows(), [(1201, 1500)]);
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// [`Error::Recording`] for an invalid recording.
pub fn doubts(recording: &Recording) -> Result<Vec<Doubt>> {
    recording.check()?;
    Ok(without_spikes(&without_wrong(recording)))
}

/// The doubts about a recording whose spikes are gone.
fn without_spikes(recording: &Recording) -> Vec<Doubt> {
    let (input, output) = (&recording.input, &recording.output);
    let (x, y) = (
        &recording.input_quantity.name,
        &recording.output_quantity.name,
    );
    let rows = |span: &Range<usize>| Rows::new(recording, span);
    let mut found = Vec::new();
    for (values, other, series, moving) in [(input, output, x, y), (output, input, y, x)] {
        found.extend(frozen(values, other).iter().map(|span| Doubt::Frozen {
            series: series.clone(),
            rows: rows(span),
            other: moving.clone(),
        }));
    }
    found.extend(repeated(input, output).iter().map(|(again, of)| {
        let (rows, of) = (rows(again), rows(of));
        Doubt::Repeated { rows, of }
    }));
    if let Some(time) = &recording.time {
        let gaps = turned_in_gaps(time, input).into_iter();
        found.extend(gaps.map(|n| Doubt::Gap {
            series: x.clone(),
            rows: rows(&(n - 1..n + 1)),
        }));
    }
    // Where rows are known to be wrong, all others would disagree with them.
    if found.is_empty() {
        let percent = |error: f64| 100.0 * error / usual_span(output);
        found.extend(disagreement(recording).map(|found| Doubt::Disagree {
            rows: found.suspect.rows.iter().map(rows).collect(),
            others: found.suspect.rest(recording.len()).map(|rest| rows(&rest)),
            with: percent(found.with),
            without: percent(found.without),
            read: found.suspect.way.map(|way| way.text(x, y)),
        }));
    }
    found
}

/// Refuses a recording that cannot be believed. Spikes that are to stay are no reason.
pub(super) fn refuse(recording: &Recording, spikes: Step) -> Result<()> {
    let found = match spikes {
        Step::Off => without_spikes(&without_wrong(recording)),
        _ => without_spikes(recording),
    };
    match found.first() {
        Some(doubt) => Err(Error::Preparation(doubt.to_string()).remedied(doubt.remedy())),
        None => Ok(()),
    }
}
