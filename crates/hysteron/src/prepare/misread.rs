//! Rows that may have been read in another way than the others: in another unit, with the columns
//! exchanged, or from a sensor that had slipped.
//!
//! Where such rows begin and end, the series jump. Read as the others they go on without a jump. Of
//! the ways to read them, only those that close the jumps are tried on a model.

use crate::recording::Recording;
use crate::series::noise::median_of;
use crate::series::spread::{range, usual_span};
use std::ops::Range;

/// Of the jumps at the ends of the rows, at most this share is left.
const CLOSED: f64 = 0.25;
/// With more jumps than this, stretches between them say nothing.
pub(super) const JUMPS: usize = 8;

/// Inputs in °F for °C, in K for °C, and the other way round: `gain T + offset`.
const TEMPERATURES: [(f64, f64); 4] = [
    (1.0 / 1.8, -32.0 / 1.8),
    (1.8, 32.0),
    (1.0, -273.15),
    (1.0, 273.15),
];
/// An inch in millimetres, a pound in newtons, a bar in psi, a turn in degrees and in radians, a
/// thousand, and the sign.
const GAINS: [f64; 6] = [
    25.4,
    4.448_22,
    14.503_8,
    180.0 / std::f64::consts::PI,
    1000.0,
    10.0,
];

/// How rows are to be read to be like the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reading {
    /// Input and output are exchanged.
    Exchanged,
    /// `gain x + offset` in place of the input `x`.
    Input(f64, f64),
    /// `gain y + offset` in place of the output `y`.
    Output(f64, f64),
}

impl Reading {
    /// The recording with `rows` read in this way.
    pub(super) fn of(self, recording: &Recording, rows: &[Range<usize>]) -> Recording {
        let mut read = recording.clone();
        for rows in rows {
            let line = |values: &mut [f64], gain: f64, offset: f64| {
                values.iter_mut().for_each(|x| *x = gain * *x + offset);
            };
            match self {
                Self::Exchanged => {
                    read.input[rows.clone()].swap_with_slice(&mut read.output[rows.clone()])
                }
                Self::Input(gain, offset) => line(&mut read.input[rows.clone()], gain, offset),
                Self::Output(gain, offset) => line(&mut read.output[rows.clone()], gain, offset),
            }
        }
        read
    }

    /// In words, of series with these names.
    pub(super) fn text(self, input: &str, output: &str) -> String {
        let line = |series: &str, (gain, offset): (f64, f64)| match (gain, offset) {
            (1.0, offset) if offset < 0.0 => format!("with {series} {:.4} lower", -offset),
            (1.0, offset) => format!("with {series} {offset:.4} higher"),
            (gain, 0.0) => format!("with {gain:.4} times the {series}"),
            (gain, _) if gain > 1.0 => format!("with {series} turned from °C to °F"),
            _ => format!("with {series} turned from °F to °C"),
        };
        match self {
            Self::Exchanged => "with their columns exchanged".into(),
            Self::Input(gain, offset) => line(input, (gain, offset)),
            Self::Output(gain, offset) => line(output, (gain, offset)),
        }
    }
}

/// Whether the middle of values lies in the range of others, or beside it by at most its width.
fn lies_near(values: &[f64], others: &[f64]) -> bool {
    let (low, high) = range(others);
    let width = high - low;
    (low - width..=high + width).contains(&median_of(values.to_vec()))
}

/// Whether rows whose columns are exchanged may err little: input and output have like values.
pub(super) fn may_be_exchanged(recording: &Recording) -> bool {
    let (input, output) = (&recording.input, &recording.output);
    lies_near(input, output) && lies_near(output, input)
}

/// Whether rows lie near the others with their columns exchanged.
pub(super) fn fits_exchanged(recording: &Recording, rows: &Range<usize>) -> bool {
    let (input, output) = (&recording.input, &recording.output);
    let others = |values: &[f64]| [&values[..rows.start], &values[rows.end..]].concat();
    lies_near(&output[rows.clone()], &others(input))
        && lies_near(&input[rows.clone()], &others(output))
}

/// Rows, and a way to read them that closes the jumps at their ends. They lie between the samples
/// `cuts` before which a series jumps.
pub(super) fn readings(recording: &Recording, cuts: &[usize]) -> Vec<(Vec<Range<usize>>, Reading)> {
    let mut found = Vec::new();
    if !(1..=JUMPS).contains(&cuts.len()) {
        return found;
    }
    let ends = [&[0], cuts, &[recording.len()]].concat();
    let last = ends.len() - 1;
    let between = |from: usize, to: usize| ends[from]..ends[to];
    let one = (0..last).flat_map(|from| (from + 1..=last).map(move |to| (from, to)));
    let one = one
        .filter(|ends| *ends != (0, last))
        .map(|(from, to)| vec![between(from, to)]);
    let every_other = |first: usize| {
        let stretches = (first..last).step_by(2);
        stretches.map(|n| between(n, n + 1)).collect()
    };
    for rows in one.chain([0, 1].map(every_other)) {
        let closing = ways(recording, &rows).into_iter();
        let closing = closing.filter(|way| closes(recording, &rows, *way));
        found.extend(closing.map(|way| (rows.clone(), way)));
    }
    found
}

/// All ways to read rows.
fn ways(recording: &Recording, rows: &[Range<usize>]) -> Vec<Reading> {
    let mut ways = vec![Reading::Exchanged];
    ways.extend(TEMPERATURES.map(|(gain, offset)| Reading::Input(gain, offset)));
    let gains = GAINS
        .into_iter()
        .flat_map(|gain| [gain, 1.0 / gain])
        .chain([-1.0]);
    ways.extend(gains.flat_map(|gain| [Reading::Input(gain, 0.0), Reading::Output(gain, 0.0)]));
    // A sensor that has slipped: by the jump.
    let first = &rows[0];
    let step = |values: &[f64]| match first.start {
        0 => values[first.end] - values[first.end - 1],
        n => values[n - 1] - values[n],
    };
    ways.push(Reading::Input(1.0, step(&recording.input)));
    ways.push(Reading::Output(1.0, step(&recording.output)));
    ways
}

/// Whether the series jump much less at the ends of `rows` where these are read in another way.
fn closes(recording: &Recording, rows: &[Range<usize>], way: Reading) -> bool {
    let other = |n: &usize| !rows.iter().any(|rows| rows.contains(n));
    let spans = [&recording.input, &recording.output].map(|values| {
        let others: Vec<f64> = (0..values.len()).filter(other).map(|n| values[n]).collect();
        usual_span(&others)
    });
    let jumps = |recording: &Recording| -> f64 {
        let ends = rows.iter().flat_map(|rows| [rows.start, rows.end]);
        let ends = ends.filter(|n| (1..recording.len()).contains(n));
        let jump = |values: &[f64], n: usize| (values[n] - values[n - 1]).abs();
        ends.map(|n| jump(&recording.input, n) / spans[0] + jump(&recording.output, n) / spans[1])
            .sum()
    };
    spans.iter().all(|span| *span > 0.0)
        && jumps(&way.of(recording, rows)) <= CLOSED * jumps(recording)
}
