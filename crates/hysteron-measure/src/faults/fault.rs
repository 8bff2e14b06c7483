//! Faults of measured recordings, put into clean ones.

use hysteron::{Recording, range};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::ops::Range;

/// A class of faults.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// Single readings far off, of either sign, in both series.
    Spikes,
    /// The same, several in a row.
    Bursts,
    /// A channel reads zero for a while.
    Zeros,
    /// A channel holds its last value for a while.
    Held,
    /// Rows are missing.
    Missing,
    /// The output stands still for a third of the recording.
    FrozenOutput,
    /// The input stands still for a third of the recording.
    FrozenInput,
    /// The clock steps forward.
    ClockForward,
    /// The clock steps back.
    ClockBack,
    /// A coarse converter: steps of a hundredth of the range.
    Quantised,
    /// Columns are exchanged in a quarter of the rows.
    Swapped,
    /// Blocks of rows come twice.
    Repeated,
    /// A quarter of the inputs is in °F instead of °C.
    InputUnit,
    /// A quarter of the outputs is in inches instead of mm.
    OutputUnit,
    /// White noise on both series.
    Noise,
    /// Spikes, bursts, zeros, missing rows and noise together.
    Everything,
}

/// All classes.
pub const FAULTS: [Fault; 16] = [
    Fault::Spikes,
    Fault::Bursts,
    Fault::Zeros,
    Fault::Held,
    Fault::Missing,
    Fault::FrozenOutput,
    Fault::FrozenInput,
    Fault::ClockForward,
    Fault::ClockBack,
    Fault::Quantised,
    Fault::Swapped,
    Fault::Repeated,
    Fault::InputUnit,
    Fault::OutputUnit,
    Fault::Noise,
    Fault::Everything,
];

impl Fault {
    /// Its name in a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Spikes => "18 spikes of either sign",
            Self::Bursts => "6 bursts of 4 to 8 readings",
            Self::Zeros => "3 dropouts to zero, 5 to 20 readings",
            Self::Held => "3 dropouts that hold the value, 5 to 20 readings",
            Self::Missing => "rows missing, 5 times 1 to 20",
            Self::FrozenOutput => "output frozen for a third",
            Self::FrozenInput => "input frozen for a third",
            Self::ClockForward => "clock steps forward by a tenth",
            Self::ClockBack => "clock steps back by a tenth",
            Self::Quantised => "readings in steps of 1 % of the range",
            Self::Swapped => "columns exchanged in a quarter of the rows",
            Self::Repeated => "two blocks of 40 rows twice",
            Self::InputUnit => "a quarter of the inputs in °F",
            Self::OutputUnit => "a quarter of the outputs in inches",
            Self::Noise => "noise of 1 % of the range on both",
            Self::Everything => "spikes, bursts, zeros, missing rows and noise",
        }
    }

    /// The recording with this fault.
    pub fn put_into(self, clean: &Recording, rng: &mut ChaCha8Rng) -> Recording {
        let mut dirty = clean.clone();
        let len = clean.len();
        let mut spans = |count: usize, lengths: Range<usize>| -> Vec<Range<usize>> {
            let span = |_| {
                let length = rng.random_range(lengths.clone());
                let start = rng.random_range(20..len - 20 - length);
                start..start + length
            };
            (0..count).map(span).collect()
        };
        match self {
            Self::Spikes | Self::Bursts => {
                let spans = match self {
                    Self::Spikes => spans(18, 1..2),
                    _ => spans(6, 4..9),
                };
                for (n, span) in spans.into_iter().enumerate() {
                    let series = series(&mut dirty, n % 2 == 0);
                    let (low, high) = range(match n % 2 == 0 {
                        true => &clean.input,
                        false => &clean.output,
                    });
                    let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
                    let height = side * rng.random_range(0.3..1.5) * (high - low);
                    series[span].iter_mut().for_each(|value| *value += height);
                }
            }
            Self::Zeros => {
                for (n, span) in spans(3, 5..21).into_iter().enumerate() {
                    series(&mut dirty, n % 2 == 0)[span].fill(0.0);
                }
            }
            Self::Held => {
                for (n, span) in spans(3, 5..21).into_iter().enumerate() {
                    let series = series(&mut dirty, n % 2 == 0);
                    let value = series[span.start];
                    series[span].fill(value);
                }
            }
            Self::Missing => {
                let gone = spans(5, 1..21);
                let kept = |n: usize| !gone.iter().any(|span| span.contains(&n));
                dirty = clean.only(kept).unwrap_or(dirty);
            }
            Self::FrozenOutput | Self::FrozenInput => {
                let span = spans(1, len / 3..len / 3 + 1).remove(0);
                let series = series(&mut dirty, self == Self::FrozenInput);
                let value = series[span.start];
                series[span].fill(value);
            }
            Self::ClockForward | Self::ClockBack => {
                let at = spans(1, 1..2).remove(0).start;
                let sign = if self == Self::ClockBack { -1.0 } else { 1.0 };
                if let Some(time) = &mut dirty.time {
                    let step = sign * 0.1 * (time[len - 1] - time[0]);
                    time[at..].iter_mut().for_each(|t| *t += step);
                }
            }
            Self::Quantised => {
                for values in [&mut dirty.input, &mut dirty.output] {
                    let (low, high) = range(values);
                    let step = 0.01 * (high - low);
                    values
                        .iter_mut()
                        .for_each(|v| *v = (*v / step).round() * step);
                }
            }
            Self::Swapped => {
                let span = spans(1, len / 4..len / 4 + 1).remove(0);
                dirty.input[span.clone()].copy_from_slice(&clean.output[span.clone()]);
                dirty.output[span.clone()].copy_from_slice(&clean.input[span]);
            }
            Self::Repeated => {
                let mut rows: Vec<usize> = (0..len).collect();
                let mut blocks = spans(2, 40..41);
                blocks.sort_by_key(|block| std::cmp::Reverse(block.start));
                for block in blocks {
                    rows.splice(block.end..block.end, block);
                }
                let pick = |values: &[f64]| rows.iter().map(|n| values[*n]).collect();
                dirty.input = pick(&clean.input);
                dirty.output = pick(&clean.output);
                // The logger goes on counting.
                dirty.time = clean.time.as_ref().map(|time| {
                    let step = (time[len - 1] - time[0]) / (len - 1) as f64;
                    (0..rows.len()).map(|n| time[0] + step * n as f64).collect()
                });
            }
            Self::InputUnit | Self::OutputUnit => {
                let span = spans(1, len / 4..len / 4 + 1).remove(0);
                let convert: fn(&mut f64) = match self {
                    Self::InputUnit => |t| *t = 1.8 * *t + 32.0,
                    _ => |y| *y /= 25.4,
                };
                let series = series(&mut dirty, self == Self::InputUnit);
                series[span].iter_mut().for_each(convert);
            }
            Self::Noise => {
                for values in [&mut dirty.input, &mut dirty.output] {
                    let (low, high) = range(values);
                    // Twelve uniform numbers make a Gaussian one.
                    let mut gaussian = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
                    let sigma = 0.01 * (high - low);
                    values.iter_mut().for_each(|v| *v += sigma * gaussian());
                }
            }
            Self::Everything => {
                for fault in [
                    Self::Noise,
                    Self::Spikes,
                    Self::Bursts,
                    Self::Zeros,
                    Self::Missing,
                ] {
                    dirty = fault.put_into(&dirty, rng);
                }
            }
        }
        dirty
    }
}

fn series(recording: &mut Recording, input: bool) -> &mut Vec<f64> {
    match input {
        true => &mut recording.input,
        false => &mut recording.output,
    }
}
