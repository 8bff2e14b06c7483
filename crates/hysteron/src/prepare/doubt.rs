//! What in a recording cannot be believed, and cannot be mended either.
//!
//! A frozen channel and a block that comes twice are told by their readings alone. Rows in other
//! units, or with their columns exchanged, are told by what they do to the others: a model that has
//! not seen them errs much less on the rest.

use super::{PrepareOptions, Step, prepare};
use crate::error::{Error, Result};
use crate::prepare::judge::{mean_distance, unseen};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use crate::series::frozen::frozen;
use crate::series::jumps::jumps;
use crate::series::noise::median_of;
use crate::series::repeated::repeated;
use crate::series::spread::usual_span;
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};
use std::fmt;
use std::ops::Range;

/// Rows that disagree raise the error on the others by at least this factor,
const FACTOR: f64 = 2.0;
/// to at least this share of the usual range of the output.
const LEAST: f64 = 0.01;
/// At most this share of the rows can disagree with the others.
const MOST: f64 = 0.4;
/// With more jumps than this, stretches between them say nothing.
const JUMPS: usize = 8;
/// Number of stretches that are looked at where nothing jumps, and how many times the usual error
/// makes one suspect.
const STRETCHES: usize = 40;
const SUSPECT: f64 = 4.0;

/// A reason not to believe a recording. Rows are counted from 1, as samples of the recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Doubt {
    /// A series keeps exactly one value while the other covers most of its range.
    Frozen {
        /// Name of the series that stands still.
        series: String,
        /// First and last row.
        rows: (usize, usize),
        /// Name of the series that moves.
        other: String,
    },
    /// Rows are the same as earlier ones, bit by bit.
    Repeated {
        /// First and last row.
        rows: (usize, usize),
        /// First and last of the earlier rows.
        of: (usize, usize),
    },
    /// No model follows these rows together with the others.
    Disagree {
        /// First and last row of each stretch.
        rows: Vec<(usize, usize)>,
        /// The error on the other rows of a model that has seen these too: a mean distance, in
        /// percent of the usual range of the output.
        with: f64,
        /// The error there of a model that has not.
        without: f64,
    },
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frozen {
                series,
                rows: (first, last),
                other,
            } => write!(
                f,
                "{series} stands still in rows {first} to {last} while {other} moves over most of \
                 its range: a frozen channel"
            ),
            Self::Repeated {
                rows: (first, last),
                of: (earlier, until),
            } => write!(
                f,
                "rows {first} to {last} are rows {earlier} to {until} once more, to the last digit"
            ),
            Self::Disagree {
                rows,
                with,
                without,
            } => {
                let rows = rows
                    .iter()
                    .map(|(first, last)| format!("{first} to {last}"));
                write!(
                    f,
                    "rows {} disagree with the others: a model that sees them errs {with:.2} % of \
                     the range on the others, without them {without:.2} %. Other units, exchanged \
                     columns or another sensor do this",
                    rows.collect::<Vec<_>>().join(" and ")
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
    /// One word for it: `frozen`, `repeated` or `disagree`.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Frozen { .. } => "frozen",
            Self::Repeated { .. } => "repeated",
            Self::Disagree { .. } => "disagree",
        }
    }

    /// The stretches of rows in doubt, counted from 1.
    #[must_use]
    pub fn rows(&self) -> Vec<(usize, usize)> {
        match self {
            Self::Frozen { rows, .. } | Self::Repeated { rows, .. } => vec![*rows],
            Self::Disagree { rows, .. } => rows.clone(),
        }
    }

    /// The same, of a recording that follows so many rows of others.
    #[must_use]
    pub(crate) fn after(mut self, before: usize) -> Self {
        let move_on = |(first, last): &mut (usize, usize)| {
            (*first, *last) = (*first + before, *last + before);
        };
        match &mut self {
            Self::Frozen { rows, .. } => move_on(rows),
            Self::Repeated { rows, of } => [rows, of].into_iter().for_each(move_on),
            Self::Disagree { rows, .. } => rows.iter_mut().for_each(move_on),
        }
        self
    }

    /// What may help.
    #[must_use]
    pub fn remedy(&self) -> Remedy {
        let rows = self.rows().into_iter();
        let rows: Vec<String> = rows
            .map(|(first, last)| format!("{first}-{last}"))
            .collect();
        Remedy::new(
            format!(
                "look at them, and take them out of the file or of the fit ({{}} rows:{}); with \
                 {{}} they are believed",
                rows.join(",")
            ),
            [Setting::any("hold-out"), Setting::on("believe")],
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
    let spikes = PrepareOptions {
        spikes: Step::Auto,
        ..PrepareOptions::all(Step::Off)
    };
    let (mended, _) = prepare(recording, &spikes, Progress::NONE)?;
    Ok(without_spikes(&mended))
}

/// The doubts about a recording whose spikes are gone.
fn without_spikes(recording: &Recording) -> Vec<Doubt> {
    let (input, output) = (&recording.input, &recording.output);
    let (x, y) = (
        &recording.input_quantity.name,
        &recording.output_quantity.name,
    );
    let rows = |span: &Range<usize>| (span.start + 1, span.end);
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
    // Where rows are known to be wrong, all others would disagree with them.
    if found.is_empty() {
        found.extend(disagreement(recording));
    }
    found
}

/// Refuses a recording that cannot be believed. Spikes that are to stay are no reason.
pub(super) fn refuse(recording: &Recording, spikes: Step) -> Result<()> {
    let found = match spikes {
        Step::Off => doubts(recording)?,
        _ => without_spikes(recording),
    };
    match found.first() {
        Some(doubt) => Err(Error::Preparation(doubt.to_string()).remedied(doubt.remedy())),
        None => Ok(()),
    }
}

/// The stretches without which a model errs least on the others, if that is much less.
fn disagreement(recording: &Recording) -> Option<Doubt> {
    let span = usual_span(&recording.output);
    let all = unseen(recording)?;
    let mut best: Option<(f64, f64, Vec<Range<usize>>)> = None;
    for stretches in suspects(recording, &all) {
        let kept = |n: usize| !stretches.iter().any(|rows| rows.contains(&n));
        let count = (0..recording.len()).filter(|n| !kept(*n)).count();
        if count == 0 || count as f64 > MOST * recording.len() as f64 {
            continue;
        }
        let Some(rest) = recording.only(kept) else {
            continue;
        };
        let Some(alone) = unseen(&rest) else { continue };
        let seen_by_all: Vec<f64> = (0..all.len())
            .filter(|n| kept(*n))
            .map(|n| all[n])
            .collect();
        let with = mean_distance(&rest.output, &seen_by_all);
        let without = mean_distance(&rest.output, &alone);
        // The usual range may be that of the wrong rows.
        let least = LEAST * usual_span(&rest.output).min(span);
        let better = best.as_ref().is_none_or(|(best, ..)| without < *best);
        if with > least && with > FACTOR * without && better {
            best = Some((without, with, stretches));
        }
    }
    let (without, with, stretches) = best?;
    let percent = |error: f64| 100.0 * error / span;
    Some(Doubt::Disagree {
        rows: stretches
            .iter()
            .map(|rows| (rows.start + 1, rows.end))
            .collect(),
        with: percent(with),
        without: percent(without),
    })
}

/// Sets of stretches that may disagree with the rest: those between jumps, alone and every other
/// one; and those where models err most.
fn suspects(recording: &Recording, predicted: &[f64]) -> Vec<Vec<Range<usize>>> {
    let len = recording.len();
    let mut sets = Vec::new();
    let mut cuts = [jumps(&recording.input), jumps(&recording.output)].concat();
    cuts.sort_unstable();
    cuts.dedup();
    if (1..=JUMPS).contains(&cuts.len()) {
        let begins = [0].into_iter().chain(cuts.iter().copied());
        let ends = cuts.iter().copied().chain([len]);
        let stretches: Vec<Range<usize>> = begins.zip(ends).map(|(a, b)| a..b).collect();
        for first in [0, 1] {
            sets.push(stretches.iter().skip(first).step_by(2).cloned().collect());
        }
        sets.extend(stretches.into_iter().map(|stretch| vec![stretch]));
    }
    let bounds: Vec<usize> = (0..=STRETCHES).map(|n| n * len / STRETCHES).collect();
    let errors = bounds.windows(2).map(|b| {
        let rows = b[0]..b[1];
        mean_distance(&recording.output[rows.clone()], &predicted[rows])
    });
    let errors: Vec<f64> = errors.collect();
    let suspect = SUSPECT * median_of(errors.clone());
    let mut large: Vec<Range<usize>> = Vec::new();
    for (error, b) in errors.iter().zip(bounds.windows(2)) {
        match large.last_mut() {
            _ if *error <= suspect => {}
            Some(last) if last.end == b[0] => last.end = b[1],
            _ => large.push(b[0]..b[1]),
        }
    }
    sets.push(large);
    sets
}
